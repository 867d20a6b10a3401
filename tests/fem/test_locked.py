"""Slip that is locked in where nodes stuck again on the way: what the ends of the stick zone are off by."""

from types import SimpleNamespace

import numpy as np
import pytest
import reversed_loads
from plain import plain
from spying import spied

import partialslip
from partialslip.friction import contact_line
from partialslip.friction.zone_ends import StickInterval
from partialslip_fem import estimate, grading, locked
from partialslip_fem.locked import locked_in


def drifting(Qf=0.75, sf=13.8, poisson=0.3):
    """Hertz contact under reversed loads, with Poisson's ratio ``poisson``. By default the zone drifts by more than its
    width. It takes back the fine elements at its right end in one jump."""
    return reversed_loads.scene(Qf, sf, "fem.accuracy=1e-3").replace({"material.nu": poisson})


def ratios(scene, exact):
    """Estimates of m and n by fem over their true errors, and the estimates; (2,) each."""
    fem = partialslip.run(scene, ["fem"]).results["fem"]
    true = partialslip.compare(fem, exact, scene, None)
    known = np.array([fem.estimate[key] for key in "mn"])
    return known / [true.m, true.n], known


@pytest.mark.slow
@pytest.mark.fault
def test_jumps_of_an_end_that_are_left_out_are_seen(monkeypatch):
    """Deliberate fault: both orders agree at the ends, as the end that takes points back jumps in both."""
    scene = drifting()
    exact = partialslip.run(scene, ["exact"]).results["exact"]
    found, known = ratios(scene, exact)
    assert found.min() > 1
    assert known.max() <= scene.fem.accuracy
    monkeypatch.setattr(locked, "_DIFFERENT", 0.0)
    monkeypatch.setattr(locked, "_REGULAR", 0.0)
    monkeypatch.setattr(locked, "_OFF", 0.0)
    found, _ = ratios(scene, exact)
    assert found.min() < 0.6


def after_jumps(right):
    """A solution, as far as ``locked`` looks at it: the left end of the stick zone [-1, ``right``] went to the left in
    jumps of the length 0.2 from 0.4 on, but waited for the first one three times as long as for the others."""
    x = np.linspace(-1.5, 1.5, 301)
    number = np.floor((0.4 - x) / 0.2)
    stuck = np.where((number >= 0) & (x > -1), 0.3 + 0.1 * number, np.nan)
    changed = np.where(x > right, 0.99, stuck)
    loads = (-1.0, -1.0, 0.0), (1.0, 1.0, 0.0)
    history = SimpleNamespace(lasting=changed, stuck=stuck, slip=0 * x, path=SimpleNamespace(ends=(0, 1), cycle=loads))
    stick = StickInterval(-1.0, right, (1, 1))
    return SimpleNamespace(stick=stick, history=history, lower=SimpleNamespace(x=x, order=1), nodes=np.arange(len(x)))


@pytest.mark.fault
def test_a_jump_of_which_the_zone_has_kept_a_part_is_seen_whole(monkeypatch):
    """What is left of the error of a jump falls with the part that is left, and its answer with the root of that part.
    Deliberate fault: the part counts as a jump of its own."""

    def kept(part):
        right = [locked_in(each, each, np.ones(2))[1] for each in (after_jumps(0.2 + 0.2 * part), after_jumps(0.4))]
        return right[0] / right[1]

    for part in (0.1, 0.3, 0.6):
        assert kept(part) > 0.9 * part**0.5
    jumps = locked._jumps

    def cut(solution):
        intervals, errors = jumps(solution)
        inside = np.clip(intervals, solution.stick.left, solution.stick.right)
        return inside, errors * (np.diff(inside, axis=0)[0] / np.diff(intervals, axis=0)[0]) ** 1.5

    monkeypatch.setattr(locked, "_jumps", cut)
    assert kept(0.1) < 0.8 * 0.1**0.5


@pytest.mark.parametrize("count", [301, 3001])
def test_slip_that_stays_off_counts_whole_however_many_nodes_slipped(count):
    """The end turned round at 0.3 and took back all points up to 1: their slip is off by the same amount. At the left
    end of [-1, 1] the dislocation at 0.3 makes a singularity of the strength 1/(pi sqrt(2)) s w(0.3)."""
    x = np.linspace(-1.5, 1.5, count)
    at = float(x[np.searchsorted(x, 0.3)])

    def solution(slip):
        history = SimpleNamespace(lasting=None, stuck=None, slip=np.where(x >= at, 2 * slip, 0.0))
        line = SimpleNamespace(x=x, order=1)
        return SimpleNamespace(
            stick=StickInterval(-1.0, 1.0, (1, 1)), history=history, lower=line, nodes=np.arange(count)
        )

    slip, strength = 1e-3, 0.7
    moves = 2 * slip * np.sqrt((1 - 0.3) / (1 + 0.3)) / (np.pi * np.sqrt(2)) / strength
    found = locked_in(solution(0.0), solution(slip), np.array([strength, strength]))
    assert found[0] == pytest.approx(locked._DIFFERENT * moves, rel=0.1)


def test_regular_jumps_leave_little_of_what_irregular_ones_leave():
    """Jumps to and fro about an even way let slip about right on both sides; l is the length of a jump only where there
    is no such way."""
    instants, edges = np.arange(1.0, 8.0), np.arange(8.0)
    regular = np.array([edges[:-1], edges[1:]])

    def apart():
        return locked._off_the_way(instants, regular, np.ones(7))[0]

    assert apart() == pytest.approx([1, 0, 0, 0, 0, 0, 1], abs=1e-12)
    instants[3] += 0.4
    assert apart()[3] == pytest.approx(0.8)
    regular[:, 5:] += 1  # no way leads over a gap
    assert apart()[4:6] == pytest.approx([1, 1])


@pytest.mark.parametrize("way", [1, -1])
def test_a_hop_before_a_jump_hides_nothing_of_the_time_off_the_way(way):
    """The end is off its way from the jump before to the jump after, whatever part of this time it waited."""
    edges, instants = way * np.array([0, 1, 1.1, 2.1, 3.1]), np.array([1, 2, 2.1, 3.1])
    intervals = np.sort([edges[:-1], edges[1:]], axis=0)
    apart, times = locked._off_the_way(instants[::way], intervals[:, ::way], np.array([1, 0.1, 0.1, 1]))
    assert (apart > 0).all()
    assert times == pytest.approx([1, 0.44, 0.44, 1])


@pytest.mark.slow
@pytest.mark.fault
def test_how_long_an_end_that_jumped_was_off_its_way_is_seen(monkeypatch):
    """Under mean tension the left end hops over two nodes, and soon jumps over many. Deliberate fault: an end that has
    just hopped is taken to be on its way, which leaves out a third of the estimate."""
    load = {"P": 199760.283, "Q": [87407.4504, -87407.4504], "sigma": [446615949.0, -562921986.0], "cycles": 6}
    flat = {"kind": "flat-rounded", "R": 0.02, "b": 0.00077701467}
    scene = plain(load, 0.6243, (70e9, 0.4), flat, fem={"accuracy": 4e-4})
    exact = partialslip.run(scene, ["exact"]).results["exact"]
    monkeypatch.setattr(grading, "_AT_BENDS", 0.0)  # on meshes that are fine at the ends of the flat, the end hops
    found, known = ratios(scene, exact)
    assert found.min() > 1
    assert known.max() <= scene.fem.accuracy
    off = locked._off_the_way
    monkeypatch.setattr(locked, "_off_the_way", lambda *given: (off(*given)[0], given[2]))
    fault, _ = ratios(scene, exact)
    assert (fault / found).min() < 0.7


@pytest.mark.slow
@pytest.mark.fault
def test_an_end_that_came_back_to_where_it_turned_round_is_seen(monkeypatch):
    """The left end comes back to 9e-5 a from where it turned round, less than the distance of two nodes. Deliberate
    fault: when nodes stuck again, before they slipped at last, is not known."""
    scene = drifting(0.6778367091, 2.85180843)
    exact = partialslip.run(scene, ["exact"]).results["exact"]
    found, known = ratios(scene, exact)
    assert found.min() > 1
    assert known.max() <= scene.fem.accuracy
    read = contact_line.read_stick_zone
    monkeypatch.setattr(contact_line, "read_stick_zone", lambda *given: read(*given[:-1]))
    found, _ = ratios(scene, exact)
    assert found.min() < 0.6


def test_where_no_node_of_the_stick_zone_slipped_nothing_is_locked_in(monkeypatch):
    pairs = spied(monkeypatch, estimate, "smooth_errors")
    partialslip.run(partialslip.load_scene("hertz-large-tension", ["fem.accuracy=1e-3"]), ["fem"])
    assert (locked_in(*pairs[-1][:2], np.ones(2)) == 0).all()


@pytest.mark.parametrize("method", ["march", "fem"])
def test_a_zone_that_tension_leaves_a_ten_thousandth_of_the_contact(method):
    """The zone drifts across the contact with the half-width 4 dQ/(pi dsigma). On cells of this size every node that
    sticks may come beyond its bound by rounding: one of them is to stick all the same."""
    scene = partialslip.load_scene("hertz-shear", ["load.sigma=[-1e12, 1e12]", "fem.accuracy=2e-4"])
    result = partialslip.run(scene, [method]).results[method]
    (Q,), (sigma,) = ({abs(value) for value in of} for of in (scene.load.Q, scene.load.sigma))
    known = result.estimate["m"] + result.estimate["n"]
    assert abs((result.m + result.n) - 8 * Q / (np.pi * sigma)) <= known * result.a
    assert known < 4e-4
    assert result.certificate["kkt"] < 1e-6
