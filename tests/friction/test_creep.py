"""Mean loads under which a zone slips in the steady state that hardly slips in the first cycles."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from known import EXACT, SCENE, result
from plain import plain

import partialslip
from partialslip.friction import history, limit
from partialslip.friction.regime import _unsure
from partialslip.run.judge import Outcome, compare
from partialslip.run.judge.verdicts import Bar, judge_regime

LOAD, HERTZ = {"P": 2e5, "Q": [-32700.0, 0.0], "sigma": [-266e6, -103e6]}, {"kind": "hertz", "R": 0.02}
CREEP = plain(LOAD, 0.35, (72.8e9, 0.3), HERTZ, fem={"accuracy": 1e-2})
PAD = Path(__file__).parents[2] / "docs" / "scenes" / "finite-pad.toml"
LEFT = 0.9664747169  # exact m, in a


@pytest.fixture(scope="module")
def exact():
    return partialslip.run(CREEP, ["exact"])["exact"]


def solved(method, **loads):
    return partialslip.run(CREEP.replace(load=loads), [method])[method]


@pytest.mark.parametrize("method", ["march", "fem"])
def test_a_zone_whose_room_is_a_millionth_slips(method, exact):
    """After three cycles q changes by 1e-5 f p0 only; beyond the stick zone 1e-6 f p are left, which the next cycle
    takes away."""
    found = solved(method)
    assert exact.m / exact.a == pytest.approx(LEFT, abs=1e-9)
    for key in ("m", "n"):
        off = abs(getattr(found, key) - getattr(exact, key)) / exact.a
        assert off <= min(found.estimate[key], 1e-3)
    assert found.counts["cycles"] <= 5
    assert "steady" not in found.undetermined


@pytest.mark.fault
def test_cycles_that_end_as_soon_as_q_hardly_changes(monkeypatch, exact):
    """Deliberate fault: room that q has left in the last cycle is taken for room that it keeps."""
    monkeypatch.setattr(limit, "undecided", lambda rooms, *_: np.zeros(len(rooms[-1]), bool))
    monkeypatch.setattr(history, "lost", lambda rooms: np.zeros(len(rooms[-1]), bool))
    found = solved("march")
    assert abs(found.m - exact.m) / exact.a > 10 * found.estimate["m"]


def test_few_cycles_are_not_judged_against_the_steady_state(exact):
    """Two cycles that are asked for are no mistake of the method; thirty are steady."""
    found = solved("march", cycles=2)
    judged = compare(found, exact, CREEP, 1e-2)
    assert judged.outcome is Outcome.NOT_JUDGED
    assert "m" in judged.unjudged  # n and q are within their bars all the same
    assert "2 cycles (load.cycles) do not reach the steady state" in str(judged.verdicts)
    assert "steady" not in solved("march", cycles=30).undetermined


def test_two_results_of_as_many_cycles_are_compared():
    found = solved("march", cycles=2)
    assert compare(found, found, CREEP, 1e-2).passed


def test_slip_that_is_too_small_tells_no_ratcheting():
    """A net slip of a cycle that is neither none nor much is that of ratcheting, or of creep that ends."""

    def untold(net, regime="small tension"):
        path = type("Cycles", (), {"ratchets": net, "steady": True, "cycles": 4})
        return _unsure(path, regime)

    assert list(untold(8.6e-4)) == ["regime"]
    assert not untold(8.6e-4, "ratchets")
    assert not untold(1e-12)

    def judged(net, true="ratchets"):
        found = result(undetermined=untold(net))
        return judge_regime(found, replace(EXACT, regime=true), SCENE, {"m": Bar(1e-3)}, {}).outcome

    assert judged(8.6e-4) is Outcome.NOT_JUDGED
    assert judged(1e-12) is Outcome.MISSED
    assert judged(8.6e-4, "stuck") is Outcome.MISSED
    assert judged(8.6e-4, "small tension") is Outcome.PASSED


def test_few_cycles_are_steady_once_q_changes_less_than_the_accuracy():
    """In the third cycle of a pad held by its sides q changes by 1e-4 f p, a twelfth of what it did in the second."""
    scene = partialslip.load_scene(PAD, ["fem.accuracy=0.1"])
    assert scene.load.cycles == 3
    found = partialslip.run(scene, ["fem"])["fem"]
    assert 1e-6 < found.last_cycle_change < 1e-3
    assert "steady" not in found.undetermined
