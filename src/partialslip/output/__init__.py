"""Files, tables, figures and pages: a toolkit that knows no scene, no result and no run."""
