"""Summary of a run as table cells, as the ledger of a verification stores it."""

import msgspec

from partialslip.report import rows
from partialslip.run import Run


class Sheet(msgspec.Struct, frozen=True):
    """Texts of tables: ``title``, ``settings`` and ``effects`` of a scene, and facts about the ``methods``."""

    title: str
    settings: tuple[tuple[str, str], ...]
    effects: tuple[tuple[str, str, str], ...]
    methods: tuple[tuple[str, str, str], ...]


def sheet(run: Run) -> Sheet:
    """Return the sheet of ``run``."""
    return Sheet(
        run.scene.title,
        tuple(rows.settings_of_tables(run.scene)),
        tuple(rows.effects(run.plan)),
        tuple(rows.methods(run.results, compared=True, units=run.scene.units)),
    )
