"""Recipes: a block below the line y = 0, graded towards its contact line or points on it."""

from collections.abc import Mapping
from types import ModuleType

import numpy as np
import numpy.typing as npt

from partialslip_meshes.gmsh import gmsh_session
from partialslip_meshes.mesh import Mesh, QuadMesh

# triangles with right angles, paired, and what is left over split so that no triangle is
_ALL_QUADS = {"Algorithm": 8, "RecombineAll": 1, "RecombinationAlgorithm": 3}


def block(
    width: float,
    contact: tuple[float, float],
    sizes: Mapping[float, float],
    growth: float,
    height: float | None = None,
    along: float | None = None,
) -> Mesh:
    """Mesh the block [-width, width] x [-height, 0].

    Parameters
    ----------
    width : float
        Half-width of the block, and its height if none is given.
    contact : (float, float)
        Ends of the line "contact" on y = 0; the rest of that side is the line "face", the block's bottom is its "back",
        the other two are its "sides".
    sizes : mapping of float to float
        Points on the contact line, each to become a vertex, and the element size there.
    growth : float
        Element size gained per unit of distance from each point, so that a wide block costs no more than the
        logarithm of its width.
    height : float, optional
    along : float, optional
        Element size all along the contact line, from where it grows likewise.

    Raises
    ------
    MissingLibraryError
        If gmsh, or a system library that it needs, is not there.
    """
    with gmsh_session() as gmsh:
        lines = _outline(gmsh, width, width if height is None else height, contact, sizes, growth, along)
        gmsh.model.mesh.generate(2)
        return Mesh(*_collect(gmsh, lines, 3))


def quad_block(width: float, contact: tuple[float, float], sizes: Mapping[float, float], growth: float,
               along: float | None = None) -> QuadMesh:  # fmt: skip
    """Mesh the block [-width, width] x [-width, 0] with quadrilaterals only; parameters and what is raised as for
    :func:`block`."""
    with gmsh_session() as gmsh:
        lines = _outline(gmsh, width, width, contact, sizes, growth, along)
        for option, value in _ALL_QUADS.items():
            gmsh.option.setNumber(f"Mesh.{option}", value)
        gmsh.model.mesh.generate(2)
        return QuadMesh(*_collect(gmsh, lines, 4))


def _outline(
    gmsh: ModuleType,
    width: float,
    height: float,
    contact: tuple[float, float],
    sizes: Mapping[float, float],
    growth: float,
    along: float | None,
) -> dict[str, list[int]]:
    """Geometry and size field; returns the curves of each named line."""
    geo, field = gmsh.model.geo, gmsh.model.mesh.field
    on_contact = sorted({*contact, *sizes})
    surface = [geo.addPoint(x, 0, 0) for x in (-width, *on_contact, width)]
    bottom = [geo.addPoint(x, -height, 0) for x in (-width, width)]
    loop = [*bottom, *reversed(surface)]
    curves = [geo.addLine(start, end) for start, end in zip(loop, [*loop[1:], loop[0]], strict=True)]
    geo.addPlaneSurface([geo.addCurveLoop(curves)])
    geo.synchronize()

    grades = []
    for x, size in sizes.items():
        distance = field.add("Distance")
        field.setNumbers(distance, "PointsList", [surface[1 + on_contact.index(x)]])
        grades.append(field.add("MathEval"))
        field.setString(grades[-1], "F", f"{float(size)!r} + {float(growth)!r} * F{distance}")
    if along is not None:
        middle, half = (contact[0] + contact[1]) / 2, (contact[1] - contact[0]) / 2
        beyond = f"(abs(x - ({middle!r})) - {half!r})"
        grades.append(field.add("MathEval"))
        field.setString(grades[-1], "F", f"{along!r} + {growth!r} * sqrt(y^2 + ({beyond} + abs{beyond})^2 / 4)")
    smallest = field.add("Min")
    field.setNumbers(smallest, "FieldsList", grades)
    field.setAsBackgroundMesh(smallest)
    for other in ("MeshSizeExtendFromBoundary", "MeshSizeFromPoints", "MeshSizeFromCurvature"):
        gmsh.option.setNumber(f"Mesh.{other}", 0)

    return {
        "contact": curves[3:-2],
        "face": [curves[2], curves[-2]],
        "back": curves[:1],
        "sides": [curves[1], curves[-1]],
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
