"""Criteria against brute force over all planes, closed forms of simple stresses, and invariances."""

import numpy as np
import pytest
from scipy.optimize import minimize

from partialslip.study.fatigue import (
    crossland,
    dang_van,
    fatemi_socie,
    findley,
    planes,
    principal_range,
    smith_watson_topper,
    with_zz,
)
from partialslip.study.fatigue.criteria import smallest_sphere

E, NU, SIGMA_Y, K, ALPHA = 72.1e9, 0.33, 500e6, 0.7, 0.3
PLANES = {
    "principal": principal_range,
    "swt": lambda stress: smith_watson_topper(stress, E, NU),
    "fatemi-socie": lambda stress: fatemi_socie(stress, E, NU, K, SIGMA_Y),
    "findley": lambda stress: findley(stress, K),
}
INVARIANTS = {"dang van": lambda stress: dang_van(stress, ALPHA), "crossland": lambda stress: crossland(stress, ALPHA)}
ALL = PLANES | INVARIANTS


def value(found):
    return getattr(found, "value", found)


def paths(load_points, count=50, plane="strain"):
    """Random stress paths that bend, and whose means differ from zero."""
    rng = np.random.default_rng(load_points)
    return with_zz(3e8 * rng.normal(size=(load_points, 3, count)) + 1e8 * rng.normal(size=(3, count)), NU, plane)


def tensors(path):
    """The stress path (s, 4) of a point as matrices (s, 3, 3)."""
    xx, yy, xy, zz = path.T
    zero = np.zeros_like(xx)
    return np.moveaxis(np.array([[xx, xy, zero], [xy, yy, zero], [zero, zero, zz]]), 2, 0)


def on_plane(name, sigma, angle, tilt):
    """A criterion on planes, from traction vectors: independent of the formulas of the package."""
    n = np.array([np.cos(tilt) * np.cos(angle), np.cos(tilt) * np.sin(angle), np.sin(tilt) + 0 * angle])
    vectors = np.einsum("sij,j...->si...", sigma, n)
    normal = (vectors * n).sum(axis=1)
    shear = vectors - normal[:, None] * n
    chord = np.sqrt(max_over_pairs(lambda i, j: ((shear[i] - shear[j]) ** 2).sum(axis=0), len(sigma)))
    if name == "principal":
        return np.ptp(normal, axis=0)
    if name == "swt":
        strain = ((1 + NU) * sigma - NU * np.trace(sigma, axis1=1, axis2=2)[:, None, None] * np.eye(3)) / E
        normals = np.einsum("sij,i...,j...->s...", strain, n, n)
        return np.maximum(normal.max(axis=0), 0) * np.ptp(normals, axis=0) / 2
    if name == "fatemi-socie":
        return chord / 2 * 2 * (1 + NU) / E * (1 + K * normal.max(axis=0) / SIGMA_Y)
    return chord / 2 + K * normal.max(axis=0)


def max_over_pairs(function, count):
    return np.max([function(i, j) for i in range(count) for j in range(i)], axis=0)


def brute_force(name, path):
    """The largest value over planes 0.5 degrees apart in the xy plane and 2 degrees across, then by Nelder and Mead."""
    sigma = tensors(path)
    angles, tilts = np.radians(np.arange(0, 180, 0.5)), np.radians(np.arange(0, 91, 2.0))
    values = on_plane(name, sigma, angles[:, None], tilts[None])
    best = np.unravel_index(values.argmax(), values.shape)
    start = np.array([angles[best[0]], tilts[best[1]]])
    size = values.max()
    if size == 0:  # compression on every plane
        return 0.0, 0.0
    polished = minimize(
        lambda at: -float(on_plane(name, sigma, at[0], at[1])) / size, start, method="Nelder-Mead",
        options={"xatol": 1e-9, "fatol": 1e-16, "initial_simplex": start + np.radians([[0, 0], [0.5, 0], [0, 1]])},
    )  # fmt: skip
    return -polished.fun * size, size


@pytest.mark.parametrize("plane", ["strain", "stress"])
@pytest.mark.parametrize("load_points", [2, 5])
@pytest.mark.parametrize("name", PLANES)
def test_the_largest_over_all_planes(name, load_points, plane):
    stress = paths(load_points, 50, plane)
    found = PLANES[name](stress)
    for number in range(stress.shape[2]):
        largest, sampled = brute_force(name, stress[:, :, number])
        assert found.value[number] == pytest.approx(largest, rel=1e-10)
        assert found.value[number] >= sampled * (1 - 1e-12)
        there = on_plane(name, tensors(stress[:, :, number]), found.angle[number], found.tilt[number])
        assert there == pytest.approx(found.value[number], rel=1e-12)  # the plane is the one that is named


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("load_points", [2, 5])
def test_the_unit_of_stress_does_not_matter(name, load_points):
    """Stress criteria scale with the stress. Those with constants of stress take all of them in one unit."""
    stress = paths(load_points)
    megapascals = {
        "swt": lambda stress: smith_watson_topper(stress, E * 1e-6, NU),
        "fatemi-socie": lambda stress: fatemi_socie(stress, E * 1e-6, NU, K, SIGMA_Y * 1e-6),
    }
    size = 1.0 if name == "fatemi-socie" else 1e6
    found = value(megapascals.get(name, ALL[name])(stress * 1e-6)) * size
    assert found == pytest.approx(value(ALL[name](stress)), rel=1e-12)


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("load_points", [2, 5])
def test_neither_mirrors_nor_the_first_load_point_matter(name, load_points):
    stress = paths(load_points)
    for same in (stress * np.array([1, 1, -1, 1])[:, None], np.roll(stress, 2, axis=0)[::-1]):
        assert value(ALL[name](same)) == pytest.approx(value(ALL[name](stress)), rel=1e-12)


@pytest.mark.parametrize("name", ALL)
def test_turned_axes(name):
    """The plane turns with the stress."""
    stress, turn = paths(3), 0.3
    cos, sin = np.cos(turn), np.sin(turn)
    xx, yy, xy, zz = np.moveaxis(stress, 1, 0)
    turned = np.stack([
        xx * cos**2 + yy * sin**2 - 2 * xy * sin * cos, xx * sin**2 + yy * cos**2 + 2 * xy * sin * cos,
        (xx - yy) * sin * cos + xy * (cos**2 - sin**2), zz,
    ], axis=1)  # fmt: skip
    one, other = ALL[name](stress), ALL[name](turned)
    assert value(other) == pytest.approx(value(one), rel=1e-10)
    if name in PLANES:
        settled = value(one) > 0
        assert np.sin(other.angle - one.angle - turn)[settled] == pytest.approx(0.0, abs=1e-5)


def uniaxial(amplitude, mean=0.0):
    """sigma_xx between mean - amplitude and mean + amplitude, plane stress."""
    stress = np.zeros((2, 4))
    stress[:, 0] = mean - amplitude, mean + amplitude
    return stress


def torsion(amplitude):
    stress = np.zeros((2, 4))
    stress[:, 2] = -amplitude, amplitude
    return stress


def test_push_and_pull():
    """Closed forms of the literature: Findley sqrt(sigma_a^2 + k^2 sigma_max^2)/2 + k sigma_max/2."""
    amplitude, mean = 200e6, 50e6
    most, stress = amplitude + mean, uniaxial(amplitude, mean)
    assert principal_range(stress).value == pytest.approx(2 * amplitude, rel=1e-14)
    assert smith_watson_topper(stress, E, NU).value == pytest.approx(most * amplitude / E, rel=1e-13)
    expected = np.sqrt(amplitude**2 + (2 * K * most / 2) ** 2) / 2 + K * most / 2
    assert findley(stress, K).value == pytest.approx(expected, rel=1e-13)
    assert dang_van(stress, ALPHA) == pytest.approx(amplitude / 2 + ALPHA * most / 3, rel=1e-14)
    assert crossland(stress, ALPHA) == pytest.approx(amplitude / np.sqrt(3) + ALPHA * most / 3, rel=1e-14)


def test_torsion():
    """Without k, Fatemi and Socie have the amplitude of the shear strain; Findley tau_a sqrt(1 + k^2)."""
    amplitude, mu = 150e6, E / (2 * (1 + NU))
    stress = torsion(amplitude)
    assert fatemi_socie(stress, E, NU, 0.0, SIGMA_Y).value == pytest.approx(amplitude / mu, rel=1e-13)
    assert findley(stress, K).value == pytest.approx(amplitude * np.sqrt(1 + K**2), rel=1e-13)
    assert principal_range(stress).value == pytest.approx(2 * amplitude, rel=1e-14)
    for found in (dang_van(stress, ALPHA), crossland(stress, ALPHA)):
        assert found == pytest.approx(amplitude, rel=1e-14)  # no hydrostatic stress


def test_planes_across_the_xy_plane_may_be_critical():
    """Equal pressures along x and y in plane strain: no shear in the xy plane, but against z."""
    stress = with_zz(np.array([[[0.0], [0.0], [0.0]], [[-1e8], [-1e8], [0.0]]]), NU)
    found = findley(stress, 0.0)
    assert found.value[0] == pytest.approx(1e8 * (1 - 2 * NU) / 4, rel=1e-12)
    assert found.tilt[0] == pytest.approx(np.pi / 4, abs=1e-6)


@pytest.mark.fault
def test_sampled_planes_alone_are_seen(monkeypatch):
    """Deliberate fault: the largest value over the sampled planes and those beside them, without Newton's method."""
    stress = paths(3, 20)
    right = findley(stress, K).value
    monkeypatch.setattr(planes, "_MOST", 1)
    monkeypatch.setattr(planes, "_newton", lambda f: (0 * f[0, 0], 0 * f[0, 0]))
    off = 1 - findley(stress, K).value / right
    assert off.min() > -1e-12
    assert off.max() > 1e-5


@pytest.mark.fault
def test_planes_across_the_xy_plane_left_out_are_seen(monkeypatch):
    """Deliberate fault: normals in the xy plane only, which miss the shear between x and z under pressure."""
    stress = with_zz(np.array([[[0.0], [0.0], [0.0]], [[-1e8], [-0.8e8], [0.0]]]), NU)
    right = findley(stress, 0.0).value[0]
    whole = planes.stresses_on
    monkeypatch.setattr(planes, "stresses_on", lambda stress, angle, tilt: whole(stress, angle, 0 * tilt))
    assert findley(stress, 0.0).value[0] < 0.8 * right


def test_compression_has_no_swt():
    assert smith_watson_topper(-np.abs(paths(3)) * np.array([1, 1, 0, 1])[:, None], E, NU).value.max() == 0.0


def test_nan_outside_a_body_stays_nan():
    stress = paths(3, 4)
    stress[:, :, 1] = np.nan
    for criterion in ALL.values():
        assert np.isnan(value(criterion(stress))).tolist() == [False, True, False, False]


def test_smallest_spheres_hold_all_points_and_cannot_be_smaller():
    """Points on the sphere have its centre in their convex hull: no way leads nearer to all of them."""
    points = np.random.default_rng(0).normal(size=(3, 9, 200))
    centre, radius = smallest_sphere(points)
    away = points - centre
    distance = np.sqrt((away**2).sum(axis=0))
    assert (distance <= radius * (1 + 1e-10)).all()
    for number in range(200):
        touching = away[:, distance[:, number] > radius[number] * (1 - 1e-9), number]
        ways = np.random.default_rng(number).normal(size=(200, 3))
        assert ((ways @ touching).min(axis=1) <= 1e-9).all()  # each way leads away from one of them


@pytest.mark.parametrize(
    "path", [np.ones((3, 4, 1)), np.zeros((3, 4, 1)), np.tile(np.eye(3)[:, :2], (1, 2))[..., None]]
)
def test_spheres_of_points_that_coincide(path):
    centre, radius = smallest_sphere(path)
    assert radius[0] == pytest.approx(np.ptp(path, axis=1).max() * np.sqrt(0.5), abs=1e-14)
    assert centre[:, 0, 0] == pytest.approx((path.min(axis=1) + path.max(axis=1))[:, 0] / 2, abs=1e-14)
