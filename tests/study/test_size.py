"""Sweeps: axes, cases solved once, and the law of the sizes."""

import contextlib
import csv
import math
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import made
import msgspec
import numpy as np
import pytest
from outline import texts as texts_of
from size_entries import X, entries, made_sizes, scene, sized

from partialslip.cli import main
from partialslip.study.batch.job import Job, solve_job
from partialslip.study.batch.ledger import Ledger
from partialslip.study.batch.sweep import Task, work_through, workers
from partialslip.study.size import sizes as size
from partialslip.study.size import tables
from partialslip.study.size.axes import axis as read
from partialslip.study.size.axes import cases as make
from partialslip.study.size.case import Sized, compared_methods, solve_sized
from partialslip.study.size.figure import grid_svg, size_svg
from partialslip.study.size.law import Kind, PointStatus, levels, trend
from partialslip.tools.errors import InputError


def test_the_error_of_marched_half_planes_is_part_of_that_of_a_difference():
    labels, none = {"load.P": 4.0, "accuracy": 1.0}, {"p_max": 1.0, "m": None, "n": None}
    fem = {"a": 1.1, "estimate": {"a": 3e-5}, "counts": {"dofs": 100}, **none}
    found = sized(labels, fem=fem, march={"a": 1.0, "estimate": {"a": 2e-5}, **none})
    along = size.along(read("load.P=4,8"), [found])
    assert (along.off["a"], along.mesh["a"]) == (pytest.approx(0.1), pytest.approx(5e-5))


def test_a_sweep_goes_on_where_it_was(tmp_path, monkeypatch):
    """Cases in the ledger are not solved again; a failed case is reported and does not stop the others."""
    path, solved = tmp_path / "ledger.jsonl", []
    cases = [Job(scene(), ("exact",), {"number": number}) for number in range(6)]
    broken = Job(scene(), ("nothing",), {"number": 6})

    def counted(job):
        solved.append(job.labels["number"])
        return solve_job(job)

    monkeypatch.setattr("partialslip.study.batch.job.solve_job", counted)
    with ThreadPoolExecutor(1) as executor:
        work_through([case.task for case in cases[:4]], Ledger(path), executor)
        seen = []
        work_through([case.task for case in (*cases, broken)], Ledger(path), executor, lambda *at: seen.append(at[:2]))
    assert solved == [0, 1, 2, 3, 4, 5, 6]
    assert seen == [(4, 7), (5, 7), (6, 7), (7, 7)]
    assert "nothing" in Ledger(path)[broken.key]["error"]


class Counting(ThreadPoolExecutor):
    """Counts the tasks submitted at once."""

    waiting = most = 0

    def submit(self, *work):
        self.waiting += 1
        self.most = max(self.most, self.waiting)
        future = super().submit(*work)
        future.add_done_callback(lambda _: setattr(self, "waiting", self.waiting - 1))
        return future


def test_a_long_sweep_is_handed_over_bit_by_bit(tmp_path):
    tasks = [Task(str(number), lambda number: {"found": number}, number) for number in range(2000)]
    ledger = Ledger(tmp_path / "ledger.jsonl")
    with Counting(2) as executor:
        work_through(tasks, ledger, executor)
    assert {entry["key"]: entry["found"] for entry in ledger} == {str(number): number for number in range(2000)}
    assert executor.most <= 256


def test_in_this_process_each_case_is_kept_before_the_next_begins(tmp_path):
    ledger, known = Ledger(tmp_path / "ledger.jsonl"), []

    def do(number):
        known.append(len(ledger))
        if number == 3:
            raise KeyboardInterrupt
        return {}

    with pytest.raises(KeyboardInterrupt), workers(processes=1) as executor:
        work_through([Task(str(number), do, number) for number in range(5)], ledger, executor)
    assert known == [0, 1, 2, 3]


WORKERS = """
import os, time
from partialslip.study.batch.sweep import workers
with workers(processes=2) as pool:
    print(*{pool.submit(os.getpid).result() for _ in range(8)}, flush=True)
    list(pool.map(time.sleep, [60] * 4))
"""


def test_no_thread_of_the_workers_is_left():
    """Otherwise the exit of Python now and then ends in "Bad file descriptor"."""
    threads = set(threading.enumerate())
    with contextlib.suppress(KeyboardInterrupt), workers(processes=2) as pool:
        tasks = [pool.submit(time.sleep, 60) for _ in range(8)]
        raise KeyboardInterrupt
    assert tasks[-1].cancelled()
    assert set(threading.enumerate()) <= threads


@pytest.mark.parametrize("kind", [signal.SIGKILL, signal.SIGINT])
def test_workers_end_with_the_process_that_they_work_for(kind):
    command = [sys.executable, "-c", WORKERS]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    numbers = [int(number) for number in process.stdout.readline().split()]
    assert numbers
    process.send_signal(kind)
    _, said = process.communicate(timeout=30)
    assert "InvalidStateError" not in said
    for _ in range(600):
        if not any(map(runs, numbers)):
            break
        time.sleep(0.05)
    else:
        pytest.fail("a worker is left behind")


def runs(number):
    """Return whether the process of that number runs; zombies do not count."""
    try:
        return Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_the_law_of_made_up_sizes_is_found():
    law = trend(made_sizes(0.3 * X**-2.0, 3e-7), "m").law
    assert law.k == pytest.approx(2, abs=1e-9)
    assert pytest.approx(0.3) == law.C
    assert law.sizes == pytest.approx([32, 64, 128])


def test_what_the_mesh_is_off_by_is_no_law():
    """Deliberate fault: sizes at which the error of the mesh equals the change by the size give a wrong order."""
    x = np.geomspace(4, 1024, 9)
    off = 0.3 * x**-2.0 + 1e-4
    assert trend(made_sizes(off, 1e-4, x), "m").law.k == pytest.approx(2, abs=0.1)
    assert trend(made_sizes(off, 0.0, x), "m").law is None  # a line through these points has k < 1, and may be level


def test_differences_that_scatter_have_no_law_and_no_sizes():
    """Three points of noise: a line through their logarithms has any slope, and no size follows from it."""
    x = np.array([2.0, 5.0, 10.0])
    for off in ([2e-3, 5e-3, 3e-2], [3e-2, 1e-2, 2.9e-2], [3e-2, 2.9e-2, 2e-2]):
        found = trend(made_sizes(np.array(off), 1e-6, x), "m")
        assert found.law is None
        assert set(found.points[:-1]) <= {PointStatus.NO_LAW, PointStatus.FEW, PointStatus.FLOOR}
        assert {each.kind for each in found.needed} <= {Kind.BOUND, Kind.INTERPOLATED}


def test_a_law_is_not_trusted_far_beyond_the_sizes():
    """0.5 size^-0.1 is 1e-4 at a size of 5e36: nobody's specimen."""
    found = trend(made_sizes(0.5 * X**-0.1), "m")
    assert found.law.k == pytest.approx(0.1)
    assert [each.kind for each in found.needed] == [Kind.BOUND] * 3
    assert str(found.needed[0]) == "> 128"


@pytest.mark.parametrize(
    ("off", "mesh", "kinds", "texts"),
    [
        (0.1 * X**-2.0, 0.0, ("bound", "interpolated", "interpolated"), ("<= 4", "10.0, inter", "31.6, inter")),
        (1.6 * X**-2.0, 0.0, ("interpolated", "interpolated", "interpolated"), ("12.6", "40", "126")),
        (0.64 * X**-2.0, 1e-6, ("measured", "interpolated", "interpolated"), ("8, measured", "25.3, inter", "80")),
        (16 * X**-2.0, 0.0, ("interpolated", "interpolated", "extrapolated"), ("40", "126", "400 (400 to 400), ex")),
        (0.2 + 0 * X, 0.0, ("bound", "bound", "bound"), ("> 128", "> 128", "> 128")),
        (0.3 * X**-2.0, 0.3 * X**-2.0, ("bound", "bound", "bound"), ("<= 8", "<= 32", "<= 128")),  # no law
        (0.3 * X**-2.0, np.where(X == 16, 1e-3, 0), ("interpolated", "extrapolated", "interpolated"),
         ("5", "17.3", "54")),
        (1.0 + 0 * X, 1.0, ("bound", "bound", "bound"), ("not known",) * 3),
    ],
)  # fmt: skip
def test_each_needed_size_says_how_it_is_known(off, mesh, kinds, texts):
    needed = trend(made_sizes(off, mesh), "m").needed
    assert tuple(each.kind for each in needed) == kinds
    for each, text in zip(needed, texts, strict=True):
        assert str(each).startswith(text)
        assert each.kind == "bound" or each.low <= each.size <= each.high


def test_intervals_of_extrapolated_sizes_hold_the_truth():
    """In 95 % of sweeps with scatter the intervals of k and of the size contain the true values."""
    random, held = np.random.default_rng(3), []
    for _ in range(400):
        off = 0.3 * X**-2.0 * np.exp(0.02 * random.standard_normal(len(X)))
        law = trend(made_sizes(off), "m").law
        _, low, high = law.size_for(1e-6)
        held.append((law.bounds[0] < 2 < law.bounds[1], low < math.sqrt(3e5) < high))
    assert np.mean(held, axis=0) == pytest.approx(0.95, abs=0.03)


def test_every_point_is_fitted_or_says_why_not():
    mesh = np.where(X == 64, 1e-4, 0.0)
    off = np.where(X == 16, np.nan, 0.3 * X**-2.0)
    points = trend(made_sizes(off, mesh), "m").points
    assert points == (
        PointStatus.SMALLER,
        PointStatus.FITTED,
        PointStatus.NO_VALUE,
        PointStatus.FITTED,
        PointStatus.UNCLEAR,
        PointStatus.FITTED,
        PointStatus.LIMIT,
    )
    assert trend(made_sizes(off, np.where(X > 8, 1.0, 0.0)), "m").points[:2] == (PointStatus.FEW, PointStatus.FEW)
    assert trend(made_sizes(off, np.nan), "m").points[0] is PointStatus.UNKNOWN


def test_the_command_prints_and_writes_what_was_found(tmp_path, monkeypatch, capsys):
    key = "bodies.lower.height"
    solved = entries(key, {at: 40 * at**-2.0 for at in (4.0, 8.0, 16.0, 32.0, 64.0, 128.0)})
    monkeypatch.setattr(size, "measure", lambda *_, **__: solved)
    command = ["study", "size", "hertz-shear", "--over", f"{key}=4,8,16,32,64,128", "--processes", "1"]
    assert main([*command, "--verbose", "--out", str(tmp_path / "solved")]) == 0
    printed = capsys.readouterr().out
    assert printed.startswith("hertz-shear, half-planes: a within 1 % from 63.2 m on")
    for text in ("63.2, interpolated", "200 (197 to 203), extrapolated", " * 3.9e-02", "   6.2e-01"):
        assert text in printed
    assert main([*command, "--level", "2%", "--out", str(tmp_path / "solved")]) == 0
    assert "3.9e-02" not in (printed := capsys.readouterr().out)
    assert printed.startswith("hertz-shear, half-planes: a within 2 % from 44.7 m on")
    files = ["cases.csv", "laws.csv", "points.csv", "size.svg"]
    assert sorted(path.name for path in (tmp_path / "solved").glob("*.[cs]*v*")) == files
    monkeypatch.setattr(size, "measure", lambda *_, **__: entries(key, {}, [4.0]))
    assert main([*command, "--out", str(tmp_path / "failed")]) == 1
    assert "not solved: bodies.lower.height 4.0, accuracy 1.0: too narrow" in capsys.readouterr().out
    assert not (tmp_path / "failed" / "size.svg").exists()


@pytest.mark.parametrize("text", ["2", "0", "-1%", "100%", "m=", "two", "nan"])
def test_levels_that_are_no_shares_are_refused(text):
    with pytest.raises(InputError, match=f"--level {text}: must be a share > 0 and < 1"):
        levels([text])


def test_levels_are_of_all_quantities_or_of_one():
    found = levels(["2%", "m=0.5%", "m=0.001"])
    assert found == {"": (0.02,), "m": (0.005, 0.001)}
    made = replace(made_sizes(1.28 * X**-2.0), levels=found)
    assert [needed.level for needed in trend(made, "m").needed] == [0.005, 0.001]
    (needed,) = trend(made, "n").needed
    assert (needed.level, needed.size) == (0.02, pytest.approx(8))


def test_ctrl_c_says_what_is_kept(tmp_path, monkeypatch, capsys):
    def stopped(_, __, ledger, *___, **____):
        ledger.add("first", entries("bodies.lower.height", {4.0: 1.0}, remains=None)[0])
        raise KeyboardInterrupt

    monkeypatch.setattr(size, "measure", stopped)
    command = ["study", "size", "hertz-shear", "--over", "bodies.lower.height=4,8", "--processes", "1"]
    assert main([*command, "--out", str(tmp_path)]) == 130
    assert capsys.readouterr().err == "partialslip: interrupted: 1 case kept; the same command goes on\n"


def test_the_same_mesh_twice_gives_no_error_of_the_mesh():
    """A fixed element size gives the same mesh for every accuracy, and no estimate."""
    axis = read("load.P=1,2")
    meshes = [
        sized(
            {"load.P": 1.0, "accuracy": accuracy},
            fem={"a": a, "p_max": 1.0, "m": None, "n": None, "estimate": {}, "counts": {"dofs": dofs}},
            exact={"a": 1.0, "p_max": 1.0, "m": None, "n": None},
        )
        for accuracy, a, dofs in ((8.0, 1.08, 10), (1.0, 1.0, 20), (0.125, 1.0, 20))
    ]  # fmt: skip
    assert size.along(axis, meshes[:1]).mesh["a"] == pytest.approx(np.nan, nan_ok=True)
    assert size.along(axis, meshes[1:]).mesh["a"] == pytest.approx(np.nan, nan_ok=True)
    assert size.along(axis, meshes).mesh["a"] == pytest.approx(0.01)


def test_table_csv_and_figure_mark_the_same_points():
    axis = read("bodies.*.width=2a,4a,8a,16a,32a,64a,128a")
    found = entries(axis.name, {at: 0.3 * at**-2.0 for at in (4.0, 8.0, 16.0, 32.0, 64.0, 128.0)}, [2.0])
    study = tables.size_study(scene(), axis, found)
    headings, rows = tables.differences_table(study, study.models[0])
    assert headings == ("size", "a", "p_max", "mesh")
    fitted = {row[0]: row[1].startswith("*") for row in rows}
    assert fitted == dict.fromkeys(("4", "8", "16"), True) | dict.fromkeys(("2", "32", "64", "128", "infinite"), False)
    points = list(csv.DictReader(tables.points_csv(study).splitlines()))
    assert [row["point"] for row in points if row["quantity"] == "a"] == [
        *["fitted"] * 3, *[PointStatus.UNCLEAR] * 3, PointStatus.LIMIT,
    ]  # fmt: skip
    assert points[-1]["point"] == "too narrow"
    laws = list(csv.DictReader(tables.laws_csv(study).splitlines()))
    unit = "[a of the half-plane]"
    ends = (f"low {unit}", f"high {unit}")
    assert [laws[0][key] for key in ("quantity", "kind", *ends)] == ["a", "interpolated", "4.0", "8.0"]
    assert all(f"size {unit}" in table[0] for table in (points, laws))
    assert tables.laws_table(study)[1][0][-1] == "4, 8, 16"
    assert [row[0] for row in tables.needed_table(study)[1]] == ["a", "p_max"]
    assert "not solved: bodies.*.width 2.0, accuracy 1.0: too narrow" in study.remarks

    texts = [text.strip() for text in texts_of(size_svg(study))]
    assert {"2", "4", "8", "16", "32", "64", "128", "not solved", "half-planes"} <= set(texts)
    assert {"10 %", "0.001 %"} <= set(texts)  # both ends of the axis
    assert "a within 1 %: half-planes\xa05.48\xa0a" in texts
    assert not any("equivalent" in text for text in texts)


def test_both_half_planes_have_their_laws():
    """Equivalent half-planes have points, laws and sizes of their own; where there are none, one line says so."""
    axis = read("bodies.*.width=2a,4a,8a,16a,32a,64a")
    left = {at: 800 * at**-4.0 for at in (8.0, 16.0, 32.0, 64.0)} | {2.0: "must be larger", 4.0: "too large"}
    found = entries(axis.name, {at: 30 * at**-2.0 for at in (2.0, 4.0, 8.0, 16.0, 32.0, 64.0)}, left=left)
    study = tables.size_study(scene(), axis, found)
    plain, alike = study.models
    assert (plain.name, alike.name) == ("half-plane", "equivalent")
    assert [trend.quantity for trend in alike.trends] == ["a"]
    assert (plain.trends[0].law.k, alike.trends[0].law.k) == pytest.approx((2, 4))
    rows = {row[0]: row[1] for row in tables.differences_table(study, alike)[1]}
    solved = {"8": "* 2.0e-01", "16": "* 1.2e-02", "32": "* 7.6e-04", "64": "4.8e-05", "infinite": "0.0e+00"}
    assert rows == {"2": "-", "4": "-", **solved}
    assert [row[:2] for row in tables.laws_table(study)[1]] == [("a", "half-plane"), ("a", "equivalent")]
    needed = {row[:2]: row[2] for row in tables.needed_table(study)[1]}
    assert needed["a", "equivalent"] == "16.8, interpolated"
    assert needed["a", "half-plane"] == "54.8, interpolated"
    assert "no equivalent half-planes at 2 and 4: must be larger" in study.remarks
    points = list(csv.DictReader(tables.points_csv(study).splitlines()))
    assert [float(row["difference"]) for row in points if row["half-planes"] == "equivalent"] == pytest.approx(
        [*(800 * at**-4.0 for at in (8.0, 16.0, 32.0, 64.0)), 0.0]
    )
    laws = list(csv.DictReader(tables.laws_csv(study).splitlines()))
    assert {row["half-planes"]: round(float(row["k"]), 6) for row in laws if row["k"]} == {
        "half-plane": 2, "equivalent": 4,
    }  # fmt: skip
    head, rows = size.case_table([axis], found, scene().units)
    column = head.index("equivalent: a")
    assert [row[column] for row in rows] == ["", "", *(left[at] for at in (8.0, 16.0, 32.0, 64.0)), 0.0]
    assert [row[head.index("no equivalent")] for row in rows] == ["must be larger", "too large", "", "", "", "", ""]
    assert all(len(row) == len(head) for row in rows)

    texts = [text.strip() for text in texts_of(size_svg(study))]
    assert {"half-planes", "equivalent half-planes", "54.8", "16.8"} <= set(texts)


def test_the_error_of_the_rig_is_an_error_of_the_mesh():
    axis = read("load.P=4,8,16,32")
    found = entries(axis.name, {at: 30 * at**-2.0 for at in axis.values}, left=dict.fromkeys(axis.values, 1e-3))
    assert size.along(axis, found, "equivalent").mesh["a"] == pytest.approx(3e-5)
    found = entries(axis.name, {4.0: 1.0}, left={4.0: 1e-3}, rig=1e-4)
    assert size.along(axis, found, "equivalent").mesh["a"] == pytest.approx(1.3e-4)
    assert size.along(axis, found).mesh["a"] == pytest.approx(3e-5)


@pytest.mark.slow
def test_equivalent_half_planes_leave_a_tenth_of_the_difference():
    """Blocks of width 8 a. Without equivalent half-planes the case stands, and says why; half-planes need none."""
    (case,) = make(scene(accuracy=1e-2), [read("bodies.*.width+bodies.*.height=8a")])
    assert case.methods == ("exact", "equivalent", "fem")
    found = solve_sized(case)
    off, left = (size.along(read("bodies.*.width+bodies.*.height=8a"), [found], name).off for name in
                 ("half-plane", "equivalent"))  # fmt: skip
    for quantity in ("a", "p", "m", "n", "q"):
        assert left[quantity] < off[quantity] / 10
    again = msgspec.json.decode(msgspec.json.encode(found), type=Sized)
    assert again.equivalent.comparison["equivalent"].errors["a"] == left["a"]

    (case,) = make(scene(accuracy=1e-2), [read("bodies.*.width+bodies.*.height=3a")])
    found = solve_sized(case)
    assert found.run.comparison["fem"].errors["a"] > 0
    assert found.equivalent is None
    assert "must be larger compared with the contact" in found.refused
    plain = scene().replace(bodies={"upper": None, "lower": None})
    half_planes = solve_sized(Job(plain, compared_methods(plain)))
    assert (half_planes.error, half_planes.refused, half_planes.equivalent) == ("", "", None)


def test_entries_without_equivalent_half_planes_are_read():
    """Those of older ledgers."""
    old = made.solved(scene(), {"load.P": 1.0, "accuracy": 1.0}, {"p": None, "q": None}, exact={"a": 1.0},
                      fem={"a": 1.1, "estimate": {}, "counts": {"dofs": 1}})  # fmt: skip
    found = msgspec.convert(msgspec.to_builtins(old), Sized)
    assert size.along(read("load.P=1,2"), [found]).off["a"] == pytest.approx(0.1)
    assert size.along(read("load.P=1,2"), [found], "equivalent").size.size == 0


def test_maps_leave_out_what_was_not_solved():
    """Each change is at the right place: first axis across, second axis up."""
    axes = [read("bodies.*.width=2a,4a,8a"), read("bodies.*.height=3a,9a")]
    entries = [
        sized(
            {"bodies.*.width": x, "bodies.*.height": y, "accuracy": 1.0},
            fem={"a": 1 + 0.1 / x / y, "p_max": 1.0, "m": None, "n": None, "estimate": {}},
            exact={"a": 1.0, "p_max": 1.0, "m": None, "n": None},
        )
        for x in axes[0].values for y in axes[1].values
    ]  # fmt: skip
    entries[0] = Sized(labels=entries[0].labels, error="too narrow")
    x, y, off = size.grid(axes, entries, "a")
    expected = 0.1 / x / y[:, None]
    expected[0, 0] = np.nan
    np.testing.assert_allclose(off, expected)
    assert "<svg" in grid_svg(x, y, off, ("width", "height"), "a")


@pytest.mark.slow
def test_blocks_come_near_the_half_plane_with_the_square_of_their_size(tmp_path):
    """Meshes are refined until the error of the mesh does not matter."""
    axis, ledger = read("bodies.*.width+bodies.*.height=16a..128a:4"), Ledger(tmp_path / "ledger.jsonl")
    with ThreadPoolExecutor(1) as executor:
        found = size.measure(scene(accuracy=1e-3), [axis], ledger, executor)
    sizes = size.along(axis, found)
    for quantity in ("a", "m"):
        assert all((10 * sizes.mesh[quantity] < sizes.off[quantity])[sizes.size < sizes.limit])
        assert trend(sizes, quantity).law.k == pytest.approx(2, abs=0.1)
    meshes = [sum(entry.labels["bodies.*.width = bodies.*.height"] == each for entry in found) for each in sizes.size]
    assert meshes[0] < meshes[-1]


def test_the_former_name_of_the_largest_pressure_is_deprecated():
    axes = [read(text) for text in ("bodies.lower.width=4a,8a", "bodies.lower.height=4a,8a")]
    with pytest.warns(DeprecationWarning, match="p0: the largest pressure is now p_max"):
        former = size.grid(axes, [], "p0")
    np.testing.assert_array_equal(former[2], size.grid(axes, [], "p_max")[2])
