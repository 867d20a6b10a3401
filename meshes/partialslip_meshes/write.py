"""Write meshes and displaced bodies with meshio."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import meshio
import numpy as np
import numpy.typing as npt

from partialslip.result import DeformedBody
from partialslip_meshes.mesh import QuadMesh


def write_msh(path: Path, body: DeformedBody) -> None:
    """Write the mesh of ``body`` to ``path`` for gmsh, with physical groups named after the body and its lines."""
    cells = [("triangle", body.triangles), *(("line", line) for line in body.lines.values())]
    numbers = [np.full(len(block), number) for number, (_, block) in enumerate(cells, start=1)]
    groups = {body.name: np.array([1, 2])}
    groups |= {name: np.array([number, 1]) for number, name in enumerate(body.lines, start=2)}
    mesh = meshio.Mesh(
        _in_space(body.points),
        cells,
        cell_data={"gmsh:physical": numbers, "gmsh:geometrical": numbers},
        field_data=groups,
    )
    meshio.write(path, mesh, file_format="gmsh22", binary=True)  # meshio writes broken ASCII under NumPy 2


def write_quads(path: Path, bodies: Mapping[str, QuadMesh]) -> None:
    """Write the meshes of ``bodies``, by name, to the text file ``path`` for gmsh.

    Physical groups are NAME for the quadrilaterals of a body and NAME-LINE for each of its lines.
    """
    first = np.cumsum([0, *(len(mesh.points) for mesh in bodies.values())])
    blocks: list[tuple[str, npt.NDArray[np.int64]]] = []
    groups: dict[str, npt.NDArray[np.int64]] = {}
    for start, (name, mesh) in zip(first.tolist(), bodies.items(), strict=False):
        groups[name] = np.array([len(groups) + 1, 2])
        blocks.append(("quad", mesh.quads + start))
        for line, edges in mesh.lines.items():
            groups[f"{name}-{line}"] = np.array([len(groups) + 1, 1])
            blocks.append(("line", edges + start))
    numbers = [np.full(len(block), number) for number, (_, block) in enumerate(blocks, start=1)]
    mesh = meshio.Mesh(
        _in_space(np.vstack([mesh.points for mesh in bodies.values()])),
        blocks,
        cell_data={"gmsh:physical": numbers, "gmsh:geometrical": numbers},
        field_data=groups,
    )
    meshio.write(path, mesh, file_format="gmsh22", binary=False)


def write_vtu(path: Path, bodies: Sequence[DeformedBody]) -> None:
    """Write ``bodies`` to the file ``path``: displacements at points; stresses and the index ``body`` on cells."""
    first = np.cumsum([0, *(len(body.points) for body in bodies)])
    triangles = [body.triangles + start for body, start in zip(bodies, first, strict=False)]
    names = bodies[0].displacements
    stresses = {name: [np.vstack([body.stresses[name] for body in bodies])] for name in bodies[0].stresses}
    mesh = meshio.Mesh(
        _in_space(np.vstack([body.points for body in bodies])),
        [("triangle", np.vstack(triangles))],
        point_data={name: _in_space(np.vstack([body.displacements[name] for body in bodies])) for name in names},
        cell_data={"body": [np.repeat(np.arange(len(bodies)), [len(block) for block in triangles])]} | stresses,
    )
    meshio.write(path, mesh, file_format="vtu")


def _in_space(plane: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    return np.column_stack([plane, np.zeros(len(plane))])
