"""Read the mesh of an input deck of Abaqus or CalculiX.

A deck without parts is one scope of numbers and names. Parts have scopes of their own, of which instances are placed
copies. Sets of the assembly have members in instances, as INSTANCE=NAME or NAME.member.
"""

import itertools
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from partialslip.tools.errors import InputError
from partialslip_meshes.found import Found, Group, Indices, joined

# fixed: types of elements by their nodes; letters behind (R, I, H, M, T, ...) change nothing of the shape
# (meshio writes triangles as R3D3 and quadrilaterals as CAX4P)
_PLANE = re.compile(r"(?:CPEG|CPE|CPS|SFM3D|M3D|DC2D|AC2D|STRI|R3D|S|CAX(?=4P$))([34689])")
_LINE = re.compile(r"(?:[TR][23]D|[DA]C1D)([23])")
_BEAM = re.compile(r"B[23]([123])")
_CELLS = {3: "triangle", 4: "quad", 6: "triangle6", 8: "quad8", 9: "quad9"}
_OF_BEAM = {"1": 2, "2": 3, "3": 2}  # fixed: nodes by the order of a beam
# fixed: keywords that make or move nodes and elements
_UNREAD = {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM", "TRANSLATE", "SUBMODEL"}
_KEYWORD = re.compile(r"[\w /+-]*$")
_PARAMETER = re.compile(r'([^,="]+)(?:=\s*("[^"]*"|[^,]*))?')
_FACE = re.compile(r"[SE]([1-6])$")  # of shells E1 to E4, or S3 to S6 as CalculiX counts


class _Card(NamedTuple):
    """A keyword, its parameters by name in capitals, and the lines below it."""

    keyword: str
    parameters: Mapping[str, str]
    lines: Sequence[str]

    @property
    def rows(self) -> Iterator[list[str]]:
        """Entries of each line."""
        return ([each.strip().strip('"') for each in line.split(",")] for line in self.lines)


class _Block(NamedTuple):
    """Elements of a type ``kind``: each row has the number and the nodes. ``cell`` is empty for lines."""

    kind: str
    cell: str
    rows: Indices


@dataclass
class _Scope:
    """Nodes (numbers, coordinates), elements and sets that share their numbers and names: a part, the assembly, or a
    deck without parts. Of a set there are the kind, the name, and a card or the numbers of its members."""

    name: str = ""
    nodes: list[tuple[Indices, npt.NDArray[np.float64]]] = field(default_factory=list)
    elements: list[_Block] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)  # types of elements that are no part of a body, and
    unused: list[Indices] = field(default_factory=list)  # their numbers
    sets: list[tuple[str, str, _Card | Indices]] = field(default_factory=list)


@dataclass
class _Placed:
    """A scope whose nodes and elements have indices in the whole mesh: numbers (k,), ascending, and indices (k,)."""

    scope: _Scope
    nodes: tuple[Indices, Indices]
    elements: tuple[Indices, Indices]
    inside: Mapping[str, "_Placed"]  # instances of the assembly, by name in lower case


def read_deck(text: str) -> Found:
    """Return nodes, plane elements and groups of the deck ``text``, without ``*INCLUDE``.

    Groups are sets of nodes and elements, surfaces (``*SURFACE``), parts and instances; those of an instance also have
    the name INSTANCE.GROUP.

    Raises
    ------
    InputError
        If the deck contradicts itself, or has what is not read.
    """
    return _Mesh(list(_cards(text))).found


def _cards(text: str) -> Iterator[_Card]:
    lines = [line.strip() for line in text.splitlines()]
    lines = [line for line in lines if line and not line.startswith("**")]
    starts = [number for number, line in enumerate(lines) if line.startswith("*")]
    for start, stop in itertools.pairwise([*starts, len(lines)]):
        head, below = lines[start], start + 1
        while head.endswith(",") and below < stop:
            head, below = head + lines[below], below + 1
        keyword, _, rest = head[1:].replace("\t", " ").partition(",")
        if not _KEYWORD.match(keyword):
            raise InputError(f"must have keywords and commas as in Abaqus; {head!r} has others")
        found = ((key.strip().upper(), value.strip().strip('"').strip()) for key, value in _PARAMETER.findall(rest))
        yield _Card(" ".join(keyword.upper().split()), {key: value for key, value in found if key}, lines[below:stop])


class _Mesh:
    """Puts together what the cards of a deck say."""

    def __init__(self, cards: Sequence[_Card]) -> None:
        self.points: list[npt.NDArray[np.float64]] = [np.empty((0, 3))]
        self.cells: list[tuple[str, Indices]] = []
        self.shells: list[bool] = []  # whether a block is of shells
        self.lines: list[Indices] = []  # edges of line elements
        self.counted = [0, 0]  # nodes, plane elements
        parts: dict[str, _Scope] = {}
        instances: list[tuple[_Scope, _Card]] = []
        whole = here = _Scope()
        for card in cards:
            _refuse_unread(card)
            name = card.parameters.get("NAME", "")
            if card.keyword == "PART":
                here = parts.setdefault(name.lower(), _Scope(name))
            elif card.keyword == "INSTANCE":
                part = card.parameters.get("PART", "").lower()
                if part and part not in parts:
                    raise InputError(f"*INSTANCE {name}: PART = {card.parameters['PART']!r} is no *PART of the deck")
                own = parts.get(part, _Scope())
                here = _Scope(name, [*own.nodes], [*own.elements], own.left_out, [*own.unused], [*own.sets])
                instances.append((here, card))
            elif card.keyword in ("END PART", "END INSTANCE", "ASSEMBLY", "END ASSEMBLY"):
                here = whole
            else:
                _collect(here, card)
        placed = {scope.name.lower(): self._placed(scope, _shift(card)) for scope, card in instances}
        of_parts = Counter(card.parameters.get("PART", "") for _, card in instances)
        if not instances:
            placed = {name: self._placed(part) for name, part in parts.items()}
        top = self._placed(whole, inside=placed)
        self.found = Found(np.concatenate(self.points), self.cells)
        for each in [*placed.values(), top]:
            self._name_groups(each)
        for scope, card in instances:  # a part with one instance by its own name, too
            part = card.parameters.get("PART", "")
            if of_parts[part] == 1 and part.lower() not in self.found.groups:
                self.found.group(part).elements.extend(self.found.group(scope.name).elements)
        if not self.cells:
            kinds = sorted({kind for scope in (whole, *parts.values()) for kind in scope.left_out})
            raise InputError(f"must have plane elements (CPE, CPS), not {', '.join(kinds) or 'none'}")

    def _placed(
        self,
        scope: _Scope,
        moved: "_Shift | None" = None,
        inside: Mapping[str, _Placed] | None = None,
    ) -> _Placed:
        """Add the nodes and elements of a part or instance (``scope``), ``moved`` to the instance's place, to the mesh;
        return their indices there."""
        numbers = joined([numbers for numbers, _ in scope.nodes])
        points = np.concatenate([np.empty((0, 3)), *(points for _, points in scope.nodes)])
        nodes = _ascending(numbers, self.counted[0] + np.arange(len(numbers)), "node")
        self.points.append(moved(points) if moved else points)
        self.counted[0] += len(points)
        places = []
        for block in scope.elements:
            ends = _looked_up(nodes, block.rows[:, 1:], "an element has the node")
            if block.cell:
                begin, self.counted[1] = self.counted[1], self.counted[1] + len(ends)
                self.cells.append((block.cell, ends))
                self.shells.append(block.kind.startswith("S"))
                places.append(begin + np.arange(len(ends)))
            else:
                places.append(-1 - sum(map(len, self.lines)) - np.arange(len(ends)))
                self.lines.append(ends[:, [0, -1]])
        known = joined([block.rows[:, 0] for block in scope.elements])
        return _Placed(scope, nodes, _ascending(known, joined(places), "element"), inside or {})

    def _name_groups(self, placed: _Placed) -> None:
        """Add the groups of the scope that was ``placed``."""
        scope, found = placed.scope, self.found
        if scope.name:
            found.group(scope.name).elements.append(placed.elements[1][placed.elements[1] >= 0])
        kinds = dict.fromkeys((kind, name.lower()) for kind, name, _ in scope.sets)
        for kind, name in sorted(kinds, key=lambda each: each[0] == "SURFACE"):  # goes before a set of the same name
            shown = next(each for _, each, _ in scope.sets if each.lower() == name)
            own = Group(shown)
            try:
                self._fill(own, placed, kind, name)
            except InputError as error:
                own.fault = str(error)
            for key in (shown, f"{scope.name}.{shown}") if scope.name else (shown,):
                group = found.group(key)
                if kind == "SURFACE":
                    group.nodes, group.edges = [], []
                group.nodes += own.nodes
                group.edges += own.edges
                group.elements += own.elements
                group.fault = group.fault or own.fault

    def _fill(self, group: Group, placed: _Placed, kind: str, name: str) -> None:
        """Add the members of a set or surface to the ``group``."""
        if kind == "NSET":
            group.nodes.append(self._nodes(placed, name))
        elif kind == "ELSET":
            members = self._elements(placed, name)
            group.elements.append(members[members >= 0])
            group.edges.append(joined(self.lines, 2)[-1 - members[members < 0]])
        else:
            self._surface(placed, name, group.nodes, group.edges)

    def _nodes(self, placed: _Placed, name: str, above: tuple[str, ...] = ()) -> Indices:
        """Indices of the nodes of the set ``name`` of a scope."""
        found = []
        for own in _of(placed, "NSET", name, above):
            if isinstance(own, _Card) and "ELSET" in own.parameters:
                found.append(self._corners(self._elements(_target(placed, own), own.parameters["ELSET"].lower())))
                continue
            for where, numbers, names in _members(placed, own):
                found.append(_looked_up(where.nodes, numbers, f"the set {name!r} has the node"))
                found += [self._nodes(where, each, (*above, name)) for each in names]
        return np.unique(joined(found))

    def _elements(self, placed: _Placed, name: str, above: tuple[str, ...] = ()) -> Indices:
        """Places of the elements of the set ``name`` of a scope."""
        found = []
        for own in _of(placed, "ELSET", name, above):
            for where, numbers, names in _members(placed, own):
                found.append(_numbered(where, numbers, f"the set {name!r}"))
                found += [self._elements(where, each, (*above, name)) for each in names]
        return np.unique(joined(found))

    def _corners(self, members: Indices) -> Indices:
        """Nodes of elements."""
        begin, found = 0, [joined(self.lines, 2)[-1 - members[members < 0]].ravel()]
        for _, cells in self.cells:
            own = members[(members >= begin) & (members < begin + len(cells))] - begin
            found.append(cells[own].ravel())
            begin += len(cells)
        return np.unique(np.concatenate(found))

    def _surface(
        self, placed: _Placed, name: str, nodes: list[Indices], edges: list[Indices], above: tuple[str, ...] = ()
    ) -> None:
        """Add what the ``*SURFACE`` of this ``name`` has to ``nodes`` and ``edges``."""
        for card in _of(placed, "SURFACE", name, above):
            assert isinstance(card, _Card)
            kind, joins = card.parameters.get("TYPE", "ELEMENT").upper(), card.parameters.get("COMBINE", "").upper()
            if kind not in ("ELEMENT", "NODE") or joins not in ("", "UNION"):
                raise InputError(f"must be a surface of elements or nodes; {name!r} is of {joins or kind}")
            if joins:
                for other in (each for row in card.rows for each in row if each):
                    self._surface(placed, other.lower(), nodes, edges, (*above, name))
                continue
            of_nodes = kind == "NODE"
            for member, label, *_ in ([*row, ""] for row in card.rows):
                where, own = _split(placed, member)
                numbers = _integers([own], "SURFACE") if own.isdecimal() else None
                if of_nodes:
                    told = f"the surface {name!r} has the node"
                    found = (
                        self._nodes(where, own.lower()) if numbers is None else _looked_up(where.nodes, numbers, told)
                    )
                    nodes.append(found)
                    continue
                told = f"the surface {name!r}"
                chosen = self._elements(where, own.lower()) if numbers is None else _numbered(where, numbers, told)
                face = _FACE.match(label.upper())
                edges.append(joined(self.lines, 2)[-1 - chosen[chosen < 0]])
                edges.append(self._sides(chosen[chosen >= 0], label.upper() if face else ""))

    def _sides(self, members: Indices, face: str) -> Indices:
        """Edges of elements: side ``face``, as S3; or of an empty one the sides that no other element has."""
        begin, found, every = 0, [], []
        for (kind, cells), shell in zip(self.cells, self.shells, strict=True):
            own = members[(members >= begin) & (members < begin + len(cells))] - begin
            begin += len(cells)
            count = 3 if kind.startswith("triangle") else 4
            sides = np.stack([cells[:, :count], np.roll(cells[:, :count], -1, axis=1)], axis=-1)
            every.append(sides.reshape(-1, 2))
            if not len(own):
                continue
            side = int(face[1]) - (2 if shell and face[0] == "S" else 0) if face else 1
            if not 1 <= side <= count:
                raise InputError(f"must have sides of elements that exist; an element {kind} has no side {face}")
            found.append(sides[own, side - 1] if face else sides[own].reshape(-1, 2))
        chosen = joined(found, 2)
        if face:
            return chosen
        _, place, times = np.unique(np.sort(joined(every, 2), axis=1), axis=0, return_inverse=True, return_counts=True)
        single = np.sort(joined(every, 2)[times[place.ravel()] == 1], axis=1) @ [1 << 31, 1]
        return chosen[np.isin(np.sort(chosen, axis=1) @ [1 << 31, 1], single)]


def _numbered(placed: _Placed, numbers: Indices, told: str) -> Indices:
    """Places of the elements of a scope with these ``numbers``; those that are no part of a body have none."""
    ids, places = placed.elements
    missing = numbers[~np.isin(numbers, np.concatenate([ids, joined(placed.scope.unused)]))]
    if len(missing):
        raise InputError(f"must have elements that exist; {told} has the element {missing[0]}")
    return places[np.isin(ids, numbers)]


def _refuse_unread(card: _Card) -> None:
    if card.keyword in _UNREAD:
        raise InputError(f"must list all nodes and elements where they are; *{card.keyword} is not read")
    if card.keyword not in ("NODE", "ELEMENT", "NSET", "ELSET"):
        return
    if "INPUT" in card.parameters or card.parameters.get("SYSTEM", "R").upper() != "R":
        key = "INPUT" if "INPUT" in card.parameters else "SYSTEM"
        raise InputError(f"must list nodes and elements by their coordinates and nodes; {key} is not read")
    for kind in ("NSET", "ELSET"):
        if not card.parameters.get(kind, "x") or (kind == card.keyword and kind not in card.parameters):
            raise InputError(f"must have the name of each set; a parameter {kind} has none")


def _collect(scope: _Scope, card: _Card) -> None:
    """Keep what a ``card`` of nodes, elements, sets or surfaces says."""
    if card.keyword == "NODE":
        rows = list(card.rows)
        scope.nodes.append((_integers([row[0] for row in rows], "NODE"), _coordinates(rows)))
        if "NSET" in card.parameters:
            scope.sets.append(("NSET", card.parameters["NSET"], scope.nodes[-1][0]))
    elif card.keyword == "ELEMENT":
        if block := _block(card):
            scope.elements.append(block)
        else:
            scope.left_out.append(card.parameters["TYPE"])
            scope.unused.append(_integers([row[0] for row in card.rows if row[0]], "ELEMENT"))
        if "ELSET" in card.parameters:
            scope.sets.append(("ELSET", card.parameters["ELSET"], block.rows[:, 0] if block else joined([])))
    elif card.keyword in ("NSET", "ELSET"):
        scope.sets.append((card.keyword, card.parameters[card.keyword], card))
    elif card.keyword == "SURFACE" and card.parameters.get("NAME"):
        scope.sets.append(("SURFACE", card.parameters["NAME"], card))


def _block(card: _Card) -> _Block | None:
    """Elements of the body, or lines; None for springs, masses, connectors and the like, which are no part of it."""
    if not (kind := card.parameters.get("TYPE", "").upper()):
        raise InputError("must have the TYPE of each *ELEMENT")
    plane, line, beam = _PLANE.match(kind), _LINE.match(kind), _BEAM.match(kind)
    if not (plane or line or beam):
        if kind.startswith("C") and not kind.startswith("CONN"):
            raise InputError(f"must have plane elements (CPE, CPS), not {kind}")
        return None
    count = int(plane[1]) if plane else int(line[1]) if line else _OF_BEAM[beam[1]] if beam else 0
    numbers = _integers([each for row in card.rows for each in row if each], "ELEMENT")
    if len(numbers) % (count + 1):
        raise InputError(f"must have a number and {count} nodes for each element {kind}")
    return _Block(kind, _CELLS[count] if plane else "", numbers.reshape(-1, count + 1))


def _of(placed: _Placed, kind: str, name: str, above: tuple[str, ...]) -> list[_Card | Indices]:
    """What the set ``name`` of a scope has; ``above`` are the sets that refer to it."""
    found = [own for each, called, own in placed.scope.sets if each == kind and called.lower() == name]
    if not found or name in above:
        why = "refers to itself" if found else "does not exist"
        raise InputError(f"must have sets that exist; {kind} {name!r} {why}")
    return found


def _target(placed: _Placed, card: _Card) -> _Placed:
    """The scope that a set of the assembly has its members in."""
    name = card.parameters.get("INSTANCE", "").lower()
    if name and name not in placed.inside:
        raise InputError(f"must have instances that exist; INSTANCE = {card.parameters['INSTANCE']!r} does not")
    return placed.inside.get(name, placed)


def _split(placed: _Placed, member: str) -> tuple[_Placed, str]:
    """The scope and the name of a ``member``, which may begin with that of an instance."""
    first, _, rest = member.partition(".")
    other = placed.inside.get(first.lower())
    return (other, rest) if other and rest else (placed, member)


def _members(placed: _Placed, own: _Card | Indices) -> Iterator[tuple[_Placed, Indices, list[str]]]:
    """Scope, node or element numbers (k,) and names of sets (lower case) of the members of a set."""
    if not isinstance(own, _Card):
        yield placed, own, []
        return
    target, listed, names = _target(placed, own), list[Indices](), list[str]()
    elsewhere: list[tuple[_Placed, Indices, list[str]]] = []
    for row in own.rows:
        given = [each for each in row if each]
        if "GENERATE" in own.parameters:
            bounds = _integers(given, own.keyword).tolist()
            low, high, step = [*bounds, *[bounds[-1], bounds[-1], 1][len(bounds) :]][:3] if bounds else (0, -1, 1)
            if high < low or step < 1:
                raise InputError(
                    f"must have a first number, a last one and a step below GENERATE, not {', '.join(row)}"
                )
            ids = target.nodes[0] if own.keyword == "NSET" else target.elements[0]
            listed.append(ids[(ids >= low) & (ids <= high) & ((ids - low) % step == 0)])
            continue
        listed.append(_integers([each for each in given if each.isdecimal()], own.keyword))
        for where, member in (_split(target, each) for each in given if not each.isdecimal()):
            if member.isdecimal():
                elsewhere.append((where, _integers([member], own.keyword), []))
            elif where is target:
                names.append(member.lower())
            else:
                elsewhere.append((where, joined([]), [member.lower()]))
    yield target, joined(listed), names
    yield from elsewhere


def _integers(texts: Sequence[str], keyword: str) -> Indices:
    """Whole numbers (n,)."""
    try:
        return np.array(texts, dtype=str).astype(np.int64) if texts else np.empty(0, dtype=np.int64)
    except (ValueError, OverflowError):
        raise InputError(f"must have whole numbers as numbers below *{keyword}") from None


def _ascending(numbers: Indices, places: Indices, of: str) -> tuple[Indices, Indices]:
    """``numbers`` and ``places`` in ascending order of the numbers."""
    order = np.argsort(numbers, kind="stable")
    if twice := int((np.diff(numbers[order]) == 0).sum()):
        raise InputError(f"must have each {of} once; {twice} are there again")
    return numbers[order], places[order]


def _coordinates(rows: Sequence[Sequence[str]]) -> npt.NDArray[np.float64]:
    """Coordinates (n, 3) of lines of ``*NODE``; those that are left out are zero."""
    try:
        exact = [[each.upper().replace("D", "E") for each in ([*row[1:4], "", ""])[:3]] for row in rows]
        return np.array([[float(each or 0) for each in row] for row in exact]).reshape(-1, 3)
    except ValueError:
        raise InputError("must have numbers as coordinates below *NODE") from None


def _looked_up(known: tuple[Indices, Indices], numbers: Indices, told: str) -> Indices:
    """Indices of nodes by their ``numbers``, an array of any shape."""
    ids, places = known
    wrong = numbers[~np.isin(numbers, ids)]
    if len(wrong):
        raise InputError(f"must have nodes that exist; {told} {wrong[0]}")
    return places[np.searchsorted(ids, numbers)] if len(ids) else numbers


class _Shift(NamedTuple):
    """Shift of an instance, and then its rotation about the line from ``a`` to ``b``, by an angle in degrees."""

    shift: npt.NDArray[np.float64]
    a: npt.NDArray[np.float64] | None = None
    b: npt.NDArray[np.float64] | None = None
    angle: float = 0.0

    def __call__(self, points: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        moved = points + self.shift
        if self.a is None or self.b is None:
            return moved
        from scipy.spatial.transform import Rotation  # takes long to import

        axis = (self.b - self.a) / np.linalg.norm(self.b - self.a)
        return np.asarray(Rotation.from_rotvec(np.radians(self.angle) * axis).apply(moved - self.a) + self.a)


def _shift(card: _Card) -> _Shift:
    try:
        rows = [[float(each or 0) for each in row] for row in card.rows]
    except ValueError:
        raise InputError("must have numbers below *INSTANCE") from None
    if not np.isfinite([each for row in rows for each in row]).all():
        raise InputError("must have finite numbers below *INSTANCE")
    shift = np.array(([*rows[0], 0.0, 0.0, 0.0] if rows else [0.0] * 3)[:3])
    if len(rows) < 2:
        return _Shift(shift)
    if len(rows[1]) < 7 or rows[1][:3] == rows[1][3:6]:
        raise InputError("must have two points and an angle as rotation below *INSTANCE")
    return _Shift(shift, np.array(rows[1][:3]), np.array(rows[1][3:6]), rows[1][6])
