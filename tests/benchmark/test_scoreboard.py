"""The page of the scoreboard is made from the answers that are kept."""

import json
import runpy
from pathlib import Path

import pytest
from closed import CLOSED

from partialslip.cli import main
from partialslip.verify.benchmark import handed_in, read_problems, read_submission
from partialslip.verify.benchmark.grade import NORMS, best_grade
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
        measured = read_problems()[number].measured
        for key, value in answer.values.items():
            allowed = max(1e-6, measured[key].uncertainty) if key in NORMS else 1e-9  # of the series of a curve
            assert abs(value - measured[key].value) <= allowed * measured[key].scale


def test_uncertain_targets_bound_the_grade():
    """Problems whose targets or curves come from methods with errors of their own cannot have an A."""
    bounded = {number: best_grade(problem) for number, problem in read_problems().items() if best_grade(problem) != "A"}
    assert {number: bounded[number] for number in ("PS-22", "PS-25")} == {"PS-22": "B", "PS-25": "B"}
    assert bounded.keys() <= set(read_problems()) - set(CLOSED)


def test_no_answer_has_a_better_grade_than_the_targets_allow():
    problems = read_problems()
    for folder in SCRIPT["SUBMISSIONS"].iterdir():
        for number, graded in grades(problems, read_submission(folder, problems)).items():
            assert graded.overall.grade >= best_grade(problems[number])


@pytest.mark.parametrize("folder", sorted(SCRIPT["SUBMISSIONS"].iterdir()), ids=lambda folder: folder.name)
def test_every_submission_can_be_handed_in(folder, capsys):
    """Author, settings, machine, decks or scripts with their checksums, and values that tables beside them show."""
    assert main(["benchmark", "check", str(folder)]) in (0, 4), capsys.readouterr().out
    assert f"accepted: {folder} can be handed in" in capsys.readouterr().out.replace("\n", " ")


@pytest.mark.fault
def test_a_submission_without_its_deck_is_not_accepted(tmp_path):
    """As the five of the first board were: no author, and no inputs."""
    import shutil

    shutil.copytree(SCRIPT["SUBMISSIONS"] / "opensees", tmp_path / "mine")
    (tmp_path / "mine" / "inputs" / "run_opensees.py").unlink()
    found, wrong = handed_in(tmp_path / "mine", read_problems())
    assert found is None
    assert any("run_opensees.py" in line for line in wrong)


def test_settings_of_a_code_are_side_by_side():
    """Two settings and two meshes of each other code, on the same sizes."""
    problems, sizes = read_problems(), set()
    codes = {folder.name: read_submission(folder, problems) for folder in SCRIPT["SUBMISSIONS"].iterdir()}
    for family in ("calculix", "getfem", "kratos", "opensees"):
        own = [each for name, each in codes.items() if name.startswith(family)]
        assert len({each.meta.settings for each in own}) >= 2
        for each in own:
            ladder = each.answers["PS-02"].ladder
            sizes.add(tuple(rung.h for rung in ladder))
    assert sizes == {(0.1, 0.05)}
