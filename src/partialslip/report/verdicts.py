"""Verdicts for people and files: results.json, results.csv and the terminal's table."""

import json
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
    texts = {_FILE: json.dumps(record, indent=1, allow_nan=False) + "\n", "results.csv": _csv(_all(verdicts))}
    return write_texts(folder, texts)


def read_verdicts(folder: Path, settings: Mapping[str, Any]) -> dict[str, list[Verdict]]:
    """The verdicts that a run with the same settings and versions left behind unfinished; none where there is no such
    file."""
    try:
        record = json.loads((folder / _FILE).read_text("utf-8"))
        same = all(record[key] == value for key, value in _head(settings).items())
        return {name: [Verdict(**one) for one in some] for name, some in record["cases"].items()} if same else {}
    except (OSError, ValueError, TypeError, KeyError, AttributeError):
        return {}


def print_verdicts(verdicts: Verdicts, console: Console, every: bool = True) -> None:
    """Print a line for each case and method, of its quantity nearest to its bar (or without ``every`` for what is
    missed only), and the sum of all."""
    rows = [min(some, key=_room) for some in _by_method(verdicts)]
    shown = rows if every else [row for row in rows if not row.passed]
    if shown:
        headings = ("case", "method", "closest", "value", "bar", "faces", "CPU s", "")
        print_table(console, headings, map(_row, shown), words=(0, 1, 2, 7))
    for verdict in _all(verdicts):
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


def _head(settings: Mapping[str, Any]) -> dict[str, Any]:
    """What a file must say to be gone on with."""
    return {"schema": SCHEMA, "settings": dict(settings), "finished": False, "versions": versions()}


def _csv(verdicts: Iterable[Verdict]) -> str:
    names = [each.name for each in fields(Verdict)]
    return csv_text(names, ([getattr(verdict, name) for name in names] for verdict in verdicts))


def _row(row: Verdict) -> list[str]:
    value, bar = ("" if number is None else f"{number:.1e}" for number in (row.value, row.bar))
    work = f"{row.iterations:,}", f"{row.cpu_s:.2f}"
    return [row.case, row.method, row.check, value, bar, *work, "ok" if row.passed else "MISSED"]


def _all(verdicts: Verdicts) -> list[Verdict]:
    return [verdict for some in verdicts.values() for verdict in some]


def _by_method(verdicts: Verdicts) -> list[list[Verdict]]:
    groups: dict[tuple[str, str], list[Verdict]] = {}
    for verdict in _all(verdicts):
        groups.setdefault((verdict.case, verdict.method), []).append(verdict)
    return list(groups.values())


def _room(verdict: Verdict) -> tuple[bool, float]:
    """To sort by: what is missed first, then by how much of the bar is left."""
    if verdict.value is None or not verdict.bar:
        return verdict.passed, 1.0
    return verdict.passed, 1 - verdict.value / verdict.bar


def _shown(verdict: Verdict) -> str:
    if verdict.value is None:
        return f"{verdict.check}:"
    return f"{verdict.check} {verdict.value:.2e}" + ("" if verdict.bar is None else f" > {verdict.bar:.2e}")
