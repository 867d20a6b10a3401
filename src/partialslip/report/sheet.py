"""What a document shows of a run, in words and table cells: plain data, which can wait in a file for its turn."""

from typing import Any

from partialslip.report import rows
from partialslip.run import Run


def sheet(run: Run) -> dict[str, Any]:
    """Title, settings and effects of the scene, and facts of every method: texts."""
    return {
        "title": run.scene.title,
        "settings": rows.settings_of_tables(run.scene),
        "effects": rows.effects(run.plan),
        "methods": rows.methods(run.results, compared=True),
    }
