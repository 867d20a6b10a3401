"""Read and check a body's mesh from a file of another tool, with meshio."""

import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NoReturn

import numpy as np
import numpy.typing as npt

from partialslip.tools.errors import InputError, MissingLibraryError, PartialslipError
from partialslip.tools.inputfile import LARGEST_MESH, read_bytes
from partialslip_meshes import gmsh
from partialslip_meshes.abaqus import read_deck
from partialslip_meshes.files import check_files, quiet, spliced
from partialslip_meshes.found import Found, from_meshio, joined
from partialslip_meshes.mesh import Mesh

_Array = npt.NDArray[np.float64]
_Indices = npt.NDArray[np.int64]

READ_FORMATS = (".msh", ".inp", ".med", ".vtu")
BOUNDARY_NAMES = ("contact", "face", "back", "left", "right")
_NODES = {"triangle": 3, "triangle6": 6, "triangle7": 7, "quad": 4, "quad8": 8, "quad9": 9}  # fixed: of each type
_LARGEST = 1e30  # limit: coordinate
_FLAT = 1e-12  # limit: of the square of the longest side: an element with less area counts as empty
_CRACK = 1e-6  # limit: of the square of its length: a hole with less area counts as a crack
_OFF = 1e-4  # limit: of the length: largest deviation of the contact line from its shape, and of points from a plane
_MIDDLE = 0.25  # limit: of a side: largest deviation of its middle node from the middle
_FEWEST = 4  # limit: edges of a contact line
_DAMAGED = "the file is damaged or of another format"


def read(
    name: str,
    path: str,
    unit: float = 1.0,
    face: Callable[[_Array], _Array] | None = None,
    needed: Sequence[str] = ("back",),
    body: str | int | None = None,
    groups: Mapping[str, str | int] | None = None,
) -> Mesh:
    """Read the mesh of a body and move it below the line y = 0, which its contact line touches.

    Quadrilaterals are split into triangles; of quadratic elements the corners are used. Elements may be numbered in
    either direction, and the body may lie on either side of its contact line. Nodes without elements are dropped.

    Lines of the boundary are the groups ``contact``, ``back``, ``left``, ``right`` and ``face`` (optional: the rest of
    the contact line's side, from left to right), in upper or lower case, of edges or of nodes: physical groups (.msh),
    sets and surfaces (.inp), groups (.med), or nonzero cell or point data (any format).

    Parameters
    ----------
    name : str
        Field of the scene that names the file, for messages.
    path : str
        File; the suffix tells the format: .msh, .inp, .med or .vtu.
    unit : float
        Factor of the lengths in the file.
    face : callable, optional
        Depth of the contact line below y = 0 at x, in the returned lengths; by default 0.
    needed : sequence of str
        Lines that must exist besides the contact line. Edges of the contact line that touch them are dropped.
    body : str or int, optional
        Group of elements, part or instance that is the body, where the file has more; physical groups also by number.
        What lies outside it is left out.
    groups : dict, optional
        Names in the file, or numbers of physical groups, of the lines of the boundary.

    Raises
    ------
    InputError
        If the file cannot be read, or the mesh is not that of a body.
    MissingLibraryError
        If h5py, which .med files need, is missing.
    """
    refuse = _refusal(name, path)
    found = _load(name, path, refuse)
    points = _in_plane(found.points, refuse) * unit
    corners = _ccw(points, _triangles(found, points, _chosen(found, body, refuse), refuse), refuse)
    boundary = _boundary(corners, len(points), found, refuse)
    _check_cracks(points, boundary, refuse)
    lines = {key: edges for key, edges in _named_lines(found, corners, boundary, groups or {}, refuse) if len(edges)}
    for key in ("contact", *needed):
        if key not in lines:
            asked = found.groups.get(str((groups or {}).get(key, key)).lower())
            if asked and (asked.nodes or asked.edges):
                refuse(f"group {asked.name!r} must have an edge of the boundary of the body")
            here = found.named(bodies=False)
            others = (
                f'the file has {here}: type groups = {{ {key} = "..." }}' if here else "the file has no groups of them"
            )
            refuse(f"must have a group {key!r} of edges or nodes of its boundary; {others}")
    every = np.concatenate(list(lines.values()))
    if len(np.unique(every, axis=0)) < len(every):
        refuse(f"edges must be in one group each; an edge is in two of the groups {', '.join(lines)}")
    bound = np.concatenate([lines[key] for key in needed])
    lines["contact"] = lines["contact"][~np.isin(lines["contact"], bound).any(axis=1)]
    below = _below(points, lines["contact"], refuse)
    if "face" in lines and not _way(points, np.concatenate([lines["contact"], lines["face"]])):
        refuse("group 'face' must go on from both ends of group 'contact', from left to right, or be left out")
    if not below:
        points, corners = points * [1, -1], corners[:, ::-1]
    _lay(points, lines["contact"], unit, face, refuse)
    used, numbers = np.unique(corners, return_inverse=True)
    place = np.full(len(points), -1)
    place[used] = np.arange(len(used))
    return Mesh(
        np.ascontiguousarray(points[used]), numbers.reshape(-1, 3), {key: place[edges] for key, edges in lines.items()}
    )


Refuse = Callable[[str], NoReturn]


def _refusal(name: str, path: str) -> Refuse:
    def refuse(why: str) -> NoReturn:
        raise InputError(f"{name} = {path!r}: {why}")

    return refuse


def _load(name: str, path: str, refuse: Refuse) -> Found:
    if (suffix := Path(path).suffix.lower()) not in READ_FORMATS:
        refuse(f"must be a file {', '.join(READ_FORMATS[:-1])} or {READ_FORMATS[-1]}")
    named = f"{name} = {path!r}"
    texts = check_files(path, named)
    if suffix == ".inp":
        try:
            return read_deck(spliced(Path(path), texts, named).decode("utf-8", "replace"))
        except InputError as error:
            refuse(str(error).removeprefix(f"{named}: "))
    if suffix == ".msh":
        text = read_bytes(path, LARGEST_MESH)
        for section in (b"$Nodes", b"$Elements"):
            if (count := text.count(b"\n" + section)) > 1:  # meshio keeps the last one
                refuse(f"must have one section {section.decode()}, not {count}")
    try:
        return _by_meshio(name, path, refuse)
    except InputError:
        if suffix not in (".msh", ".med"):
            raise
        with tempfile.TemporaryDirectory() as folder:  # what gmsh reads and meshio does not
            target = str(Path(folder) / "body.msh")
            try:
                gmsh.ask({"path": str(Path(path).absolute()), "target": target})
            except PartialslipError:
                refuse(f"cannot be read: {_DAMAGED}")
            return _by_meshio(name, target, refuse)


def _by_meshio(name: str, path: str, refuse: Refuse) -> Found:
    printed = ""
    try:
        # meshio prints what is wrong and exits
        with quiet() as output, np.errstate(all="ignore"):
            import meshio  # slow to import, so only here

            try:
                return from_meshio(meshio.read(path))
            finally:
                printed = output.getvalue()
    except ModuleNotFoundError as error:
        raise MissingLibraryError(f"{name}: {error.name} is missing; pip install partialslip[med]") from None
    except OSError as error:
        refuse(f"cannot be read: {error.strerror or _DAMAGED}")
    except (Exception, SystemExit):
        why = printed.partition("Error:")[0].strip() or _DAMAGED
        refuse(f"cannot be read: {' '.join(why.split())}")


def _chosen(found: Found, body: str | int | None, refuse: Refuse) -> npt.NDArray[np.bool_]:
    """Mask of the elements that belong to ``body``, over all blocks of elements; all without a ``body``."""
    count = sum(len(cells) for _, cells in found.cells)
    if body is None:
        return np.ones(count, dtype=bool)
    group = found.groups.get(str(body).lower())
    if group and group.fault:
        refuse(f"group {body!r}: {group.fault}")
    chosen = np.zeros(count, dtype=bool)
    chosen[joined(group.elements) if group else []] = True
    if not chosen.any():
        here = found.named(bodies=True)
        refuse(f"must have elements of the body {body!r}; the file has {here or 'no groups of elements'}")
    return chosen


def _in_plane(points: _Array, refuse: Refuse) -> _Array:
    points = np.asarray(points, dtype=float)
    if points.ndim != 2 or not len(points) or points.shape[1] not in (2, 3):
        refuse("must have nodes")
    if wrong := int((~(np.abs(points) < _LARGEST).all(axis=1)).sum()):
        refuse(f"must have coordinates that are finite and less than {_LARGEST:g}; {wrong} nodes have others")
    if np.ptp(points, axis=0)[2:].max(initial=0.0) > _OFF * np.ptp(points[:, :2]):
        refuse("must lie in a plane z = const")
    return points[:, :2]


def _triangles(found: Found, points: _Array, chosen: npt.NDArray[np.bool_], refuse: Refuse) -> _Indices:
    """Corners of the ``chosen`` elements, (t, 3); quadrilaterals are split along the shorter diagonal."""
    if unknown := sorted({kind for kind, _ in found.cells} - {*_NODES}):
        refuse(f"must have triangles and quadrilaterals, linear or quadratic, not {', '.join(unknown)}")
    parts = [np.empty((0, 3), dtype=np.int64)]
    begin = 0
    for kind, every in found.cells:
        cells = every[chosen[begin : begin + len(every)]]
        begin += len(every)
        if not cells.size:
            continue
        if not (cells.min() >= 0 and cells.max() < len(points)):
            refuse("must have elements whose nodes exist")
        if cells.shape[1:] != (_NODES[kind],):
            refuse("must have elements with as many nodes as their type")
        count = 3 if kind.startswith("triangle") else 4
        ring = points[cells[:, :count]]
        sides = np.roll(ring, -1, axis=1) - ring
        if cells.shape[1] >= 2 * count:
            off = points[cells[:, count : 2 * count]] - (ring + sides / 2)
            if (np.linalg.norm(off, axis=-1) > _MIDDLE * np.linalg.norm(sides, axis=-1)).any():
                refuse("nodes of quadratic elements must be in order: corners, then middles of the sides")
        corners = cells[:, :count]
        if count == 4 and (flat := corners[:, 2] == corners[:, 3]).any():  # triangles written as quadrilaterals
            parts.append(corners[flat, :3])
            corners, ring, sides = corners[~flat], ring[~flat], sides[~flat]
        if count == 4:
            turns = _cross(sides, np.roll(sides, -1, axis=1))
            if not ((turns > 0).all(axis=1) | (turns < 0).all(axis=1)).all():
                refuse("nodes of quadrilaterals must be in order around convex ones")
            short = np.linalg.norm(ring[:, 2] - ring[:, 0], axis=1) <= np.linalg.norm(ring[:, 3] - ring[:, 1], axis=1)
            turned = np.where(short[:, None], corners, np.roll(corners, -1, axis=1))
            corners = np.concatenate([turned[:, [0, 1, 2]], turned[:, [0, 2, 3]]])
        parts.append(corners)
    return np.concatenate(parts)


def _ccw(points: _Array, corners: _Indices, refuse: Refuse) -> _Indices:
    """Turn all triangles counter-clockwise."""
    if not len(corners):
        refuse("must have triangles or quadrilaterals")
    sides = np.roll(points[corners], -1, axis=1) - points[corners]
    areas, longest = _cross(sides[:, 0], sides[:, 1]), np.linalg.norm(sides, axis=-1).max(axis=1)
    if empty := int((np.abs(areas) <= _FLAT * longest**2).sum()):
        refuse(f"must have elements with an area; {empty} have none")
    return np.where((areas > 0)[:, None], corners, corners[:, ::-1])


def _boundary(corners: _Indices, count: int, found: Found, refuse: Refuse) -> _Indices:
    """Edges that belong to one triangle only, with the body on their left, (b, 2)."""
    from scipy.sparse import coo_array  # takes long to import
    from scipy.sparse.csgraph import connected_components

    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    there, back = edges @ [count, 1], edges @ [1, count]
    order = np.argsort(there)
    if folded := int((np.diff(there[order]) == 0).sum()):
        refuse(f"must not have overlapping elements; at {folded} edges two are on the same side")
    place = np.minimum(np.searchsorted(there, back, sorter=order), len(edges) - 1)
    shared = there[order[place]] == back
    beside, other = (number[shared] % len(corners) for number in (np.arange(len(edges)), order[place]))
    graph = coo_array((np.ones(len(beside)), (beside, other)), shape=(len(corners), len(corners)))
    if (pieces := connected_components(graph)[0]) > 1:
        here = found.named(bodies=True)
        others = f"; if it has more bodies, type body = ..., one of {here}" if here else ""
        refuse(f"must be one piece, connected by common nodes, not {pieces}{others}")
    return edges[~shared]


def _check_cracks(points: _Array, boundary: _Indices, refuse: Refuse) -> None:
    """Refuse a mesh whose elements are not joined: nodes of the boundary at one place, or a hole without an area, as
    around a node in the middle of another element's side."""
    from scipy.sparse import coo_array  # takes long to import
    from scipy.sparse.csgraph import connected_components

    nodes, ends = np.unique(boundary, return_inverse=True)
    ends = ends.reshape(-1, 2)
    if twice := len(nodes) - len(np.unique(points[nodes], axis=0)):
        refuse(f"must have no two nodes at one place; nodes of the boundary at the place of others: {twice}")
    graph = coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(len(nodes), len(nodes)))
    loop = connected_components(graph, directed=False)[1][ends[:, 0]]
    start, end = points[boundary[:, 0]], points[boundary[:, 1]]
    middle = np.column_stack([np.bincount(loop, each) / np.bincount(loop) for each in start.T])[loop]
    start, end = start - middle, end - middle
    area = np.abs(np.bincount(loop, _cross(start, end) / 2))
    around = np.bincount(loop, np.linalg.norm(end - start, axis=1))
    if cracks := int((area <= _CRACK * around**2).sum()):
        refuse(f"must have elements that share whole sides; cracks between elements: {cracks}")


def _named_lines(
    found: Found, corners: _Indices, boundary: _Indices, names: Mapping[str, str | int], refuse: Refuse
) -> Iterator[tuple[str, _Indices]]:
    """Name and boundary edges of each line; ``names`` are those of their groups in the file. Members outside the body
    are left out."""
    known = np.sort(boundary, axis=1)
    for line in BOUNDARY_NAMES:
        wanted = str(names.get(line, line))
        group = found.groups.get(wanted.lower())
        if group and group.fault:
            refuse(f"group {wanted!r}: {group.fault}")
        if line in names and not (group and (group.nodes or group.edges)):
            here = found.named(bodies=False) or "no groups of edges or nodes"
            refuse(f"must have the group {wanted!r} of edges or nodes for {line!r}; the file has {here}")
        edges, members = joined(group.edges if group else [], 2), joined(group.nodes if group else [])
        for some in (edges, members):
            if some.size and not (some.min() >= 0 and some.max() < len(found.points)):
                refuse(f"group {wanted!r} must have nodes that exist")
        nodes = np.zeros(len(found.points), dtype=bool)
        nodes[members] = True
        inside = np.sort(edges[np.isin(edges, corners).all(axis=1)], axis=1)
        if not _among(inside, known).all():
            refuse(f"group {wanted!r} must have edges of the boundary only")
        yield line, boundary[_among(known, inside) | nodes[boundary].all(axis=1)]


def _below(points: _Array, contact: _Indices, refuse: Refuse) -> bool:
    """Whether the body lies below its contact line."""
    if len(contact) < _FEWEST:
        refuse(f"group 'contact' must have at least {_FEWEST} edges, not {len(contact)}")
    way = _way(points, contact)
    if not way:
        refuse("group 'contact' must be one line from left to right, with the body on one side of it")
    return way < 0


def _way(points: _Array, edges: _Indices) -> int:
    """Direction along x of ``edges``, 1 or -1; 0 if they are not one line that goes from left to right."""
    ways = np.sign(np.diff(points[edges, 0], axis=1))
    nodes = np.unique(edges)
    chain = nodes[np.argsort(points[nodes, 0])]
    pairs = np.sort(np.column_stack([chain[:-1], chain[1:]]), axis=1)
    joined = len(pairs) == len(edges) and _among(pairs, np.sort(edges, axis=1)).all()
    return int(ways[0, 0]) if joined and (ways == ways[0]).all() else 0


def _lay(
    points: _Array, contact: _Indices, unit: float, face: Callable[[_Array], _Array] | None, refuse: Refuse
) -> None:
    """Shift ``points`` along y so that the contact line touches y = 0."""
    x, y = points[np.unique(contact)].T
    if not x.min() < 0 < x.max():
        low, high = x.min() / unit, x.max() / unit
        refuse(f"contact line must have x = 0 inside; in the file it is from x = {low:g} to {high:g}: move the body")
    height = y + (face(x) if face else 0.0)
    off = np.ptp(height) / np.ptp(x)
    if not off <= _OFF:
        shape = "of the profile's shape (or kind 'block')" if face else "flat (or kind 'pad')"
        refuse(f"contact line must be {shape}; it is off by {off:.2g} of its length, about x = 0")
    points[:, 1] -= np.median(height)


def _among(edges: _Indices, others: _Indices) -> npt.NDArray[np.bool_]:
    """Which of the ``edges`` are among the ``others``; nodes of each edge must be sorted."""
    count = max(edges.max(initial=0), others.max(initial=0)) + 1
    return np.isin(edges @ [count, 1], others @ [count, 1])


def _cross(a: _Array, b: _Array) -> _Array:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
