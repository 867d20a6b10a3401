"""Tractions of several files or parts of a table: p and q apart, and one state for each load point."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from partialslip.codes.score.csvfile import Columns
from partialslip.codes.score.headers import FIRST, NORMAL, Asked
from partialslip.codes.score.rows import starts
from partialslip.scene import Scene
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

_APART = 1e-6  # accuracy: of the extent of x: largest distance of a point from itself in another file
_LIKE = 0.02  # limit: of the pressure, in the norm: largest difference between load points that is not told
_SHEARS = {"p": "q", "Fn": "Ft"}


class _State(NamedTuple):
    """Columns by name at one load point, ``made_of`` which expressions, in the file ``name``; ``of`` which part."""

    name: str
    values: dict[str, Array]
    nodes: list[str] | None
    made_of: str
    of: dict[str, str]


def joined(parts: Sequence[tuple[str, Columns]], asked: Asked, scene: Scene) -> Columns:
    """Columns x, p (or Fn), p1, q1 and q2 of all ``parts``, each with the name of its file.

    A part without pressure or shear belongs to the next one, which has it. Two states are those of load points 1 and 2;
    else there must be one for each load point of the cycle. Points are joined by x, or by the numbers of nodes.

    Raises
    ------
    InputError
        If parts do not fit to each other, or not to the scene.
    """
    states: list[_State] = []
    notes = tuple(dict.fromkeys(note for _, columns in parts for note in columns.notes))
    rest: _State | None = None
    for name, columns in parts:
        state = _averaged(_State(name, columns.values, columns.nodes, columns.made_of, columns.of))
        if rest:
            state = _beside(rest, state)
        rest = None if _whole(state, asked) else state
        if not rest:
            states.append(state)
    if rest:
        lacks = "pressure" if not set(NORMAL) & set(rest.values) else "shear" if "x" in rest.values else "x"
        raise InputError(
            f"{rest.name}: no column of {lacks}: must be there, or in the file given after it; or give --columns"
        )
    if len(states) == 1:
        (only,) = states
        normal = next(name for name in NORMAL if name in only.values)
        order = ("x", normal, *[name for name in only.values if name not in ("x", normal)])
        moment = any(columns.moment for _, columns in parts)
        return Columns({name: only.values[name] for name in order}, only.made_of, notes, moment)
    return _cycle(states, asked, scene, notes)


def _cycle(states: list[_State], asked: Asked, scene: Scene, notes: tuple[str, ...]) -> Columns:
    """Columns of a cycle from its ``states``."""
    load = scene.load
    if len(states) != len(load.points) and (len(states) != 2 or not load.in_phase):
        wanted = f"{len(load.points)}, one for each load point of the cycle" + (", or 2" if load.in_phase else "")
        raise InputError(f"{asked.origin}: {len(states)} states: must be {wanted}")
    first, second = load.ends if len(states) > 2 else (0, 1)
    normals = {name for state in states for name in NORMAL if name in state.values}
    if len(normals) > 1:
        raise InputError(f"{asked.origin}: columns p and Fn: must be the same in all files")
    (normal,) = normals
    for state in states:
        _check_of(states[second], state, ("part", "pair"))
    states = [_at_points_of(states[second], state) for state in states]
    shear, pressures = _SHEARS[normal], [state.values[normal] for state in states]
    values = {"x": states[second].values["x"], normal: pressures[second]}
    if asked.anew or (asked.anew is None and not scene.mirrored):
        values[FIRST[normal]] = pressures[first]
    else:
        off = np.linalg.norm(pressures[second] - pressures[first]) / max(
            float(np.linalg.norm(pressures[second])), 1e-300
        )
        notes += (
            (f"{normal} differs by {off:.0%} between the load points, but the scene's does not vary",)
            if off > _LIKE
            else ()
        )
    if all(shear in state.values for state in states):
        shears = np.array([state.values[shear] for state in states])
        one, two = (shears[first], shears[second]) if load.in_phase else (shears.min(axis=0), shears.max(axis=0))
        values |= {f"{shear}1": one, f"{shear}2": two}
    elif asked.shear:
        raise InputError(f"{asked.origin}: must have one column of shear at each load point, {shear}, not its change")
    named = f"load points 1 and 2: {states[first].name} and {states[second].name}"
    told = () if states[first].name == states[second].name else (named,)
    return Columns(values, states[second].made_of, (*notes, *told))


def _whole(state: _State, asked: Asked) -> bool:
    """Whether a ``state`` has x, a pressure and, if there is friction, a shear."""
    shears = set(state.values) - {"x", *NORMAL}
    return "x" in state.values and bool(set(NORMAL) & set(state.values)) and bool(shears or not asked.shear)


def _averaged(state: _State) -> _State:
    """``state`` with one row for each x, ascending, or as it is if it has no x."""
    x = state.values.get("x")
    if x is None or not len(x):
        return state
    order = np.argsort(x, kind="stable")
    first = starts(x[order])
    counts = np.diff(np.append(first, len(x)))
    values = {name: np.add.reduceat(column[order], first) / counts for name, column in state.values.items()}
    nodes = [state.nodes[row] for row in order] if state.nodes and len(first) == len(x) else None
    return state._replace(values=values, nodes=nodes)


def _beside(one: _State, other: _State) -> _State:
    """Both in one: what one has, and what the other has."""
    if (set(one.values) - {"x"}) & set(other.values) or set(one.values) == set(other.values):
        raise InputError(
            f"{one.name} and {other.name}: must be a file of p and one of q, or both in each; or give --columns"
        )
    if "x" not in one.values or set(one.values) == {"x"}:
        one, other = other, one
    _check_of(one, other, ("part", "step", "frame", "pair"))
    other = _at_points_of(one, other)
    made = ", ".join(dict.fromkeys(part for text in (one.made_of, other.made_of) for part in text.split(", ") if part))
    return one._replace(values=other.values | one.values, made_of=made, of=other.of | one.of)


def _check_of(one: _State, other: _State, keys: Sequence[str]) -> None:
    """Raise InputError if both say of what they are, and it is not the same."""
    for key in keys:
        if key in one.of and one.of[key].lower() != other.of.get(key, one.of[key]).lower():
            raise InputError(
                f"{one.name} is of {key} {one.of[key]}, {other.name} of {other.of[key]}: must be of one {key}"
            )


def _at_points_of(one: _State, other: _State) -> _State:
    """``other`` with its rows in the order of ``one``: joined by x, or by numbers of nodes."""
    if other is one:
        return other
    x, at = one.values.get("x"), other.values.get("x")
    if x is not None and at is not None and len(x) == len(at) and np.abs(x - at).max() <= _APART * np.ptp(x):
        return other
    alone = set(other.values) == {"x"}  # a list of nodes, which may have others, too
    has, other_has = set(one.nodes or ()), set(other.nodes or ())
    once = len(has) == len(one.nodes or ()) and len(other_has) == len(other.nodes or ())
    if has and once and (has == other_has or (alone and has < other_has)):
        rows = {node: row for row, node in enumerate(other.nodes or ())}
        order = np.array([rows[node] for node in one.nodes or ()])
        return other._replace(values={name: column[order] for name, column in other.values.items()}, nodes=one.nodes)
    counts = [len(next(iter(state.values.values()))) for state in (one, other)]
    raise InputError(
        f"{one.name} and {other.name}: {counts[0]} and {counts[1]} rows: must be at the same x, or have the same nodes "
        "in a column node"
    )
