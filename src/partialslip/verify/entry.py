"""What a verification keeps: what was asked for, and for each finished case its verdicts and what a document shows."""

from collections.abc import Mapping
from typing import Any

import msgspec

from partialslip.batch.ledger import Made
from partialslip.report.sheet import Sheet
from partialslip.verify.case import CaseVerdict
from partialslip.verify.suites import Suite


class Settings(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """What was asked for: the ``suite``, ``only`` some of its cases (all, if empty), and of random scenes the
    ``method``, the ``seed`` and how many, ``count``."""

    suite: Suite
    only: tuple[str, ...]
    method: str | None = None
    seed: int | None = None
    count: int | None = None

    @property
    def asked(self) -> dict[str, str | int]:
        """The settings that were given, by name; a count of random scenes only where they were not named."""
        given = {"suite": self.suite, "method": self.method, "seed": self.seed, "count": self.count}
        if self.only:
            del given["count"]
        return {key: value for key, value in given.items() if value is not None}


class Entry(msgspec.Struct, frozen=True, kw_only=True):
    """A finished case: its name, why it is ``hard``, its ``verdicts``, the ``sheet`` that a document shows (None where
    no method found anything, and of random scenes), whether it has meshes of its own, and when and with what it was
    ``made`` (None before a ledger has it)."""

    case: str
    hard: str
    verdicts: tuple[CaseVerdict, ...]
    sheet: Sheet | None = None
    own_meshes: bool = False
    made: Made | None = None

    @classmethod
    def of(cls, entry: Mapping[str, Any]) -> "Entry":
        """The entry of a ledger as this type."""
        return msgspec.convert(entry, cls)
