"""Cell averages of tractions, relative L2 errors of cell averages, and resultants."""

import math
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from partialslip.result import Traction, TractionAt
from partialslip.tools.arrays import Array
from partialslip.tools.bars import LEAST_SHEAR

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)


def cell_errors(traction: Traction, reference: Traction, f: float = 0.0) -> tuple[float, float]:
    """Return relative L2 errors of the cell averages of p and of q = dq/2 over the reference's contact.

    Parameters
    ----------
    traction, reference : Traction
        Tractions of the result and of the reference.
    f : float, optional
        Coefficient of friction. The error of q is relative to the larger of q's norm and 1e-3 of f p's norm; if f is 0,
        to the larger of the norms of q and p.
    """
    errors = norm_errors(traction, reference, f, ("p", "q"))
    return errors["p"], errors["q"]


class Pair(NamedTuple):
    """Values of a traction and of its reference, like with like.

    Parameters
    ----------
    keys : tuple of str
        Quantities, as for :func:`fields`; the first is p.
    places, widths : (n,) arrays
        Of the cells, m.
    found, true : (keys, n) arrays
        Averages over cells that cover the reference's contact. Of a table its own values and those that it would have
        of the reference, and averages over the parts of the reference's contact for which no value stands.
    """

    keys: tuple[str, ...]
    places: Array
    widths: Array
    found: Array
    true: Array

    def errors(self, f: float) -> dict[str, float]:
        """Relative L2 errors by key (:func:`norm_errors`)."""
        off, norms = (np.sqrt(values**2 @ self.widths) for values in (self.found - self.true, self.true))
        return relative(off, norms, f, self.keys)

    def off(self, arm: int = 0) -> dict[str, float]:
        """Integrals of the differences by key, times x to the power ``arm``."""
        sums = (self.found - self.true) @ (self.widths * self.places**arm)
        return dict(zip(self.keys, sums.tolist(), strict=True))


def paired(traction: Traction, reference: Traction, keys: tuple[str, ...]) -> Pair:
    """Return the values of ``traction`` and ``reference`` for the ``keys`` and, first, for p."""
    keys = tuple(dict.fromkeys(("p", *keys)))
    own, true = (partial(fields, each, keys=keys) for each in (traction, reference))
    if traction.observed is None:
        cells = _cells(traction, reference)
        averages = (means(of, cells, each.breaks) for of, each in ((own, traction), (true, reference)))
        return Pair(keys, (cells[1:] + cells[:-1]) / 2, np.diff(cells), *averages)
    (starts, ends), of = traction.observed.cells.T, traction.observed.of
    places, widths = traction.x, ends - starts
    found, wanted = _by_key(traction.values, keys), of(true, reference.breaks)
    # from the end of each part to the start of the next, within the reference's contact
    contact = reference.breaks.min(), reference.breaks.max()
    left, right = np.clip(np.stack([np.append(contact[0], ends), np.append(starts, contact[1])]), *contact)
    if (bare := right > left).any():
        cells = np.stack([left[bare], right[bare]], axis=1).ravel()
        between = (means(of, cells, each.breaks)[..., ::2] for of, each in ((own, traction), (true, reference)))
        found, wanted = (np.concatenate(pair, axis=-1) for pair in zip((found, wanted), between, strict=True))
        places = np.append(places, (left + right)[bare] / 2)
        widths = np.append(widths, (right - left)[bare])
    return Pair(keys, places, widths, found, wanted)


def norm_errors(traction: Traction, reference: Traction, f: float, keys: tuple[str, ...]) -> dict[str, float]:
    """Return relative L2 errors by key: of cell averages, or of the values of a table.

    Parameters
    ----------
    traction, reference : Traction
        Tractions of the result and of the reference.
    f : float
        Coefficient of friction.
    keys : tuple of str
        ``p`` and ``p_1`` (load points 2 and 1): relative to the norm of the quantity; ``q``, ``q1``, ``q2``: relative
        to the larger of the norm of the quantity and 1e-3 of f p's norm; without friction, where q = 0, relative to
        the norm of p. Zero if both are zero.
    """
    errors = paired(traction, reference, keys).errors(f)
    return {key: errors[key] for key in keys}


def relative(off: Array, norms: Array, f: float, keys: tuple[str, ...]) -> dict[str, float]:
    """Return errors by key from norms of errors, ``off``, and of tractions, (keys,), first of p; ``f`` and ``keys`` as
    for :func:`norm_errors`."""
    least = LEAST_SHEAR * f * norms[0] if f else norms[0]
    return {
        key: _ratio(error, norm if key.startswith("p") else max(norm, least))
        for key, error, norm in zip(keys, off.tolist(), norms.tolist(), strict=True)
    }


def integrals(traction: Traction, keys: tuple[str, ...], arm: int = 0) -> dict[str, float]:
    """Return integrals of p, p_1 or q times x to the power ``arm`` over all cells, N/m or N; ``keys`` names them."""
    cells = np.unique(np.concatenate([traction.breaks, [] if traction.cells is None else traction.cells]))
    sums = means(lambda x: x**arm * fields(traction, x, keys), cells, cells) @ np.diff(cells)
    return dict(zip(keys, sums.tolist(), strict=True))


def fields(traction: Traction, x: Array, keys: tuple[str, ...]) -> Array:
    """Return tractions at ``x`` (n,), (keys, n), Pa.

    ``keys`` are p and p_1 (pressure at load points 2 and 1), q = dq/2, and q1 and q2, if the ``traction`` has them.
    """
    return _by_key(traction.at(x), keys)


def _by_key(found: TractionAt, keys: tuple[str, ...]) -> Array:
    known = {"p_1": found.pressures[0], "p": found.p, "q": found.dq / 2, "q1": found.q1, "q2": found.q2}
    return np.array([known[key] for key in keys])


def cell_means(traction: Traction, cells: Array) -> tuple[Array, Array]:
    """Return means (c,) of p and dq of a ``traction``, Pa, over the cells with ascending ends ``cells`` (c + 1,), m."""
    p, dq = means(lambda x: np.stack(traction.at(x)[:2]), cells, traction.breaks)
    return p, dq


def means(function: Callable[[Array], Array], cells: Array, breaks: Array) -> Array:
    """Return means of ``function``, (k,) -> (..., k), over the cells, (..., c).

    Gauss quadrature in an angle over each piece between ``cells`` ends and ``breaks`` of the traction. Square roots at
    the breaks are integrated exactly.
    """
    ends = np.unique(np.concatenate([cells, breaks]))
    ends = ends[(ends >= cells[0]) & (ends <= cells[-1])]
    middle, half = (ends[1:] + ends[:-1]) / 2, np.diff(ends) / 2
    angle = np.pi / 2 * (_NODES + 1)
    weights = np.pi / 2 * _WEIGHTS * np.sin(angle)
    points = middle[:, None] - half[:, None] * np.cos(angle)
    values = function(points.ravel())
    pieces = half * (values.reshape(*values.shape[:-1], *points.shape) @ weights)
    first = np.searchsorted(ends, cells[:-1])
    return np.add.reduceat(pieces, first, axis=-1) / np.diff(cells)


def _cells(traction: Traction, reference: Traction) -> Array:
    """Return the ends of the cells to average over, m; the cells cover the reference's contact.

    The cells are the method's, else the reference's, else the intervals between the method's points. If both have
    cells, each cell end of the method moves to the nearest one of the reference, because the reference resolves
    nothing within a cell.
    """
    known = (each.cells for each in (traction, reference) if each.cells is not None)
    cells = next(known, np.unique(traction.x))
    left, right = reference.breaks.min(), reference.breaks.max()
    first, last = np.searchsorted(cells, left, "right") - 1, np.searchsorted(cells, right, "left")
    own = cells[max(first, 0) : last + 1]
    if traction.cells is not None and reference.cells is not None:
        ends = reference.cells
        nearest = ends[np.searchsorted((ends[1:] + ends[:-1]) / 2, own)]
        within = (own > left) & (own < right) & (nearest > left) & (nearest < right)
        own = np.union1d(own[(own <= left) | (own >= right)], nearest[within])
    return np.union1d(own, [end for end in (left, right) if not own[0] <= end <= own[-1]])


def _ratio(error: float, norm: float) -> float:
    return 0.0 if error == 0 else float(error / norm) if norm else math.inf
