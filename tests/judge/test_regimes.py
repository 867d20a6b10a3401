"""Where the name of a regime is not judged: zones narrower than the bar, and a mean of Q next to its bound."""

from dataclasses import replace

import pytest
from known import EXACT, SCENE, SHARE, A, F, P, result
from msgspec.structs import replace as changed

from partialslip import compare
from partialslip.run.judge import Outcome
from partialslip.run.judge.verdicts import _barely, _too_near

NEXT = 1 - 1e-12


def zone(left, right, regime):
    """Return a result with the stick zone [left, right], in a."""
    return replace(EXACT, regime=regime, stick_centre=(left + right) / 2 * A, stick_half_width=(right - left) / 2 * A)


def test_what_has_no_zone_is_near_to_nothing():
    for lost in ({"stick_centre": None}, {"stick_half_width": None}):
        none = replace(EXACT, **lost)
        assert _too_near(replace(none, regime="sliding"), none, 9.0) == ""
    assert _too_near(replace(EXACT, regime="ratchets"), replace(EXACT, regime="stuck"), 9 * A) == ""
    assert _too_near(replace(EXACT, regime="sliding"), zone(-0.9, 0.9, "stuck"), 0.2 * A) == ""


LIMIT = F * P


def held(mean, **limits):
    """Return a reference with these limits of the mean of Q and a scene with this mean, N/m."""
    Q = tuple(mean + way * SHARE * LIMIT for way in (-1, 1))
    return replace(EXACT, limits=limits), changed(SCENE, load=changed(SCENE.load, Q=Q))


@pytest.mark.parametrize(
    "limits", [{"Q_mean": 0.5 * LIMIT}, {"Q_mean_least": -0.5 * LIMIT, "Q_mean_most": 0.5 * LIMIT}]
)
@pytest.mark.parametrize("sign", [-1, 1])
def test_a_mean_next_to_its_bound_tells_not_whether_it_ratchets(limits, sign):
    for off, near in ((0.0, True), (0.009, True), (-0.009, True), (0.011, False), (-0.011, False)):
        reference, scene = held(sign * (0.5 + off) * LIMIT, **limits)
        found = _barely(result(regime="ratchets"), reference, scene, 0.01)
        assert bool(found) is near, (off, sign)
        assert not found or found.startswith("the mean of Q is nearer")
        assert bool(_barely(result(), replace(reference, regime="ratchets"), scene, 0.01)) is near


def test_the_mean_may_be_off_by_just_the_bar():
    reference, scene = held(0.0, Q_mean=0.25 * LIMIT)
    assert _barely(result(regime="ratchets"), reference, scene, 0.25)
    assert not _barely(result(regime="ratchets"), reference, scene, 0.25 * NEXT)


def test_only_ratchets_have_a_bound_of_the_mean():
    reference, scene = held(0.5 * LIMIT, Q_mean=0.5 * LIMIT)
    assert not _barely(result(), reference, scene, 0.01)
    assert not _barely(result(regime="ratchets"), replace(reference, regime="sliding"), scene, 0.01)
    assert not _barely(result(regime="ratchets"), replace(reference, limits={}), scene, 0.01)
    uneven, scene = held(-0.5 * LIMIT, Q_mean_least=-0.2 * LIMIT, Q_mean_most=0.5 * LIMIT)
    assert not _barely(result(regime="ratchets"), uneven, scene, 0.01)


@pytest.mark.parametrize(("unsure", "outcome"), [({}, Outcome.MISSED), ({"regime": "too little"}, Outcome.NOT_JUDGED)])
@pytest.mark.parametrize("ratchets", ["result", "reference"])
def test_slip_that_adds_up_to_little_tells_not_whether_it_ratchets(unsure, outcome, ratchets):
    """A mean of Q 1.8 % above its bound adds 8.6e-4 of the slip of half a cycle: march and fem called it steady."""
    drifting = result("march", undetermined=unsure, estimate=dict.fromkeys("mnq", 1e-6))
    other = result(regime="ratchets")
    pair = (other, drifting) if ratchets == "result" else (drifting, replace(other, method="exact"))
    verdicts = {each.quantity: each for each in compare(*pair, SCENE, 1e-4).verdicts}
    assert verdicts["regime"].outcome is outcome
    assert (verdicts["regime"].reason == "march: too little") == (outcome is Outcome.NOT_JUDGED)
