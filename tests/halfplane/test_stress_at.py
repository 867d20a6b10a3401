"""Stresses of results of the exact method: mean loads, varying pressure, and phases between the load points."""

import math

import numpy as np
import pytest
from reversed_loads import scene as reversed_scene
from varying_scenes import varying

import partialslip
from partialslip import InputError, load_scene
from partialslip.halfplane import states

ALUMINIUM = "fretting-aluminium"
SCENES = {
    "large tension": load_scene("hertz-large-tension"),
    "mean Q": load_scene(ALUMINIUM, ["load.Q=[-1e4, 3e4]", "load.sigma=[0, 2e7]"]),
    "the first loading to point 1": load_scene(ALUMINIUM, ["load.Q=[-3e4, 1e4]", "load.sigma=[0, 2e7]"]),
    "flat": load_scene("flat-rounded", ["load.Q=[-1e4, 3e4]", "load.sigma=[0, 2e7]"]),
    "flat, large tension": reversed_scene(0.4, 3.44, name="flat-rounded"),
    "turns round": reversed_scene(0.55, 7.0, name="hertz-shear", mean=(0.05, 0.5)),
    "a slope": load_scene("hertz-shear", ["load.sigma_slope=[-1e10, 1e10]"]),
    "on the way": load_scene(ALUMINIUM, ["load.Q=[-2e4, 1e4, 2e4]", "load.sigma=[-2e7, 1e7, 2e7]"]),
    "pressed": load_scene("hertz-shear", ["load.Q=[0, 0]"]),
    "free": load_scene("hertz-shear", ["load.Q=[0, 0]", "load.sigma=[1e7, 1e8]", "friction.f=0"]),
    "varying P": varying((0.98, 1.0), 1.08, 0.36, mean=0.85),
    "varying P and M": varying((1.036, 1.0), 0.723, -0.568, e=(0, -0.046), mean=0.1),
    "varying P without shear": varying((1.0, 1.5), 0.0, 0.0),
}
PHASES = np.array([0, 0.1, 0.33, 0.5, 0.5001, 0.8, 1.0])

every_scene = pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)


def solved(scene):
    return partialslip.run(scene, "exact", subsurface=True)["exact"]


def loads_at(scene, phase):
    """(Q, sigma, sigma_slope, P) on straight ways between the load points."""
    points = np.array([(*along, P) for along, (P, _) in zip(scene.load.along, scene.pressing, strict=True)])
    first, second = scene.load.ends
    position = np.interp(phase, [0, 0.5, 1], [first, second, first + len(points)])
    return np.array([np.interp(position, np.arange(len(points) + 1), [*row, row[0]]) for row in points.T])


def sums_of_forces(result, x, y):
    """Stresses (2, 3, k) as sums over forces on the surface, by quadrature of the tractions."""
    share = (1 - np.cos(np.linspace(0, np.pi, 200))) / 2
    breaks = result.traction.breaks
    ends = np.unique(breaks[:-1, None] + np.diff(breaks)[:, None] * share)
    nodes, weights = np.polynomial.legendre.leggauss(16)
    half = np.diff(ends)[:, None] / 2
    t, weights = (ends[:-1, None] + half * (1 + nodes)).ravel(), (half * weights).ravel()
    of = result.traction
    at = of.at(t)
    pressures, shears = at.pressures, at.levels or (0 * t, 0 * t)
    side, r, depth = np.where(y < 0, 1, -1)[:, None], x[:, None] - t, np.abs(y)[:, None]
    found = []
    for p, q in zip(pressures, shears, strict=True):
        radial = 2 / np.pi * (-side * q * r + p * depth) / (r**2 + depth**2) ** 2
        found.append([-(radial * part) @ weights for part in (r**2, depth**2, r * y[:, None])])
    return np.array(found)


@every_scene
def test_stresses_are_those_of_the_tractions(scene):
    result, random = solved(scene), np.random.default_rng(0)
    x, y = random.uniform(-3, 3, 60), random.choice([-1, 1], 60) * random.uniform(0.02, 3, 60)
    x, y = x * result.a, y * result.a
    expected = sums_of_forces(result, x, y)
    for point, of in zip(scene.load.ends, expected, strict=True):
        _, sigma, slope = scene.load.along[point]
        of[0] += np.where(y < 0, sigma + slope * x, 0)
        of[2] -= np.where(y < 0, slope * y, 0)
    assert result.stress_at(x, y) == pytest.approx(expected, rel=0, abs=2e-10 * result.p0)
    assert (result.stress_at(x, y, [0, 0.5]) == result.stress_at(x, y)).all()


@every_scene
def test_a_horizontal_cut_carries_the_loads_at_every_phase(scene):
    result = solved(scene)
    angle = (np.arange(400) + 0.5) / 400 * np.pi - np.pi / 2
    for y in (-4 * result.a, 6 * result.a):
        x, weights = abs(y) * np.tan(angle), np.abs(y) / np.cos(angle) ** 2 * np.pi / 400
        found = result.stress_at(x, 0 * x + y, PHASES)
        for phase, of in zip(PHASES, found, strict=True):
            Q, _, slope, P = loads_at(scene, phase)
            assert of[1] @ weights == pytest.approx(-P, rel=1e-9)
            own = slope * y if y < 0 else 0.0  # of the bulk tension, on the whole line
            assert (of[2] + own) @ weights == pytest.approx(-Q, rel=0, abs=1e-8 * P)
        assert found[-1] == pytest.approx(found[0], rel=0, abs=1e-12 * result.p0)
        far = np.sign(y) * np.array([400 * result.a])
        bulk = result.stress_at(0 * far, far, PHASES)[:, 0, 0]
        assert bulk == pytest.approx([loads_at(scene, phase)[1] * (y < 0) for phase in PHASES], abs=5e-3 * result.p0)


@every_scene
def test_friction_holds_at_every_phase(scene):
    """On the surface: no tension across, |sigma_xy| <= f p, and no relative strain beyond what slips."""
    result, f = solved(scene), scene.friction.f
    x = np.linspace(-1.2, 1.2, 301) * result.a
    for sigma in result.stress_at(x, 0 * x, PHASES):
        p, q = -sigma[1], -sigma[2]
        assert (p >= -1e-11 * result.p0).all()
        # infinitely steep at the ends of stick zones, which are known to rounding
        assert (np.abs(q) <= f * p + 1e-7 * result.p0).all()
    assert result.stress_at(x, 0 * x, 0.25) == pytest.approx(result.stress_at(x, 0 * x, [0.25])[0], rel=0, abs=0)


def test_cattaneo_and_mindlin_along_the_way():
    """On the way from load point 1, dq = 2 f p0 (w(1) - w(c)) with w(c) = sqrt(c^2 - x^2) and c^2 = 1 - share Qf: two
    fields of sliding contacts."""
    scene = load_scene("hertz-shear")
    result, random = solved(scene), np.random.default_rng(1)
    x, y = random.uniform(-2, 2, 300), -random.uniform(0, 2, 300)
    unit, Qf = scene.friction.f * result.p0, 0.6

    def sheared(c):
        """Stresses, in f p0, under q = sqrt(c^2 - x^2) (Johnson, Contact Mechanics, section 7.1)."""
        z = x + 1j * y
        root = np.sqrt(z - c) * np.sqrt(z + c)
        T, T_z = root - z, z / root - 1
        return np.stack([-2 * T.real + y * T_z.imag, -y * T_z.imag, T.imag + y * T_z.real])

    first, *between, second = result.stress_at(x * result.a, y * result.a, [0, 0.1, 0.25, 0.4, 0.5])
    for share, found in zip((0.2, 0.5, 0.8, 1.0), (*between, second), strict=True):
        change = 2 * unit * (sheared(1.0) - sheared(math.sqrt(1 - share * Qf)))
        assert found - first == pytest.approx(change, rel=0, abs=1e-12 * result.p0)


def test_sliding_with_all_friction():
    """|Q| = f P at both load points: q = f p, sigma_xx of Johnson, section 7.1, inside and on the surface."""
    scene = load_scene("hertz-shear")
    P, f = scene.P, scene.friction.f
    result = solved(scene.replace(load={"Q": [-f * P, f * P], "sigma": [1e7, 1e7]}))
    assert result.regime == "sliding"
    random = np.random.default_rng(1)
    x, y = random.uniform(-2, 2, 300), -np.where(np.arange(300) < 100, 0, random.uniform(0, 2, 300))
    z = x + 1j * np.minimum(y, -1e-300)
    root = np.sqrt(z - 1) * np.sqrt(z + 1)
    T, T_z = root - z, z / root - 1
    expected = np.stack([-2 * T.real + y * T_z.imag, -y * T_z.imag, T.imag + y * T_z.real]) * f * result.p0
    one, two = result.stress_at(x * result.a, y * result.a)
    assert (two - one) / 2 == pytest.approx(expected, rel=0, abs=1e-12 * result.p0)
    assert ((two + one) / 2)[0, y == 0] - 1e7 == pytest.approx(
        -result.traction.at(x * result.a).p[y == 0], rel=0, abs=1e-12 * result.p0
    )
    with pytest.raises(InputError, match=r"^phases: 0.3 is between load points 1 and 2, where the contact slides"):
        result.stress_at(0, 0, [0, 0.3])


@pytest.mark.parametrize(
    ("overrides", "why"),
    [
        (["load.sigma_slope=[0, 1e9]", "load.sigma=[-1e8, 2e8]"], "the cycle slips where the first loading sticks"),
        (["load.Q=[-4e5, 4e5]"], "the contact slides"),
    ],
)
def test_not_known_where_the_shear_is_not(overrides, why):
    result = solved(load_scene("hertz-large-tension", overrides))
    assert result.stress_at is None
    assert result.surface is None
    assert why in result.undetermined["stresses"]


def test_phases_without_a_closed_form_are_refused():
    turns = load_scene(ALUMINIUM, ["load.Q=[-2e4, 1e4, 0, 2e4]", "load.sigma=[-2e7, 1e7, 0, 2e7]"])
    with pytest.raises(InputError, match=r"^phases: 0.2 is between load points between which the loads turn; use"):
        solved(turns).stress_at(0, 0, [0, 0.2])
    assert solved(turns).stress_at(0, 0, 0.7).shape == (3,)
    reverses = load_scene("hertz-large-tension", ["load.sigma=[-1e8, 1e8]", "load.Q=[-2e4, 2e4]"])
    result = solved(reverses)
    if result.path_dependent:
        with pytest.raises(InputError, match="slip reverses; use march"):
            result.stress_at(0, 0, 0.2)


@pytest.mark.parametrize("phases", [[-0.1], [0, 1.5], float("nan")])
def test_phases_are_from_0_to_1(phases):
    result = solved(SCENES["pressed"])
    with pytest.raises(InputError, match=r"^phases: .* is not allowed; must be from 0 to 1$"):
        result.stress_at(0, 0, phases)
    with pytest.raises(InputError, match=r"^phases = 'x': must be numbers from 0 to 1$"):
        result.stress_at(0, 0, "x")


def test_points_of_any_shape():
    result = solved(SCENES["mean Q"])
    assert result.stress_at(0.0, -1e-4).shape == (2, 3)
    assert result.stress_at([], []).shape == (2, 3, 0)
    assert result.stress_at([[0.0], [1e-4]], [0.0, -1e-4, 1e-4], PHASES).shape == (7, 3, 2, 3)
    found = result.stress_at([0.0, np.nan, np.inf, 0.0], [0.0, 0.0, 0.0, -np.inf])
    assert np.isfinite(found[..., 0]).all()
    assert np.isnan(found[..., 1:]).all()


@pytest.mark.fault
def test_a_way_back_taken_for_the_way_there_is_caught(monkeypatch):
    """Deliberate fault: slip on the way back adds to q instead of taking it back."""
    true = states._Constant.__call__
    monkeypatch.setattr(states._Constant, "__call__", lambda self, share, **_: true(self, back=False, share=share))
    with pytest.raises(AssertionError):
        test_a_horizontal_cut_carries_the_loads_at_every_phase(SCENES["mean Q"])
