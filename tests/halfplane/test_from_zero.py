"""q1 and q2 where slip turns round: loads followed from a contact without shear, against march and by symmetry."""

import functools

import numpy as np
import pytest
import reversed_loads

import partialslip
from partialslip.halfplane.gradual_path import from_zero
from partialslip.halfplane.gradual_path.stage import Loads

REVERSED, MEAN, SMALL_MEAN = (0.0, 0.0), (0.05, 0.5), (0.02, 0.1)  # mean of Q, in f P, and of sigma, in f p0
X = np.linspace(-0.999, 0.999, 201)


def scene(Qf, sf, mean, *more, turn=1, mirror=1):
    mean = turn * mean[0], turn * mirror * mean[1]
    return reversed_loads.scene(turn * Qf, turn * mirror * sf, *more, name="hertz-shear", mean=mean)


@functools.cache
def exact(*given, **named):
    return partialslip.run(scene(*given, **named), "exact", subsurface=True)["exact"]


def levels(result):
    """q1 and q2 at ``X``, in f p0."""
    return np.array(result.traction.at(X * result.a).levels) / (0.5 * result.p0)


@pytest.mark.parametrize(
    ("Qf", "sf", "mean"),
    [
        (0.55, 7.0, MEAN),
        (0.55, 7.0, SMALL_MEAN),
        (0.6004, 3.2226, REVERSED),  # the right end returns to where it stood a cycle before
        (0.75, 6.0, REVERSED),
    ],
)
@pytest.mark.slow
def test_march_agrees(Qf, sf, mean):
    """March follows cells event by event and knows nothing of the phases. Up to f p0/2 is locked in."""
    found = exact(Qf, sf, mean)
    assert not found.undetermined
    assert found.stress_at is not None
    marched = partialslip.run(scene(Qf, sf, mean, "fem.accuracy=1e-3"), "march")["march"]
    x = marched.traction.x
    for key, mine, its in zip(
        ("q1", "q2"), found.traction.at(x).levels, (marched.traction.q1, marched.traction.q2), strict=True
    ):
        off = np.sqrt(np.trapezoid((mine - its) ** 2, x) / np.trapezoid(mine**2, x))
        assert off < 2 * marched.estimate[key]


@pytest.mark.slow
@pytest.mark.fault
def test_a_path_that_begins_in_the_steady_cycle_is_seen(monkeypatch):
    """Deliberate fault: nothing is locked in, as if the loads had no mean."""
    true = levels(exact(0.55, 7.0, MEAN))
    followed = from_zero.from_zero

    def without_mean(_, steady, cycles):
        return followed(Loads(steady.loads.tension / 2, steady.loads.shear / 2), steady, cycles)

    monkeypatch.setattr("partialslip.halfplane.turning.from_zero", without_mean)
    wrong = levels(partialslip.run(scene(0.55, 7.0, MEAN), "exact")["exact"])
    assert np.abs(wrong - true).max() > 0.3


def test_loads_are_held_within_the_bound():
    """|q| <= f p, and int q dx = Q at both load points."""
    found = exact(0.55, 7.0, MEAN)
    angle = (np.arange(20000) + 0.5) / 20000 * np.pi
    x, weights = np.cos(angle), np.sin(angle) * np.pi / 20000
    for q, force in zip(found.traction.at(x * found.a).levels, (0.05 - 0.55, 0.05 + 0.55), strict=True):
        scaled = q / (0.5 * found.p0)
        assert (np.abs(scaled) <= np.sqrt(1 - x**2) + 1e-9).all()
        assert scaled @ weights == pytest.approx(force * np.pi / 2, abs=1e-5)


@pytest.mark.slow
def test_one_cycle_does_not_lead_to_the_steady_state_of_mean_loads():
    assert "q1" in exact(0.55, 7.0, MEAN, "load.cycles=1").undetermined
    assert not exact(0.55, 7.0, REVERSED, "load.cycles=2").undetermined


@pytest.mark.slow
def test_fully_reversed_loads_lock_in_next_to_nothing():
    q1, q2 = levels(exact(0.55, 7.0, REVERSED))
    assert np.abs(q1 + q2).max() < 1e-5
    assert np.abs(q2).max() > 0.9


@pytest.mark.parametrize(
    ("turn", "mirror"),
    [pytest.param(-1, 1, marks=pytest.mark.slow), (1, -1), pytest.param(-1, -1, marks=pytest.mark.slow)],
)
def test_signs_of_the_loads(turn, mirror):
    """Reversed loads reverse q; tension against dQ mirrors the contact. Load point 2 stays the last one."""
    plain = levels(exact(0.55, 7.0, MEAN))
    other = levels(exact(0.55, 7.0, MEAN, turn=turn, mirror=mirror))
    np.testing.assert_allclose(other, turn * plain[:, ::mirror], atol=1e-9)


@pytest.mark.slow
@pytest.mark.fault
def test_ways_on_which_slip_does_not_hold_are_refused(monkeypatch):
    """Large means make zones slip within the stick zone on the way; without the check of the conditions q is wrong
    without a word."""
    assert {"q1", "q2"} <= exact(0.6738, 5.1666, (0.03, 0.4)).undetermined.keys()
    monkeypatch.setattr(from_zero, "_checked", lambda way: way)
    assert not partialslip.run(scene(0.6738, 5.1666, (0.03, 0.4)), "exact")["exact"].undetermined
