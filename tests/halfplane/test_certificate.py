"""The certificate of the steady state under gradual loads, and what it must see."""

import numpy as np
import pytest

from partialslip.halfplane.gradual_path.certificate import certificate_of, certify, stages
from partialslip.halfplane.gradual_path.drift import Drift
from partialslip.halfplane.gradual_path.half_cycle import HalfCycle, steady
from partialslip.halfplane.gradual_path.phases import Retreating
from partialslip.halfplane.gradual_path.stage import Loads, LostError
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.punch import Punch

HELD = 1e-9  # f p0


def cycle(Qf, sf, shape=None):
    return steady(Loads(sf, np.pi * Qf), shape or HertzShape())


@pytest.mark.parametrize(
    ("Qf", "sf"),
    [
        (0.55, 7.0),
        (0.75, 6.0),
        pytest.param(0.6434668934976868, 8.670889385947003, marks=pytest.mark.slow),
        (0.9975, 7.2),
        # with an inner slip zone:
        (0.9, 9.0),  # b turns round shortly before the left interval vanishes
        (0.53022, 9.55338),  # a moves by 1e-6 only, before the inner zone closes
        pytest.param(0.9, 14.0, marks=pytest.mark.slow),  # on its way back b passes where it began
        pytest.param(0.85, 9.0, marks=pytest.mark.slow),  # half cycles tend slowly to the steady one
        pytest.param(0.47450296749, 19.4127801131, marks=pytest.mark.slow),  # breaks two widths of the drift before
        pytest.param(0.3827638404516185, 16.617226290315028, marks=pytest.mark.slow),  # no point sticks throughout
        pytest.param(0.75640025965298385, 11.57815391228589, marks=pytest.mark.slow),  # the same, from mixed states
        pytest.param(0.40770240756657306, 15.993849408989083, marks=pytest.mark.slow),  # half cycles grew
    ],
)
def test_all_conditions_hold(Qf, sf):
    assert certificate_of(cycle(Qf, sf)).worst < HELD


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
def test_all_conditions_hold_under_random_loads(seed):
    """With or without a zone inside that slips; two states each."""
    rng, judged = np.random.default_rng([37, seed]), 0
    while judged < 2:
        try:
            found = cycle(rng.uniform(0.4, 0.99), rng.uniform(7, 15))
        except LostError:
            continue
        assert certificate_of(found).worst < 1e-7
        judged += 1


@pytest.mark.slow
@pytest.mark.fault
def test_a_zone_inside_left_out_is_seen():
    """The steady state at (0.9, 14) without the zone inside that slips for a while is the same at its end, and violates
    the bound on the way, by a quarter of f p0."""
    found = cycle(0.8989503087286937, 14.038013448105065)
    one = HalfCycle(found.loads, found.start, found, parts=False)
    assert certificate_of(found).worst < 1e-8
    assert certificate_of(one).bound > 0.1
    assert certificate_of(one).steady < 1e-8


def test_all_conditions_hold_under_a_flat_rounded_punch():
    assert certificate_of(cycle(0.55, 7.0, Punch(0.4))).worst < HELD


@pytest.mark.fault
def test_a_kernel_of_drift_off_by_a_percent_is_seen(monkeypatch):
    found, right = cycle(0.55, 7.0), Drift.accumulated
    monkeypatch.setattr(Drift, "accumulated", lambda self, place, tau: 1.01 * right(self, place, tau))
    seen = certificate_of(HalfCycle(found.loads, found.start, found))
    assert seen.stick > 1e-5
    assert seen.equilibrium > 1e-5


@pytest.mark.fault
def test_a_drifting_zone_a_percent_too_wide_is_seen(monkeypatch):
    right = Loads.least.fget
    monkeypatch.setattr(Loads, "least", property(lambda self: 1.01 * right(self)))
    assert certificate_of(cycle(0.55, 7.0)).worst > 1e-5


@pytest.mark.fault
def test_slip_of_the_wrong_sign_in_retreat_is_seen():
    found = cycle(0.55, 7.0)
    first, last = found.phases[0].first, found.phases[0].last
    wrong = Retreating(found.loads, first, 1, last.progress, last.zone)
    assert certify(found.loads, [first, last]).slip < HELD
    assert certify(found.loads, [first, wrong.last]).slip > 1e-3


@pytest.mark.fault
def test_half_a_cycle_that_is_not_steady_is_seen():
    found = cycle(0.55, 7.0)
    path = stages(found)
    first = HalfCycle(found.loads, -path[-2].q, found)
    assert certificate_of(first).steady > 1e-5


@pytest.mark.fault
def test_stages_that_leave_one_out_of_the_way_are_seen():
    """From the first stage to the last in one step, points slip there and back: no such step is admissible."""
    found = cycle(0.55, 7.0)
    path = stages(found)
    assert certify(found.loads, [path[0], path[-1]]).worst > 1e-5
