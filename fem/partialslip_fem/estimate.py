"""Error estimates of a solution, from a second solution on the same mesh with elements of a neighbouring order.

Away from the ends of zones the solution is smooth. On meshes graded to the ends errors decrease with the order k like
r^(2 k), where r depends on the mesh: ends of zones and means of tractions converge like the energy, whose prefactor is
about one in scaled units. Errors of orders k and k - 1 are therefore r^(2 k) and r^(2 (k-1)), and the difference d
between the two solutions is about the latter. The error of order k is then d^(k/(k-1)). Against the order above, the
error is d itself. If shear is confined to narrow strips, the prefactor is the norm of the shear.

Where ends of zones wander (:attr:`partialslip_fem.mesh_solution.MeshSolution.wanders`), they leave kinks in q within
elements. Errors then hardly depend on the order, and the change of m, n and q is itself the error. Where slip reverses,
load steps have no part in it, and both solutions may agree at the ends by chance: the ends are known no better than the
slip that the way has locked in (:mod:`partialslip_fem.locked`). An end that drifts is read twice, from the room that q
has left and from the loads at which the nodes beside it re-stuck
(:attr:`partialslip.friction.zone_ends.StickInterval.caught`): it is not known better than both readings agree. One that
reversed and came back is not known better than the nodes beside it are apart, if these do not tell how far it came.
Where it reversed q has a kink, which elements of both orders miss alike.

Where the gap's curvature jumps within elements, p has a kink of the kind x log|x| there. Errors then fall slowly with
the order: like those of q at kinks, they are a part of the change.

At an end tractions are square roots. There the error depends on the element size, not on the order, and on where in its
element the end lies: both orders miss one inside an element alike, and the same mesh with a vertex at the end found is
several times better (:attr:`partialslip_fem.mesh_solution.MeshSolution.inside`). It also depends on the distance to the
next end or kink of the profile, as ends of the stick zone are fitted to some elements next to them. Where these
elements grow fast, they reach as far as the kink: ends are not known better than a fit to fewer elements agrees
(:attr:`partialslip.friction.zone_ends.StickInterval.fits`). Ends of the contact are not, either: under a gap that is no
parabola p departs from a square root soon (:attr:`partialslip_fem.mesh_solution.MeshSolution.fits`).
"""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from scipy.interpolate import PPoly

from partialslip.tools.arrays import Array, Mask
from partialslip.tools.bars import BARS, LEAST_SHEAR
from partialslip_fem.locked import locked_in
from partialslip_fem.mesh_solution import MeshSolution
from partialslip_fem.mortar import within_cells

END_KEYS = ("a", "left", "right", "m", "n")
_SHEARS = ("q", "q1", "q2")
KEYS = (*END_KEYS, "p", *_SHEARS)

# accuracy: Safety factors on errors away from the ends (measured: benchmarks/estimates.py).
_SAFE = {"a": 3.0, "left": 3.0, "right": 3.0, "m": 1.3, "n": 1.3, "p": 2.6, "q": 2.0, "q1": 2.0, "q2": 2.0}
_EASED_SAFE = {6: 2.0}  # accuracy: the same for meshes that grow faster near the ends, by order
_LEAST_OF_A = 1 / 3  # accuracy: of the error of a: least error of any end
# accuracy: Least errors of m and n where slip reverses, measured: in their own change; and the largest one due to
# slip that is locked in, in the change of q.
_OF_TURNED, _MOST = 0.2, 2.0
_NARROW = 0.1  # accuracy: of the norm of f p: shear with a smaller norm is confined to narrow strips

# accuracy: Errors due to the elements at the ends, measured; benchmarks/estimates.py checks the sum of all errors.
# Error of an end of a zone, in the mean size of the element that the end lies in and its neighbours, by order: at a
# vertex, and inside an element, at least a fifth of it from both vertices.
_AT_VERTEX = {1: 0.1, 2: 0.03, 3: 0.003, 4: 0.002, 6: 0.001}
_INSIDE, _BESIDE = {1: 0.1, 2: 0.03, 3: 0.006, 4: 0.007, 6: 0.002}, 0.2
# Factors of (element size / gap)^2 in the error of an end of the stick zone: gap to the other end of the stick zone,
# and to the nearest other end or kink.
_FIT = np.array([8.0, 2.0])
# accuracy: error of an end due to the fit, in the distance of both fits, as the shorter one has a part of that error
# (measured on exact forces beside kinks of flat-rounded profiles: 1.1 to 1.6)
_READ = 1.5
# accuracy: The same of bodies of dissimilar materials, where p and q vary with each other, in the element size
# (measured): after a cycle, and under a flat punch, whose corner is to be found, too. Ends of their contact: where
# the slip zone is wider than an element, whose p is a power of the distance, and where it is not.
_COUPLED, _PUNCHED = 0.1, 0.3
_SLIPPING, _STUCK = 0.02, 0.3
# accuracy: error of an end and of p, in that of q1 and q2, as q opens the gap (measured)
_OF_LOCKED, _P_OF_LOCKED = 0.004, 0.02
_SIDE = 0.5  # accuracy: largest error of an end due to the fit, in the element size
# accuracy: error of an end that moves over nodes that slipped, in the element size: q is off its bound by little there
_CAUGHT_UP = 0.05
_KINK = 0.03  # accuracy: L2 error of q at a kink, in its strength times the element size
# accuracy: the same where an end of the stick zone reversed, in the strength times the distance to the nearest
# vertex (measured at 11 kinks: 0.006 to 0.1)
_TURNED_KINK = 0.1
_STEEP = 0.3  # accuracy: the same at ends of a narrow slip zone, also times element size / gap
_SHIFT = 1.5  # accuracy: L2 error of q due to a shifted kink, in its strength times the shift
# accuracy: of the change: least errors of ends and of tractions where the gap's curvature jumps within elements. There
# both orders converge alike, and the error of a traction is about the change.
_OF_BROKEN, _OF_BROKEN_TRACTION = 0.4, 0.8
# accuracy: L2 error of p where the gap's curvature jumps at a vertex, in the factor of x log|x| in p times the element
# size^1.5, by order: twice the largest in runs of random flats and tables, where more than the bends adds to it
# (benchmarks/accuracy.py bends has the bends alone)
_BENT = {1: 2.0, 2: 0.2, 3: 0.015, 4: 0.006, 6: 0.0018}
_ACROSS = 3.0  # accuracy: elements on either side of a kink from which its strength is found
# accuracy: Errors of p and q, in the error of an end, for Hertz contacts; in other contacts also times the steepness.
_TRACTIONS = {"p": 8.0, "q": 32.0}


def smooth_errors(
    solution: MeshSolution,
    other: MeshSolution,
    eased: bool = False,
    breaks: Sequence[float] = (),
    corner: float = math.inf,
) -> dict[str, float]:
    """Errors of ``solution`` away from the ends, from the ``other`` solution of the neighbouring order; ``eased``:
    whether the elements grow faster near the ends than elsewhere; ``breaks``: where the gap's curvature jumps;
    ``corner``: as from :func:`partialslip_fem.goals.corner`.

    Errors of a, left, right, m and n are in contact half-widths; of p, q, q1 and q2 relative L2 errors of cell means.
    """
    order = solution.lower.order
    power = order / min(order, other.lower.order) - 1
    changes = _changes(solution, other)
    prefactors = _prefactors(solution) | dict.fromkeys(END_KEYS, min(corner / solution.half_width, 1.0))
    safe = _EASED_SAFE.get(order, 1.0) if eased else 1.0
    errors = {
        key: safe * _SAFE[key] * change * (change / prefactors.get(key, 1.0)) ** power
        for key, change in changes.items()
    }
    if _within_elements(solution, breaks):
        parts = dict.fromkeys(END_KEYS, _OF_BROKEN) | dict.fromkeys(("p", *_SHEARS), _OF_BROKEN_TRACTION)
        errors = {key: max(error, parts[key] * changes[key]) for key, error in errors.items()}
    if solution.wanders:
        turns = bool(solution.history and solution.history.turns)
        parts = dict.fromkeys(("m", "n"), _OF_TURNED if turns else 1.0) | dict.fromkeys(_SHEARS, 1.0)
        errors |= {key: max(errors[key], part * changes[key]) for key, part in parts.items() if key in changes}
        if turns and "q" in changes:
            locked = dict(zip(("m", "n"), _of_locked(solution, other, changes["q"]), strict=True))
            errors |= {key: max(errors[key], least) for key, least in locked.items()}
    least = _LEAST_OF_A * errors["a"]  # two solutions may agree at one end by chance
    return {key: max(error, least) if key in END_KEYS else error for key, error in errors.items()}


def _of_locked(solution: MeshSolution, other: MeshSolution, change: float) -> list[float]:
    """Errors e_lock of m and n under slip reversal due to locked-in slip, half-widths; ``change`` is the relative
    change of q between both solutions, which limits them."""
    assert solution.history
    strengths = _strengths(solution, [solution.history.change / 2], solution.zone_ends[2:4])[0]
    errors = locked_in(solution, other, strengths) / solution.half_width
    return np.minimum(errors, _MOST * change).tolist()


def _within_elements(solution: MeshSolution, breaks: Sequence[float]) -> bool:
    """Whether some of the ``breaks`` lie in the contact and on no vertex."""
    points = within_cells(solution.lower.x[:: solution.lower.order], breaks)
    return bool(((points > solution.left) & (points < solution.right)).any())


def end_errors(solution: MeshSolution, sizes: Array, inside: Array, gaps: Array, at_kinks: Array) -> dict[str, float]:
    """Errors due to the element sizes at the zone ends, by key as for :func:`smooth_errors`.

    e_end = C(s) h, h = ``sizes``, s = ``inside``: tractions are square roots at a zone end, which two orders on one
    mesh miss alike, so that their difference does not show e_end. C rises linearly from ``_AT_VERTEX`` at a vertex (s =
    0) to ``_INSIDE`` at s >= ``_BESIDE`` (measured by benchmarks/estimates.py). The fit of the stick-zone ends adds a
    term in (h/gap)^2.

    Parameters
    ----------
    solution : MeshSolution
    sizes : (k,) array
        Sizes of the elements at ``solution.zone_ends``, in contact half-widths.
    inside : (k,) array
        Distances of the ends from the nearest vertex, in these elements, as from :meth:`MeshSolution.inside`.
    gaps : (2, k) array
        As from :func:`partialslip_fem.goals.gaps`.
    at_kinks : (j,) array
        Sizes of the elements at ``solution.kinks``, in contact half-widths.
    """
    order = solution.lower.order
    off = (_AT_VERTEX[order] + (_INSIDE[order] - _AT_VERTEX[order]) * np.minimum(inside / _BESIDE, 1.0)) * sizes
    if solution.dissimilar and solution.stick:
        beside = np.abs(solution.zone_ends[2:4] - solution.zone_ends[:2]) / solution.half_width
        off[:2] += np.where(beside > sizes[:2], _SLIPPING, _STUCK) * sizes[:2]
    most = float(off.max()) * max(_steepness(solution), 1.0)
    read, places = _READ * solution.fits / solution.half_width, solution.contact_end_places
    lefts, rights = (np.maximum(off[ends], read[side::2]) for side, ends in enumerate(places))
    errors = {"a": float(lefts[0] + rights[0]) / 2, **{key: most * times for key, times in _TRACTIONS.items()}}
    errors |= {"left": float(lefts.max()), "right": float(rights.max())}
    if solution.stick:
        fit = np.minimum((_FIT[:, None] * np.minimum(sizes / gaps, 1.0) ** 2).sum(axis=0), _SIDE) * sizes
        if not (solution.history and solution.history.turns):  # otherwise strips and nodes that re-stuck tell
            read = np.minimum(_READ * np.array(solution.stick.fits) / solution.half_width, _SIDE * sizes[2:4])
            reaches = np.isfinite(gaps[:, 2:4]).any(axis=0)  # a fit has no error where nothing is near
            fit[2:4] = np.maximum(fit[2:4], reaches * read)
        fitted = off + fit
        if solution.dissimilar:
            fitted[2:4] += _PUNCHED * sizes[:4].max() if solution.slips_when_pressed else _COUPLED * sizes[2:4]
        if solution.history and solution.history.turns:
            fitted[2:4] += _of_caught(solution, sizes[2:4])
            fitted[2:4] += np.array(solution.stick.strips) / solution.half_width
        errors |= dict(zip("mn", fitted[2:4].tolist(), strict=True))
    if solution.history:
        half, *both = _norms(solution).tolist()
        a = solution.half_width
        if solution.stick and half > 0:  # where slip strips are narrow, q is steep beside them
            near = (sizes * np.minimum(sizes / gaps.min(axis=0), 1.0))[2:4]
            errors["q"] = math.hypot(errors["q"], *(_STEEP * _stick_end_strengths(solution) * near))
        turned, *locked = _kink_errors(solution, at_kinks * a)
        for key, norm, kinks in zip(("q1", "q2"), both, locked, strict=True):
            if norm > 0:
                errors[key] = math.hypot(errors["q"] * half, kinks) / norm
        if half > 0:
            errors["q"] = math.hypot(errors["q"], turned / half)
    return errors


def _of_caught(solution: MeshSolution, sizes: Array) -> Array:
    """Errors of the ends of the stick zone that have moved outwards, over nodes that slipped before, (2,); 0 at others.
    ``sizes`` (2,) are those of the elements at the ends, in contact half-widths."""
    assert solution.stick
    apart = np.abs(np.subtract(solution.stick.caught, solution.zone_ends[2:4])) / solution.half_width
    # nodes that slip a little once more under mean loads re-stick as well, and tell nothing of the end
    apart = np.where(np.isnan(apart), _SIDE * sizes, np.minimum(apart, sizes))
    return np.where(solution.stick.moved, _CAUGHT_UP * sizes + apart, 0.0)


def bend_errors(solution: MeshSolution, bends: Array, sizes: Array) -> dict[str, float]:
    """L2 errors of p, q, q1 and q2 due to elements of ``sizes`` (k,), in contact half-widths, at points where the gap's
    curvature jumps by ``bends`` (k,): p gains bends/pi x log|x| there, and q as much as f p does where it slips. Empty
    without such points."""
    if not len(bends):
        return {}
    off = _BENT[solution.lower.order] / math.pi * float(np.linalg.norm(bends * (sizes * solution.half_width) ** 1.5))
    pressed = _norm(solution.pressure())
    errors = {"p": off / pressed}
    if solution.history:
        bound = _norm(solution.shear(solution.history.bound))
        errors |= {
            key: off / pressed * bound / norm
            for key, norm in zip(_SHEARS, _norms(solution).tolist(), strict=True)
            if norm > 0
        }
    return errors


def bend_sizes(solution: MeshSolution, bends: Array, error: float) -> Array:
    """Element sizes, (k,), in contact half-widths, with which ``bends`` (k,) leave an ``error`` of tractions, relative
    to their bars."""
    if not len(bends):
        return np.empty(0)
    of_one = max(off / BARS[key] for key, off in bend_errors(solution, np.ones(1), np.ones(1)).items())
    return (error / (of_one * bends * math.sqrt(len(bends)))) ** (2 / 3)


def rounding_error(solution: MeshSolution) -> float:
    """Error of ``solution`` due to rounding: of ends in contact half-widths, of tractions relative.

    It is proportional to the number of unknowns and to (lambda + 2 mu)/mu, which is large for nearly incompressible
    materials; elements of order 6 have thrice the error of those of order 4 (measured).
    """
    loses = max((each.body.kappa + 1) / (each.body.kappa - 1) for each in solution.bodies)
    return float(np.finfo(float).eps) * loses * solution.dofs * max(solution.lower.order / 4, 1.0) ** 3


def combined(solution: MeshSolution, smooth: Mapping[str, float], at_ends: Mapping[str, float]) -> dict[str, float]:
    """Combine errors away from the ends (``smooth``) and ``at_ends`` of ``solution``.

    Errors of ends are added. L2 errors of tractions lie in different elements and are combined as root of the sum of
    squares; q gets a third part due to the shift of the stick zone's ends.
    """
    errors = {
        key: error + at_ends[key] if key in END_KEYS else math.hypot(error, at_ends[key])
        for key, error in smooth.items()
        if key in at_ends
    }
    if "q" in errors:
        norms = _norms(solution)
        shifts = _SHIFT * _stick_end_strengths(solution) * [errors["m"], errors["n"]]
        moved = float(np.hypot.reduce(shifts)) * float(norms[0])
        for key, norm in zip(_SHEARS, norms.tolist(), strict=True):
            if key in errors and norm > 0:
                errors[key] = math.hypot(errors[key], moved / norm)
    if solution.dissimilar and "q2" in errors:
        off = max(errors["q1"], errors["q2"])
        errors |= {key: error + _OF_LOCKED * off for key, error in errors.items() if key in END_KEYS}
        errors["p"] = math.hypot(errors["p"], _P_OF_LOCKED * off)
    return errors


def _stick_end_strengths(solution: MeshSolution) -> Array:
    """Strengths of the kinks of q = (q2 - q1)/2 at the ends of the stick zone, (2,), relative to the L2 norm of q.

    Lengths are in contact half-widths.
    """
    assert solution.history
    change = solution.history.change / 2
    strengths: Array = _strengths(solution, [change], solution.zone_ends[2:4])[0] * solution.half_width
    norm = float(_norms(solution)[0])
    return strengths / norm if norm > 0 else 0 * strengths


def stick_element_size(solution: MeshSolution, gaps: Array, error: float) -> float:
    """Element size for which the ends of the stick zone are known to ``error``; both in contact half-widths.

    Either the size is small enough beside the ``gaps`` (:func:`partialslip_fem.goals.gaps`), or the element itself is
    as small as the error. Infinite without a stick zone in ``solution``.
    """
    if not solution.stick:
        return np.inf
    beside = float(np.cbrt(error * (gaps[:, 2:4] ** 2).min(axis=1) / _FIT).min())
    return max(beside, error / _SIDE)


def kink_sizes(solution: MeshSolution, error: float) -> Array:
    """Element size at each of ``solution.kinks``, (j,), in contact half-widths, for an ``error`` of q1 and q2."""
    if not solution.kinks or not solution.history:
        return np.empty(0)
    norms = np.maximum(_norms(solution)[1:], np.finfo(float).tiny)
    relative = (
        _KINK * _kink_strengths(solution)[1:] * solution.half_width * math.sqrt(len(solution.kinks)) / norms[:, None]
    )
    return error / np.maximum(relative.max(axis=0), np.finfo(float).tiny)


def _norms(solution: MeshSolution) -> Array:
    """L2 norms of the cell means of (q2 - q1)/2, q1 and q2, (3,), at least ``LEAST_SHEAR`` of the norm of f p."""
    history = solution.history
    assert history
    norms = [_norm(solution.shear(forces)) for forces in (history.change / 2, history.q1, history.q2)]
    return np.maximum(norms, LEAST_SHEAR * _norm(solution.shear(history.bound)))


def _prefactors(solution: MeshSolution) -> dict[str, float]:
    """Prefactors of the errors of shear, by key: less than one where shear is small beside f p."""
    if not solution.history:
        return {}
    relative = _norms(solution) / _norm(solution.shear(solution.history.bound))
    return dict(zip(_SHEARS, np.minimum(relative / _NARROW, 1.0).tolist(), strict=True))


def _norm(traction: PPoly) -> float:
    force = np.diff(traction.antiderivative()(traction.x))
    return float(np.sqrt(np.sum(force**2 / np.diff(traction.x))))


def _kink_errors(solution: MeshSolution, sizes: Array) -> list[float]:
    """L2 errors of (q2 - q1)/2, q1 and q2 due to elements of ``sizes`` (j,) at the kinks of ``solution``; where an end
    of the stick zone reversed, the kink is smeared to the nearest vertex."""
    inside = solution.inside(np.array(solution.kinks))
    parts = np.where(_turned(solution), _TURNED_KINK * inside, _KINK)
    return np.hypot.reduce(parts * _kink_strengths(solution) * sizes, axis=1).tolist()


def _kink_strengths(solution: MeshSolution) -> Array:
    """Strengths of the kinks of (q2 - q1)/2, q1 and q2, (3, j).

    (q2 - q1)/2 has a kink only where an end of the stick zone reversed; this point is known to half a node distance,
    and the strength is the largest within it.
    """
    history, kinks, turned = solution.history, np.array(solution.kinks), _turned(solution)
    assert history
    shears, half = [history.change / 2, history.q1, history.q2], _between_nodes(solution) / 2
    found = _strengths(solution, shears, kinks)
    beside = [_strengths(solution, shears, kinks + way * half) for way in (-1, 1)]
    found = np.where(turned, np.maximum.reduce([found, *beside]), found)
    found[0, ~turned] = 0.0
    return found


def _turned(solution: MeshSolution) -> Mask:
    """Whether an end of the stick zone reversed at each of the kinks of ``solution``, (j,)."""
    apart = np.abs(np.subtract.outer(np.array(solution.kinks), solution.turning))
    return (apart <= _between_nodes(solution)[:, None]).any(axis=1)


def _between_nodes(solution: MeshSolution) -> Array:
    """Distances of the nodes between which the kinks of ``solution`` lie, (j,)."""
    x = solution.lower.x[solution.nodes]
    after = np.clip(np.searchsorted(x, solution.kinks), 1, len(x) - 1)
    return x[after] - x[after - 1]


def _strengths(solution: MeshSolution, shears: Sequence[Array], points: Array) -> Array:
    """Strengths of kinks at ``points`` (k,) in the tractions of the nodal forces ``shears``, (s, k).

    The strength is the factor c of c sqrt(distance), which the traction gains on one side of the point. The forces on
    two intervals of length d on either side of the point differ by slope d^2 + 2/3 c d^(3/2). Intervals of half the
    length separate the two terms.
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
    """Steepness of p at the ends of the contact, relative to Hertz contact; the larger of both ends.

    Steepness is the factor of the square root of the distance from the end over the RMS of p. The factor follows from
    the force on the cell at the end and the next cell.
    """
    p, contact_ends = solution.pressure(), np.array([solution.left, solution.right])
    force = p.antiderivative()
    rms = np.sqrt(np.sum(np.diff(force(p.x)) ** 2 / np.diff(p.x)) / (2 * solution.half_width))
    cells = np.clip(np.searchsorted(p.x, contact_ends) - 1, 1, len(p.x) - 3)
    inside = p.x[cells + np.array([2, -1])]
    forces = np.abs(force(p.x[[0, -1]]) - force(inside))
    return float(np.max(1.5 * forces / np.abs(inside - contact_ends) ** 1.5) * np.sqrt(solution.half_width / 3) / rms)


def _changes(solution: MeshSolution, other: MeshSolution) -> dict[str, float]:
    a = solution.half_width
    ends = np.abs(np.subtract(solution.contact_ends, other.contact_ends)).max(axis=0) / a
    changes = {"a": abs(other.half_width - a) / a, "left": float(ends[0]), "right": float(ends[1])}
    pressure = solution.pressure()
    changes["p"] = _difference(pressure, other.pressure(), _norm(pressure))
    if solution.stick and other.stick and solution.history and other.history:
        changes["m"] = abs(other.stick.left - solution.stick.left) / a
        changes["n"] = abs(other.stick.right - solution.stick.right) / a
        for key, (of, at), norm in zip(_SHEARS, _shears(solution, other), _norms(solution).tolist(), strict=True):
            changes[key] = _difference(of, at, norm)
    return {key: changes[key] for key in KEYS if key in changes}


def _shears(*solutions: MeshSolution) -> Iterator[tuple[PPoly, ...]]:
    """(q2 - q1)/2, q1 and q2, in turn, of each of the ``solutions``."""
    for share, key in ((0.5, "change"), (1.0, "q1"), (1.0, "q2")):
        yield tuple(solution.shear(share * getattr(solution.history, key)) for solution in solutions)


def _difference(traction: PPoly, other: PPoly, norm: float) -> float:
    """L2 difference of the cell means of two tractions, relative to ``norm``."""
    widths = np.diff(traction.x)
    force, otherwise = (np.diff(each.antiderivative()(traction.x)) for each in (traction, other))
    return float(np.sqrt(np.sum((otherwise - force) ** 2 / widths))) / norm if norm > 0 else 0.0
