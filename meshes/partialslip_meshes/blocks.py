"""Mesh a block with a flat or round face, graded to points on its contact line, and the holder below it."""

from collections.abc import Callable, Mapping
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from partialslip_meshes.gmsh import ask
from partialslip_meshes.grading import Eased, formula, in_effect
from partialslip_meshes.mesh import Mesh, QuadMesh

# fixed: Squares of the largest ratio of neighbours on a line: gmsh's own, and one above all that the sizes ask for
_SMOOTH, _UNSMOOTHED = 1.8, 4.0
_NOTCH_SIZE = 0.02  # accuracy: element size in the notch between block and holder, in the block's half-width

Corner = Literal["foot", "shoulder", "notch"]
Face = Callable[[npt.NDArray[np.float64]], npt.NDArray[np.float64]]
Meshed = tuple[npt.NDArray[np.float64], npt.NDArray[np.int64], dict[str, npt.NDArray[np.int64]], float]


def block(
    width: float,
    contact: tuple[float, float],
    sizes: Mapping[float, float],
    growth: float,
    height: float | None = None,
    along: float | None = None,
    holder: tuple[float, float] | None = None,
    face: Face | None = None,
    facets: float | None = None,
    corners: Mapping[Corner, float] | None = None,
    eased: Eased | None = None,
) -> Mesh:
    """Mesh the block [-width, width] x [-height, 0].

    Parameters
    ----------
    width : float
        Half-width of the block, and its height if none is given.
    contact : (float, float)
        Ends of the line "contact" on y = 0. The rest of this side is the line "face". The bottom, of the holder if
        there is one, is "back"; the sides next to it are "left" and "right"; all other sides are "flanks".
    sizes : mapping of float to float
        Element size by point x on the contact line. Every point becomes a vertex.
    growth : float
        Element size gained per unit of distance from each point: the number of elements grows with the logarithm of
        the width.
    height : float, optional
        Height of the block; by default its half-width.
    along : float, optional
        Element size all along the contact line, from which it grows in the same way.
    holder : (float, float), optional
        Half-width and height of a second block below the first, joined to it.
    face : callable, optional
        Depth of the curved face below y = 0 at x, from 0 to less than the height.
    facets : float, optional
        Largest element size on the face, divided by the distance from the middle of the contact line or by half of the
        line's length, whichever is larger.
    corners : mapping of str to float, optional
        Element sizes at corners on both sides: "foot" (ends of the back), "shoulder" (upper ends of "left" and
        "right"), "notch" (between block and holder).
    eased : Eased, optional
        Larger growth near the points of ``sizes``.

    Raises
    ------
    MissingLibraryError
        If gmsh, or a system library that gmsh needs, is missing.
    PartialslipError
        If gmsh cannot make the mesh, or the gmsh process dies twice.
    """
    outline = (width, contact, sizes, growth, height, along, holder, face, facets, corners, eased)
    return Mesh(*_outlined(3, *outline))


def quad_block(
    width: float,
    contact: tuple[float, float],
    sizes: Mapping[float, float],
    growth: float,
    along: float | None = None,
    height: float | None = None,
    holder: tuple[float, float] | None = None,
    face: Face | None = None,
    corners: Mapping[Corner, float] | None = None,
) -> QuadMesh:
    """Mesh the block [-width, width] x [-height, 0] with quadrilaterals. Arguments and errors as for :func:`block`."""
    outline = (width, contact, sizes, growth, height, along, holder, face, None, corners)
    return QuadMesh(*_outlined(4, *outline)[:3])


def _outlined(
    nodes: int,
    width: float,
    contact: tuple[float, float],
    sizes: Mapping[float, float],
    growth: float,
    height: float | None,
    along: float | None,
    holder: tuple[float, float] | None,
    face: Face | None,
    facets: float | None,
    corners: Mapping[Corner, float] | None,
    eased: Eased | None = None,
) -> Meshed:
    """Mesh of the block of :func:`block` with elements of ``nodes`` nodes each."""
    height = width if height is None else height
    at_corners: dict[Corner, float] = {"notch": _NOTCH_SIZE * width} if holder else {}
    at_corners.update(corners or {})
    formulas = {corner: formula(size, growth) for corner, size in at_corners.items()}
    outline = {"width": width, "height": height, "holder": holder, "facets": facets, "at_corners": formulas}
    points, elements, lines, cpu_s = _made(nodes, contact, sizes, growth, along, eased, **outline)
    if face:
        x, y = points.T
        points[:, 1] -= face(np.clip(x, -width, width)) * np.maximum(1 + y / height, 0.0)
    return points, elements, lines, cpu_s


def _made(
    corners: int,
    contact: tuple[float, float],
    sizes: Mapping[float, float],
    growth: float,
    along: float | None,
    eased: Eased | None,
    **outline: Any,
) -> Meshed:
    """Points, elements with so many ``corners``, named lines, and CPU seconds of a mesh; nodes are numbered from 0."""
    formulas = [(x, formula(size, growth, eased)) for x, size in sizes.items()]
    outline["smooth"] = _UNSMOOTHED if in_effect(eased, growth) else _SMOOTH
    request = {"contact": contact, "sizes": formulas, "growth": growth, "along": along, **outline}
    head, (tags, coordinates, elements, *lines) = ask({"corners": corners, **request})
    named = np.frombuffer(tags, dtype=np.uint64).astype(np.int64)
    number = np.zeros(int(named.max()) + 1, dtype=np.int64)
    number[named] = np.arange(len(named))

    def cells(nodes: bytes, corners: int) -> npt.NDArray[np.int64]:
        return number[np.frombuffer(nodes, dtype=np.uint64).reshape(-1, corners)]

    return (
        np.ascontiguousarray(np.frombuffer(coordinates).reshape(-1, 3)[:, :2]),
        cells(elements, corners),
        {name: cells(nodes, 2) for name, nodes in zip(head["lines"], lines, strict=True)},
        head["cpu_s"],
    )
