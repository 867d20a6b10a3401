"""The page of the scoreboard is made from the answers that are kept."""

import json
import runpy
from pathlib import Path

from partialslip.verify.benchmark import read_problems, read_submission
from partialslip.verify.benchmark.grade import best_grade
from partialslip.verify.benchmark.scoreboard import grades

DOCS = Path(__file__).parents[2] / "docs"
SCRIPT = runpy.run_path(str(DOCS / "scoreboard.py"))


def test_the_page_is_todays():
    assert (DOCS / "scoreboard.md").read_text("utf-8") == SCRIPT["page"]()


def test_the_table_of_stiffness_on_the_page_of_symptoms_is_todays():
    peers = DOCS.parent / "benchmarks" / "peers"
    lines = [json.loads(line) for line in (peers / "stiffness.jsonl").read_text("utf-8").splitlines()]
    assert len(lines) > 24
    assert runpy.run_path(str(peers / "stiffness.py"))["table"](lines) in (DOCS / "symptoms.md").read_text("utf-8")


def test_exact_answers_are_the_targets():
    found = read_submission(SCRIPT["SUBMISSIONS"] / "exact", read_problems())
    for number, answer in found.answers.items():
        for key, value in answer.values.items():
            target = read_problems()[number].targets[key]
            assert abs(value - target.value) <= 1e-9 * target.scale


def test_uncertain_targets_bound_the_grade():
    """Problems whose targets come from methods with errors of their own cannot have an A."""
    bounded = {number: best_grade(problem) for number, problem in read_problems().items() if best_grade(problem) != "A"}
    assert bounded == {"PS-18": "B", "PS-22": "B", "PS-25": "B"}


def test_no_answer_has_a_better_grade_than_the_targets_allow():
    problems = read_problems()
    for folder in SCRIPT["SUBMISSIONS"].iterdir():
        for number, graded in grades(problems, read_submission(folder, problems)).items():
            assert graded.overall.grade >= best_grade(problems[number])
