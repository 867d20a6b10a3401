"""CalculiX results: contact stresses of ``*CONTACT FILE`` in .frd and of ``*CONTACT PRINT`` (CSTR) in .dat.

CSHEAR1 acts along x, from the slave's surface on the master's (seen in runs of version 2.20): it is q where the slave
is the lower body. Formats: the manuals of CalculiX GraphiX (chapter *Result Format*) and of CalculiX CrunchiX.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from partialslip.arrays import Array
from partialslip.errors import InputError

_Corners = tuple[tuple[int, ...], ...]

_CONTACT = ("CPRESS", "CSHEAR1")
_STRESS = " contact stress (slave "
_WIDTH = 12  # of a number
_QUADS: _Corners = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))
_WEDGE: _Corners = ((0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))
_TETS: _Corners = ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))
# Corners of the faces by type of element; those of plane elements are numbered as in the solid ones they grow into.
_FACES: dict[int, _Corners] = {1: _QUADS, 4: _QUADS, 2: _WEDGE, 5: _WEDGE, 3: _TETS, 6: _TETS}
_FACES |= dict.fromkeys((7, 8), ((), (), (0, 1), (1, 2), (2, 0)))
_FACES |= dict.fromkeys((9, 10), ((), (), (0, 1), (1, 2), (2, 3), (3, 0)))

Indices = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Block:
    """Contact stresses at one moment: their ``step`` (0 if the file does not say), the ``keys`` (n, k) of what they
    are at, node numbers or element and face, and ``stress`` (n, 2), normal and along x."""

    step: int
    keys: Indices
    stress: Array


def read_frd(text: str, origin: str, chosen: tuple[int, int] | None, ends: tuple[int, int, int]) -> dict[str, Array]:
    """Columns x, p, q1 and q2 of an ASCII .frd file: of the nodes where there is contact at either load point.

    Parameters
    ----------
    chosen : (int, int), optional
        Contact results, counted from 1, of load points 1 and 2. Otherwise those at the ends of the last steps.
    ends : (int, int, int)
        Load points 1 and 2 of the cycle, counted from 0, and how many it has.

    Raises
    ------
    InputError
        If it is no such file, or has no contact results.
    """
    lines = text.splitlines()
    numbers, points = _nodes(lines, origin)
    first, second = _pair(_contacts(lines, origin), origin, chosen, ends, "*CONTACT FILE with CSTR")
    if not np.array_equal(first.keys, second.keys):
        raise InputError(f"{origin}: contact results at load points 1 and 2 are not of the same nodes")
    touched = (first.stress != 0).any(axis=1) | (second.stress != 0).any(axis=1)
    x = _found(numbers, points[:, 0], second.keys[touched, 0], origin)
    return {"x": x, "p": second.stress[touched, 0], "q1": first.stress[touched, 1], "q2": second.stress[touched, 1]}


def read_dat(
    text: str, mesh: str, origin: str, chosen: tuple[int, int] | None, ends: tuple[int, int, int]
) -> dict[str, Array]:
    """Columns x, p, q1 and q2 of a .dat file: of slave nodes, or means over slave faces. ``mesh`` is the text of the
    .frd file, which knows where they are. Otherwise like :func:`read_frd`."""
    first, second = _pair(_printed(text.splitlines(), origin), origin, chosen, ends, "*CONTACT PRINT with CSTR")
    keys = np.unique(np.concatenate([first.keys, second.keys]), axis=0)
    one, two = (_means(keys, block) for block in (first, second))
    lines = mesh.splitlines()
    numbers, points = _nodes(lines, origin)
    if keys.shape[1] == 2:
        x = _middles(lines, keys, numbers, points[:, 0], origin)
    else:
        x = _found(numbers, points[:, 0], keys[:, 0], origin)
    return {"x": x, "p": two[:, 0], "q1": one[:, 1], "q2": two[:, 1]}


def _pair(
    blocks: Sequence[Block], origin: str, chosen: tuple[int, int] | None, ends: tuple[int, int, int], wanted: str
) -> tuple[Block, Block]:
    """Those of load points 1 and 2."""
    if not blocks:
        raise InputError(f"{origin}: no contact stresses in it; ask CalculiX for {wanted}")
    if chosen is not None:
        if not all(1 <= number <= len(blocks) for number in chosen):
            raise InputError(f"--at {chosen[0]},{chosen[1]}: {origin} has contact results 1 to {len(blocks)}")
        return blocks[chosen[0] - 1], blocks[chosen[1] - 1]
    last = [block for block, after in zip(blocks, [*blocks[1:], None], strict=True)
            if after is None or not block.step or block.step != after.step]  # fmt: skip
    first, second, count = ends
    if len(last) < count:
        raise InputError(f"{origin}: contact results of {len(last)} steps: must be of the {count} of a cycle")
    return last[first - count], last[second - count]


def _nodes(lines: Sequence[str], origin: str) -> tuple[Indices, Array]:
    start = next((i for i, line in enumerate(lines) if line.startswith("    2C")), None)
    if start is None:
        raise InputError(f"{origin}: no nodes (2C) in it: must be an .frd file of CalculiX")
    return _table(lines, start, 3, origin)


def _contacts(lines: Sequence[str], origin: str) -> list[Block]:
    """All contact results, in order."""
    blocks, step = [], 0
    for i, line in enumerate(lines):
        if line.startswith("    1PSTEP"):
            step = _whole(line.split()[-1], i, origin)
        elif line.startswith(" -4  CONTACT"):
            names = []
            while i + 1 < len(lines) and lines[i + 1].startswith(" -5"):
                i += 1
                names.append(lines[i][5:13].strip())
            if not set(_CONTACT) <= set(names[:6]):
                raise InputError(f"{origin}: line {i + 1}: contact results must have {' and '.join(_CONTACT)}")
            nodes, values = _table(lines, i, min(len(names), 6), origin)
            blocks.append(Block(step, nodes[:, None], values[:, [names.index(name) for name in _CONTACT]]))
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
        raise InputError(f"{origin}: line {start + 2} and after: not rows of {columns} numbers, in ASCII") from None
    return numbers, values.reshape(len(rows), columns)


def _rows(lines: Sequence[str], start: int, origin: str) -> Iterator[str]:
    for i in range(start + 1, len(lines)):
        if lines[i].startswith(" -3"):
            return
        if lines[i].startswith(" -1"):
            yield lines[i]
    raise InputError(f"{origin}: breaks off in the block that begins at line {start + 1}")


def _printed(lines: Sequence[str], origin: str) -> list[Block]:
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
            raise InputError(f"{origin}: line {start + 3} and after: not rows of {keys + 3} numbers") from None
        with np.errstate(invalid="ignore"):
            blocks.append(Block(0, table[:, :keys].astype(np.int64), table[:, keys : keys + 2]))
    if len({block.keys.shape[1] for block in blocks}) > 1:
        raise InputError(f"{origin}: contact stresses of nodes and of faces: must be of one kind")
    return blocks


def _means(keys: Indices, block: Block) -> Array:
    """Of the block's rows by key; zero where there is no contact."""
    _, place = np.unique(np.concatenate([keys, block.keys]), axis=0, return_inverse=True)
    at, count = place.ravel()[len(keys) :], np.zeros(len(keys))
    total = np.zeros((len(keys), 2))
    np.add.at(total, at, block.stress)
    np.add.at(count, at, 1.0)
    result: Array = total / np.maximum(count, 1.0)[:, None]
    return result


def _middles(lines: Sequence[str], keys: Indices, numbers: Indices, x: Array, origin: str) -> Array:
    """x in the middle of faces, by element and number."""
    start = next((i for i, line in enumerate(lines) if line.startswith("    3C")), None)
    if start is None:
        raise InputError(f"{origin}: the .frd file beside it has no elements (3C)")
    wanted = set(keys[:, 0].tolist())
    corners: dict[int, tuple[int, list[int]]] = {}
    kind, element = 0, 0
    for i in range(start + 1, len(lines)):
        line = lines[i]
        if line.startswith(" -3"):
            break
        if line.startswith(" -1"):
            element, kind = (_whole(word, i, origin) for word in (line[3:13], line[13:18]))
            if element in wanted:
                corners[element] = (kind, [])
        elif line.startswith(" -2") and element in wanted:
            corners[element][1].extend(_whole(word, i, origin) for word in line[3:].split())
    means = []
    for element, face in keys.tolist():
        kind, nodes = corners.get(element, (0, []))
        faces = _FACES.get(kind, ())
        local = faces[face - 1] if 1 <= face <= len(faces) else ()
        if not local or max(local) >= len(nodes):
            raise InputError(f"{origin}: face {face} of element {element} is not in the .frd file beside it")
        means.append([nodes[corner] for corner in local])
    count = np.array([len(nodes) for nodes in means])
    at = _found(numbers, x, np.concatenate(means), origin)
    result: Array = np.add.reduceat(at, np.cumsum(count) - count) / count
    return result


def _found(numbers: Indices, x: Array, wanted: Indices, origin: str) -> Array:
    order = np.argsort(numbers)
    place = np.searchsorted(numbers[order], wanted)
    known = (place < len(numbers)) & (numbers[order][np.minimum(place, len(numbers) - 1)] == wanted)
    if not known.all():
        hint = "of plane elements CalculiX prints the nodes of the solid ones they grow into: take the .frd file"
        raise InputError(f"{origin}: node {wanted[~known][0]} is not in the .frd file ({hint})")
    result: Array = x[order][place]
    return result


def _whole(word: str, line: int, origin: str) -> int:
    try:
        return int(word)
    except ValueError:
        raise InputError(f"{origin}: line {line + 1}: {word.strip()[:20]!r}: must be a whole number") from None
