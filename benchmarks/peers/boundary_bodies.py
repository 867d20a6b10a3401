"""What the shape of a body adds to the displacements of its contact line: boundary elements of a whole body.

A point force on the surface of a half-plane has the stresses and displacements of Flamant (K. L. Johnson, Contact
Mechanics, 1985, sections 2.2 and 2.3). A body of a size is not a half-plane: its other faces are free, held or guided.
What must be added there is smooth along the contact. It is found by the direct method of C. A. Brebbia and
J. Dominguez (Boundary Elements, 1992): Kelvin's solution in plane strain, constant elements, collocation at their
middles. The script boundary.py uses this module; both import nothing of partialslip.
"""

import itertools
from typing import Any, NamedTuple

import numpy as np

Array = np.ndarray[Any, np.dtype[Any]]

PLACES = 9  # Chebyshev points along the contact, for forces and for displacements
DEGREE = 8  # of the polynomials of displacements along the contact
GAUSS = 16  # points of an element
# of elements: size beside the contact, a; size at a corner, in the length of the side; and how it rises with distance
NEAR, CORNER, GROWTH = 0.12, 0.004, 0.025
FREE, HELD = 0, 1  # what a side prescribes along x and along z: traction, or displacement


class Side(NamedTuple):
    """Points (k, 2) of a side, in turn: the contact's from -x to x, and on around the body; all lengths are in a. And
    what the side ``prescribes`` along x and z."""

    points: Array
    prescribes: tuple[int, int]


def sides_of(body: dict[str, Any], a: float, R: float) -> list[Side]:
    """Sides of a block or a pad of the benchmark, lengths in m; the first one is that of the contact."""
    width, height = body["width"] / a / 2, body["height"] / a
    holder = body.get("holder", {})
    x, curved = _along(width), a / R if body["kind"] == "pad" else 0.0
    top = np.column_stack([x, curved * x**2 / (1 + np.sqrt(1 - (curved * x) ** 2))])
    corners = [top[-1], np.array([width, height])]
    if holder:
        width, height = holder["width"] / a / 2, height + holder["height"] / a
        corners += [np.array([width, corners[-1][1]]), np.array([width, height])]
    corners += [corner * (-1, 1) for corner in corners[::-1]]
    back = len(corners) // 2 - 1  # of the sides between corners
    prescribes = [(FREE, FREE)] * (len(corners) - 1)
    prescribes[back] = (FREE, HELD) if body["support"] == "roller" else (HELD, HELD)
    if body.get("pulled"):  # along x: the right side by the tension, whose strain is uniform; the left side is held
        prescribes[-1] = (HELD, FREE)
    straight = [
        Side(_straight(*ends), what) for ends, what in zip(itertools.pairwise(corners), prescribes, strict=True)
    ]
    return [Side(top, (FREE, FREE)), *straight]


def _along(width: float) -> Array:
    """Ends of the elements of the contact's side: small beside the contact and at the corners."""
    x = np.linspace(0, width, 20001)
    sizes = np.minimum(NEAR + GROWTH * x, CORNER * width + GROWTH * (width - x))
    half = _spaced(x, sizes)
    return np.concatenate([-half[:0:-1], half])


def _straight(start: Array, end: Array) -> Array:
    """Ends of the elements of another side: small at the corners."""
    share = np.linspace(0, 1, 20001)
    shares = _spaced(share, CORNER + GROWTH * np.minimum(share, 1 - share))
    return start + shares[:, None] * (end - start)


def _spaced(x: Array, sizes: Array) -> Array:
    """Points from the first to the last ``x`` whose distances are about ``sizes``."""
    numbers = np.concatenate([[0], np.cumsum(np.diff(x) * 2 / (sizes[1:] + sizes[:-1]))])
    return np.interp(np.linspace(0, numbers[-1], int(np.ceil(numbers[-1])) + 1), numbers, x)


def added(body: dict[str, Any], nu: float, reach: float, a: float, R: float) -> tuple[Array, Array]:
    """Displacements that the shape of a body adds along the contact; x is along the contact, and z into the body.

    Parameters
    ----------
    body : dict
        Table of the problem.
    nu : float
    reach : float
        Half-width of the part of the contact line that is asked for, a.
    a, R : float
        m.

    Returns
    -------
    (PLACES,) array, (PLACES, 2, PLACES, 2) array
        Places x, and the displacement along x or z at a place by a unit force along x or z at another, times
        E/(2 (1 - nu^2)).
    """
    sides = sides_of(body, a, R)
    starts = np.concatenate([side.points[:-1] for side in sides])
    ends = np.concatenate([side.points[1:] for side in sides])
    held = np.concatenate([np.tile(side.prescribes, (len(side.points) - 1, 1)) for side in sides]).astype(bool)
    middles, along = (starts + ends) / 2, ends - starts
    lengths = np.hypot(*along.T)
    normals = np.column_stack([along[:, 1], -along[:, 0]]) / lengths[:, None]
    G, H = _matrices(middles, starts, along, lengths, normals, nu)
    count, curved = len(middles), a / R if body["kind"] == "pad" else 0.0
    known = held.ravel()
    matrix = np.where(known, -G, H)
    places = reach * np.cos((np.arange(PLACES) + 0.5) / PLACES * np.pi)[::-1]
    on_top = np.arange(len(sides[0].points) - 1)
    forces = []
    for x in places:
        r = middles - [x, x**2 * curved / 2]
        # a chord and its circle meet at half the angle of the arc: middles of elements lie beside the circle
        passed = (r * normals).sum(axis=1) / (r**2).sum(axis=1)
        passed[on_top] = curved / 2
        for way in (0, 1):
            u, t = flamant(r, passed, way, nu)
            forces.append(np.where(held, -u, -t).ravel())
    given = np.column_stack(forces)
    solution = np.linalg.solve(matrix, np.where(known, -H, G) @ given)
    moved = np.where(known[:, None], given, solution).reshape(count, 2, PLACES, 2)[on_top]
    near = np.abs(middles[on_top, 0]) < 1.5 * reach
    fitted = np.polynomial.chebyshev.chebfit(
        middles[on_top, 0][near] / reach, moved[near].reshape(near.sum(), -1), DEGREE
    )
    found = np.polynomial.chebyshev.chebval(places / reach, fitted).T
    return places, found.reshape(PLACES, 2, PLACES, 2) + of_arc(places, curved, nu)


def of_arc(places: Array, curved: float, nu: float) -> Array:
    """Flamant's displacements at ``places`` (k,) of an arc of curvature ``curved``, by forces at these places, less
    those on a plane, of first order in the slope of the chord: (k, 2, k, 2), like those of :func:`added`. Kelvin's
    elements have what the tractions add that Flamant's forces leave on the arc."""
    slopes = curved * np.add.outer(places, places) / 2
    found = np.zeros((len(places), 2, len(places), 2))
    found[:, 0, :, 1], found[:, 1, :, 0] = slopes / np.pi, slopes * nu / (1 - nu) / np.pi
    return found


def flamant(r: Array, passed: Array, way: int, nu: float) -> tuple[Array, Array]:
    """Displacements and tractions (k, 2) at ``r`` (k, 2) from a unit force on a half-plane, along x or z by ``way``, of
    a material with E = 2 (1 - nu^2). ``passed`` (k,) is the normal times r over r squared."""
    size = np.hypot(*r.T)
    e = r / size[:, None]
    t = -2 / np.pi * (e[:, way] * passed)[:, None] * e
    angle = np.arctan2(e[:, 0], e[:, 1])  # from z; from x it is a quarter turn less
    angle = angle if way else np.pi / 2 - angle
    cos, sin, log = np.cos(angle), np.sin(angle), np.log(size)
    b, c = (1 - 2 * nu) / (2 * (1 - nu)) / np.pi, nu / (1 - nu) / np.pi  # (1 - 2 nu) (1 + nu)/E, 2 nu (1 + nu)/E
    radial = -cos * log / np.pi - b * angle * sin
    around = sin * log / np.pi + c * sin - b * angle * cos + b * sin
    across = np.column_stack([e[:, 1], -e[:, 0]]) if way else np.column_stack([-e[:, 1], e[:, 0]])
    return radial[:, None] * e + around[:, None] * across, t


def _matrices(
    middles: Array, starts: Array, along: Array, lengths: Array, normals: Array, nu: float
) -> tuple[Array, Array]:
    """Matrices (2 n, 2 n) of tractions and of displacements: H u = G t."""
    count, shear = len(middles), 1 - nu  # of E = 2 (1 - nu^2)
    nodes, weights = np.polynomial.legendre.leggauss(GAUSS)
    G, H = np.zeros((2, count, 2, count, 2))
    one = np.eye(2)
    for node, weight in zip((nodes + 1) / 2, weights / 2, strict=True):
        r = starts + node * along - middles[:, None]  # from each collocation point to each element
        size = np.sqrt((r**2).sum(axis=-1))
        e = r / size[..., None]
        over = weight * lengths
        ee = e[..., :, None] * e[..., None, :]
        U = (ee - (3 - 4 * nu) * np.log(size)[..., None, None] * one) / (8 * np.pi * shear * (1 - nu))
        across = (e * normals).sum(axis=-1)[..., None, None]
        turned = e[..., :, None] * normals[:, None, :] - normals[:, :, None] * e[..., None, :]
        T = across * ((1 - 2 * nu) * one + 2 * ee) - (1 - 2 * nu) * turned
        T /= -4 * np.pi * (1 - nu) * size[..., None, None]
        G += (U * over[:, None, None]).transpose(0, 2, 1, 3)
        H += (T * over[:, None, None]).transpose(0, 2, 1, 3)
    for k in range(count):  # an element on itself: the logarithm is exact, and the traction has no principal value
        tangent = along[k] / lengths[k]
        log = (3 - 4 * nu) * lengths[k] * (1 - np.log(lengths[k] / 2))
        G[k, :, k] = (log * one + lengths[k] * np.outer(tangent, tangent)) / (8 * np.pi * shear * (1 - nu))
        H[k, :, k] = one / 2
    return G.reshape(2 * count, -1), H.reshape(2 * count, -1)
