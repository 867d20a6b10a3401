"""Regenerate the page of the scoreboard: python docs/scoreboard.py writes scoreboard.md from benchmarks/submissions."""

from pathlib import Path

from partialslip.benchmark import read_problems, read_submission, scoreboard
from partialslip.benchmark.problem import EDITION

DOCS = Path(__file__).parent
SUBMISSIONS = DOCS.parent / "benchmarks" / "submissions"

_HEAD = """\
# Scoreboard

Grades of codes on the [problems of the benchmark](howto/benchmark.md), edition {edition}, from A (every target within
1e-4) to E (beyond 5e-2), with CPU seconds in brackets. A dash: the code does not offer the problem, or one of the
targets. The answers are in `benchmarks/submissions`; they were measured on one machine, which other work shared.

{codes}

"""


def page() -> str:
    """Content of the page."""
    problems = read_problems()
    found = [read_submission(folder, problems) for folder in sorted(SUBMISSIONS.iterdir())]
    board = scoreboard(problems, found)
    letters = [chr(ord("a") + number) for number in range(len(found))]
    codes = "\n".join(
        f"- **{letter}**: {each.meta.code} {each.meta.version}"
        + (f"; {each.meta.settings}" if each.meta.settings else "")
        for letter, each in zip(letters, found, strict=True)
    )
    lines = ["| | " + " | ".join(letters) + " |", "|---|" + "---|" * len(letters)]
    lines += [f"| {row[0]} | " + " | ".join(row[1:]) + " |" for row in board.rows]
    return _HEAD.format(edition=EDITION, codes=codes) + "\n".join(lines) + "\n"


if __name__ == "__main__":
    (DOCS / "scoreboard.md").write_text(page(), "utf-8")
