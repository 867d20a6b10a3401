"""What a solution is off by, from its own mesh: by solving there once more with elements of a neighbouring order.

Away from the ends of zones the solution is smooth, and on meshes graded to the ends errors fall with the order k like
r^(2 k), r depending on the mesh: ends of zones and means of tractions converge like the energy, whose prefactor is
about one in the units used here. Errors of orders k and k - 1 are therefore r^(2 k) and r^(2 (k-1)), and the
difference d between the two is the latter: d^(k/(k-1)) is left of order k. Against the order above, d itself is.
Where shear is confined to narrow strips the prefactor is its norm rather than one.

At an end itself, where tractions are square roots, the order does not matter; the size of the element does. So does
the distance to the next end, or kink of the profile, over which tractions are square roots: ends of the stick zone are
fitted to some elements beside them.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.interpolate import PPoly

from partialslip.arrays import Array
from partialslip.bars import LEAST_SHEAR
from partialslip.result import Clock
from partialslip_fem.mesh_solution import MeshSolution
from partialslip_fem.problem import Problem
from partialslip_fem.solving import solve_on_meshes

# The order below costs least, but where it locks (P2 and P1 towards nu = 0.5) its errors say nothing.
NEIGHBOUR = {1: 2, 2: 3, 3: 4, 4: 3}

END_KEYS = ("a", "left", "right", "m", "n")
_SHEARS = ("q", "q1", "q2")
KEYS = (*END_KEYS, "p", *_SHEARS)

# The difference of the orders bounds an error up to a factor, that of meshes (see benchmarks/estimates.py).
_SAFE = {"a": 3.0, "left": 3.0, "right": 3.0, "m": 1.9, "n": 1.9, "p": 2.6, "q": 2.0, "q1": 2.0, "q2": 2.0}
_SAME = 1 / 3  # of the error of a: no end is known better than that
_SMALL = 0.1  # of the norm of f p: shear whose norm is less is confined to narrow strips, and errors start from less

# What an end, p and q are off by, measured as multiples of the size of the element that the end lies in.
AT_END = {1: 0.1, 2: 0.03, 3: 0.003, 4: 0.002}
# of what an end of the stick zone is off by where elements are not small beside the distance to the other end of it,
# and to what else is near
_FIT = np.array([8.0, 2.0])
_STICK = 1.5  # of what an end of the contact is off by: an end of the stick zone
_SIDE = 0.5  # of the size of its element: an end is not off by more
_KINK = 0.03  # of a kink's strength times the size of its element: what q is off by, in L2
_STEEP = 0.3  # the same, times the size in the distance to the next end: where that is small, of the stick zone's ends
_SHIFT = 1.5  # of a kink's strength times how far it is off: what q is off by, in L2
_ACROSS = 3.0  # elements on either side of a kink that tell its strength
_TRACTIONS = {"p": 12.0, "q": 40.0}  # of that in Hertz contacts, in proportion to :func:`_steepness` in others


def neighbour(solution: MeshSolution, problem: Problem, width: float, clock: Clock) -> MeshSolution:
    """The solution on the same mesh that the errors of ``solution`` are estimated by."""
    return solve_on_meshes(
        [body.mesh for body in solution.bodies], replace(problem, order=NEIGHBOUR[problem.order]), width, clock
    )


def smooth_errors(solution: MeshSolution, other: MeshSolution) -> dict[str, float]:
    """Errors of the contact's half-width and ends, m and n (in contact half-widths), p, q, q1 and q2 (relative L2 of
    cell averages), but for those of the elements at the ends; ``other`` is the neighbour."""
    order = solution.lower.order
    power = order / min(order, other.lower.order) - 1
    changes, prefactors = _changes(solution, other), _prefactors(solution)
    errors = {
        key: _SAFE[key] * change * (change / prefactors.get(key, 1.0)) ** power for key, change in changes.items()
    }
    least = _SAME * errors["a"]  # two solutions may meet in one of the ends by chance
    return {key: max(error, least) if key in END_KEYS else error for key, error in errors.items()}


def end_errors(solution: MeshSolution, sizes: Array, gaps: Array, beside: Array) -> dict[str, float]:
    """What the elements at the ends add.

    Parameters
    ----------
    solution : MeshSolution
    sizes : (k,) array
        Those of the elements that the ``solution.zone_ends`` lie in, in contact half-widths.
    gaps : (2, k) array
        From each of the ends of the stick zone to the other one (infinite at other ends), and from each end to the
        nearest of the other ends and kinks.
    beside : (j,) array
        Sizes of the elements that the ``solution.kinks`` lie in.
    """
    off = AT_END[solution.lower.order] * sizes
    most = float(off.max()) * max(_steepness(solution), 1.0)
    errors = {"a": float(off[:2].mean()), **{key: most * times for key, times in _TRACTIONS.items()}}
    first, second = solution.contact_end_places
    errors |= {"left": float(off[first].max()), "right": float(off[second].max())}
    if solution.stick:
        fit = _FIT[:, None] * np.minimum(sizes / gaps, 1.0) ** 2
        fitted = _STICK * off + np.minimum(fit.sum(axis=0), _SIDE) * sizes
        errors |= dict(zip("mn", fitted[2:4].tolist(), strict=True))
    if solution.history:
        half, *both = _norms(solution)
        a = solution.half_width
        if solution.stick and half > 0:  # where slip strips are narrow, q is steep beside them
            near = (sizes * np.minimum(sizes / gaps.min(axis=0), 1.0))[2:4]
            errors["q"] = math.hypot(errors["q"], *(_STEEP * _beside(solution) * near))
        locked = np.hypot.reduce(_KINK * _locked(solution) * beside * a, axis=1)
        for key, norm, kinks in zip(("q1", "q2"), both, locked.tolist(), strict=True):
            if norm > 0:
                errors[key] = math.hypot(errors["q"] * half, kinks) / float(norm)
    return errors


def rounding_error(solution: MeshSolution) -> float:
    """What rounding leaves of the ends, in contact half-widths, and of tractions, relative.

    The stiffness of a body that hardly changes its volume is the larger one, (lambda + 2 mu)/mu, and so is what its
    factor loses of the rest; that adds up with the unknowns.
    """
    loses = max((each.body.kappa + 1) / (each.body.kappa - 1) for each in solution.bodies)
    return float(np.finfo(float).eps) * loses * solution.dofs


def together(solution: MeshSolution, smooth: Mapping[str, float], at_ends: Mapping[str, float]) -> dict[str, float]:
    """Both errors: of ends their sum; of tractions, which are in L2 and lie in different elements, the root of the sum
    of squares, and what q is off by where the stick zone's ends are."""
    errors = {
        key: error + at_ends[key] if key in END_KEYS else math.hypot(error, at_ends[key])
        for key, error in smooth.items()
        if key in at_ends
    }
    if "q" in errors:
        norms = _norms(solution)
        moved = float(np.hypot.reduce(_SHIFT * _beside(solution) * [errors["m"], errors["n"]])) * float(norms[0])
        for key, norm in zip(_SHEARS, norms.tolist(), strict=True):
            if key in errors and norm > 0:
                errors[key] = math.hypot(errors[key], moved / norm)
    return errors


def _beside(solution: MeshSolution) -> Array:
    """Strengths of the kinks of q = (q2 - q1)/2 at both ends of the stick zone, of lengths in contact half-widths and
    relative to the L2 norm of q, (2,)."""
    assert solution.history
    change = solution.history.change / 2
    strengths: Array = _strengths(solution, [change], solution.zone_ends[2:4])[0] * solution.half_width
    norm = float(_norms(solution)[0])
    return strengths / norm if norm > 0 else 0 * strengths


def stick_element_size(solution: MeshSolution, gaps: Array, error: float) -> float:
    """The size of elements, in contact half-widths, that tell where the stick zone ends to ``error``: small enough
    beside the ``gaps``, or themselves so small that an end somewhere in one is known to that."""
    if not solution.stick:
        return np.inf
    beside = float(np.cbrt(error * (gaps[:, 2:4] ** 2).min(axis=1) / _FIT).min())
    return max(beside, error / _SIDE)


def kink_sizes(solution: MeshSolution, error: float) -> Array:
    """Sizes of elements, in contact half-widths, at each of the kinks that leave q1 and q2 within ``error``."""
    if not solution.kinks or not solution.history:
        return np.empty(0)
    norms = np.maximum(_norms(solution)[1:], np.finfo(float).tiny)
    relative = _KINK * _locked(solution) * solution.half_width * math.sqrt(len(solution.kinks)) / norms[:, None]
    sizes: Array = error / np.maximum(relative.max(axis=0), np.finfo(float).tiny)
    return sizes


def _norms(solution: MeshSolution) -> Array:
    """L2 norms of the cell averages of (q2 - q1)/2, q1 and q2, or what their errors are relative to at least."""
    history = solution.history
    assert history
    norms = [_norm(solution.shear(forces)) for forces in (history.change / 2, history.q1, history.q2)]
    result: Array = np.maximum(norms, LEAST_SHEAR * _norm(solution.shear(history.bound)))
    return result


def _prefactors(solution: MeshSolution) -> dict[str, float]:
    """Of the errors of shear, which are less than one where it is small beside f p."""
    if not solution.history:
        return {}
    relative = _norms(solution) / _norm(solution.shear(solution.history.bound))
    return dict(zip(_SHEARS, np.minimum(relative / _SMALL, 1.0).tolist(), strict=True))


def _norm(traction: PPoly) -> float:
    force = np.diff(traction.antiderivative()(traction.x))
    return float(np.sqrt(np.sum(force**2 / np.diff(traction.x))))


def _locked(solution: MeshSolution) -> Array:
    """Strengths of the kinks of q1 and q2, (2, k)."""
    history = solution.history
    assert history
    return _strengths(solution, [history.q1, history.q2], np.array(solution.kinks))


def _strengths(solution: MeshSolution, shears: Sequence[Array], points: Array) -> Array:
    """Factors of the square root of the distance that tractions under the forces ``shears`` gain on one side of each of
    the points, (s, k).

    What two intervals of length d on either side of a point bear differs by s d^2, s the slope, and by 2/3 of the
    factor times d^(3/2); that of half the length tells the two apart.
    """
    vertices = solution.lower.x[:: solution.lower.order]
    width = _ACROSS * np.diff(vertices)[np.clip(np.searchsorted(vertices, points) - 1, 0, len(vertices) - 2)]
    places = points + width * np.array([[-1.0], [-0.5], [0.0], [0.5], [1.0]])
    found = []
    for forces in shears:
        resultant = solution.shear(forces).antiderivative()
        before, close, at, near, after = resultant(np.clip(places, vertices[0], vertices[-1]))
        whole, half = after - 2 * at + before, near - 2 * at + close
        found.append(1.5 * np.abs(4 * half - whole) / ((math.sqrt(2) - 1) * width**1.5))
    return np.array(found)


def _steepness(solution: MeshSolution) -> float:
    """The factor of the square root of the distance from an end that p begins with, over the RMS of p, as a multiple of
    that of a Hertz contact; the larger one of the two ends. It is taken from the force on the cell the end lies in and
    the one beside it."""
    p, ends = solution.pressure(), np.array([solution.left, solution.right])
    force = p.antiderivative()
    rms = np.sqrt(np.sum(np.diff(force(p.x)) ** 2 / np.diff(p.x)) / (2 * solution.half_width))
    cells = np.clip(np.searchsorted(p.x, ends) - 1, 1, len(p.x) - 3)
    inside = p.x[cells + np.array([2, -1])]
    forces = np.abs(force(p.x[[0, -1]]) - force(inside))
    return float(np.max(1.5 * forces / np.abs(inside - ends) ** 1.5) * np.sqrt(solution.half_width / 3) / rms)


def _changes(solution: MeshSolution, other: MeshSolution) -> dict[str, float]:
    a = solution.half_width
    ends = np.abs(np.subtract(solution.contact_ends, other.contact_ends)).max(axis=0) / a
    changes = {"a": abs(other.half_width - a) / a, "left": float(ends[0]), "right": float(ends[1])}
    pressure = solution.pressure()
    changes["p"] = _apart(pressure, other.pressure(), _norm(pressure))
    if solution.stick and other.stick and solution.history and other.history:
        changes["m"] = abs(other.stick.left - solution.stick.left) / a
        changes["n"] = abs(other.stick.right - solution.stick.right) / a
        for key, (of, at), norm in zip(_SHEARS, _shears(solution, other), _norms(solution).tolist(), strict=True):
            changes[key] = _apart(of, at, norm)
    return {key: changes[key] for key in KEYS if key in changes}


def _shears(*solutions: MeshSolution) -> Iterator[tuple[PPoly, ...]]:
    """Half the change of the shear, and shear at load points 1 and 2, of each solution."""
    for share, key in ((0.5, "change"), (1.0, "q1"), (1.0, "q2")):
        yield tuple(solution.shear(share * getattr(solution.history, key)) for solution in solutions)


def _apart(traction: PPoly, other: PPoly, norm: float) -> float:
    """L2 difference of their means over the cells, relative to ``norm``."""
    widths = np.diff(traction.x)
    force, otherwise = (np.diff(each.antiderivative()(traction.x)) for each in (traction, other))
    return float(np.sqrt(np.sum((otherwise - force) ** 2 / widths))) / norm if norm > 0 else 0.0
