"""The work that scenes take, counted, with the methods' estimates of their errors; and the table of both.

``python tests/work/counting.py`` counts all anew, writes the table, and prints what has changed.
"""

import math
from pathlib import Path

import partialslip
from partialslip.result import Result
from partialslip.verify import hard_cases, shipped, solve_case

TABLE = Path(__file__).parent / "work.txt"
RENEW = "python tests/work/counting.py"
HEAD = f"""\
# Work of the shipped scenes and of ten hard cases, and the methods' own estimates of their errors: of the ends (the
# largest of a, m and n, in a) and of q (relative). They change where speed or accuracy changes.
# If they are meant to change, write this file anew: {RENEW}
"""
HARD = (
    "near-sliding-1e-3", "near-stuck-1e-9", "transition-at", "huge-tension-1e-5", "beside-small", "nu-0.4999",
    "sharp-0.99", "mean-load-0.5", "varying-near-zero", "non-matching-0.7",
)  # fmt: skip
CASES = {case.name: case for case in (*shipped(), *hard_cases()) if case.name in (*partialslip.shipped_scenes(), *HARD)}
COUNTS = ("unknowns", "meshes", "factorizations", "iterations", "load_steps")
ESTIMATES = ("ends", "q")
COLUMNS = (*COUNTS, *ESTIMATES)

# Gmsh cuts one or the other of two equal edges, as rounding decides: meshes of other processors have some triangles
# more or less, and the active set takes another way. On meshes of five kinds (three processors, element sizes 0.1 %
# larger and smaller) unknowns differ by up to 3.7 % and iterations by up to 9 %. No other count differs: one mesh more
# is a changed estimate, or a changed goal.
SHARE = {"unknowns": 0.06, "iterations": 0.15}
FEW = 4  # iterations
FACTOR = 1.6  # of estimates, which differ by up to a factor of 1.4 on these meshes

Row = dict[str, float | None]


def counted(name: str) -> dict[tuple[str, str], Row]:
    """Return the rows of the methods of a case that iterate, by case and method."""
    found = solve_case(CASES[name])
    return {(name, method): _row(result) for method, result in found.items() if method != "exact"}


def _row(result: object) -> Row:
    assert isinstance(result, Result), result
    counts, estimate = result.counts, result.estimate
    ends = [estimate[key] for key in "amn" if key in estimate]
    return {
        "unknowns": counts.get("dofs") or counts.get("cells"),
        **{key: counts.get(key) for key in COUNTS[1:]},
        "ends": max(ends, default=None),
        "q": estimate.get("q"),
    }


def changes(expected: Row, found: Row) -> list[str]:
    """Return a line for each number that is not as expected."""
    lines = []
    for key, value in expected.items():
        now = found[key]
        if value is None or now is None:
            same, allowed = value is now, ""
        else:
            least, most = _range(key, value)
            same, allowed = least <= now <= most, f" (allowed: {_text(key, least)} to {_text(key, most)})"
        if not same:
            lines.append(f"{key}: {_text(key, value)} -> {_text(key, now)}{allowed}")
    return lines


def _range(key: str, value: float) -> tuple[float, float]:
    if key in ESTIMATES:
        return value / FACTOR, value * FACTOR
    room = SHARE.get(key, 0.0) * value + (FEW if key == "iterations" else 0)
    return math.floor(value - room), math.ceil(value + room)


def read() -> dict[tuple[str, str], Row]:
    """Return the table: rows by case and method."""
    rows = [line.split() for line in TABLE.read_text("utf-8").splitlines() if not line.startswith("#")]
    return {
        (case, method): {
            key: None if cell == "-" else (float if key in ESTIMATES else int)(cell)
            for key, cell in zip(COLUMNS, cells, strict=True)
        }
        for case, method, *cells in rows[1:]
    }


def text(table: dict[tuple[str, str], Row]) -> str:
    """Return the table as the text of its file."""
    rows = [("case", "method", *COLUMNS)]
    rows += [(*names, *(_text(key, value) for key, value in row.items())) for names, row in table.items()]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ["  ".join(f"{cell:{'<>'[k > 1]}{widths[k]}}" for k, cell in enumerate(row)) for row in rows]
    return HEAD + "\n".join(lines) + "\n"


def _text(key: str, value: float | None) -> str:
    if value is None:
        return "-"
    return f"{value:.1e}" if key in ESTIMATES else f"{value:.0f}"


def _renew() -> None:
    before = read() if TABLE.exists() else {}
    table = {names: row for name in CASES for names, row in counted(name).items()}
    TABLE.write_text(text(table), "utf-8")
    for names, row in read().items():
        for key, now in row.items():
            if names not in before or before[names].get(key) != now:
                print(*names, f"{key}: {_text(key, before.get(names, {}).get(key))} -> {_text(key, now)}")


if __name__ == "__main__":
    _renew()
