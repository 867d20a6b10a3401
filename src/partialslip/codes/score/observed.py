"""What the values of a table would be of another traction: a table is compared with the reference like with like."""

from collections.abc import Callable
from functools import partial

import numpy as np

from partialslip.codes.score.samples import Samples
from partialslip.result import Observed, Traction
from partialslip.run.judge.measures import fields, means, relative
from partialslip.tools.arrays import Array

_Function = Callable[[Array], Array]
_SHARES = 0.25, 0.5, 0.75  # fixed: places between two points
_GAPS = 20_000  # cost: most gaps between points at which is looked what they hide


def observed(samples: Samples) -> Observed:
    """Return what the values of ``samples`` stand for."""
    x, cells = samples.x, samples.cells
    if samples.kind == "sampled" or cells is None:
        return Observed(_around(x), partial(_sampled, x))
    parts = np.stack([cells[:-1], cells[1:]], axis=1)
    if samples.kind == "nodal":
        return Observed(parts, partial(_over_weights, x))
    parts[0, 0], parts[-1, 1] = min(cells[0], 2 * x[0] - x[1]), max(cells[-1], 2 * x[-1] - x[-2])
    return Observed(parts, partial(_means, cells))


def hidden(x: Array, reference: Traction, f: float, keys: tuple[str, ...]) -> dict[str, float]:
    """Return how much of the ``reference`` the spacing of points ``x`` hides, by key, in the norms of
    :func:`partialslip.run.judge.measures.norm_errors`: how far lines between its values there are off.

    ``f`` and ``keys`` as there.
    """
    true = partial(fields, reference, keys=("p", *keys))
    some = np.arange(0, len(x) - 1, -(-len(x) // _GAPS))
    gaps, (left, right) = np.diff(x)[some], (true(x[some]), true(x[some + 1]))
    off = [np.abs((1 - share) * left + share * right - true(x[some] + share * gaps)) for share in _SHARES]
    lost = np.sqrt(np.max(off, axis=0) ** 2 @ gaps * ((x[-1] - x[0]) / gaps.sum()))
    cells = np.unique(np.concatenate([reference.breaks, [] if reference.cells is None else reference.cells]))
    norms = np.sqrt(means(lambda at: true(at) ** 2, cells, cells) @ np.diff(cells))
    return relative(lost, norms, f, ("p", *keys))


def _around(x: Array) -> Array:
    """Ends of the parts that values at points ``x`` (n,) stand for, (n, 2), m: up to the middle between two points, or
    as far as from the point to its other neighbour where the gap is wider than both gaps beside it together: a hole.
    Beyond the outermost points a hole begins likewise."""
    gaps = np.diff(x)
    before, after = np.append(np.inf, gaps[:-1]), np.append(gaps[1:], np.inf)
    hole = gaps > before + after
    middle = (x[1:] + x[:-1]) / 2
    ends = np.append(np.where(hole, x[:-1] + before, middle), x[-1] + gaps[-1])
    starts = np.append(x[0] - gaps[0], np.where(hole, x[1:] - after, middle))
    return np.stack([starts, ends], axis=1)


def _sampled(x: Array, function: _Function, _: Array) -> Array:
    return function(x)


def _means(cells: Array, function: _Function, breaks: Array) -> Array:
    return means(function, cells, breaks)


def _over_weights(x: Array, function: _Function, breaks: Array) -> Array:
    """Integrals of ``function`` times the shape functions of linear elements with the nodes ``x``, over the integrals
    of the shape functions."""
    widths = np.diff(x)

    def times_shapes(points: Array) -> Array:
        element = np.clip(np.searchsorted(x, points, "right") - 1, 0, len(widths) - 1)
        s = (points - x[element]) / widths[element]
        return np.stack([1 - s, s])[:, None] * np.concatenate([function(points), np.ones((1, len(points)))])

    left, right = means(times_shapes, x, breaks) * widths
    sums = np.zeros((len(left), len(x)))
    sums[:, :-1] += left
    sums[:, 1:] += right
    return sums[:-1] / sums[-1]
