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


def write_body(path: Path, body: QuadMesh) -> None:
    """Write the mesh of ``body`` to ``path``, with its lines as named groups.

    The suffix tells the format, as :func:`partialslip_meshes.read` reads it: .msh (physical groups), .inp (node sets),
    .med (groups; needs h5py) or .vtu (cell data, 1 on the line's edges).
    """
    names = list(body.lines)
    sizes = [len(edges) for edges in body.lines.values()]
    of_edges = np.repeat(np.arange(1, len(names) + 1), sizes)
    cells = [("quad", body.quads), ("line", np.concatenate([*body.lines.values()]))]
    points, suffix = _in_space(body.points), path.suffix
    if suffix == ".msh":
        numbers = [np.full(len(body.quads), len(names) + 1), of_edges]
        groups = {name: np.array([number, 1]) for number, name in enumerate(names, start=1)}
        groups["body"] = np.array([len(names) + 1, 2])
        data = {"gmsh:physical": numbers, "gmsh:geometrical": numbers}
        meshio.write(path, meshio.Mesh(points, cells, cell_data=data, field_data=groups), "gmsh22", binary=False)
    elif suffix == ".inp":
        path.write_text(_inp(body), "ascii")
    elif suffix == ".med":
        mesh = meshio.Mesh(body.points, cells, cell_data={"cell_tags": [np.zeros(len(body.quads), int), -of_edges]})
        mesh.cell_tags = {-number: [name] for number, name in enumerate(names, start=1)}
        meshio.write(path, mesh, "med")
    else:
        nowhere = np.zeros(len(body.quads))
        data = {name: [nowhere, 1.0 * (of_edges == number)] for number, name in enumerate(names, start=1)}
        meshio.write(path, meshio.Mesh(points, cells, cell_data=data), "vtu")


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


def _inp(body: QuadMesh) -> str:
    """``body`` as text for Abaqus and CalculiX; meshio writes quadrilaterals as axisymmetric."""
    lines = ["*NODE", *(f"{k}, {x:.12e}, {y:.12e}" for k, (x, y) in enumerate(body.points.tolist(), 1))]
    lines += ["*ELEMENT, TYPE=CPE4, ELSET=body"]
    lines += [", ".join(map(str, (k, *nodes))) for k, nodes in enumerate((body.quads + 1).tolist(), 1)]
    for name, edges in body.lines.items():
        lines += [f"*NSET, NSET={name}", *(f"{node}," for node in (np.unique(edges) + 1).tolist())]
    return "\n".join(lines) + "\n"


def _in_space(plane: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    return np.column_stack([plane, np.zeros(len(plane))])
