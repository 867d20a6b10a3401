"""Legs followed event by event: against small steps, brute force, invariances, and Coulomb's conditions on the way."""

import itertools

import numpy as np
import pytest

from partialslip.friction import path_following
from partialslip.friction.active_set import solve_bounded
from partialslip.friction.path_following import Bounds, Follower
from partialslip.friction.tableau import Tableau
from partialslip.halfplane.hertz import HertzShape
from partialslip.march.cells import compliance, forces
from partialslip.tools.errors import PartialslipError

CERTIFIED = 1e-11  # residuals, in f P: rounding errors of a few hundred pivots
DRIFTS = (0.6434668934976868, 8.670889385947003)  # (Q_f, s_f): the stick zone drifts, points slip and stick again


def hertz(cells=120):
    """Compliance, bound and displacements under tension of Hertz contact on equal cells: a = f = A = p0 = 1."""
    vertices = np.linspace(-1, 1, cells + 1)
    return compliance(vertices / 2), np.pi / 2 * forces(HertzShape(), vertices), (vertices[1:] + vertices[:-1]) / 8


def loaded(load, problem, stages=()):
    """First loading, and the half-cycle after it."""
    (Qf, sf), (C, bound, x) = load, problem
    follower = Follower(C)
    first = follower.leg(Bounds.constant(bound), 0 * bound, sf / 2 * x, np.pi / 2 * Qf)
    return first, follower.leg(Bounds.constant(bound), first.forces, -sf * x, -np.pi * Qf, stages)


def random_problem(seed, largest=40):
    """A compliance that is no inverse M-matrix, bounds over six decades, and three legs (g, change of Q)."""
    random = np.random.default_rng(seed)
    count = int(random.integers(3, largest))
    x = np.sort(random.random(count))
    C = 3 - np.log((x[:, None] - x) ** 2 + 1e-4) / 2 + 1e-2 * np.eye(count)
    bound = random.random(count) ** 3 + 1e-6
    Q = np.concatenate([[0.0], random.uniform(-0.99, 0.99, 3) * bound.sum()])
    legs = [(10 ** random.uniform(-2, 1) * random.standard_normal(count), change) for change in np.diff(Q)]
    return C, bound, legs


def in_turn(C, bound, legs):
    follower, found = Follower(C), []
    for g, Q in legs:
        found.append(follower.leg(Bounds.constant(bound), found[-1].forces if found else 0 * bound, g, Q))
    return found


def in_steps(C, bound, start, g, Q, count):
    """Forces and slip in ``count`` equal load steps, each a bounded programme."""
    x, rest = start, 0 * start
    for number in range(1, count + 1):
        found = solve_bounded(C, C @ x + g / count, -bound, bound, float(start.sum()) + Q * number / count)
        x, rest = found.x, rest + found.rest
    return x, rest


def test_load_steps_converge_to_it():
    """Errors of load steps fall at least in proportion to their length, in forces and in slip."""
    C, bound, x = problem = hertz()
    first, back = loaded(DRIFTS, problem)
    errors = []
    for count in (8, 16, 32, 64):  # steps in which several nodes stick again
        q, rest = in_steps(C, bound, first.forces, -DRIFTS[1] * x, -np.pi * DRIFTS[0], count)
        errors.append((np.abs(q - back.forces).sum(), np.abs(rest - back.rest).sum()))
    assert np.isfinite(back.stuck).sum() > 8
    assert (np.log2(np.divide(errors[:-1], errors[1:])).mean(axis=0) > 0.9).all()
    assert errors[0][0] > 1e-3


@pytest.mark.parametrize("Qf", [0.1, 0.5, 0.9])
def test_small_tension_in_one_step(Qf):
    """Both ends only retreat: one step from load point to load point gives the same."""
    C, bound, x = problem = hertz()
    first, back = loaded((Qf, 2 * Qf), problem)
    for leg, start, change in ((first, 0 * bound, 1 / 2), (back, first.forces, -1)):
        q, rest = in_steps(C, bound, start, change * 2 * Qf * x, change * np.pi * Qf, 1)
        assert leg.forces == pytest.approx(q, abs=1e-12)
        assert leg.rest == pytest.approx(rest, abs=1e-12)
        assert leg.pivots == leg.slips.sum()


@pytest.mark.parametrize("seed", range(30))
def test_certificate_and_coulomb_on_the_way(seed):
    """At random places of a leg nodes that stick do not move, and nodes that slip lie on the bound that opposes them;
    by products with C alone."""
    C, bound, legs = random_problem(seed)
    random, start, follower = np.random.default_rng(seed), 0 * bound, Follower(C)
    for g, Q in legs:
        at = np.sort(random.random(6))
        leg = follower.leg(Bounds.constant(bound), start, g, Q, at.tolist())
        assert leg.residual.max() <= CERTIFIED * bound.sum()
        assert leg.imbalance <= CERTIFIED * bound.sum()
        assert (leg.path >= np.abs(leg.rest) - 1e-12).all()
        assert (leg.slipped >= -1e-12).all()  # work is lost
        for (one, two), (before, after) in zip(itertools.pairwise(at), itertools.pairwise(leg.stages), strict=True):
            part = Follower(C).leg(Bounds.constant(bound), before, (two - one) * g, (two - one) * Q)
            assert part.forces == pytest.approx(after, abs=1e-9)
            slip = (two - one) * g - C @ (after - before)
            between = (part.highest < bound) & (part.lowest > -bound)
            if between.any():
                slip -= slip[between].mean()
                assert slip[between] == pytest.approx(0, abs=1e-9)
                assert (slip[part.lowest > -bound] >= -1e-9).all()
                assert (slip[part.highest < bound] <= 1e-9).all()
        start = leg.forces


@pytest.mark.parametrize("seed", range(10))
def test_invariances(seed):
    """Mirrored, reversed, scaled, and taken in two parts: the same forces and slip."""
    C, bound, legs = random_problem(seed)
    found = in_turn(C, bound, legs)
    mirrored = in_turn(C[::-1, ::-1], bound[::-1], [(g[::-1], Q) for g, Q in legs])
    opposite = in_turn(C, bound, [(-g, -Q) for g, Q in legs])
    shifted = in_turn(C + 7.0, bound, [(g + 3.0, Q) for g, Q in legs])
    scaled = in_turn(1e6 * C, 1e-3 * bound, [(1e3 * g, 1e-3 * Q) for g, Q in legs])
    part = float(np.random.default_rng(seed).random())
    split = in_turn(C, bound, [(share * g, share * Q) for g, Q in legs for share in (part, 1 - part)])
    for number, leg in enumerate(found):
        close = {"abs": 1e-10 * bound.sum()}
        assert mirrored[number].forces[::-1] == pytest.approx(leg.forces, **close)
        assert opposite[number].forces == pytest.approx(-leg.forces, **close)
        assert shifted[number].forces == pytest.approx(leg.forces, **close)
        assert 1e3 * scaled[number].forces == pytest.approx(leg.forces, **close)
        one, two = split[2 * number : 2 * number + 2]
        assert two.forces == pytest.approx(leg.forces, **close)
        size = 1e-9 * float(np.abs(leg.path).max()) + 1e-12
        assert one.rest + two.rest == pytest.approx(leg.rest, abs=size)
        assert one.path + two.path == pytest.approx(leg.path, abs=size)
        assert np.minimum(one.lowest, two.lowest) == pytest.approx(leg.lowest, **close)
        assert np.maximum(one.highest, two.highest) == pytest.approx(leg.highest, **close)


def test_both_ends_at_once():
    """In symmetric contact nodes reach their bounds in pairs; forces stay even, and unloading is Masing's."""
    C, bound, x = hertz(121)
    first, back = loaded((0.7, 0.0), (C, bound, x))
    for leg in (first, back):
        assert leg.forces == pytest.approx(leg.forces[::-1], abs=1e-14)
    assert back.forces == pytest.approx(-first.forces, abs=1e-13)
    assert back.rest == pytest.approx(-2 * first.rest, abs=1e-13)


def test_dissipation_is_the_work_of_the_loads():
    """Over a steady cycle Q, on the displacement of a point that sticks, and tension do the work against friction."""
    (C, bound, x), (Qf, sf), at = hertz(), DRIFTS, np.linspace(0, 1, 2001)
    follower, forces, lost, work = Follower(C), 0 * bound, 0.0, 0.0
    sticks = int(np.argmin(np.abs(4 * x + 0.5)))
    for number in range(21):
        way = (-1) ** number * (2 if number else 1) / 2
        leg = follower.leg(Bounds.constant(bound), forces, way * sf * x, way * np.pi * Qf, at.tolist())
        if number > 18:
            shift = (leg.stages - forces) @ C[sticks] - way * sf * x[sticks] * at
            work += float(np.trapezoid(leg.stages.sum(axis=1), shift) + np.trapezoid(leg.stages @ (way * sf * x), at))
            lost += float(bound @ leg.path)
            assert leg.path[sticks] == 0
        forces = leg.forces
    assert lost == pytest.approx(work, rel=1e-6)


def test_contact_that_slides():
    C, bound, x = hertz(20)
    with pytest.raises(PartialslipError, match=r"slides; \|Q\| must be less than f P"):
        Follower(C).leg(Bounds.constant(bound), 0 * bound, x, 1.001 * float(bound.sum()))


def residual(load=DRIFTS):
    problem = hertz()
    return max(float(leg.residual.max()) for leg in loaded(load, problem)) / problem[1].sum()


@pytest.mark.fault
def test_slip_rates_checked_with_the_wrong_sign(monkeypatch):
    """Deliberate fault: held nodes stick again when they should slip on, which no leg ends with."""
    true = path_following._Leg._room

    def turned(self):
        room = true(self)
        return np.where(self._tableau.sticks, room, -room)

    assert residual() <= CERTIFIED
    monkeypatch.setattr(path_following._Leg, "_room", turned)
    with pytest.raises(PartialslipError, match="without an end"):
        residual()


@pytest.mark.fault
def test_no_node_sticks_again(monkeypatch):
    """Deliberate fault: nodes slip on against their traction. Their displacements and forces fit each other; the sign
    of slip, from a product with C, does not. Where the stick zone should drift, it shrinks to nothing."""

    C, bound, x = problem = hertz()
    (Qf, sf), parts = (0.5, 2.1), np.linspace(0, 1, 41)

    def against():
        """Largest slip along -T of nodes on their bounds, in a fortieth of a half-cycle."""
        _, back = loaded((Qf, sf), problem, parts.tolist())
        held = np.abs(back.stages) >= (1 - 1e-12) * bound
        slip = np.diff(-sf * np.outer(parts, x) - (back.stages - back.stages[0]) @ C, axis=0)
        sticks = int(np.argmin(back.path))
        along = (slip - slip[:, [sticks]]) * np.sign(back.stages[1:])
        return float(-along[held[1:] & held[:-1]].min())

    assert against() <= 1e-12
    room = path_following._Leg._room
    monkeypatch.setattr(path_following._Leg, "_room", lambda leg: np.where(leg._tableau.sticks, room(leg), np.inf))
    assert against() > 1e-3
    with pytest.raises(PartialslipError, match="slides"):
        loaded(DRIFTS, problem)


@pytest.mark.fault
def test_tableau_with_errors(monkeypatch):
    """Deliberate fault: pivots with errors of 1e-9, and no check of the rates on the way; the residual sees them."""
    true = Tableau.pivot

    def rough(self, node, column):
        true(self, node, column * (1 + 1e-9 * np.sin(np.arange(len(column)))))

    monkeypatch.setattr(Tableau, "pivot", rough)
    monkeypatch.setattr(path_following, "_CHECKED", 1)
    assert residual() <= 1e2 * CERTIFIED
    monkeypatch.setattr(path_following, "_CHECKED", 10**9)
    assert residual() > 1e2 * CERTIFIED


def corrected():
    """Largest error of the displacements, relative, after the corrections of a leg that is 1e-12 off, with a tenth of
    the nodes at their bounds."""
    C, bound, x = hertz()
    start = np.clip(1.1 * bound * np.sin(9 * x), -bound, bound)
    leg = path_following._Leg(C, np.diag(C), Bounds.constant(bound), Tableau(np.linalg.inv(C)), start, 0 * bound, 0.0)
    leg._enter(0)
    leg._rest += 1e-12 * np.cos(40 * x)
    before = np.abs(leg._displacement_errors()).max()
    leg._refine()
    assert (np.abs(leg._forces) <= bound).all()
    return float(np.abs(leg._displacement_errors()).max() / before)


@pytest.mark.fault
def test_forces_cut_off_at_their_bounds_by_a_correction(monkeypatch):
    """Deliberate fault: nodes that stick at their bounds do not give way to a correction. In two hundred cycles near
    the largest mean loads the errors then grew beyond what a certificate allows."""
    assert corrected() < 1e-3
    monkeypatch.setattr(path_following, "_GIVE", 0)
    assert corrected() > 0.1
