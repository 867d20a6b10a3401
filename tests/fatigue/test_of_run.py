"""Hot spots in the report of a run: only where the scene asks for criteria, and those of the answer."""

import pytest

import partialslip
from partialslip.cli import main
from partialslip.study.fatigue import hot_spots
from partialslip.study.fatigue.page import criteria_sections

ASKED = ["fatigue.distance=2e-5"]


def test_a_scene_that_asks_for_criteria_gets_them():
    scene = partialslip.load_scene("fretting-aluminium", ASKED)
    run = partialslip.run(scene, "exact", stresses=True)
    (section,) = criteria_sections(run)
    shown = {row[0]: (row[1], float(row[2].split()[0])) for row in section.rows}
    spots = hot_spots(scene, run["exact"])
    assert shown["sigma_xx, largest"] == ("MPa", pytest.approx(spots["sigma_xx"].value / 1e6, rel=1e-6))
    assert shown["swt, averaged, line"] == ("MPa", pytest.approx(spots["swt.line"].value / 1e6, rel=1e-6))
    assert {unit for unit, _ in shown.values()} == {"MPa"}  # values of a criterion can be compared
    assert "0.02 mm" in section.lines[0]


def test_other_scenes_and_runs_without_stresses_have_none():
    plain = partialslip.load_scene("fretting-aluminium")
    assert criteria_sections(partialslip.run(plain, "exact", stresses=True)) == []
    sliding = partialslip.load_scene("fretting-aluminium", [*ASKED, "load.Q=[-1e5, 1e5]"])
    assert criteria_sections(partialslip.run(sliding, "exact")) == []


def test_the_report_of_the_command_has_them(tmp_path):
    assert main(["run", "fretting-aluminium", "--with", "exact", "--set", *ASKED, "--out", str(tmp_path)]) == 0
    page = (tmp_path / "report.html").read_text("utf-8")
    assert "<h2>Fatigue criteria</h2>" in page
    assert "<td>swt, at the surface</td>" in page
