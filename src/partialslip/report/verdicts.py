"""Verdicts for people and files: results.json, results.csv and the terminal's table."""

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

from rich.console import Console

from partialslip.report.files import csv_text, write_texts
from partialslip.report.record import versions
from partialslip.report.table import print_table
from partialslip.verify import Verdict

SCHEMA = "partialslip/verify/1"
_FILE = "results.json"

Verdicts = Mapping[str, Sequence[Verdict]]


def write_verdicts(folder: Path, settings: Mapping[str, Any], verdicts: Verdicts, finished: bool) -> list[Path]:
    """Write results.json and results.csv into ``folder``: the verdicts by case, and what was asked for. Returns their
    paths. Raises InputError if the folder cannot be written."""
    record = {
        "schema": SCHEMA,
        "settings": dict(settings),
        "finished": finished,
        "versions": versions(),
        "cases": {name: [asdict(verdict) for verdict in some] for name, some in verdicts.items()},
    }
    texts = {_FILE: json.dumps(record, indent=1, allow_nan=False) + "\n", "results.csv": _csv(every_one(verdicts))}
    return write_texts(folder, texts)


def was_finished(folder: Path) -> bool:
    """Whether ``folder`` holds the verdicts of a run that came to its end."""
    try:
        record = json.loads((folder / _FILE).read_text("utf-8"))
        return record["schema"] == SCHEMA and record["finished"] is True
    except (OSError, ValueError, TypeError, KeyError, RecursionError):
        return False


def print_verdicts(verdicts: Verdicts, console: Console, every: bool = True) -> None:
    """Print a line for each case and method, of its quantity nearest to its bar (or without ``every`` for what is
    missed only), and the sum of all."""
    rows = nearest(verdicts)
    shown = rows if every else [row for row in rows if not row.passed]
    if shown:
        headings = ("case", "method", "closest", "value", "bar", "faces", "CPU s", "")
        print_table(console, headings, map(_row, shown), words=(0, 1, 2, 7))
    for verdict in every_one(verdicts):
        if not verdict.passed:
            what = " ".join(part for part in (_shown(verdict), verdict.found) if part)
            console.print(f"missed: {verdict.case}, {verdict.method}: {what}", soft_wrap=True, markup=False)
    if rows:
        most = max(rows, key=lambda row: row.iterations)
        console.print(
            f"{len(verdicts):,} cases, {sum(not row.passed for row in rows):,} with something missed, "
            f"{sum(row.cpu_s for row in rows):.1f} CPU s, at most {most.iterations:,} iterations ({most.case})",
            style="bold", soft_wrap=True, markup=False,
        )  # fmt: skip


def _csv(verdicts: Iterable[Verdict]) -> str:
    names = [each.name for each in fields(Verdict)]
    return csv_text(names, ([getattr(verdict, name) for name in names] for verdict in verdicts))


def _row(row: Verdict) -> list[str]:
    value, bar = ("" if number is None else f"{number:.1e}" for number in (row.value, row.bar))
    work = f"{row.iterations:,}", f"{row.cpu_s:.2f}"
    return [row.case, row.method, row.check, value, bar, *work, "ok" if row.passed else "MISSED"]


def every_one(verdicts: Verdicts) -> list[Verdict]:
    """All of them in one list."""
    return [verdict for some in verdicts.values() for verdict in some]


def nearest(verdicts: Verdicts) -> list[Verdict]:
    """Of each case and method the verdict that is missed, or nearest to its bar."""
    groups: dict[tuple[str, str], list[Verdict]] = {}
    for verdict in every_one(verdicts):
        groups.setdefault((verdict.case, verdict.method), []).append(verdict)
    return [min(some, key=room) for some in groups.values()]


def room(verdict: Verdict) -> tuple[bool, float]:
    """To sort by: what is missed first, then by how much of the bar is left."""
    share = verdict.share
    return verdict.passed, math.inf if share is None else 1 - share


def _shown(verdict: Verdict) -> str:
    if verdict.value is None:
        return f"{verdict.check}:"
    return f"{verdict.check} {verdict.value:.2e}" + ("" if verdict.bar is None else f" > {verdict.bar:.2e}")
