"""Tools for files, tables, figures and pages, independent of scenes, results and runs."""
