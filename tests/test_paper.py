"""The paper says what the frozen files say: each of its numbers is made by paper/paper.py."""

import re
import runpy
from pathlib import Path

import pytest

from partialslip.verify.benchmark import read_problems

FOLDER = Path(__file__).parents[1] / "paper"
SCRIPT = runpy.run_path(str(FOLDER / "paper.py"))
PAPER = (FOLDER / "paper.md").read_text("utf-8")
TEMPLATE = (FOLDER / "paper.in.md").read_text("utf-8")
BIB = (FOLDER / "paper.bib").read_text("utf-8")


def digits(text):
    """What of the body of the template has digits: names of works, problems and the licence set aside."""
    body = text.split("---\n", 2)[2]
    return re.findall(r"\S*\d\S*", re.sub(r"@\w+|PS-01|CC-BY-4\.0", "", body))


def test_the_paper_is_todays():
    assert SCRIPT["paper"]() == PAPER


def test_no_number_is_written_by_hand():
    assert digits(TEMPLATE) == []


@pytest.mark.fault
def test_a_number_by_hand_is_noticed():
    assert digits(TEMPLATE.replace("{problems}", "27", 1)) == ["27"]


def test_numbers_are_those_of_the_targets():
    found, problems = SCRIPT["numbers"](), read_problems()
    assert found["problems"] == str(len(problems))
    assert found["targets"] == str(sum(len(problem.targets) for problem in problems.values()))


def test_every_work_is_cited_and_listed():
    cited = set(re.findall(r"@(\w+)", TEMPLATE.split("---\n", 2)[2]))
    assert cited == set(re.findall(r"^@\w+\{(\w+),", BIB, re.MULTILINE))


def test_length_and_sections_are_those_of_the_journal():
    assert 750 <= len(PAPER.split("---\n", 2)[2].split()) <= 1750
    for section in ("Summary", "Statement of need", "State of the field", "Software design", "Acknowledgements"):
        assert f"\n# {section}\n" in PAPER
    need = PAPER.split("# Statement of need\n")[1].split("\n# ")[0]
    assert len(need.split()) <= 320
