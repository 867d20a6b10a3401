"""Error measures between two results, and verdicts against bars. The measures are fixed, so that figures compare
across versions and codes: see :class:`Comparison`."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from partialslip import views
from partialslip.result import Array, Result, Traction

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)

# Bars on traction errors, in multiples of the accuracy asked of a, m and n.
P_BAR, Q_BAR = 10.0, 15.0

_NEAR = 3.0  # half-widths: how far stresses inside are compared


@dataclass(frozen=True)
class Comparison:
    """Errors of a result against a reference; None where there is nothing to compare: without a stick zone, and of
    m, n and q where the reference says that the contact ratchets, so that its steady state is not reached.

    ``a``, ``m``, ``n``: |difference| / a. ``p``, ``q``: relative L2 over the contact of cell averages (each cell's mean
    against the reference's mean over the same cell), q being (q2 - q1)/2. ``p_nodal``, ``q_nodal``: relative L2 of
    nodal values; ``p_max``, ``q_max``: the largest error of a node, in p0 and f p0. Where stresses were asked for and
    both know them, ``surface`` is the relative L2 error of sigma_xx along both surfaces as averages over those cells,
    ``largest`` the relative error of its largest value on the lower body, and ``inside`` the relative L2 error of the
    stresses in the middle of the triangles within 3 a, by area. ``bars`` are what a, m, n, p and q must not exceed;
    ``missed`` says what failed, in words.
    """

    a: float
    m: float | None
    n: float | None
    p: float | None
    q: float | None
    p_nodal: float
    q_nodal: float | None
    p_max: float
    q_max: float | None
    surface: float | None
    largest: float | None
    inside: float | None
    bars: dict[str, float]
    missed: tuple[str, ...]

    @property
    def passed(self) -> bool:
        """Whether every error is within its bar, and the regimes agree."""
        return not self.missed

    def _repr_html_(self) -> str:
        return views.html(self)


def compare(result: Result, reference: Result, f: float, accuracy: float | None) -> Comparison:
    """Compare ``result`` with ``reference``, of the same scene.

    Parameters
    ----------
    f : float
        Coefficient of friction: errors of q are given in f p0.
    accuracy : float, optional
        Bar for a, m and n (fractions of a); p and q have 10 and 15 times that. Without it there are no bars: of
        finite bodies half-planes are no truth, and the differences are their size.
    """
    a, p0 = reference.a, reference.p0
    errors: dict[str, float | None] = {"a": abs(result.a - a) / a, "m": None, "n": None}
    settles = reference.regime != "ratchets"
    if settles and None not in (result.m, result.n, reference.m, reference.n):
        # by centre and half-width, which do not cancel in a tiny stick zone
        centre = (result.stick_centre or 0.0) - (reference.stick_centre or 0.0)
        half_width = (result.stick_half_width or 0.0) - (reference.stick_half_width or 0.0)
        errors |= {"m": abs(half_width - centre) / a, "n": abs(half_width + centre) / a}
    errors["p"], q = cell_errors(result.traction, reference.traction)
    errors["q"] = q if settles else None

    p, dq = reference.traction.at(result.traction.x)
    p_off, q_off = result.traction.p - p, (result.traction.dq - dq) / 2
    shears = settles and bool(dq.any())
    shares = {"a": 1.0, "m": 1.0, "n": 1.0, "p": P_BAR, "q": Q_BAR}
    bars = {} if accuracy is None else {key: share * accuracy for key, share in shares.items()}
    return Comparison(
        **{key: errors[key] for key in shares},  # type: ignore[arg-type]
        p_nodal=_relative(p_off, p, result.traction.x),
        q_nodal=_relative(q_off, dq / 2, result.traction.x) if shears else None,
        p_max=float(np.abs(p_off).max() / p0),
        q_max=float(np.abs(q_off).max() / (f * p0)) if shears else None,
        **_stress_errors(result, reference),  # type: ignore[arg-type]
        bars=bars,
        missed=_missed(result, reference, errors, bars),
    )


def cell_errors(traction: Traction, reference: Traction) -> tuple[float | None, float | None]:
    """Relative L2 errors of p and q = dq/2 as averages over the cells that overlap the reference's contact."""
    if traction.cells is None:
        return None, None
    left, right = reference.breaks.min(), reference.breaks.max()
    cells = traction.cells
    first, last = np.searchsorted(cells, left, "right") - 1, np.searchsorted(cells, right, "left")
    cells = cells[max(first, 0) : last + 1]
    widths = np.diff(cells)
    means, exact = cell_means(traction, cells), cell_means(reference, cells)
    p, q = (
        float(np.sqrt(np.sum((mean - true) ** 2 * widths) / norm)) if (norm := np.sum(true**2 * widths)) > 0 else None
        for mean, true in zip(means, exact, strict=True)
    )
    return p, q


def _stress_errors(result: Result, reference: Result) -> dict[str, float | None]:
    errors: dict[str, float | None] = dict.fromkeys(("surface", "largest", "inside"))
    cells, a = result.traction.cells, reference.a
    if result.surface and reference.surface and cells is not None:
        breaks = np.union1d(result.traction.breaks, reference.traction.breaks)
        found, true = (_means(each.at, cells, breaks) for each in (result.surface, reference.surface))
        widths = np.diff(cells)
        errors["surface"] = float(np.sqrt(((found - true) ** 2 @ widths).sum() / (true**2 @ widths).sum()))
        (_, largest), (_, truly) = result.surface.largest, reference.surface.largest
        errors["largest"] = abs(largest - truly) / abs(truly)
    if result.bodies and reference.stress_at:
        off, norm = 0.0, 0.0
        for body in result.bodies:
            corners = body.points[body.triangles]
            near = (np.abs(corners.mean(axis=1)) <= _NEAR * a).all(axis=1)
            (along, across), (x, y) = (
                np.moveaxis(corners[near, 1:] - corners[near, :1], 0, -1),
                corners[near].mean(axis=1).T,
            )
            areas = np.abs(along[0] * across[1] - along[1] * across[0])
            truth = reference.stress_at(x, y)
            values = np.stack([stress[near].T for stress in body.stresses.values()])
            off, norm = off + float(((values - truth) ** 2 @ areas).sum()), norm + float((truth**2 @ areas).sum())
        errors["inside"] = float(np.sqrt(off / norm))
    return errors


def cell_means(traction: Traction, cells: Array) -> tuple[Array, Array]:
    """Means of p and dq over each of the cells with ends ``cells`` (ascending), (c,) each."""
    p, dq = _means(lambda x: np.stack(traction.at(x)), cells, traction.breaks)
    return p, dq


def _means(function: Callable[[Array], Array], cells: Array, breaks: Array) -> Array:
    """Means of ``function`` (k,) -> (..., k) over the cells, (..., c).

    Gauss quadrature in an angle over every piece between cell ends and breaks of the traction, which takes square
    roots at the breaks exactly.
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


def _relative(error: Array, true: Array, x: Array) -> float:
    norm = np.trapezoid(true**2, x)
    return float(np.sqrt(np.trapezoid(error**2, x) / norm)) if norm > 0 else 0.0


def _missed(
    result: Result, reference: Result, errors: dict[str, float | None], bars: dict[str, float]
) -> tuple[str, ...]:
    missed = [
        f"{key}: error {error:.3g} > {bars[key]:.3g}"
        for key, error in errors.items()
        if error and error > bars.get(key, np.inf)
    ]
    missed += result.uncertified
    if bars and result.regime != reference.regime:
        missed.append(f"regime: {result.regime}, not {reference.regime}")
    return tuple(missed)
