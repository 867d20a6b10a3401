"""Read CalculiX results: contact stresses of ``*CONTACT FILE`` in .frd and of ``*CONTACT PRINT`` (CSTR) in .dat."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from partialslip.scene.units import SYSTEMS, Units
from partialslip.tools.arrays import Array, Indices
from partialslip.tools.errors import InputError

Corners = tuple[tuple[int, ...], ...]

# fixed: nodes of the faces in the order of Abaqus and CalculiX
_HEXAHEDRON: Corners = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))
_WEDGE: Corners = ((0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))  # fixed:
_TETRAHEDRON: Corners = ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))  # fixed:
# Plane elements are expanded to solids, whose first two faces are the plane ones.
_TRIANGLE: Corners = ((), (), (0, 1), (1, 2), (2, 0))
_QUADRILATERAL: Corners = ((), (), (0, 1), (1, 2), (2, 3), (3, 0))

#: Indices of a face's corners among the nodes of the element: ``FACE_CORNERS[type][face - 1]``.
FACE_CORNERS: dict[int, Corners] = {
    1: _HEXAHEDRON, 4: _HEXAHEDRON,
    2: _WEDGE, 5: _WEDGE,
    3: _TETRAHEDRON, 6: _TETRAHEDRON,
    7: _TRIANGLE, 8: _TRIANGLE,
    9: _QUADRILATERAL, 10: _QUADRILATERAL,
}  # fmt: skip


_CONTACT = ("CPRESS", "CSHEAR1")
_STRESS = " contact stress (slave "
_WIDTH = 12  # fixed: characters of a number


@dataclass(frozen=True)
class ContactStress:
    """Contact stresses at one time.

    Parameters
    ----------
    step : int
        Number of the load step; 0 if the file does not give it.
    keys : (n, 1) or (n, 2) int array
        Node numbers, or numbers of element and face.
    stress : (n, 2) array
        Normal stress and stress along x, in the file's unit.
    """

    step: int
    keys: Indices
    stress: Array


class LoadPoints(NamedTuple):
    """Indices of load points 1 and 2, ``first`` and ``second``, in the cycle, from 0, which has ``number`` load points.
    With ``every`` one, q1 and q2 are the least and the largest shear at any of them, as out of phase."""

    first: int
    second: int
    number: int
    every: bool = False


def read_frd(text: str, origin: str, chosen: tuple[int, int] | None, load_points: LoadPoints) -> dict[str, Array]:
    """Columns x, p, p1, q1, q2, y and z of an ASCII .frd file, at the nodes in contact at one of the load points.

    Parameters
    ----------
    text, origin : str
        Content of the file, and its name for messages.
    chosen : (int, int), optional
        Numbers of the contact results of load points 1 and 2, from 1. By default the last result of each of the last
        steps.
    load_points : LoadPoints

    Raises
    ------
    InputError
        If the file is not an .frd file or has no contact results.
    """
    lines = text.splitlines()
    numbers, points = _nodes(lines, origin)
    found = _at_load_points(_contacts(lines, origin), origin, chosen, load_points, "*CONTACT FILE with CSTR")
    if not all(np.array_equal(each.keys, found[0].keys) for each in found):
        raise InputError(f"{origin}: contact results at the load points: must be at the same nodes")
    stresses = np.array([each.stress for each in found])
    touched = (stresses != 0).any(axis=(0, 2))
    x, *across = (_at_nodes(numbers, column, found[0].keys[touched, 0], origin) for column in points.T)
    return _columns(x, stresses[:, touched]) | dict(zip("yz", across, strict=True))


def read_dat(
    text: str, mesh: str, origin: str, chosen: tuple[int, int] | None, load_points: LoadPoints
) -> tuple[dict[str, Array], bool]:
    """Columns x, p, p1, q1 and q2 of a .dat file, at slave nodes or as means over slave faces, and whether over faces.

    ``mesh`` is the content of the .frd file, which has the coordinates. The rest as for :func:`read_frd`.
    """
    blocks = _printed(text.splitlines(), origin)
    found = _at_load_points(blocks, origin, chosen, load_points, "*CONTACT PRINT with CSTR")
    keys = np.unique(np.concatenate([each.keys for each in found]), axis=0)
    lines = mesh.splitlines()
    numbers, points = _nodes(lines, origin)
    faces = keys.shape[1] == 2
    if faces:
        x = _middles(lines, keys, numbers, points[:, 0], origin)
    else:
        x = _at_nodes(numbers, points[:, 0], keys[:, 0], origin)
    return _columns(x, np.array([_means(keys, each) for each in found])), faces


def _columns(x: Array, stresses: Array) -> dict[str, Array]:
    """Columns by name, from ``stresses`` (k, n, 2) at load points 1 and 2 and, if q1 and q2 are to be the least and the
    largest shear of the cycle, at the other ones; p is the pressure at load point 2."""
    (p1, p, *_), shear = stresses[..., 0], stresses[..., 1]
    q1, q2 = shear if len(shear) == 2 else (shear.min(axis=0), shear.max(axis=0))
    return {"x": x, "p": p, "p1": p1, "q1": q1, "q2": q2}


def stated_units(mesh: str) -> Units | None:
    """Units of an .frd file, from the names of the materials, if the deck is of :mod:`partialslip.export`; else None.

    CalculiX copies only these names from the deck to the file.
    """
    head = mesh[: mesh.find("\n    2C")].splitlines()
    names = [line[14:].strip() for line in head if line.startswith("    1UMAT")]
    return next((units for units in SYSTEMS if any(name.endswith(f"_{units.identifier}") for name in names)), None)


def _at_load_points(
    blocks: Sequence[ContactStress], origin: str, chosen: tuple[int, int] | None, load_points: LoadPoints, wanted: str
) -> list[ContactStress]:
    """Contact stresses at load points 1 and 2 and, if ``load_points`` ask for it, at the others of the last cycle."""
    if not blocks:
        raise InputError(f"{origin}: no contact stresses; add {wanted} to the CalculiX deck")
    if chosen is not None:
        if not all(1 <= number <= len(blocks) for number in chosen):
            raise InputError(
                f"--at {chosen[0]},{chosen[1]}: must be from 1 to {len(blocks)}, contact results of {origin}"
            )
        return [blocks[chosen[0] - 1], blocks[chosen[1] - 1]]
    last = [block for block, after in zip(blocks, [*blocks[1:], None], strict=True)
            if after is None or not block.step or block.step != after.step]  # fmt: skip
    first, second, count, every = load_points
    if len(last) < count:
        raise InputError(
            f"{origin}: contact results of {len(last)} steps: must be {count} or more, one per load point of a cycle"
        )
    others = [end for end in range(count) if every and end not in (first, second)]
    return [last[end - count] for end in (first, second, *others)]


def _nodes(lines: Sequence[str], origin: str) -> tuple[Indices, Array]:
    start = next((i for i, line in enumerate(lines) if line.startswith("    2C")), None)
    if start is None:
        raise InputError(f"{origin}: no nodes (block 2C): must be an .frd file of CalculiX")
    return _table(lines, start, 3, origin)


def _contacts(lines: Sequence[str], origin: str) -> list[ContactStress]:
    """All contact results of an .frd file, in order."""
    blocks, step = [], 0
    for i, line in enumerate(lines):
        if line.startswith("    1PSTEP"):
            step = _integer(line.split()[-1], i, origin)
        elif line.startswith(" -4  CONTACT"):
            names = []
            while i + 1 < len(lines) and lines[i + 1].startswith(" -5"):
                i += 1
                names.append(lines[i][5:13].strip())
            if not set(_CONTACT) <= set(names[:6]):
                raise InputError(f"{origin}: line {i + 1}: contact results: must include {' and '.join(_CONTACT)}")
            nodes, values = _table(lines, i, min(len(names), 6), origin)
            blocks.append(ContactStress(step, nodes[:, None], values[:, [names.index(name) for name in _CONTACT]]))
    return blocks


def _table(lines: Sequence[str], start: int, columns: int, origin: str) -> tuple[Indices, Array]:
    """Numbers (n,) and values (n, columns) of the rows after line ``start``, up to the end of the block."""
    rows = list(_rows(lines, start, origin))
    short = start > 0 and len(rows) > 0 and len(rows[0].rstrip()) == 8 + _WIDTH * columns  # format 0
    head = 8 if short else 13
    try:
        numbers = np.array([int(row[3:head]) for row in rows], dtype=np.int64)
        places = range(head, head + _WIDTH * columns, _WIDTH)
        values = np.array([[float(row[place : place + _WIDTH]) for place in places] for row in rows])
    except (ValueError, OverflowError):
        raise InputError(f"{origin}: line {start + 2} and after: must be ASCII rows of {columns} numbers") from None
    return numbers, values.reshape(len(rows), columns)


def _rows(lines: Sequence[str], start: int, origin: str) -> Iterator[str]:
    for i in range(start + 1, len(lines)):
        if lines[i].startswith(" -3"):
            return
        if lines[i].startswith(" -1"):
            yield lines[i]
    raise InputError(f"{origin}: line {start + 1}: the block that begins here has no end; is the file complete?")


def _printed(lines: Sequence[str], origin: str) -> list[ContactStress]:
    blocks = []
    for start, line in enumerate(lines):
        if not line.startswith(_STRESS):
            continue
        keys = 2 if line.startswith(f"{_STRESS}element") else 1
        end = start + 2
        while end < len(lines) and lines[end].strip():
            end += 1
        try:
            table = np.array([[float(value) for value in row.split()] for row in lines[start + 2 : end]])
            table = table.reshape(-1, keys + 3)
        except ValueError:
            raise InputError(f"{origin}: line {start + 3} and after: must be rows of {keys + 3} numbers") from None
        with np.errstate(invalid="ignore"):
            blocks.append(ContactStress(0, table[:, :keys].astype(np.int64), table[:, keys : keys + 2]))
    if len({block.keys.shape[1] for block in blocks}) > 1:
        raise InputError(f"{origin}: contact stresses at nodes and on faces: must be of one kind")
    return blocks


def _means(keys: Indices, block: ContactStress) -> Array:
    """Mean stress of the rows with each key, (n, 2); zero where the block has no row."""
    _, place = np.unique(np.concatenate([keys, block.keys]), axis=0, return_inverse=True)
    at, count = place.ravel()[len(keys) :], np.zeros(len(keys))
    total = np.zeros((len(keys), 2))
    np.add.at(total, at, block.stress)
    np.add.at(count, at, 1.0)
    return total / np.maximum(count, 1.0)[:, None]


def _middles(lines: Sequence[str], keys: Indices, numbers: Indices, x: Array, origin: str) -> Array:
    """x of the middles of faces, given by element and face number, (n,)."""
    start = next((i for i, line in enumerate(lines) if line.startswith("    3C")), None)
    if start is None:
        raise InputError(f"{origin}: elements (block 3C): must be in the .frd file of the same name")
    wanted = set(keys[:, 0].tolist())
    corners: dict[int, tuple[int, list[int]]] = {}
    kind, element = 0, 0
    for i in range(start + 1, len(lines)):
        line = lines[i]
        if line.startswith(" -3"):
            break
        if line.startswith(" -1"):
            element, kind = (_integer(word, i, origin) for word in (line[3:13], line[13:18]))
            if element in wanted:
                corners[element] = (kind, [])
        elif line.startswith(" -2") and element in wanted:
            corners[element][1].extend(_integer(word, i, origin) for word in line[3:].split())
    means = []
    for element, face in keys.tolist():
        kind, nodes = corners.get(element, (0, []))
        faces = FACE_CORNERS.get(kind, ())
        local = faces[face - 1] if 1 <= face <= len(faces) else ()
        if not local or max(local) >= len(nodes):
            raise InputError(f"{origin}: face {face} of element {element}: must be in the .frd file of the same name")
        means.append([nodes[corner] for corner in local])
    count = np.array([len(nodes) for nodes in means])
    at = _at_nodes(numbers, x, np.concatenate(means), origin)
    return np.add.reduceat(at, np.cumsum(count) - count) / count


def _at_nodes(numbers: Indices, x: Array, wanted: Indices, origin: str) -> Array:
    order = np.argsort(numbers)
    place = np.searchsorted(numbers[order], wanted)
    known = (place < len(numbers)) & (numbers[order][np.minimum(place, len(numbers) - 1)] == wanted)
    if not known.all():
        hint = "for plane elements CalculiX prints nodes of the expanded solids: score the .frd file instead"
        raise InputError(f"{origin}: node {wanted[~known][0]}: must be in the .frd file; {hint}")
    return x[order][place]


def _integer(word: str, line: int, origin: str) -> int:
    try:
        return int(word)
    except ValueError:
        raise InputError(f"{origin}: line {line + 1}: {word.strip()[:20]!r}: must be a whole number") from None
