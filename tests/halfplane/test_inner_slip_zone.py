"""An inner slip zone under gradual loads: the phase in which it slips, and the half cycles that begin with it."""

import functools

import event_cells
import numpy as np
import pytest

from partialslip.halfplane.gradual_path import certificate as certificates
from partialslip.halfplane.gradual_path.certificate import certificate_of, certify
from partialslip.halfplane.gradual_path.half_cycle import HalfCycle, steady, stuck
from partialslip.halfplane.gradual_path.inner_rates import B, Z, other_root
from partialslip.halfplane.gradual_path.retreat import Zone
from partialslip.halfplane.gradual_path.stage import Loads, LostError, Stage, common_zones
from partialslip.halfplane.hertz import HertzShape

LOADS = Loads(7.2, np.pi * 0.9975)


@functools.cache
def parted():
    """The steady half cycle, and its phase with the inner zone."""
    half = steady(LOADS, HertzShape())
    return half, half.phases[0]


@pytest.mark.slow
def test_conditions_hold_while_the_inner_zone_slips():
    half, phase = parted()
    shares = np.linspace(0, 1, 9)[1:]
    way = [phase.first._replace(q=half.start), *(phase.at(share * phase.last.progress) for share in shares)]
    found = certify(LOADS, way)
    assert max(found.bound, found.equilibrium, found.stick, found.slip) < 1e-8


def test_both_intervals_move_alike():
    """The integral of the strain across the inner zone vanishes: here by Gauss-Chebyshev quadrature."""
    _, phase = parted()
    for share in (0.0, 0.3, 0.9):
        left, low, high, right, zero = phase.way.at(share * phase.last.progress)
        u = np.cos(np.pi * (np.arange(400) + 0.5) / 400)
        z = (low + high) / 2 + (high - low) / 2 * u
        other = other_root(np.array([left, low, high, right]), zero, LOADS.least)
        values = (z - zero) * (z - other) / np.sqrt((z - left) * (right - z))
        assert abs(values.mean()) < 1e-9 * np.abs(values).mean()


def test_the_inner_zone_opens_by_two_thirds_of_the_way_of_z0():
    """What a point has seen as b passes it adds up to nothing. At the beginning b = v t and z0 = w t: the integral of
    (v t - w u)/sqrt(t - u) over u from 0 to t vanishes for v = 2 w/3."""
    way = parted()[1].way
    for progress in (1e-8, 1e-7, 1e-6):
        moved = way.at(progress) - way.first
        assert moved[B] / moved[Z] == pytest.approx(2 / 3, abs=1e-4)


def test_points_that_change_from_one_interval_to_the_other_have_slipped():
    """Two intervals stick, (-0.9, -0.3) and (0.1, 0.9); then one, (-0.4, 0.8). If the left interval has vanished, the
    points between -0.4 and -0.3 were in the inner zone meanwhile, and so were those up to 0.1; if the inner zone has
    closed at -0.5, the points of the left one are left of there."""
    q = parted()[0].start
    begin = Stage(0.0, Zone(-0.9, 0.9), q, Zone(-0.3, 0.1))
    vanished, closed = Stage(0.5, Zone(-0.4, 0.8), q), Stage(0.5, Zone(-0.7, 0.8), q, Zone(-0.5, -0.5))
    assert stuck([begin, vanished]) == (0.1, 0.8)
    assert stuck([begin, closed, Stage(1.0, Zone(-0.6, 0.7), q)]) == (-0.6, -0.5)
    low, high = stuck([begin, vanished, Stage(1.0, Zone(-0.6, 0.05), q)])
    assert low > high


@pytest.mark.slow
@pytest.mark.fault
def test_points_of_a_vanished_interval_that_count_as_stuck_are_seen(monkeypatch):
    """Deliberate fault: what the left interval and the zone after it have in common sticks throughout."""

    def overlap(before, after):
        return common_zones((one, other) for one in before.sticks for other in after.sticks)

    loads = Loads(15.993849408989083, np.pi * 0.40770240756657306)
    before = steady(loads, HertzShape(), parts=False)
    half = HalfCycle(loads, -before.settled, before)
    way = [half.phases[0].at(0.05 * half.phases[0].last.progress), half.phases[0].last]
    assert certify(loads, way).stick < 1e-8
    monkeypatch.setattr(certificates, "lasting", overlap)
    assert certify(loads, way).stick > 1e-4


@pytest.mark.slow
def test_the_inner_zone_closes_when_event_driven_cells_say_so():
    """At (0.85, 9), by cells that are followed event by event and share nothing with the package."""
    half = steady(Loads(9.0, np.pi * 0.85), HertzShape())
    x, q, closes = event_cells.follow(200, 0.85, 9.0)
    assert closes == pytest.approx(half.phases[0].last.progress, abs=2e-2)
    assert np.abs(q - half.last.q(x)).mean() < 5e-3


@pytest.mark.slow
@pytest.mark.fault
def test_a_kink_beside_the_right_end_left_out_is_seen(monkeypatch):
    """Deliberate fault: where a came to rest within 1e-6 of the right end, the state has no kink. The ways of the ends
    from such a state are lost, or points that stick are strained."""
    true = HalfCycle.stuck.fget

    def stuck(self):
        low, high = true(self)
        return low, self.last.zone.right if self.last.zone.right - high < 1e-6 else high

    monkeypatch.setattr(HalfCycle, "stuck", property(stuck))
    try:
        seen = certificate_of(steady(Loads(9.55338, np.pi * 0.53022), HertzShape())).stick
    except LostError:
        seen = np.inf
    assert seen > 1e-8


@pytest.mark.slow
def test_states_are_mixed_where_their_parts_meet_and_between():
    """A state is on the way to itself; half-way between two states that are alike, places at which parts meet are, too,
    and q on the bound stays there. States with other parts are not mixed."""
    one, other = parted()[0].last.q, steady(Loads(7.21, LOADS.shear), HertzShape()).last.q
    x = np.linspace(-1, 1, 801)[1:-1]
    np.testing.assert_allclose(one.toward(one, 0.3)(x), one(x), atol=1e-9)
    half = one.toward(other, 0.5)
    zones = [np.array(each.breaks) for each in (one, half, other)]
    outer = [each[[0, -1]] for each in zones]
    np.testing.assert_allclose(outer[1], (outer[0] + outer[2]) / 2, atol=1e-14)
    assert np.abs(half(x[x > outer[1][1]])) == pytest.approx(np.sqrt(1 - x[x > outer[1][1]] ** 2))
    assert np.abs(half(x) - (one(x) + other(x)) / 2).mean() < 1e-4
    assert one.toward(steady(Loads(7.0, np.pi * 0.55), HertzShape()).last.q, 0.5) is None


@pytest.mark.fault
def test_an_inner_zone_left_out_is_seen():
    """Deliberate fault: at the same stages the stick zone is one."""
    half, phase = parted()
    shares, one = np.linspace(0, 1, 9)[1:], HalfCycle(LOADS, half.start, half, parts=False)
    way = [one.phases[0].first, *(one.at(share * phase.last.progress) for share in shares)]
    assert certify(LOADS, way).bound > 1e-3
