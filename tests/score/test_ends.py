"""Ends of zones read from tables of all kinds: errors against exact ends, and estimates that are not below them."""

import importlib

import numpy as np
import pytest
import spoiling

from partialslip import load_scene, score
from partialslip.codes.score.kinds import EVERY, RUNNING, Average
from partialslip.codes.score.samples import samples
from partialslip.run.judge.measures import cell_means, means

ends = importlib.import_module("partialslip.codes.score.ends")
method = importlib.import_module("partialslip.codes.score.method")
SCENES = ("hertz-small-tension", "hertz-large-tension", "flat-rounded")


def points(name, count, phase):
    """Evenly spaced points over the contact and a tenth beyond; ``phase`` in spacings."""
    a = spoiling.exact(load_scene(name)).a
    return 1.1 * a * (np.linspace(-1, 1, count) + 2 * phase / (count - 1))


def sampled(traction, x):
    return traction.at(x)[:2]


def mean(traction, x):
    h = x[1] - x[0]
    return cell_means(traction, np.append(x - h / 2, x[-1] + h / 2))


def nodal(traction, x):
    """Nodal forces of linear elements over the nodes' weights."""
    h = x[1] - x[0]
    cells = np.concatenate([[x[0] - h], x, [x[-1] + h]])
    whole = means(lambda t: np.stack(traction.at(t)[:2]), cells, traction.breaks)
    first = means(lambda t: t * np.stack(traction.at(t)[:2]), cells, traction.breaks)
    right = (first - cells[:-1] * whole) / h
    return right[:, :-1] + (whole - right)[:, 1:]


def p_and_q_averaged(traction, x):
    return [np.convolve(values, np.ones(3) / 3, "same") for values in sampled(traction, x)]


def dq_averaged(traction, x):
    p, dq = sampled(traction, x)
    return p, np.convolve(dq, np.ones(5) / 5, "same")


KINDS = {"sampled": sampled, "mean": mean, "nodal": nodal, "p and q": p_and_q_averaged, "dq": dq_averaged}


def read(name, count, values, kind=None, phase=0.2):
    """Errors of a, m and n (if given) from a table, their estimates, and the spacing, all in a; and the samples."""
    scene, x = load_scene(name), points(name, count, phase)
    truth = spoiling.exact(scene)
    p, dq = values(truth.traction, x)
    made = samples({"x": x, "p": p, "dq": dq}, "t", (1, 1, 1), 1, kind)
    found = method.scored(scene, made, "t", "t")
    given = [key for key in "amn" if getattr(found, key) is not None]
    off = {key: abs(getattr(found, key) - getattr(truth, key)) / truth.a for key in given}
    return off, found.estimate, (x[1] - x[0]) / truth.a, made


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_is_told_and_read(kind, name):
    """From the table alone: to a thousandth of the spacing where nothing but the kind hides the end."""
    off, estimate, spacing, made = read(name, 401, KINDS[kind])
    assert made.averages == (Average(kind if kind in ("mean", "nodal") else "sampled", 3 if kind == "p and q" else 1),)
    for key in "amn":
        assert off[key] <= max(1.5 * estimate[key], 1e-9)
        assert off[key] < 1e-3 * spacing


@pytest.mark.parametrize("given", ["sampled", "mean", "nodal"])
@pytest.mark.parametrize("kind", ["sampled", "mean", "nodal"])
def test_a_kind_that_is_given_is_believed(given, kind):
    """A wrong one leaves a fit so bad that the estimate tells: by up to a spacing another kind moves an end."""
    off, estimate, spacing, made = read("hertz-small-tension", 151, KINDS[kind], given)
    assert (made.kind, made.guessed, made.averages) == (given, False, (Average(given),))
    known = max(estimate[key] for key in "mn")
    if given == kind:
        assert all(off[key] <= 1.5 * estimate[key] + 1e-9 for key in "amn")
        assert known < 0.02 * spacing
    else:
        assert all(off[key] <= spacing for key in "amn")
        assert known > 0.1 * spacing


@pytest.mark.parametrize(("name", "count"), [("hertz-small-tension", 151), ("hertz-large-tension", 401)])
def test_shear_that_alone_was_averaged(name, count, monkeypatch):
    """|dq| over five points: m was off by 3.6e-2 with an estimate of 2.8e-6, n by 1.3e-2 with 1.6e-5. Against p
    averaged alike slip shows where it is; without that the estimates tell at least."""
    off, estimate, spacing, _ = read(name, count, dq_averaged)
    assert all(off[key] <= max(estimate[key], 1e-9) < 1e-3 * spacing for key in "amn")
    monkeypatch.setattr(method, "alike", lambda p, dq, inside: (p[inside], dq[inside], 1))
    off, estimate, spacing, _ = read(name, count, dq_averaged)
    assert all(off[key] <= estimate[key] for key in off)
    assert max(estimate[key] for key in "mn") > 0.5 * spacing


@pytest.mark.parametrize("average", EVERY, ids=str)
def test_averages_of_powers(average):
    """In closed form as by the trapezoidal rule, on uneven points and beyond their ends."""
    x = np.array([0.0, 0.3, 0.5, 0.9, 1.1, 1.6, 1.8, 2.1, 2.2, 2.6, 3.0, 3.1])
    at, powers = np.arange(5, 8), np.array([0.5, 1.5, 2.5])
    found = average.powers(x, at, np.array([1.25, 2.05, 4.0]), powers)
    t = np.linspace(x[0], x[-1], 200_001)
    for row, end in zip(found, (1.25, 2.05, 4.0), strict=True):
        values = np.maximum(end - t, 0)[:, None] ** powers

        def at_point(i, values=values):
            if average.kind == "sampled":
                return np.array([np.interp(x[i], t, column) for column in values.T])
            if average.kind == "mean":
                weight = ((t >= (x[i - 1] + x[i]) / 2) & (t < (x[i] + x[i + 1]) / 2)).astype(float)
            else:
                weight = np.interp(t, x[i - 1 : i + 2], [0, 1, 0], left=0, right=0)
            return weight @ values / weight.sum()

        reach = average.points // 2
        expected = [np.mean([at_point(j) for j in range(i - reach, i + reach + 1)], axis=0) for i in at]
        assert row == pytest.approx(np.array(expected), abs=2e-4)
        for i, own in zip(at, row, strict=True):  # the end of the first value above zero lies beyond its beginning
            assert (own[0] > 0) == (end > average.begins(x, i))


@pytest.mark.parametrize("average", EVERY, ids=str)
def test_secants_of_averages_grow_no_farther_than_said(average):
    """Wherever between two points the end lies; and as far as that somewhere, to a point."""
    x, at = np.arange(-30.0, 1.0), np.arange(5, 30)
    values = average.powers(x, at, np.linspace(-15.0, -14.0, 100)[1:], np.array([0.5]))[:, ::-1, 0]
    most = 0
    for each in values:
        inside = each[np.flatnonzero(each > 0)]
        most = max(most, int((inside / np.arange(1.0, len(inside) + 1)).argmax()))
    assert average.rises - 1 <= most <= average.rises


def test_the_end_lies_between_the_last_value_above_zero_and_the_next():
    """Noise that hides everything else leaves that."""
    random = np.random.default_rng(4)
    x = np.linspace(-1.2, 1.2, 61)
    for _ in range(20):
        shift = random.uniform(-0.02, 0.02)
        values = np.sqrt(np.maximum(1 - (x - shift) ** 2, 0)) * (1 + 0.1 * random.standard_normal(61))
        first, last = ends.zone_around_peak(values, 0.0)
        found = ends.read_right_end(x, values, last, first, EVERY[:3])
        assert x[last - 1] <= found.x <= x[last + 1]
        assert abs(found.x - 1 - shift) <= found.uncertainty
        assert found.uncertainty >= (x[1] - x[0]) / 2


def test_noise_is_told_from_curvature():
    x = np.sort(np.random.default_rng(2).uniform(-1, 1, 200))
    smooth = 1 + x + x**2 - x**3
    assert ends.noise_level(smooth, x) < 1e-12
    noisy = smooth + 1e-3 * np.random.default_rng(3).standard_normal(200)
    assert ends.noise_level(noisy, x) == pytest.approx(1e-3, rel=0.3)


def test_a_note_tells_what_was_guessed(tmp_path):
    scene, x = load_scene("hertz-small-tension"), points("hertz-small-tension", 151, 0.2)
    traction = spoiling.exact(scene).traction
    for values, said in ((sampled, ()), (mean, ("read as means over cells, as the ends of p show",))):
        path = tmp_path / "t.csv"
        np.savetxt(path, np.column_stack([x, *values(traction, x)]), delimiter=",", header="x,p,dq", comments="")
        notes = score(scene, path)["t.csv"].notes
        assert [any(text in note for note in notes) for text in said] == [True] * len(said)
        assert len(notes) == len(said)
        assert not any("read as" in note for note in score(scene, path, kind="mean")["t.csv"].notes)


def test_forces_of_quadratic_elements_are_those_of_linear_ones():
    """Exactly, whatever the tractions."""
    scene = load_scene("hertz-large-tension")
    x = points("hertz-large-tension", 161, 0.2)
    quadratic = spoiling.nodal(scene, x, 2).columns
    linear = spoiling.nodal(scene, x[::2], 1).columns
    found = samples(quadratic, "t", (1, 1, 1), 2)
    same = samples(linear, "t", (1, 1, 1), 1)
    assert found.p == pytest.approx(same.p, rel=1e-9, abs=1e-9 * same.p.max())
    assert found.x == pytest.approx(same.x)


@pytest.mark.fault
@pytest.mark.parametrize(("name", "sampling", "blind"), [("flat-rounded", "151", ("_fade", "_far")),
                                                         ("hertz-shear", "1001", ("_fade",))])  # fmt: skip
def test_the_nearest_points_alone_take_a_blurred_end_for_a_sharp_one(name, sampling, blind, monkeypatch):
    """Deliberate fault: where the values begin to fade is not looked for, and farther away neither. Friction by a soft
    penalty is then read where it has faded; where that takes a hundred points, farther away, too."""
    scene = load_scene(name)
    clean = spoiling.sampled(scene, spoiling.points(spoiling.exact(scene), sampling))
    ((at, slip),) = spoiling.penalty(scene, 1e-1, 1e-1).values()
    x, p = clean.columns["x"], clean.columns["p"]
    shear = 2 * scene.friction.f * p * np.tanh(np.interp(x / clean.truth.a, at, slip))
    spoiled = spoiling.samples({"x": x, "p": p, "dq": shear}, "t", (1, 1, 1), 1)
    found = method.scored(scene, spoiled, "t", "t")
    assert found.n is None
    assert "m and n are not given" in found.notes[-1]
    for each in blind:
        monkeypatch.setattr(ends._Reading, each, lambda *_: None)
    wrong = method.scored(scene, spoiled, "t", "t")
    assert abs(wrong.n - clean.truth.n) > 10 * wrong.estimate["n"] * clean.truth.a


@pytest.mark.fault
def test_a_rise_of_power_three_halves_is_always_a_drift(monkeypatch):
    """Deliberate fault: the power is not compared with others. Where slip may reverse, a sharp end then moves out."""
    monkeypatch.setattr(method, "may_turn_round", lambda _: True)
    off, estimate, _, _ = read("hertz-large-tension", 151, sampled, phase=0.45)
    assert all(off[key] <= max(estimate[key], 1e-9) for key in "mn")
    drifted = ends._Reading._drifted

    def believed(self, averages):
        found = drifted(self, averages)
        window = np.arange(self.last - 1, self.last + 1)
        tried, misfits = self._misfits(averages[0], window, *self._bracket(averages), 1.5, 1)
        end = float(tried[misfits.argmin()])
        return found or ends._Fit(end, end, end, 0.0, 1)

    monkeypatch.setattr(ends._Reading, "_drifted", believed)
    off, estimate, _, _ = read("hertz-large-tension", 151, sampled, phase=0.45)
    assert any(off[key] > 10 * estimate[key] for key in "mn")


def test_what_may_be_averaged_is_odd():
    assert all(count % 2 for count in RUNNING)
