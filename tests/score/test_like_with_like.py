"""A table is compared with the reference at its own points, or means, or nodal forces; what a table cannot tell is
neither passed nor missed; and mistakes that hid in both are named."""

import importlib

import meshio
import numpy as np
import pytest
import spoiling
from tables import sampled as rows
from tables import written

from partialslip import load_scene, run, score
from partialslip.report.files import tractions_csv
from partialslip.report.record import record
from partialslip.run.judge import Outcome, verdicts
from partialslip.run.judge.verdicts import judged
from partialslip.tools.errors import InputError

SCENE = load_scene("fretting-aluminium")
EXACT = run(SCENE, ["exact"])["exact"]


def sampled(count, result=EXACT, reach=1.1):
    return tuple(rows(result, count, reach).T)


def compared(scene, path, **settings):
    found = score(scene, path, **settings)
    return found[path.name], found.comparisons[path.name]


@pytest.mark.parametrize("wrong", ["p", "dq"])
def test_tractions_off_by_three_percent_are_told(wrong, tmp_path):
    """The test of docs/howto/csv.md, in a code's own checks."""
    x, p, dq = sampled(161)
    bars = (1e-2, 1e-2, 1e-2)
    assert str(score(SCENE, written(tmp_path / "t.csv", (x, p, dq)), bar=bars).conclusion) == "all bars met"
    off = (x, p * (1.03 if wrong == "p" else 1), dq * (0.97 if wrong == "dq" else 1))
    outcome = score(SCENE, written(tmp_path / "t.csv", off), bar=bars)
    assert not outcome.passed
    assert str(outcome.conclusion).startswith("missed: t.csv: " + {"p": "P: error 0.03", "dq": "dQ: error"}[wrong])


@pytest.mark.parametrize("count", [45, 89, 353])
def test_a_perfect_table_of_points_is_perfect(count, tmp_path):
    """At 0.05 a lines between the points are 1.5e-2 of p off, which is no error of the table."""
    found, comparison = compared(SCENE, written(tmp_path / "t.csv", sampled(count)), kind="sampled")
    assert max(comparison.errors[key] for key in ("p", "q", "P", "dQ")) < 1e-10
    assert 0.1 / count < found.settings["spacing_hides_p"] < 3 / count
    assert found.settings["noise_over_p0"] < 1e-4  # and hardly any of it is noise


@pytest.mark.parametrize("order", [1, 2])
def test_perfect_nodal_forces_are_perfect(order, tmp_path):
    forces = spoiling.nodal(SCENE, sampled(89)[0], order).columns
    path = written(tmp_path / "t.csv", [*forces.values()], ",".join(forces))
    found, comparison = compared(SCENE, path, order=order)
    assert max(comparison.errors[key] for key in ("p", "q", "P", "dQ")) < 1e-5  # of the quadrature
    assert max(comparison.a, comparison.m, comparison.n) < 0.15 * 2.2 / 88
    assert found.traction.p @ np.diff(found.traction.cells) == pytest.approx(SCENE.P, rel=1e-5)
    if order == 2:  # taken for elements of order 1
        with pytest.raises(InputError, match="another order"):
            score(SCENE, path)


def test_perfect_means_are_perfect_and_taken_for_values_they_are_not(tmp_path):
    x, *_ = sampled(89)
    edges = np.concatenate([[1.5 * x[0] - x[1] / 2], (x[1:] + x[:-1]) / 2, [1.5 * x[-1] - x[-2] / 2]])
    fine = np.linspace(edges[:-1], edges[1:], 4001, axis=1)
    means = [np.trapezoid(EXACT.traction.at(fine)[k], fine, axis=1) / np.diff(edges) for k in (0, 1)]
    path = written(tmp_path / "t.csv", (x, *means))
    _, comparison = compared(SCENE, path, kind="mean")
    assert max(comparison.errors[key] for key in ("p", "q")) < 1e-4  # of the trapezoidal rule at the ends
    assert compared(SCENE, path, kind="sampled")[1].errors["p"] > 3e-3


@pytest.mark.fault
def test_lines_between_points_for_the_points(tmp_path, monkeypatch):
    """Deliberate fault: the table for a function of x. What the spacing hides is then taken for an error."""
    path = written(tmp_path / "t.csv", sampled(45))
    assert compared(SCENE, path)[1].errors["p"] < 1e-10
    monkeypatch.setattr(importlib.import_module("partialslip.codes.score.method"), "observed", lambda _: None)
    monkeypatch.setattr(
        importlib.import_module("partialslip.codes.score"), "_too_far_apart", lambda _, result, __: result
    )
    assert compared(SCENE, path)[1].errors["p"] > 1e-2


def test_too_few_points_do_not_tell(tmp_path):
    found = score(SCENE, written(tmp_path / "t.csv", sampled(8, reach=1.2)), bar=0.1)
    verdicts = {each.quantity: each for each in found.comparisons["t.csv"].verdicts}
    assert verdicts["p"].outcome is Outcome.NOT_JUDGED
    assert "too far apart" in verdicts["p"].reason


def test_three_outcomes():
    """Certain, or not judged."""
    assert judged(1.0, 2.0, 0.5) is Outcome.PASSED
    assert judged(1.8, 2.0, 0.5) is Outcome.NOT_JUDGED
    assert judged(2.2, 2.0, 0.5) is Outcome.NOT_JUDGED
    assert judged(2.6, 2.0, 0.5) is Outcome.MISSED
    assert judged(np.nan, 2.0, 0.5) is Outcome.MISSED
    assert judged(9.0, 2.0, np.inf) is Outcome.NOT_JUDGED


@pytest.mark.fault
def test_what_the_table_cannot_tell_is_not_judged(tmp_path, monkeypatch):
    """a is off by less than the bar, by chance: ten points a contact, with noise, tell it to more than that. Deliberate
    fault: without the estimate it is called ok, or missed."""
    x, p, dq = sampled(25)
    noise = 0.02 * EXACT.p0 * np.random.default_rng(1).standard_normal((2, 25)) * (p > 0)
    path = written(tmp_path / "t.csv", (x, p + noise[0], dq + noise[1]))
    found, comparison = compared(SCENE, path, bar=1e-3)
    (a,) = (each for each in comparison.verdicts if each.quantity == "a")
    assert found.estimate["a"] > 1e-3
    assert a.outcome is Outcome.NOT_JUDGED
    assert a.reason.startswith("this table tells a to 0.")
    data = record(score(SCENE, path, bar=1e-3))  # and so it is found from the file of results
    (again,) = (each for each in data.comparison["t.csv"].verdicts if each.quantity == "a")
    assert again.outcome is Outcome.NOT_JUDGED
    monkeypatch.setattr(verdicts, "read_to", lambda *_: 0.0)
    (a,) = (each for each in compared(SCENE, path, bar=1e-3)[1].verdicts if each.quantity == "a")
    assert a.outcome is not Outcome.NOT_JUDGED


def test_without_friction_there_is_no_shear(tmp_path):
    """dq of 7.5 % of P: 15 bars of the norm of p, within which a shear that is not zero may be, are too many."""
    scene = load_scene("hertz-shear", ["friction.f=0", "load.Q=[0,0]"])
    x, p, _ = sampled(161, run(scene, ["exact"])["exact"])
    assert score(scene, written(tmp_path / "t.csv", (x, p, 0.075 * p)), bar=1e-2).outcome is Outcome.MISSED
    assert score(scene, written(tmp_path / "t.csv", (x, p, 0 * p)), bar=1e-2).outcome is Outcome.PASSED


def test_a_contact_that_pulls_is_missed(tmp_path):
    x, p, dq = sampled(161)
    touching = np.flatnonzero(p > 0)
    p[[touching[0] - 1, touching[-1] + 1]] = -0.2 * EXACT.p0
    path = written(tmp_path / "t.csv", (x, p, dq))
    notes = " ".join(compared(SCENE, path)[0].notes)
    assert "p is -0.2 of its largest" in notes
    assert "does not pull" in notes
    verdicts = {each.quantity: each for each in score(SCENE, path, bar=1e-2).comparisons["t.csv"].verdicts}
    assert verdicts["p_least"].outcome is Outcome.MISSED
    assert verdicts["p_least"].error == pytest.approx(0.2)


def test_the_range_of_shear_out_of_phase_has_no_sign(tmp_path):
    """Its sum is not dQ, and may be nearer to -dQ."""
    loads = "load.Q=[0.0, 21213.2, 30e3, 21213.2, 0.0, -21213.2, -30e3, -21213.2]"
    tension = "load.sigma=[100e6, 70.7107e6, 0.0, -70.7107e6, -100e6, -70.7107e6, 0.0, 70.7107e6]"
    scene = load_scene("fretting-aluminium", [loads, tension, "fem.accuracy=1e-2"])
    march = run(scene, ["march"])["march"].traction
    right, _ = compared(scene, written(tmp_path / "t.csv", (march.x, march.p, march.dq)))
    assert not right.notes
    turned, _ = compared(scene, written(tmp_path / "t.csv", (march.x, march.p, -march.dq)))
    assert "dq may be of the opposite sign: correct with --factors 1,1,-1" in turned.notes


def test_half_of_a_contact_is_not_to_be_centred(tmp_path):
    x, p, dq = sampled(161)
    half = x >= 0
    notes = " ".join(compared(SCENE, written(tmp_path / "t.csv", (x[half], p[half], dq[half])))[0].notes)
    assert "the table begins at x = " in notes
    assert "within the contact: give all of it, as shear differs from side to side" in notes
    assert "--centre" not in notes
    reversed_shear = load_scene("hertz-shear")
    x, p, dq = sampled(161, run(reversed_shear, ["exact"])["exact"])
    cut = compared(reversed_shear, written(tmp_path / "t.csv", (x[half], p[half], dq[half])))[0]
    assert "--factors" not in " ".join(cut.notes)  # the sums are half of those of the scene
    x, p, dq = sampled(161)
    away = written(tmp_path / "t.csv", (x + 3 * EXACT.a, p, dq))
    assert "--centre auto puts x = 0 there" in " ".join(compared(SCENE, away)[0].notes)


@pytest.mark.parametrize("name", ["q", "dq"])
def test_the_shear_at_one_load_point_is_recognised(name, tmp_path):
    """Under Q = [0, Q2] it adds up to Q2, but is neither the change nor half of it."""
    scene = load_scene("hertz-shear", ["load.Q=[0, 1e5]", "fem.accuracy=1e-2"])
    march = run(scene, ["march"])["march"].traction
    path = written(tmp_path / "t.csv", (march.x, march.p, march.q2), f"x,p,{name}")
    found = score(scene, path, bar=1e-2)
    assert found.outcome is Outcome.NOT_JUDGED
    assert {"m", "n", "q"} <= set(found.conclusion.unjudged)
    assert f"{name} adds up to Q at load point 2" in found["t.csv"].notes[0]
    both = written(tmp_path / "t.csv", (march.x, march.p, march.q1, march.q2), "x,p,q1,q2")
    assert not compared(scene, both)[0].notes


def test_a_contact_that_sticks_nearly_everywhere_is_not_taken_for_a_sliding_one(tmp_path):
    """Slip zones of 1.6e-4 a lie between two points: no f is read, and neither m, n nor the regime is told."""
    scene = load_scene("hertz-shear", ["load.Q=[-100, 100]"])
    found = score(scene, written(tmp_path / "t.csv", sampled(161, run(scene, ["exact"])["exact"])), bar=1e-3)
    assert found.outcome is Outcome.NOT_JUDGED
    assert {"m", "n"} <= set(found.conclusion.unjudged)


def test_a_contact_that_slides_need_not_bear_dQ(tmp_path):
    scene = load_scene("hertz-shear", ["load.Q=[-4e5, 4e5]"])
    found = score(scene, written(tmp_path / "t.csv", sampled(161, run(scene, ["exact"])["exact"])), bar=1e-2)
    assert not found["t.csv"].notes
    assert found.passed


def stacked(path, label, factor):
    x, p, dq = sampled(61)
    rows = np.column_stack([np.repeat([1, 2], 61), np.tile(x, 2), np.tile(p, 2), np.append(factor * dq, dq) / 2])
    return written(path, (rows,), f"{label},x,CPRESS,CSHEAR1")


@pytest.mark.parametrize("label", ["surface", "load_point"])
def test_rows_of_two_surfaces_or_load_points_are_not_averaged(label, tmp_path):
    path = stacked(tmp_path / "t.csv", label, -1)
    with pytest.raises(InputError, match=f'{label} is 1, 2: must be one: keep one, as by --where "{label}=2"'):
        score(SCENE, path)
    assert score(SCENE, path, where={label: "2"}, bar=1e-2).comparisons["t.csv"].q < 1e-10


def test_rows_that_differ_little_are_averaged_with_a_note(tmp_path):
    path = stacked(tmp_path / "t.csv", "layer", 1.01)
    assert "rows at equal x were averaged; they differ by 1.0% in q" in score(SCENE, path)["t.csv"].notes


def test_points_below_the_surface_are_not_averaged(tmp_path):
    x, p, dq = sampled(61)
    points = np.column_stack([np.tile(x, 2), np.repeat([0, -0.01 * EXACT.a], 61), np.zeros(122)])
    data = {"p": np.append(p, 0 * p), "dq": np.append(dq, 0 * dq)}
    meshio.write(tmp_path / "t.vtu", meshio.Mesh(points, [("vertex", np.arange(122)[:, None])], point_data=data))
    with pytest.raises(
        InputError,
        match=r"rows at equal x differ by 100% in p.*; Points:1 is 0, .*keep one, as by --where \"Points:1=0\"",
    ):
        score(SCENE, tmp_path / "t.vtu")


def test_the_tractions_of_a_run_are_scored(tmp_path):
    """Those of one method; they have dq, and q1 and q2, which need not be chosen from."""
    path, both = tmp_path / "tractions.csv", run(SCENE, ["exact", "march"])
    path.write_text(tractions_csv(run(SCENE, ["exact"])), "utf-8")
    assert score(SCENE, path, bar=1e-3).passed
    path.write_text(tractions_csv(both), "utf-8")
    with pytest.raises(InputError, match='method is exact, march: must be one: keep one, as by --where "method=march"'):
        score(SCENE, path)


def test_columns_without_values_are_none(tmp_path):
    """As q1 and q2 of a method that does not know them."""
    x, p, dq = sampled(61)
    rows = "".join(f"{a!r},{b!r},,,{c!r}\n" for a, b, c in np.column_stack([x, p, dq]).tolist())
    (tmp_path / "t.csv").write_text(f"x,p,q1,q2,dq\n{rows}", "utf-8")
    assert compared(SCENE, tmp_path / "t.csv")[1].errors["q"] < 1e-10


def test_what_is_left_outside_of_a_contact_is_no_contact(tmp_path):
    """A pressure of 2.5e-6 p0 at every point of the table, as soft contact leaves it."""
    x, p, dq = sampled(161)
    found, judged = compared(SCENE, written(tmp_path / "t.csv", (x, p + 2.5e-6 * EXACT.p0, dq + 2.5e-7 * EXACT.p0)))
    assert found.regime == EXACT.regime
    errors = {each.quantity: each.error for each in judged.verdicts if each.quantity in ("a", "m", "n")}
    assert len(errors) == 3
    assert all(error < found.estimate[key] < 0.03 for key, error in errors.items())
