"""Response surfaces over the deviations t of the inputs, and draws of t.

Of k inputs, ``star`` are the points 0 and +-1 on each axis. Additive quadratics through the star are the differences

    y(t) = y(0) + sum_i (y_i+ - y_i-)/2 t_i + (y_i+ + y_i- - 2 y(0))/2 t_i^2;

:func:`interpolated` goes through any points: cubic radial functions and a polynomial.
"""

import itertools
from collections.abc import Callable, Sequence

import numpy as np
from scipy.special import ndtri

from partialslip.scene.tolerance import REACH, Input
from partialslip.tools.arrays import Array

Surface = Callable[[Array], Array]  # of t (n, k) gives y (n, q) of q quantities

_SPARE = 1.5  # accuracy: points for each term of the polynomial
_POWERS = 3  # accuracy: of each input, whose variance is its share: sharper curves have less than 1 % more


def star(count: int) -> Array:
    """The points of the star, (2 k + 1, k): 0, then -1 and 1 on each axis, for ``count`` = k inputs."""
    axes = np.repeat(np.eye(count), 2, axis=0)
    axes[::2] *= -1
    return np.vstack([np.zeros(count), axes])


def draws(inputs: Sequence[Input], count: int) -> Array:
    """``count`` draws of the deviations of ``inputs``, (count, k), evenly spread: a Kronecker sequence.

    u_i = frac(1/2 + i g^-j), g^(k+1) = g + 1 (R. Kronecker; M. Roberts 2018, "The unreasonable effectiveness of
    quasirandom sequences"). The first draws are the same for every count. scipy.stats.qmc, as evenly spread, takes a
    CPU second to import.
    """
    g = 2.0
    for _ in range(60):
        g = (1 + g) ** (1 / (len(inputs) + 1))
    u = (0.5 + np.arange(1, count + 1)[:, None] * g ** -np.arange(1.0, len(inputs) + 1)) % 1
    return np.where([each.normal for each in inputs], ndtri(u) / REACH, 2 * u - 1)


def quadratic(t: Array, y: Array) -> Surface:
    """The additive quadratic through the star: ``t`` (2 k + 1, k), ``y`` (2 k + 1, q); linear in an input of which one
    side is NaN."""
    del t
    low, high = y[1::2] - y[0], y[2::2] - y[0]
    low, high = np.where(np.isnan(low), -high, low), np.where(np.isnan(high), -low, high)
    slope, bend = np.nan_to_num((high - low) / 2), np.nan_to_num((high + low) / 2)
    return lambda t: y[0] + t @ slope + t**2 @ bend


def interpolated(t: Array, y: Array) -> Surface:
    """The surface sum_i w_i \\|t - t_i\\|^3 + polynomial through points: ``t`` (n, k), ``y`` (n, q). NaN are left out.
    The degree is 2, less where the points are few."""
    known = np.isfinite(y)
    alike = [np.flatnonzero((pattern == known.T).all(axis=1)) for pattern in np.unique(known.T, axis=0)]
    parts = [(columns, _through(t[known[:, columns[0]]], y[known[:, columns[0]]][:, columns])) for columns in alike]

    def at(where: Array) -> Array:
        found = np.empty((len(where), y.shape[1]))
        for columns, surface in parts:
            found[:, columns] = surface(where)
        return found

    return at


def _through(t: Array, y: Array) -> Surface:
    degree = next((d for d in (2, 1) if len(t) >= _SPARE * _powers(t, d).shape[1]), 0)
    tail = _powers(t, degree)
    none = np.zeros((tail.shape[1],) * 2)
    matrix = np.block([[_cubes(t, t), tail], [tail.T, none]])
    weights = np.linalg.lstsq(matrix, np.vstack([y, np.zeros((len(none), y.shape[1]))]), rcond=None)[0]
    return lambda at: np.hstack([_cubes(at, t), _powers(at, degree)]) @ weights


def _cubes(one: Array, other: Array) -> Array:
    squares = (one**2).sum(axis=1)[:, None] + (other**2).sum(axis=1) - 2 * one @ other.T
    return np.maximum(squares, 0.0) ** 1.5


def _powers(t: Array, degree: int) -> Array:
    """All monomials of ``t`` (n, k) up to the ``degree``, (n, terms)."""
    columns = [np.ones(len(t))]
    for power in range(1, degree + 1):
        columns += [
            t[:, each].prod(axis=1) for each in itertools.combinations_with_replacement(range(t.shape[1]), power)
        ]
    return np.stack([np.asarray(each) for each in columns], axis=1)


def shares(t: Array, y: Array) -> Array:
    """First-order Sobol' indices of the inputs, (k,), from draws ``t`` (n, k) and ``y`` (n,): the variance of the part
    of y that one input explains, a cubic, over that of y; 0 where y does not vary. NaN are left out."""
    known = np.isfinite(y)
    t, y = t[known], y[known]
    if not len(y) or not (total := float(y.var())):
        return np.zeros(t.shape[1])
    columns = np.stack([t**power for power in range(1, _POWERS + 1)], axis=-1)  # (n, k, powers)
    centred = columns - columns.mean(axis=0)
    weights = np.linalg.lstsq(centred.reshape(len(t), -1), y - y.mean(), rcond=None)[0]
    parts: Array = np.einsum("nkp,kp->nk", centred, weights.reshape(centred.shape[1:]))
    found = parts.var(axis=0) / total
    return found / max(1.0, found.sum())  # draws that slide are missing, which ties inputs to each other
