"""The loop of Q over the displacement of the plates: file, figure, and what a record of the plates knows."""

import csv
import io
from dataclasses import replace

import numpy as np
import pytest
from known import A, C, F, P, result

import partialslip
from partialslip import load_scene
from partialslip.report import write_run
from partialslip.report.loop import loop_csv, loop_remark, loop_rows, loop_svg
from partialslip.result.plates import Plates
from partialslip.result.record import ResultRecord
from partialslip.run import compared
from partialslip.scene.plan import plan

STIFFNESS = 4e9
BLOCKS = load_scene(
    "hertz-shear",
    [
        "shown_in='N-mm'", f"load={{P={P}, Q=[{-C * F * P}, {C * F * P}]}}", f"friction.f={F}",
        "bodies={upper={width=0.02, height=0.01}, lower={width=0.02, height=0.01}}",
    ],
)  # fmt: skip


def plates(steps, slip=1e-6):
    """Plates on a loop like an ellipse, of some ``steps``; with no ``slip`` on a line."""
    phase = np.linspace(0, 2 * np.pi, steps + 1)
    Q = C * F * P * np.cos(phase)
    moved = (Q - Q[0]) / STIFFNESS - slip * np.sin(phase)
    return Plates(
        np.array([-1, 1]) * Q[0], np.array([-1, 1]) * Q[0] / STIFFNESS, np.full(2, 1e-6),
        np.diag([1 / STIFFNESS, 1e-10]), np.column_stack([moved, Q]),
    )  # fmt: skip


def ran(scene=BLOCKS, **changes):
    return compared(scene, plan(scene), {"fem": replace(result(), **changes)}, None)


def test_the_file_has_the_units_of_the_scene():
    head, *lines = csv.reader(io.StringIO(loop_csv(ran(plates=plates(40)))))
    assert head == ["displacement [mm]", "Q [N/mm]", "load point"]
    assert {number: line[-1] for number, line in enumerate(lines) if line[-1]} == {0: "2", 20: "1", 40: "2"}
    found = np.array([line[:2] for line in lines], float) * [1e-3, 1e3]
    np.testing.assert_allclose(found, plates(40).loop, rtol=1e-12, atol=1e-20)
    assert loop_csv(ran()) == ""


def test_files_and_page_of_finite_bodies_have_the_loop(tmp_path):
    def written(folder, **changes):
        write_run(ran(**changes), folder)
        return (folder / "report.html").read_text("utf-8"), {path.name for path in folder.iterdir()}

    page, names = written(tmp_path / "loop", plates=plates(40))
    assert "loop.csv" in names
    assert "displacement, mm" in page
    assert "work of Q in a cycle" in page
    page, names = written(tmp_path / "none")
    assert "loop.csv" not in names
    assert "<h2>Plates</h2>" not in page


def test_a_loop_without_area_is_not_drawn():
    """Neither that of contacts that stick, nor that of a few steps, whose area tells little."""
    for flat in (plates(40, slip=0.0), plates(2), plates(4)):
        run = ran(plates=flat)
        assert loop_svg(run) == ""
        assert "load.steps" in loop_remark(run)
        assert "work of Q in a cycle" not in dict(loop_rows(run))
    open_one = ran(plates=plates(40))
    assert "less Q/stiffness, mm" in loop_svg(open_one)
    assert loop_remark(open_one) == ""
    assert loop_remark(ran(plates=plates(12))) == ""  # mirror images are followed event by event
    unlike = BLOCKS.replace({"bodies.upper.width": 0.01})
    assert "load.steps" in loop_remark(ran(unlike, plates=plates(12)))
    assert "Nothing slips" in loop_remark(ran(plates=plates(40, slip=0.0), regime="stuck"))


def test_the_work_of_an_ellipse():
    work = np.pi * C * F * P * 1e-6
    assert abs(plates(400).work) == pytest.approx(work, rel=1e-3)
    assert float(dict(loop_rows(ran(plates=plates(400))))["work of Q in a cycle"].split()[0]) == pytest.approx(
        plates(400).work, rel=1e-3
    )  # N mm/mm are J/m


def test_a_record_knows_what_the_plates_know(tmp_path):
    run = ran(plates=plates(40))
    write_run(run, tmp_path)
    record = partialslip.load_result(tmp_path / "results.json")
    assert record["fem"].plates.work == pytest.approx(run["fem"].plates.work, rel=1e-12)
    assert record["fem"].plates.stiffness == pytest.approx(run["fem"].plates.stiffness, rel=1e-12)
    assert ResultRecord.of(run["fem"], curves=False).plates.work is None
    assert record["fem"].a == pytest.approx(A)


def test_a_record_is_read_like_a_run(tmp_path):
    write_run(ran(), tmp_path)
    record = partialslip.load_result(tmp_path / "results.json")
    assert list(record) == ["fem"]
    assert record["fem"] is record.methods["fem"]
    with pytest.raises(KeyError, match="method 'exact': the record has fem"):
        record["exact"]
