"""The finite-element method on scenes: what must hold whatever the mesh, on coarse ones."""

import numpy as np
import pytest

from partialslip import load_scene, plan
from partialslip.run.judge import cell_means
from partialslip_fem import solve

COARSE, FINE = "fem.accuracy=1e-2", "fem.accuracy=1e-3"


def fem(name, *overrides, subsurface=False):
    scene = load_scene(name, [COARSE, *overrides])
    return solve(scene, plan(scene, subsurface=subsurface))


@pytest.fixture(scope="module")
def large():
    return fem("hertz-large-tension")


def test_equilibrium(large):
    scene = load_scene("hertz-large-tension")
    traction = large.traction
    p, dq = (means @ np.diff(traction.cells) for means in cell_means(traction, traction.cells))
    assert p == pytest.approx(scene.P, rel=1e-10)
    assert dq == pytest.approx(scene.load.dQ, rel=1e-10)
    assert max(large.certificate.values()) < 1e-10


def test_reversed_loads_reverse_the_traction():
    large = fem("hertz-large-tension", "effects.history=true")
    assert large.traction.q1 == pytest.approx(-large.traction.q2, abs=1e-9 * large.p0)
    assert large.last_cycle_change < 1e-9


def test_plane_stress_is_plane_strain_of_another_material():
    """E, nu in plane stress act like E (1+2nu)/(1+nu)^2, nu/(1+nu) in plane strain."""
    stress = fem("fretting-aluminium", "material.plane=stress")
    E, nu = 72.1e9, 0.33
    strain = fem("fretting-aluminium", f"material.E={E * (1 + 2 * nu) / (1 + nu) ** 2}", f"material.nu={nu / (1 + nu)}")
    assert (stress.a, stress.m, stress.n) == pytest.approx((strain.a, strain.m, strain.n), rel=1e-7)


def test_frictionless_scene_solves_no_friction():
    result = fem("hertz-shear", "load.Q=[0, 0]")
    assert result.regime == "stuck"
    assert result.counts["load_steps"] == 0
    assert result.last_cycle_change is None
    assert not result.traction.dq.any()
    assert (result.m, result.n) == pytest.approx((result.a, result.a))


@pytest.mark.parametrize("overrides", [["load.Q=[-4e5, 4e5]"], ["friction.f=0"], ["load.Q=[1e5, 3.2e5]"]])
def test_sliding_is_said(overrides):
    result = fem("hertz-large-tension", *overrides)
    assert result.regime == "sliding"
    assert result.m is None
    assert "slides" in result.notes[0]


def test_static_mean_load_sticks():
    result = fem("hertz-shear", "load.Q=[1e5, 1e5]")
    assert result.regime == "stuck"
    assert result.traction.q2.max() > 0


@pytest.mark.slow
def test_mean_loads_reach_the_steady_range_cycle_by_cycle():
    """Tractions change from cycle to cycle, ever less; the ends of the stick zone are those of the reversed loads of
    the same changes from the second cycle on (tests/march/test_marching.py)."""
    overrides = ["load.Q=[31415.9, 219911.5]", "load.sigma=[2e8, 1e9]"]  # 0.1 .. 0.7 fP, 1 .. 5 f p0
    exact_m, exact_n = 0.749058362969, 0.370590356334  # dQ/(2fP) = 0.3, dsigma/(f p0) = 4
    steady, off = [], []
    for cycles in (1, 2, 8):
        result = fem("hertz-large-tension", FINE, *overrides, f"load.cycles={cycles}")
        steady.append(result.last_cycle_change)
        assert any("not steady" in note for note in result.notes) == (steady[-1] > 1e-3)
        off.append(max(abs(result.m / result.a - exact_m), abs(result.n / result.a - exact_n)))
    assert steady[0] > 10 * 1e-3 > steady[2]
    assert max(off[1:]) < min(1e-3, off[0]), off


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.49, 0.4999])
def test_no_locking(nu):
    result = fem("hertz-small-tension", FINE, f"material.nu={nu}", "load.sigma=[0, 0]")
    scene = load_scene("hertz-small-tension", [f"material.nu={nu}", "load.sigma=[0, 0]"])
    a = np.sqrt(2 * scene.material.A * scene.profile.R * scene.P / np.pi)
    half_width = np.sqrt(1 - scene.load.dQ / (2 * scene.friction.f * scene.P))
    assert result.a == pytest.approx(a, rel=2e-3)
    assert result.m / result.a == pytest.approx(half_width, abs=2e-3)


@pytest.mark.slow
def test_tiny_stick_zone_is_reported_not_failed():
    result = fem("hertz-large-tension", FINE, "load.sigma=[-4e10, 4e10]")  # 1.5e-36 a
    assert result.regime == "large tension"
    assert result.stick_half_width < 1e-2 * result.a
    assert result.stick_centre / result.a == pytest.approx(-0.319691, abs=1e-2)


def test_displacements_meet_where_the_bodies_stick():
    """Of both bodies, solved back: what sticks moves together, and the surfaces follow the gap where they touch."""
    result = fem("hertz-small-tension", FINE, subsurface=True)
    scene = load_scene("hertz-small-tension")
    lower, upper = result.bodies
    x = lower.points[:, 0]
    on_line = np.abs(lower.points[:, 1]) < 1e-15
    sticks = on_line & (x > -0.95 * result.m) & (x < 0.9 * result.n)
    touches = on_line & (np.abs(x) < 0.98 * result.a)
    first, second = ({b.name: b.displacements[f"displacement_{k}"] for b in (lower, upper)} for k in (1, 2))
    slid = [(u["lower"] - u["upper"])[sticks, 0] for u in (first, second)]
    scale = scene.material.A * scene.friction.f * result.p0 * result.a
    change = slid[1] - slid[0]
    assert np.ptp(change) < 1e-3 * scale  # no slip between load points 1 and 2
    closed = (upper.displacements["displacement_2"] - lower.displacements["displacement_2"])[:, 1]
    gap = scene.profile.gap_at(x) + closed
    assert np.ptp(gap[touches]) < 1e-3 * scale
