"""Deliberate faults: each is a mistake that contact codes have made, and a full run must turn red because of it.

``compare`` against the exact solution is the check; the same run without the fault passes. Faults that a single
function's own tests must catch stand beside those tests.
"""

from dataclasses import replace

import numpy as np
import pytest

import partialslip
from partialslip.condensed import friction
from partialslip.condensed.friction import march as true_march
from partialslip.halfplane import traction as exact_traction
from partialslip_fem import adapt, level
from partialslip_fem.farfield import FarField
from partialslip_fem.farfield import half_plane as true_half_plane

ACCURACY = "fem.accuracy=1e-3"


def outcome(name="hertz-large-tension", *overrides):
    return partialslip.run(partialslip.load_scene(name, [ACCURACY, *overrides])).comparisons["fem"]


def missed(comparison):
    return {what.split(":")[0] for what in comparison.missed}


def test_without_a_fault_everything_passes():
    assert outcome().passed


def march_with(change):
    """A march along a path whose load points have been changed."""
    return lambda C, x, bound, path: true_march(
        C, x, bound, replace(path, cycle=tuple(change(Q, strain) for Q, strain in path.cycle))
    )


def test_tension_of_the_wrong_sign(monkeypatch):
    monkeypatch.setattr(level, "march", march_with(lambda Q, strain: (Q, -strain)))
    assert {"m", "n", "q"} <= missed(outcome())


def test_tension_left_out(monkeypatch):
    monkeypatch.setattr(level, "march", march_with(lambda Q, _: (Q, 0.0)))
    assert {"m", "n", "q", "regime"} <= missed(outcome())


def test_friction_silently_smaller(monkeypatch):
    monkeypatch.setattr(level, "march", lambda C, x, bound, path: true_march(C, x, 0.9 * bound, path))
    assert "q" in missed(outcome())


def test_history_not_committed_between_steps(monkeypatch):
    """Every step starts from nothing: reversed proportional loads cannot tell, a mean load does."""

    def forgetful(C, x, bound, path):
        alone = [true_march(C, x, bound, replace(path, cycle=(load,), ends=(0, 0), cycles=1)) for load in path.cycle]
        first, second = (alone[end].q2 for end in path.ends)
        return replace(true_march(C, x, bound, path), q1=first, q2=second)

    mean = ["load.Q=[31415.9, 219911.5]", "load.sigma=[2e8, 1e9]", "load.cycles=12"]
    assert outcome("hertz-large-tension", *mean).passed
    monkeypatch.setattr(level, "march", forgetful)
    assert {"m", "n", "q"} & missed(outcome("hertz-large-tension", *mean))


def test_normal_compliance_used_for_shear(monkeypatch):
    true = level.relative_compliances
    monkeypatch.setattr(level, "relative_compliances", lambda *args: replace(C := true(*args), xx=1.05 * C.yy))
    assert missed(outcome())


def test_one_body_rigid(monkeypatch):
    """Half the compliance: the contact of one elastic body with a rigid one."""
    true = level.relative_compliances
    monkeypatch.setattr(
        level, "relative_compliances", lambda *args: replace(C := true(*args), xx=C.xx / 2, yy=C.yy / 2)
    )
    assert {"a", "p"} <= missed(outcome())


@pytest.mark.parametrize("lost", ["all but the resultant", "shear's"])
def test_far_field_without_its_dipole(monkeypatch, lost):
    def truncated(*args):
        far = true_half_plane(*args)
        moments = far.moments.copy()
        count = len(moments) // 2
        moments[1 : count if lost == "shear's" else None] = 0
        if lost != "shear's":
            moments[count] = far.moments[count]
        return FarField(far.fields, moments)

    assert outcome("hertz-large-tension", "fem.width=8").passed
    monkeypatch.setattr(level, "half_plane", truncated)
    assert missed(outcome("hertz-large-tension", "fem.width=8"))


def test_contact_points_beyond_a_hidden_gap_dropped(monkeypatch):
    """A cut-off on the initial gap: points that would have touched are never asked."""
    true = level.press

    def cut_off(normal, gap, P):
        candidates = np.flatnonzero(gap < 0.7 * gap.max())
        solution = true(normal[np.ix_(candidates, candidates)], gap[candidates], P)
        x = np.zeros(len(gap))
        x[candidates] = solution.x
        missing = (0, len(gap) - len(candidates))
        return replace(solution, x=x, residual=np.pad(solution.residual, missing))

    monkeypatch.setattr(level, "press", cut_off)
    monkeypatch.setattr(adapt, "_FINEST", 1e-2)
    assert {"a", "p"} <= missed(outcome("hertz-shear"))


def test_stick_that_is_a_stiff_spring(monkeypatch):
    """Penalty: what sticks creeps in proportion to its traction, here by about a hundredth of the slip."""

    def springs(C, x, bound, path):
        return true_march(C + 0.01 * np.diag(1 / bound), x, bound, path)

    monkeypatch.setattr(level, "march", springs)
    assert {"m", "n", "q"} & missed(outcome())


def test_sign_of_x_instead_of_the_slip_zones(monkeypatch):
    """The exact side can be wrong too: sgn(x) breaks down where the stick zone lies beside the middle."""
    true = exact_traction.half_range

    def by_x(x, zone, shape):
        slips = (x < zone.centre - zone.half_width) | (x > zone.centre + zone.half_width)
        return np.where(slips, np.sign(x) * np.abs(true(x, zone, shape)), true(x, zone, shape))

    from partialslip.halfplane import method

    beside = "load.sigma=[-1e9, 1e9]"  # the stick zone ends at n < 0
    assert outcome("hertz-large-tension", beside).passed
    monkeypatch.setattr(method, "half_range", by_x)
    assert "q" in missed(outcome("hertz-large-tension", beside))


def test_faults_touch_what_is_used():
    """The names patched above are the ones the model calls."""
    assert level.march is friction.march
    assert level.half_plane is true_half_plane
