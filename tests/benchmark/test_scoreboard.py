"""The page of the scoreboard is made from the answers that are kept."""

import runpy
from pathlib import Path

from partialslip.benchmark import read_problems, read_submission

DOCS = Path(__file__).parents[2] / "docs"
SCRIPT = runpy.run_path(str(DOCS / "scoreboard.py"))


def test_the_page_is_todays():
    assert (DOCS / "scoreboard.md").read_text("utf-8") == SCRIPT["page"]()


def test_exact_answers_are_the_targets():
    found = read_submission(SCRIPT["SUBMISSIONS"] / "exact", read_problems())
    for number, answer in found.answers.items():
        for key, value in answer.values.items():
            target = read_problems()[number].targets[key]
            assert abs(value - target.value) <= 1e-9 * target.scale
