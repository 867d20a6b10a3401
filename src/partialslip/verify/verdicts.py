"""Write and print verdicts: results.json, results.csv and the terminal table."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields
from pathlib import Path

import msgspec
from rich.console import Console

from partialslip.report import rows
from partialslip.run.judge import NO_BAR, Outcome
from partialslip.tools.errors import InputError
from partialslip.tools.groups import grouped
from partialslip.tools.inputfile import read_bytes
from partialslip.tools.origin import versions
from partialslip.tools.output.files import csv_text, json_text, write_texts
from partialslip.tools.output.tables import print_table
from partialslip.tools.strictjson import decoded
from partialslip.verify.case import CaseVerdict, conclusions, requirement_of
from partialslip.verify.entry import Settings

VERDICTS_SCHEMA = "partialslip/verify/2"
_FILE = "results.json"
_SCREEN = 24  # display: rows
_LARGEST = 2**30  # limit: bytes

Verdicts = Mapping[str, Sequence[CaseVerdict]]


class VerificationRecord(msgspec.Struct, frozen=True):
    """Content of the ``results.json`` of a verification.

    Parameters
    ----------
    schema : str
    settings : Settings
    finished : bool
        Whether the run finished.
    versions : dict of str to str
        Versions of Python and packages.
    cases : dict of str to tuple of CaseVerdict
        Verdicts by case.
    """

    schema: str
    settings: Settings
    finished: bool
    versions: dict[str, str]
    cases: dict[str, tuple[CaseVerdict, ...]]


class _Finished(msgspec.Struct):
    schema: str
    finished: bool


def write_verdicts(folder: Path, settings: Settings, verdicts: Verdicts, finished: bool) -> list[Path]:
    """Write results.json and results.csv into ``folder``. Returns the paths.

    Parameters
    ----------
    folder : Path
    settings : Settings
    verdicts : mapping of str to sequence of CaseVerdict
        Verdicts by case.
    finished : bool
        Whether the run is finished.

    Raises
    ------
    InputError
        If the folder cannot be written.
    """
    found = VerificationRecord(
        schema=VERDICTS_SCHEMA,
        settings=settings,
        finished=finished,
        versions=versions(),
        cases={name: tuple(verdict.finite for verdict in some) for name, some in verdicts.items()},
    )
    texts = {
        _FILE: json_text(found),
        "results.csv": _csv(every_one(verdicts)),
    }
    return write_texts(folder, texts)


def was_finished(folder: Path) -> bool:
    """Return whether ``folder`` holds the verdicts of a finished run."""
    try:
        found = decoded(read_bytes(folder / _FILE, _LARGEST), _Finished, _FILE)
    except InputError:
        return False
    return found.schema == VERDICTS_SCHEMA and found.finished


def print_verdicts(verdicts: Verdicts, console: Console, every: bool = True) -> None:
    """Print ``verdicts`` on ``console``: one row per case and method, for the quantity nearest to the bar, and totals.

    Without ``every``, more rows than a screen shows are left out unless a verdict is missed.
    """
    closest = nearest(verdicts)
    shown = closest if every or len(closest) <= _SCREEN else [row for row in closest if missed(row)]
    if shown:
        headings = ("case", "method", "closest", "error", "bar", "iterations", "CPU s", "")
        print_table(console, headings, map(_verdict_row, shown), words=(0, 1, 2, 7))
    listed = every_one(verdicts)
    for verdict in filter(missed, listed):
        console.print(f"missed: {verdict.case}, {verdict.method}: {verdict.text}", soft_wrap=True, markup=False)
    for (case, method), found in conclusions(listed).items():
        if found.unjudged and found.outcome is not Outcome.MISSED:
            console.print(f"{case}, {method}: {found.text}", soft_wrap=True, markup=False)
    for reason, cases in _without_reference(listed).items():
        console.print(f"m, n and q not judged: {', '.join(cases)}: {reason}", soft_wrap=True, markup=False)
    if closest:
        most = max(closest, key=lambda row: row.iterations)
        unjudged = sum(verdict.outcome is Outcome.NOT_JUDGED for verdict in listed)
        console.print(
            f"{len(verdicts):,} cases, {sum(map(missed, closest)):,} with something missed"
            f"{f', {unjudged:,} of {len(listed):,} verdicts not judged' if unjudged else ''}, "
            f"{sum(row.cpu_s for row in closest):.1f} CPU s, at most {most.iterations:,} iterations ({most.case})",
            style="bold", soft_wrap=True, markup=False,
        )  # fmt: skip


def _without_reference(verdicts: Iterable[CaseVerdict]) -> dict[str, list[str]]:
    """Cases of which no solution is known to hold for m, by the reason."""
    found = grouped(
        (verdict.reason, verdict.case)
        for verdict in verdicts
        if verdict.quantity == "m" and verdict.outcome is Outcome.NOT_JUDGED
        if verdict.waived and verdict.known and verdict.reason not in ("", NO_BAR)
    )
    return {reason: [*dict.fromkeys(cases)] for reason, cases in found.items()}


def _csv(verdicts: Iterable[CaseVerdict]) -> str:
    names = [each.name for each in fields(CaseVerdict)]
    return csv_text(names, ([getattr(verdict.finite, name) for name in names] for verdict in verdicts))


def _verdict_row(row: CaseVerdict) -> list[str]:
    error, bar = ("" if number is None else f"{number:.1e}" for number in (row.error, row.bar))
    work = f"{row.iterations:,}", f"{row.cpu_s:.2f}"
    return [row.case, row.method, row.quantity, error, bar, *work, rows.word(row)]


def missed(verdict: CaseVerdict) -> bool:
    """Return whether ``verdict`` is missed."""
    return verdict.outcome is Outcome.MISSED


def every_one(verdicts: Verdicts) -> list[CaseVerdict]:
    """Return all ``verdicts`` in one list."""
    return [verdict for some in verdicts.values() for verdict in some]


def nearest(verdicts: Verdicts) -> list[CaseVerdict]:
    """Return one verdict per case and method: a missed one, else the one nearest to the bar, without estimates: how far
    these are from errors says nothing about the errors."""
    groups = grouped(
        ((verdict.case, verdict.method), verdict)
        for verdict in every_one(verdicts)
        if missed(verdict) or requirement_of(verdict.quantity) != "estimate"
    )
    return [min(some, key=bar_left) for some in groups.values()]


def bar_left(verdict: CaseVerdict) -> tuple[bool, float]:
    """Return the sort key of ``verdict``: missed verdicts first, then by the remaining fraction of the bar."""
    share = verdict.share if verdict.outcome is not Outcome.NOT_JUDGED else None
    return not missed(verdict), math.inf if share is None else 1 - share
