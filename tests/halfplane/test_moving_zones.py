"""Stick zones that move along the contact while the loads change, by march and by finite elements at their default
settings, beside the exact steady state."""

import numpy as np
import pytest
import reversed_loads

from partialslip import halfplane, load_scene, run
from partialslip.halfplane.gradual_path.half_cycle import steady
from partialslip.halfplane.gradual_path.stage import Loads
from partialslip.halfplane.hertz import HertzShape

SHEAR = load_scene("hertz-shear")
P0 = halfplane.contact(SHEAR).p0
DRIFTS = [
    (0.55, 7.0),
    *(pytest.param(*loads, marks=pytest.mark.slow) for loads in ((0.6, 7.0), (0.6434668934976868, 8.670889385947003))),
]
# with an inner slip zone: m and n by event-driven boundary elements of 400 and 800 cells, and what they are known to
INNER = {(0.85, 9.0): (0.963682, 0.535761, 5e-6), (0.9975, 7.2): (0.758333, 0.697968, 5e-6)}


def solved(Qf, sf, method, *settings):
    return run(reversed_loads.scene(Qf, sf, *settings, name="hertz-shear"), [method]).results[method]


def error_of_q(found, q):
    """Relative L2 error of the means over the cells of a result."""
    nodes, weights = np.polynomial.legendre.leggauss(8)
    places = found.traction.cells / found.a
    places = np.concatenate([[-1], places[np.abs(places) < 1], [1]])
    widths = np.diff(places)
    x = (places[1:] + places[:-1])[:, None] / 2 + widths[:, None] / 2 * nodes
    dq = found.traction.at(x.ravel() * found.a).dq / (2 * SHEAR.friction.f * found.p0)
    own, true = (values.reshape(x.shape) @ weights / 2 for values in (dq, q(x.ravel())))
    return np.sqrt((own - true) ** 2 @ widths / (true**2 @ widths))


@pytest.mark.parametrize("method", ["march", "fem"])
@pytest.mark.parametrize(("Qf", "sf"), DRIFTS)
def test_drift(Qf, sf, method):
    """Ends and q within twice their estimates; one step from load point to load point is off by 1e-2 a."""
    found, exact = solved(Qf, sf, method, "fem.accuracy=1e-4"), steady(Loads(sf, np.pi * Qf), HertzShape()).last
    for key, end in (("m", -exact.zone.left), ("n", exact.zone.right)):
        assert abs(getattr(found, key) / found.a - end) <= 2 * found.estimate[key]
    assert error_of_q(found, exact.q) <= 2 * found.estimate["q"]
    assert found.counts["events"] > 0


@pytest.mark.parametrize(("Qf", "sf", "method"), [
    pytest.param(0.85, 9.0, "march", marks=pytest.mark.slow),
    (0.85, 9.0, "fem"),
    (0.9975, 7.2, "march"),
    (0.9975, 7.2, "fem"),
])  # fmt: skip
def test_inner_slip_zone(Qf, sf, method):
    m, n, known = INNER[Qf, sf]
    found = solved(Qf, sf, method, "fem.accuracy=1e-3")
    assert abs(found.m / found.a - m) <= 2 * found.estimate["m"] + known
    assert abs(found.n / found.a + n) <= 2 * found.estimate["n"] + known
    assert max(found.estimate["m"], found.estimate["n"]) < 5e-3


# the left end has just begun to take points back when the leg ends: by finite elements it shows at two nodes
TAKES_BACK = 0.55, 4.4


def off_where_points_are_taken_back():
    found, true = solved(*TAKES_BACK, "fem", "fem.accuracy=1e-4"), steady(loads(*TAKES_BACK), HertzShape()).last.zone
    return max(abs(found.m / found.a + true.left), abs(found.n / found.a - true.right))


def loads(Qf, sf):
    return Loads(sf, np.pi * Qf)


@pytest.mark.slow
def test_two_nodes_beside_the_stick_zone_tell_that_its_end_takes_points_back():
    assert off_where_points_are_taken_back() < 1e-4


@pytest.mark.fault
def test_a_few_nodes_anywhere_taken_for_the_noise_of_elements_would_be_seen(monkeypatch):
    """As it was: one step, and m 1.5e-3 a off while its estimate said 2e-5."""
    monkeypatch.setattr("partialslip.friction.coulomb_constant_pressure._SLIGHT", np.inf)
    assert off_where_points_are_taken_back() > 1e-3
