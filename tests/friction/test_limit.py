"""The limit of cycles that come to the steady state in geometric progression."""

from dataclasses import replace

import numpy as np
import pytest
from cell_contact import cells, loads
from plain import plain

import partialslip
from partialslip.friction import history
from partialslip.friction.coulomb_constant_pressure import march
from partialslip.friction.limit import Cycles, ahead, cycle_change, cycles_settled, limit, lost, room_of, undecided
from partialslip.run.judge.measures import norm_errors

BOUND = np.array([1.0, 2.0, 0.5, 0.0])
END, MODE = np.array([0.3, -1.2, 0.1, 0.0]), np.array([0.2, 0.1, -0.05, 0.0])


def found(states):
    times = ahead(states, BOUND)
    return None if times is None else limit(states, BOUND, times)


@pytest.mark.parametrize("ratio", [0.1, 0.7, 0.99])
def test_geometric_progression(ratio):
    """The limit of a progression is exact, from four states on; errors beside it count as much as the ratio tells."""
    states = [END + MODE * ratio**k for k in range(4)]
    assert found(states) == pytest.approx(END, abs=1e-12)
    assert found(states[:3]) is None
    beside = [state + 1e-4 * (1 - ratio) ** 2 * MODE[::-1] * 0.05**k for k, state in enumerate(states)]
    assert found(beside) == pytest.approx(END, abs=1e-4)


def test_bounds_are_kept():
    states = [np.array([0.9 - 0.5 * 0.9**k, 0.0, 0.0, 0.0]) + np.array([0.3, 0, 0, 0]) for k in range(4)]
    assert (np.abs(found(states)) <= BOUND).all()


def test_no_progression():
    """Power laws, growth, oscillations and cycles that repeat have no limit that four cycles tell."""
    for shares in ([1, 1 / 2, 1 / 3, 1 / 4], [1, 2, 4, 8], [1, -0.5, 0.25, -0.125], [1, 1, 1, 1]):
        assert found([END + share * MODE for share in shares]) is None


@pytest.mark.parametrize(("Qf", "sf"), [(0.6, 10.0), (0.7, 9.0)])
def test_skipped_cycles_change_nothing(Qf, sf, monkeypatch):
    """Under a small mean load nodes come slowly to their bounds: cycles that are skipped change neither the change of q
    from load point to load point nor what is locked in."""
    _, *problem = cells(growth=0.2)
    path = loads(Qf, sf)
    path = replace(path, cycle=tuple((Q + 0.03, strain, slope) for Q, strain, slope in path.cycle))
    hastened = march(*problem, 1.0, path)
    monkeypatch.setattr(history, "ahead", lambda *_: None)
    plain = march(*problem, 1.0, path)
    for key in ("q1", "q2"):
        assert getattr(hastened, key) == pytest.approx(getattr(plain, key), abs=1e-6 * problem[-1].max())
    assert hastened.load_steps < plain.load_steps


def ends(changes):
    """Cycle after which cycles end, None if they go on."""
    return next((count for count in range(1, len(changes) + 1) if cycles_settled(changes[:count])), None)


@pytest.mark.parametrize("power", [1, 2])
def test_slow_creep_is_followed_until_it_is_none(power):
    creep = 50.0 / np.arange(1, 200) ** power
    end = ends(creep.tolist())
    assert creep[end - 1] <= 1 < creep[end - 2]


def test_changes_that_are_rounding_and_fall_no_more_end_cycles():
    rounding = np.random.default_rng(5).uniform(2, 5, 100).tolist()
    assert 8 < ends([3e3, 200.0, 15.0, *rounding]) < 40


def test_changes_too_large_for_rounding_go_on():
    assert ends(np.random.default_rng(5).uniform(150, 500, 100).tolist()) is None


def test_a_change_counts_beside_its_bound_and_the_rounding_of_all_forces():
    forces, near = np.array([1.0, 2.0, 0.0]), np.array([1e-7, 2e-7, 0.0])
    assert cycle_change(forces, forces, near, 3.0, 0.0) == 0
    assert cycle_change(forces + 1e-7 * np.eye(3)[0], forces, near, 0.0, 0.0) == pytest.approx(1, rel=1e-6)
    assert cycle_change(forces + 3e-14 * np.eye(3)[2], forces, near, 3.0, 0.0) == pytest.approx(1 / 3, rel=1e-6)
    assert cycle_change(forces + 3e-14 * np.eye(3)[2], forces, near, 0.0, 2e-15) == pytest.approx(1 / 2, rel=1e-6)
    assert cycle_change(0 * forces, 0 * forces, 0 * near, 0.0, 0.0) == 0


def test_what_room_will_be_left():
    """Room in geometric progression is lost, unless its limit is more than half of it; a power of the cycles is not
    known, nor is room that grew before it fell, or that of fewer than three cycles."""
    count = np.arange(1, 5)[:, None]
    rooms = np.hstack(
        [0.02**count, 0.7**count, 1 + 0.1**count, 0.1 + 0 * count, 1 / count**2, np.abs(count - 2.5) - 0.4]
    )
    bound = np.ones(6)
    assert lost(rooms).tolist() == [True, True, False, False, False, False]
    assert not lost(rooms[:2]).any()
    assert undecided(rooms[:3], bound, 1.0, 3).tolist() == [False, False, False, False, True, False]
    assert undecided(rooms[:2], bound, 1.0, 2).tolist() == [True, True, False, False, True, True]
    assert undecided(rooms[:1], bound, 0.01, 1).tolist() == [True, False, False, True, False, False]
    assert not undecided(rooms[:2], bound, 1e-9, 2).any()  # more room than may still go


def test_room_in_a_cycle():
    """Between the ends of the cycle; out of phase up to the bound and down to it at any of the load points."""
    visited = [(np.array([q]), np.array([bound])) for q, bound in ((-1.0, 1.5), (0.5, 1.0), (0.8, 2.0))]
    assert room_of(visited, (0, 2)) == pytest.approx([1.5 + 2.0 - 1.8])
    assert room_of(visited, None) == pytest.approx([0.5 + 0.5])


def test_cycles_go_on_while_room_falls():
    """q hardly changes, and room falls a thousandfold in each cycle: the third one tells that nothing is left."""
    cycles, q = Cycles(5e-3, 5e-3), np.ones(2)
    ends = []
    for room in (1.0, 1e-3, 1e-6):
        cycles.add(q + 1e-3, q, q, np.array([room, 0.5]), 2.0, 0.0)
        ends.append(cycles.end)
    assert ends == [True, False, True]
    cycles.skipped()
    cycles.add(q + 1e-3, q, q, np.array([1e-6, 0.5]), 2.0, 0.0)
    assert not cycles.end
    assert not cycles.steady


@pytest.mark.slow
def test_skipped_cycles_of_coupled_bodies_change_nothing(monkeypatch):
    """Blocks whose q needs a hundred cycles until nothing changes: the normal forces go on with it."""
    bodies = {
        "upper": {"kind": "block", "width": 6.7e-3, "height": 7.8e-3},
        "lower": {"kind": "block", "width": 19e-3, "height": 6.4e-3, "support": "roller"},
    }
    load = {"P": 875e3, "Q": [-161e3, 161e3], "sigma": [498e6, -498e6], "steps": 8}
    flat = {"kind": "flat-rounded", "R": 0.02, "b": 2.9e-4}
    scene = plain(load, 0.23, (70e9, 0.0), flat, bodies=bodies, fem={"size": 0.05})
    hastened = partialslip.run(scene, ["fem"])["fem"]
    monkeypatch.setattr(history, "ahead", lambda *_: None)
    every = partialslip.run(scene, ["fem"])["fem"]
    for key in ("a", "m", "n"):
        assert getattr(hastened, key) == pytest.approx(getattr(every, key), abs=1e-6 * every.a)
    norms = norm_errors(hastened.traction, every.traction, scene.friction.f, ("q1", "q2"))
    assert max(norms.values()) < 1e-5
    assert hastened.counts["load_steps"] < every.counts["load_steps"] / 3
