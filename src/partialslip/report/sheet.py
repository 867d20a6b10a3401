"""Summary of a run in words and table cells, as the ledger of a verification keeps it."""

import msgspec

from partialslip.report import rows
from partialslip.run import Run


class Sheet(msgspec.Struct, frozen=True):
    """Title, settings and effects of a scene, and facts of every method, as the texts of tables."""

    title: str
    settings: tuple[tuple[str, str], ...]
    effects: tuple[tuple[str, str, str], ...]
    methods: tuple[tuple[str, str, str], ...]


def sheet(run: Run) -> Sheet:
    """The sheet of ``run``."""
    return Sheet(
        run.scene.title,
        tuple(rows.settings_of_tables(run.scene)),
        tuple(rows.effects(run.plan)),
        tuple(rows.methods(run.results, compared=True)),
    )
