"""What a mesh file has: nodes, plane elements, and named groups of nodes, edges and elements."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import meshio

Indices = npt.NDArray[np.int64]

_PHYSICAL, _FAMILY = "gmsh:physical", "cell_tags"


@dataclass
class Group:
    """Members of a group ``name``: indices of nodes, edges (e, 2) by their nodes, and numbers of elements. ``fault``
    says why it cannot be read, which matters only to who asks for it."""

    name: str
    nodes: list[Indices] = field(default_factory=list)
    edges: list[Indices] = field(default_factory=list)
    elements: list[Indices] = field(default_factory=list)
    fault: str = ""


@dataclass
class Found:
    """Content of a mesh file.

    Parameters
    ----------
    points : (n, 2) or (n, 3) array
    cells : list of (str, (c, k) array)
        Type, as meshio names it, and nodes of blocks of elements. Elements are numbered through all blocks.
    groups : dict
        By name in lower case, or number as text.
    """

    points: npt.NDArray[np.float64]
    cells: list[tuple[str, Indices]] = field(default_factory=list)
    groups: dict[str, Group] = field(default_factory=dict)

    def group(self, name: str) -> Group:
        """The group ``name``, which is added if there is none."""
        name = name.strip(" \0")  # of fixed length in .med
        return self.groups.setdefault(name.lower(), Group(name))

    def named(self, bodies: bool) -> str:
        """Names of the groups of elements (``bodies``), or of nodes and edges, for messages."""
        names = [
            group.name
            for group in self.groups.values()
            if any(map(len, group.elements if bodies else [*group.nodes, *group.edges]))
        ]
        names = [name for name in names if not name.isdecimal()] or names  # numbers where nothing has a name
        return ", ".join([*names[:_MOST], *(["..."] if len(names) > _MOST else [])])


_MOST = 12  # display: names of groups in a message


def from_meshio(mesh: "meshio.Mesh") -> Found:
    """Return the content of a ``mesh`` that meshio has read.

    Groups are physical groups, by name and by number (.msh), families (.med), sets, and data that are not zero, of
    cells or of points (any format).
    """
    found = Found(np.asarray(mesh.points, dtype=float))
    begin = 0
    for block, cells in enumerate(mesh.cells):
        nodes = np.asarray(cells.data, dtype=np.int64)
        line, vertex = cells.type.startswith("line"), cells.type == "vertex"
        for name, inside in _members(mesh, block, cells.type):
            group = found.group(name)
            if line:
                group.edges.append(nodes[inside][:, :2])
            elif vertex:
                group.nodes.append(nodes[inside].ravel())
            else:
                group.elements.append(begin + np.arange(len(nodes))[inside])
        if not (line or vertex):
            found.cells.append((cells.type, nodes))
            begin += len(nodes)
    for name, members in _nodes(mesh):
        found.group(name).nodes.append(members)
    return found


def _members(mesh: "meshio.Mesh", block: int, kind: str) -> Iterator[tuple[str, Indices]]:
    """Name of each group, and which cells of the ``block`` of a ``kind`` it has."""
    dimension = 0 if kind == "vertex" else 1 if kind.startswith("line") else 2
    for key, values in mesh.cell_data.items():
        data = np.asarray(values[block])
        if key == _PHYSICAL:
            names = {int(each[0]): name for name, each in mesh.field_data.items() if int(each[-1]) == dimension}
            for number in np.unique(data[data != 0]).tolist():
                yield from (
                    (name, np.flatnonzero(data == number)) for name in {str(number), names.get(number, "")} - {""}
                )
        elif key == _FAMILY:
            for number, names in getattr(mesh, _FAMILY, {}).items():
                yield from ((name, np.flatnonzero(data == number)) for name in names)
        elif not key.startswith("gmsh:"):
            yield key, np.flatnonzero(data.reshape(len(data), -1).any(axis=1))
    for name, members in mesh.cell_sets.items():
        if not name.startswith("gmsh:") and len(members) > block and members[block] is not None:
            yield name, np.asarray(members[block], dtype=np.int64)


def _nodes(mesh: "meshio.Mesh") -> Iterator[tuple[str, Indices]]:
    """Name and members of each group of nodes."""
    for key, values in mesh.point_data.items():
        data: npt.NDArray[Any] = np.asarray(values)
        if key == "point_tags":
            for number, names in getattr(mesh, "point_tags", {}).items():
                yield from ((name, np.flatnonzero(data == number)) for name in names)
        elif not key.startswith("gmsh:"):
            yield key, np.flatnonzero(data.reshape(len(data), -1).any(axis=1))
    for name, members in mesh.point_sets.items():
        yield name, np.asarray(members, dtype=np.int64)


def joined(parts: Sequence[Indices], *shape: int) -> Indices:
    """The ``parts`` as one array; without any an empty one of ``shape``."""
    return np.concatenate([np.empty((0, *shape), dtype=np.int64), *parts])
