"""Settings of a verification, and the ledger's entries of finished cases."""

import msgspec

from partialslip.report.rows import Sheet
from partialslip.tools.origin import Made
from partialslip.verify.case import CaseVerdict
from partialslip.verify.formulas import Formula
from partialslip.verify.ladder import Convergence
from partialslip.verify.suites import Suite


class TitleBlock(msgspec.Struct, frozen=True, omit_defaults=True):
    """Title block of the report: ``project``, ``author``, ``reviewer`` and ``document`` number; empty if not given."""

    project: str = ""
    author: str = ""
    reviewer: str = ""
    document: str = ""

    @property
    def given(self) -> dict[str, str]:
        """Given fields by name."""
        return {key: text for key in self.__struct_fields__ if (text := getattr(self, key))}


class Settings(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """Settings of a verification.

    Parameters
    ----------
    suite : str
    only : tuple of str
        Names of cases; empty for all.
    method, seed, count : optional
        For random scenes: method, seed and number of scenes.
    ladder : bool
        Whether to add a refinement ladder to each case that allows one.
    block : TitleBlock
    """

    suite: Suite
    only: tuple[str, ...]
    method: str | None = None
    seed: int | None = None
    count: int | None = None
    ladder: bool = False
    block: TitleBlock = TitleBlock()

    @property
    def asked(self) -> dict[str, str | int]:
        """Given settings by name; ``count`` only if ``only`` is empty."""
        given = {"suite": self.suite, "method": self.method, "seed": self.seed, "count": self.count}
        if self.only:
            del given["count"]
        return {key: value for key, value in given.items() if value is not None}


class Entry(msgspec.Struct, frozen=True, kw_only=True):
    """A finished case.

    Parameters
    ----------
    case : str
        Name.
    hard : str
        Why the case is hard; kind of loads of a random scene.
    verdicts : tuple of CaseVerdict
    sheet : Sheet or None
        Tables for the report; None if every method failed, and for random scenes.
    own_meshes : bool
        Whether the meshes are given.
    formulas : tuple of (str, str)
        Formulas that the exact method evaluates, with numbers of references.
    ladder : tuple of Convergence
        Convergence by quantity; empty without a refinement ladder.
    made : Made or None
        Origin of the entry; None before it is in a ledger.
    """

    case: str
    hard: str
    verdicts: tuple[CaseVerdict, ...]
    sheet: Sheet | None = None
    own_meshes: bool = False
    formulas: tuple[Formula, ...] = ()
    ladder: tuple[Convergence, ...] = ()
    made: Made | None = None
