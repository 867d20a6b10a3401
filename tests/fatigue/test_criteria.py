"""Criteria against brute force over all planes, closed forms of simple stresses, and invariances."""

import numpy as np
import pytest
from scipy.optimize import minimize

from partialslip.fatigue import (
    crossland,
    dang_van,
    fatemi_socie,
    findley,
    principal_range,
    smith_watson_topper,
    with_zz,
)
from partialslip.fatigue.invariants import smallest_sphere

E, NU, SIGMA_Y, K, ALPHA = 72.1e9, 0.33, 500e6, 0.7, 0.3
PLANES = {
    "principal": principal_range,
    "swt": lambda stress: smith_watson_topper(stress, E, NU),
    "fatemi-socie": lambda stress: fatemi_socie(stress, E, NU, K, SIGMA_Y),
    "findley": lambda stress: findley(stress, K),
}
INVARIANTS = {
    "dang van": lambda stress: dang_van(stress, ALPHA),
    "crossland": lambda stress: crossland(stress, ALPHA),
}
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
    """The largest value over planes 0.1 degrees apart in the xy plane and 1 degree across, then by Nelder and Mead."""
    sigma = tensors(path)
    angles, tilts = np.radians(np.arange(0, 180, 0.1)), np.radians(np.arange(0, 91, 1.0))
    values = on_plane(name, sigma, angles[:, None], tilts[None])
    best = np.unravel_index(values.argmax(), values.shape)
    start = np.array([angles[best[0]], tilts[best[1]]])
    size = values.max()
    if size == 0:  # compression on every plane
        return 0.0, 0.0
    polished = minimize(
        lambda at: -float(on_plane(name, sigma, at[0], at[1])) / size,
        start,
        method="Nelder-Mead",
        options={"xatol": 1e-9, "fatol": 1e-16, "initial_simplex": start + np.radians([[0, 0], [0.1, 0], [0, 0.5]])},
    )
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
