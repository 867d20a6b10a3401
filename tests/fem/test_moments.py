"""Bodies that turn: moments and profiles that are not even, by finite elements against the exact solution."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from msgspec import to_builtins
from plain import plain

from partialslip import parse_scene, run
from partialslip_fem import goals
from partialslip_fem import method as fem_method

TABLE = np.linspace(-2e-3, 2.5e-3, 91)
SIDES = np.where(TABLE < 0, TABLE**2 / 0.02, TABLE**2 / 0.04 + np.maximum(TABLE, 0) ** 4 * 3e4)


def scene(kind="table", tilt="free", **load):
    profiles = {
        "table": {"kind": "tabulated", "x": TABLE, "gap": SIDES, "tilt": tilt},
        "flat": {"kind": "flat-rounded", "R": 0.01, "b": 1e-3},
        "hertz": {"kind": "hertz", "R": 0.01},
    }
    load = {"P": 1e5, "Q": [-1e4, 1e4], "sigma": [-3e7, 3e7], **load}
    return plain(load, profile=profiles[kind], fem={"accuracy": 1e-3})


@pytest.mark.parametrize("given", [
    pytest.param(scene(), id="uneven gap"),
    pytest.param(scene("flat", e=6e-4), id="flat on one corner", marks=pytest.mark.slow),
    pytest.param(scene(tilt="fixed", sigma=[-1e8, 1e8]), id="fixed tilt", marks=pytest.mark.slow),
    pytest.param(scene("hertz", M=-30.0), id="far from x = 0", marks=pytest.mark.slow),
])  # fmt: skip
def test_finite_elements_agree(given):
    outcome = run(given, ["exact", "fem"], subsurface=given.M == 0)
    assert outcome.passed, outcome.missed
    fem, exact = outcome.results["fem"], outcome.results["exact"]
    for key, error in outcome.comparisons["fem"].errors.items():
        if key in fem.estimate:
            assert error <= 2 * fem.estimate[key], key  # estimates are right within a factor of two
    assert fem.certificate["equilibrium"] < 1e-12
    assert outcome.plan.needs("moment") == (given.M is not None)
    assert fem.ends[1] == pytest.approx(exact.ends[1], abs=1e-3 * exact.a)


@pytest.mark.slow
def test_mirrored_bodies_have_mirrored_results():
    given = scene()
    mirrored = parse_scene({
        **to_builtins(given),
        "profile": {"kind": "tabulated", "x": -TABLE[::-1], "gap": SIDES[::-1]},
        "load": {"P": 1e5, "Q": [1e4, -1e4], "sigma": [-3e7, 3e7]},
    })  # fmt: skip
    one, other = (run(each, ["fem"]).results["fem"] for each in (given, mirrored))
    assert (one.m, one.n) == pytest.approx((other.n, other.m), abs=1e-4 * one.a)


@pytest.mark.fault
def test_bodies_that_do_not_turn_would_be_seen(monkeypatch):
    scaled = fem_method.scaled
    monkeypatch.setattr(fem_method, "scaled", lambda *args: replace(scaled(*args), turns=False))
    outcome = run(parse_scene(to_builtins(scene()) | {"fem": {"size": 0.1}}), ["exact", "fem"])
    assert outcome.comparisons["fem"].errors["M"] > 1e-2


@pytest.mark.slow
@pytest.mark.parametrize("M", [(1000.0, -1000.0), (0.0, 300.0)])
def test_contacts_that_a_moment_moves_by_many_half_widths(M):
    """The blocks reach beyond the whole way of the contact, not only beyond 16 of its half-widths."""
    flat, how = {"kind": "flat-rounded", "R": 0.01, "b": 2e-3}, {"fem": {"accuracy": 1e-2}}
    given = plain({"P": 1e5, "M": M}, 0.5, (70e9, 0.3), flat, effects={"friction": False}, **how)
    fem = run(given, ["fem"]).results["fem"]
    # far from the flat the bodies turn until the contact is that of a cylinder, about the line of action of P
    a = np.sqrt(2 / np.pi * given.material.A * 0.01 * 1e5)
    far = [(ends, moment) for ends, moment in zip(fem.contact_ends, M, strict=True) if abs(moment) > 1e5 * (2e-3 + a)]
    assert far
    for ends, moment in far:
        assert np.array(ends) == pytest.approx(moment / 1e5 + np.array([-a, a]), abs=1e-2 * a)
    assert fem.certificate["equilibrium"] < 1e-12


def test_a_stick_zone_of_one_point_has_gaps_to_divide_by():
    """A contact that moves by more than its width may stick at one node only."""
    ends = SimpleNamespace(zone_ends=np.array([-1.0, 1.0, 0.5, 0.5]), stick=True, half_width=1.0, turning=())
    found = goals.gaps(ends, SimpleNamespace(kinks=(), sharp_kinks=lambda _: ()))
    with np.errstate(over="raise", divide="raise"):
        assert (1e5 / found[0, 2:] > 1).all()
    assert found[:, :2] == pytest.approx(np.array([[np.inf, np.inf], [1.5, 0.5]]))
