"""Recipes: a block below its face, flat or round, graded towards points on its contact line; and its holder."""

from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Literal

import numpy as np
import numpy.typing as npt

from partialslip_meshes.gmsh import gmsh_session
from partialslip_meshes.mesh import Mesh, QuadMesh

# triangles with right angles, paired, and what is left over split so that no triangle is
_ALL_QUADS = {"Algorithm": 8, "RecombineAll": 1, "RecombinationAlgorithm": 3}

_CORNER = 0.02  # element size in the notch between block and holder, in the block's half-width

Corner = Literal["foot", "shoulder", "notch"]


def block(
    width: float,
    contact: tuple[float, float],
    sizes: Mapping[float, float],
    growth: float,
    height: float | None = None,
    along: float | None = None,
    holder: tuple[float, float] | None = None,
    face: Callable[[npt.NDArray[np.float64]], npt.NDArray[np.float64]] | None = None,
    facets: float | None = None,
    corners: Mapping[Corner, float] | None = None,
) -> Mesh:
    """Mesh the block [-width, width] x [-height, 0].

    Parameters
    ----------
    width : float
        Half-width of the block, and its height if none is given.
    contact : (float, float)
        Ends of the line "contact" on y = 0; the rest of that side is the line "face", the bottom, of the holder if
        there is one, is the "back", the sides beside it are "left" and "right", and all else "flanks".
    sizes : mapping of float to float
        Points on the contact line, each to become a vertex, and the element size there.
    growth : float
        Element size gained per unit of distance from each point, so that a wide block costs no more than the
        logarithm of its width.
    height : float, optional
    along : float, optional
        Element size all along the contact line, from where it grows likewise.
    holder : (float, float), optional
        Half-width and height of a block below the first one, and one piece with it.
    face : callable, optional
        How far the side y = 0 is to lie back at x instead, from 0 to less than the height.
    facets : float, optional
        The largest element size on that side, in the distance from the middle of the contact line or half of that
        line's length, whichever is larger.
    corners : mapping of str to float, optional
        Element sizes on both sides at the "foot" (an end of the back), at the "shoulder" (the upper end of the sides
        "left" and "right"), and in the "notch" between block and holder.

    Raises
    ------
    MissingLibraryError
        If gmsh, or a system library that it needs, is not there.
    """
    height = width if height is None else height
    with gmsh_session() as gmsh:
        lines = _outline(gmsh, (width, height), holder, contact, sizes, growth, along, facets, corners or {})
        gmsh.model.mesh.generate(2)
        mesh = Mesh(*_collect(gmsh, lines, 3))
    if face:
        x, y = mesh.points.T
        mesh.points[:, 1] -= face(np.clip(x, -width, width)) * np.maximum(1 + y / height, 0.0)
    return mesh


def quad_block(width: float, contact: tuple[float, float], sizes: Mapping[float, float], growth: float,
               along: float | None = None) -> QuadMesh:  # fmt: skip
    """Mesh the block [-width, width] x [-width, 0] with quadrilaterals only; parameters and what is raised as for
    :func:`block`."""
    with gmsh_session() as gmsh:
        lines = _outline(gmsh, (width, width), None, contact, sizes, growth, along, None, {})
        for option, value in _ALL_QUADS.items():
            gmsh.option.setNumber(f"Mesh.{option}", value)
        gmsh.model.mesh.generate(2)
        return QuadMesh(*_collect(gmsh, lines, 4))


def _outline(
    gmsh: ModuleType,
    size: tuple[float, float],
    holder: tuple[float, float] | None,
    contact: tuple[float, float],
    sizes: Mapping[float, float],
    growth: float,
    along: float | None,
    facets: float | None,
    at_corners: Mapping[Corner, float],
) -> dict[str, list[int]]:
    """Geometry and size field; returns the curves of each named line."""
    geo, field = gmsh.model.geo, gmsh.model.mesh.field
    width, height = size
    on_contact = sorted({*contact, *sizes})
    # corners of the right side, from the back to the face
    corners = [(width, -height), (width, 0.0)]
    if holder:
        foot = (holder[0], -height)
        corners = [(holder[0], -height - holder[1]), *([foot] if foot != corners[0] else []), *corners]
    right = [geo.addPoint(x, y, 0) for x, y in corners]
    left = [geo.addPoint(-x, y, 0) for x, y in corners]
    surface = [left[-1], *(geo.addPoint(x, 0, 0) for x in on_contact), right[-1]]
    loop = [*right, *reversed(surface[1:-1]), *reversed(left)]
    curves = [geo.addLine(start, end) for start, end in zip(loop, [*loop[1:], loop[0]], strict=True)]
    geo.addPlaneSurface([geo.addCurveLoop(curves)])
    geo.synchronize()

    starts = {surface[1 + on_contact.index(x)]: size for x, size in sizes.items()}
    places: dict[Corner, int] = {"foot": 0, "shoulder": 1 if holder else -1}
    if holder and holder[0] != width:
        places["notch"] = 1 if holder[0] < width else 2
        at_corners = {"notch": _CORNER * width, **at_corners}
    for corner, size_there in at_corners.items():
        starts |= {side[places[corner]]: size_there for side in (left, right)}
    grades = []
    for point, size_there in starts.items():
        distance = field.add("Distance")
        field.setNumbers(distance, "PointsList", [point])
        grades.append(field.add("MathEval"))
        field.setString(grades[-1], "F", f"{float(size_there)!r} + {float(growth)!r} * F{distance}")
    middle, half = (contact[0] + contact[1]) / 2, (contact[1] - contact[0]) / 2
    beyond = f"(abs(x - ({middle!r})) - {half!r})"
    if along is not None:
        grades.append(field.add("MathEval"))
        field.setString(grades[-1], "F", f"{along!r} + {growth!r} * sqrt(y^2 + ({beyond} + abs{beyond})^2 / 4)")
    if facets is not None:
        grades.append(field.add("MathEval"))
        field.setString(
            grades[-1], "F", f"{facets!r} * ({half!r} + ({beyond} + abs{beyond}) / 2) + {growth!r} * abs(y)"
        )
    smallest = field.add("Min")
    field.setNumbers(smallest, "FieldsList", grades)
    field.setAsBackgroundMesh(smallest)
    for other in ("MeshSizeExtendFromBoundary", "MeshSizeFromPoints", "MeshSizeFromCurvature"):
        gmsh.option.setNumber(f"Mesh.{other}", 0)

    up = len(corners) - 1  # curves of a side
    return {
        "contact": curves[up + 1 : -up - 2],
        "face": [curves[up], curves[-up - 2]],
        "back": curves[-1:],
        "left": [curves[-2]],
        "right": curves[:1],
        **({"flanks": [*curves[1:up], *curves[-up - 1 : -2]]} if up > 1 else {}),
    }


def _collect(
    gmsh: ModuleType, lines: Mapping[str, list[int]], corners: int
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64], dict[str, npt.NDArray[np.int64]]]:
    """Points, elements of so many corners, and named lines of the mesh in gmsh, with the nodes numbered from zero."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    number = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    number[tags] = np.arange(len(tags))

    def cells(dimension: int, entity: int, corners: int) -> npt.NDArray[np.int64]:
        _, _, nodes = gmsh.model.mesh.getElements(dimension, entity)
        result: npt.NDArray[np.int64] = number[nodes[0].reshape(-1, corners)]
        return result

    return (
        np.ascontiguousarray(coordinates.reshape(-1, 3)[:, :2]),
        cells(2, -1, corners),
        {name: np.vstack([cells(1, curve, 2) for curve in curves]) for name, curves in lines.items()},
    )
