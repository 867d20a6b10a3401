"""Asymptotes at the ends of the contact against closed forms, and the slip zones that they predict."""

import numpy as np
import pytest

import partialslip
from partialslip.study.fatigue import edges
from partialslip.study.fatigue.tables import edge_table, edge_units

SHEAR = "hertz-shear"


def solved(name, *overrides, method="exact"):
    scene = partialslip.load_scene(name, overrides)
    return scene, partialslip.run(scene, method)[method]


@pytest.mark.parametrize("side", [0, 1])
def test_hertz(side):
    """K_N = p0 sqrt(2/a), K_T = (dQ/pi +- a dsigma/4)/sqrt(2 a), and f p - |dq|/2 = f sqrt((x + m)(n - x))/(A R)."""
    scene, result = solved("hertz-small-tension")
    a, way, f = result.a, (-1, 1)[side], scene.friction.f
    edge = edges(scene, result)[side]
    assert edge.K_N.value == pytest.approx(result.p0 * np.sqrt(2 / a), rel=1e-10)
    K_T = (scene.load.dQ / np.pi + way * a * scene.load.dsigma / 4) / np.sqrt(2 * a)
    assert edge.K_T.value == pytest.approx(K_T, rel=1e-14)
    stick = f * result.p0 / a * np.sqrt(result.m + result.n)
    assert edge.K_S.value == pytest.approx(stick, rel=1e-9)
    for coefficient in (edge.K_N, edge.K_S):
        assert coefficient.error < 1e-7 * coefficient.value


@pytest.mark.parametrize(("method", "bar"), [("march", 2e-2), ("fem", 2e-2), ("exact", 1e-9)])
def test_every_method(method, bar):
    """The estimate tells the error."""
    scene, result = solved("hertz-small-tension", "fem.accuracy=1e-4", method=method)
    true = edges(*solved("hertz-small-tension"))
    for edge, known in zip(edges(scene, result), true, strict=True):
        for found, closed in ((edge.K_N, known.K_N), (edge.K_T, known.K_T), (edge.K_S, known.K_S)):
            off = abs(found.value - closed.value)
            assert off < bar * closed.value
            assert off <= found.error + 1e-9 * closed.value


def test_the_adhered_solution_gives_K_T():
    """Of a contact with so much friction that next to nothing slips. A slip zone c changes K_T by about c/a."""
    scene, result = solved("hertz-small-tension")
    rough, adhered = solved("hertz-small-tension", "friction.f=1000")
    for edge, closed in zip(edges(scene, result, adhered), edges(scene, result), strict=True):
        slip = (2 * adhered.a - adhered.m - adhered.n) / adhered.a
        assert edge.K_T.value == pytest.approx(closed.K_T.value, rel=2 * slip)
        assert slip < 5e-4
    assert edges(rough, adhered)[1].predicted < 1e-3 * result.a


def test_small_slip_zones_are_predicted():
    """Cattaneo: 1 - c/a = 1 - sqrt(1 - Q/(f P)) = Q/(2 f P) + Q^2/(8 (f P)^2) + ...: off by a quarter of itself."""
    for share in (0.01, 0.02, 0.04):
        scene = partialslip.load_scene(SHEAR)
        Q = share * scene.friction.f * scene.P
        scene = scene.replace(load={"Q": [-Q, Q]})
        result = partialslip.run(scene, "exact")["exact"]
        for edge in edges(scene, result):
            assert edge.predicted == pytest.approx(share / 2 * result.a, rel=1e-9)
            assert edge.found / edge.predicted - 1 == pytest.approx(share / 4, rel=0.05)


def test_tension_along_x():
    """K_T of a tension that varies along x, by the adhered solution: friction of 1000."""
    scene, result = solved(SHEAR, "load.sigma_slope=[-1e11,1e11]", "friction.f=1000")
    slip = (2 * result.a - result.m - result.n) / result.a
    for edge, other in zip(edges(scene, result, result), edges(scene, result), strict=True):
        assert edge.K_T.value == pytest.approx(other.K_T.value, rel=2 * slip)
        assert slip < 1e-3


def test_varying_pressure_has_no_single_end():
    scene = partialslip.load_scene(SHEAR, ["load.Q=[-1e5,1e5]", "fem.accuracy=1e-2"]).replace(
        load={"P": [6e5, 7e5], "p0": None}
    )
    assert edges(scene, partialslip.run(scene, "march")["march"]) == ()


def test_coefficients_are_told_in_the_units_of_the_scene():
    """In N, mm and MPa a stress over the root of a length is 10^7.5 times smaller, times the root 10^4.5; SI has
    prefixes."""
    si, mm = (partialslip.assess(partialslip.load_scene(SHEAR, [f"shown_in='{name}'"])) for name in ("SI", "N-mm"))
    (head, (row, *_)), (_, (in_MPa, *_)) = map(edge_table, (si, mm))
    assert head == ["end", "K_N", "K_T", "predicted slip/a", "slip/a", "K_S"]
    assert edge_units(si) == "K_N and K_S in GPa/m^0.5, K_T in MPa m^0.5"
    for place, power in ((1, -1.5), (2, -1.5), (5, -1.5)):
        assert float(row[place]) / float(in_MPa[place]) == pytest.approx(10**power, rel=1e-5)
    assert edge_units(mm) == "K_N and K_S in MPa/mm^0.5, K_T in MPa mm^0.5"
