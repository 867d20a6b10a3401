"""The work that scenes take, counted, and the table of what it should be.

``python tests/work/counting.py`` counts all anew, writes the table, and prints what has changed.
"""

from pathlib import Path

import partialslip
from partialslip.result import Result
from partialslip.verify import hard_cases, shipped, solve_case

TABLE = Path(__file__).parent / "work.txt"
RENEW = "python tests/work/counting.py"
HEAD = f"""\
# Work of the shipped scenes and of ten hard cases. A change of speed or accuracy changes these counts.
# If it is meant to be so, write this file anew: {RENEW}
"""
HARD = (
    "near-sliding-1e-3", "near-stuck-1e-6", "transition-at", "huge-tension-1e-5", "beside-small", "nu-0.4999",
    "sharp-0.99", "mean-load-0.5", "varying-near-zero", "non-matching-0.7",
)  # fmt: skip
CASES = {case.name: case for case in (*shipped(), *hard_cases()) if case.name in (*partialslip.shipped_scenes(), *HARD)}
COUNTS = ("unknowns", "meshes", "factorizations", "iterations", "load_steps")

# Gmsh cuts one or the other of two equal edges, as rounding decides: meshes of other processors have some triangles
# more or less, and the active set takes another way. So the unknowns may differ by this share, and so may the
# iterations, but for a few. No other count may differ: a mesh more is a changed estimate.
SHARE = {"unknowns": 0.03, "iterations": 0.15}
FEW = 4

Counts = dict[str, int | None]


def counted(name: str) -> dict[tuple[str, str], Counts]:
    """Return the counts of the methods of a case that iterate, by case and method."""
    found = solve_case(CASES[name])
    return {(name, method): _counts(result) for method, result in found.items() if method != "exact"}


def _counts(result: object) -> Counts:
    assert isinstance(result, Result), result
    unknowns = result.counts.get("dofs") or result.counts.get("cells")
    return {"unknowns": unknowns, **{key: result.counts.get(key) for key in COUNTS[1:]}}


def changes(expected: Counts, found: Counts) -> list[str]:
    """Return a line for each count that is not as expected."""
    lines = []
    for key, count in expected.items():
        now = found[key]
        if count is None or now is None:
            same, allowed = count is now, ""
        else:
            room = SHARE[key] * count + (FEW if key == "iterations" else 0) if key in SHARE else 0
            same, allowed = abs(now - count) <= room, f" (allowed: {count - room:.0f} to {count + room:.0f})"
        if not same:
            lines.append(f"{key}: {_text(count)} -> {_text(now)}{allowed}")
    return lines


def read() -> dict[tuple[str, str], Counts]:
    """Return the table: counts by case and method."""
    rows = [line.split() for line in TABLE.read_text("utf-8").splitlines() if not line.startswith("#")]
    return {
        (case, method): {key: None if cell == "-" else int(cell) for key, cell in zip(COUNTS, cells, strict=True)}
        for case, method, *cells in rows[1:]
    }


def text(table: dict[tuple[str, str], Counts]) -> str:
    """Return the table as the text of its file."""
    rows = [("case", "method", *COUNTS), *((*key, *map(_text, counts.values())) for key, counts in table.items())]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = [
        "  ".join(cell.ljust(width) if k < 2 else cell.rjust(width) for k, (cell, width) in enumerate(zip(row, widths, strict=True)))
        for row in rows
    ]
    return HEAD + "\n".join(lines) + "\n"


def _text(count: int | None) -> str:
    return "-" if count is None else str(count)


if __name__ == "__main__":
    before = read() if TABLE.exists() else {}
    table = {key: counts for name in CASES for key, counts in counted(name).items()}
    TABLE.write_text(text(table), "utf-8")
    for key, counts in table.items():
        for count, now in counts.items():
            if key in before and before[key][count] != now:
                print(*key, f"{count}: {_text(before[key][count])} -> {_text(now)}")
