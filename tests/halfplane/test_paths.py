"""Load paths of any kind: many load points, loads out of phase, hundreds of cycles, ratchets."""

import numpy as np
import pytest

import partialslip
from partialslip import halfplane

ROUGH = "fem.accuracy=1e-3"
BASE = partialslip.load_scene("hertz-large-tension")
FP = BASE.friction.f * BASE.P
FP0 = BASE.friction.f * halfplane.contact(BASE).p0
CIRCLE = np.linspace(0, 2 * np.pi, 17)[1:]


def scene(Q, sigma, *overrides):
    """Loads in f P and f p0."""
    Q, sigma = ([float(v) for v in np.array(values) * unit] for values, unit in ((Q, FP), (sigma, FP0)))
    return partialslip.load_scene("hertz-large-tension", [f"load.Q={Q}", f"load.sigma={sigma}", ROUGH, *overrides])


def marched(Q, sigma, *overrides):
    return partialslip.run(scene(Q, sigma, *overrides), ["march"]).results["march"]


def ends(result):
    return result.m / result.a, result.n / result.a


def test_load_points_of_a_cycle():
    load = scene([0.1, 0.5, 0.7, 0.3], [1, 3, 4, 2]).load
    assert load.in_phase
    assert load.ends == (0, 2)
    assert (load.dQ, load.dsigma) == pytest.approx((0.6 * FP, 3 * FP0))
    assert not scene([0.1, 0.5, 0.7, 0.3], [1, 3, 4, 2.1]).load.in_phase
    assert scene([0.2, 0.2, 0.2], [1, 3, 2]).load.in_phase  # Q does not change
    assert partialslip.load_scene("hertz-shear", ["load.Q=[-1e5, 0, 1e5]"]).load.points[0] == (-1e5, 0.0)


def test_points_on_the_way_of_loads_in_phase_do_not_matter():
    """Proportional loading: if slip does not reverse, a path may be cut into pieces. Cells are finer at the ends of the
    pieces' stick zones."""
    two = marched([-0.3, 0.3], [-2, 2])
    many = marched([-0.3, 0, 0.3, 0.1, 0], [-2, 0, 2, 2 / 3, 0], "load.cycles=2")
    known = sum(max(each.estimate["m"], each.estimate["n"]) for each in (two, many))
    assert ends(many) == pytest.approx(ends(two), abs=known)
    assert many.slip.dissipated == pytest.approx(two.slip.dissipated, rel=1e-3)
    outcome = partialslip.run(scene([-0.3, 0, 0.3, 0], [-2, 0, 2, 0]), ["exact", "march"])
    assert outcome.passed
    assert outcome.results["exact"].regime == "large tension"


@pytest.mark.slow
def test_loads_out_of_phase():
    """Both step-by-step methods find one answer: the part that never slips, the tractions' range, the energy."""
    way = 0.5 * np.cos(CIRCLE), 3 * np.sin(CIRCLE)
    outcome = partialslip.run(scene(*way, "load.cycles=3", "fem.accuracy=1e-4"))
    march, fem = (outcome.results[name] for name in ("march", "fem"))
    assert outcome.reference == "march"
    assert (march.regime, fem.regime) == ("out of phase", "out of phase")
    assert ends(march) == pytest.approx(ends(fem), abs=1e-4)
    assert outcome.comparisons["fem"].q < 1e-3
    assert march.slip.dissipated == pytest.approx(fem.slip.dissipated, rel=3e-4)
    assert (march.traction.q1 <= march.traction.q2).all()


def test_out_of_phase_tends_to_in_phase():
    """A narrow ellipse in the plane of Q and sigma is nearly a line, and dissipates nearly the energy of the line."""
    way = np.cos(CIRCLE)
    line = marched(0.3 * way, 2 * way, "load.cycles=2")
    ellipse = marched(0.3 * way, 2 * np.cos(CIRCLE + 1e-3), "load.cycles=2")
    assert (line.regime, ellipse.regime) == ("large tension", "out of phase")
    assert ends(ellipse) == pytest.approx(ends(line), abs=3e-3)
    assert ellipse.slip.dissipated == pytest.approx(line.slip.dissipated, rel=3e-3)


def test_the_exact_method_says_that_it_has_no_closed_form():
    with pytest.raises(partialslip.InputError, match=r"load\.sigma: out of phase with load\.Q"):
        partialslip.run(scene([0.3, 0, -0.3], [1, 2, 1]), ["exact"])


@pytest.mark.slow
def test_a_hundred_cycles_all_certified():
    """Q 0.1 .. 0.7 f P and sigma 1 .. 5 f p0: every leg has its certificate, and q changes ever less."""
    result = marched([0.1, 0.7], [1, 5], "load.cycles=100")
    assert 10 < result.counts["cycles"] <= 100
    assert result.counts["events"] > 0  # slip turns round
    assert result.certificate["kkt"] < 1e-11
    assert result.certificate["equilibrium"] < 1e-12  # rounding of a sum over hundreds of cells
    assert result.last_cycle_change < 1e-6
    assert result.regime == "large tension"


def test_a_cycle_of_nothing_dissipates_nothing():
    still = marched([0.3, 0.3], [1, 1])
    assert still.regime == "stuck"
    assert still.slip.dissipated == pytest.approx(0, abs=1e-12)
