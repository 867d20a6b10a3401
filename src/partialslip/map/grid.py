"""The data of the stick-zone map: stick zones over all loads at once, lengths as fractions of a.

Loads are scaled by the friction: Qf = dQ/(2 f P) and sf = dsigma/(f p0) with p0 = 2 P/(pi a). The map is that of
positive dQ and dsigma; other signs follow by symmetry.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.halfplane.contact import Contact, contact
from partialslip.halfplane.hertz import Hertz
from partialslip.halfplane.shape import Shape
from partialslip.halfplane.steady import stick_zones, transition
from partialslip.result import Result, StickZone
from partialslip.run import run
from partialslip.scene import Scene

_TOP = 10.0  # of sf; more where the scene's point needs it, up to
_HIGHEST = 40.0
_COUNT = 50  # of steps along either axis
_COUNT_KINKED = 25  # where the pressure has corners, which take their time
M_LEVELS = (0.2, 0.4, 0.6, 0.8, 0.9)
N_LEVELS = (-0.8, -0.6, -0.4, -0.2, 0.0, 0.2, 0.4, 0.6, 0.8)
_AT_ONCE = 128  # zones between two tellings of progress
_CONSTANT = np.array([0.2, 0.4, 0.6, 0.8])  # Qf of the curves over dsigma a/dQ, which is sf/(pi Qf)
_RATIOS = np.linspace(0, 8, 51)
_ALONG = 101  # points of a line


class LoadedZones(NamedTuple):
    """Loads ``Qf`` and ``sf`` and their stick zones ``zone``, as fractions of a: arrays of one shape."""

    Qf: Array
    sf: Array
    zone: StickZone[Array]


class Line(NamedTuple):
    """The loads (points,) that give one end of the stick zone its place ``at`` (m or n)."""

    at: float
    Qf: Array
    sf: Array


@dataclass(frozen=True)
class Point:
    """Where a scene lies on the map: the sizes of its scaled loads, and what the ``exact`` method says of it.
    ``mirrored``: its loads differ in sign, so that m and n change places on the map."""

    Qf: float
    sf: float
    mirrored: bool
    exact: Result


@dataclass(frozen=True)
class StickMap:
    """``grid``: (rows of equal sf, columns of equal Qf). ``m_lines`` and ``n_lines``: loads of equal m and equal n.
    ``border``: between small and large tension, where m = a. ``curves``: (curves of equal Qf, points), with that
    border among the points; ``turns``: there, (curves,).

    ``scene`` and ``pressed`` are None for Hertz in general; ``point`` is None where there is no scene, or where it is
    not on the map: ``missing`` says why.
    """

    grid: LoadedZones
    m_lines: list[Line]
    n_lines: list[Line]
    border: Line
    curves: LoadedZones
    turns: LoadedZones
    scene: Scene | None = None
    pressed: Contact | None = None
    point: Point | None = None
    missing: str = ""


def stick_map(scene: Scene | None = None, progress: Callable[[str], None] = lambda _: None) -> StickMap:
    """The map for the pressure of ``scene``, without one for Hertz. ``progress`` is called with a line of text now and
    then.

    Raises
    ------
    InputError
        If there is no friction; and as :func:`partialslip.halfplane.contact`.
    """
    if scene is None:
        return _mapped(Hertz(), _TOP, progress)
    if scene.friction.f == 0:
        raise InputError("friction.f = 0: must be > 0 for a map; without friction nothing sticks")
    pressed = contact(scene)
    point, missing = _point(scene, pressed)
    top = max(_TOP, math.ceil(1.2 * point.sf)) if point else _TOP
    data = _mapped(pressed.shape, top, progress)
    return replace(data, scene=scene, pressed=pressed, point=point, missing=missing)


def _mapped(shape: Shape, top: float, progress: Callable[[str], None]) -> StickMap:
    count = _COUNT_KINKED if shape.kinks else _COUNT
    grid = np.meshgrid(np.linspace(0, 1, count, endpoint=False), np.linspace(0, top, count + 1))
    turns = transition(_CONSTANT, shape)
    ratios = np.broadcast_to(_RATIOS, (len(_CONSTANT), len(_RATIOS)))
    tensions = np.sort(np.concatenate([np.pi * _CONSTANT[:, None] * ratios, turns[:, None]], axis=1), axis=1)
    return StickMap(
        grid=_zones(grid[0], grid[1], shape, lambda share: progress(f"map {share:.0%}")),
        m_lines=[line for m in M_LEVELS for line in _m_lines(m, shape)],
        n_lines=[_n_line(n, shape) for n in N_LEVELS],
        border=_m_lines(1.0, shape)[0],
        curves=_zones(_CONSTANT[:, None] + 0 * tensions, tensions, shape, lambda share: progress(f"ends {share:.0%}")),
        turns=_zones(_CONSTANT, turns, shape),
    )


def _m_lines(m: float, shape: Shape) -> tuple[Line, Line]:
    """Small and large tension. n goes from m, where dsigma or dQ is zero, to -m, where the stick zone has gone: the
    loads of a stick zone are explicit (docs/theory.md, section 4)."""
    c = m * _half_widths(0.0, 1.0)
    small, large = (shape.conditions(1 - m + 0 * c, c, s + 0 * c) for s in (1, -1))
    return Line(m, small.Qf, small.sf), Line(m, large.Qf, large.sf)


def _n_line(n: float, shape: Shape) -> Line:
    """m goes from n or -n to 1 (small tension), and back (large tension)."""
    c = _half_widths(max(n, 0.0), (1 + n) / 2)
    c, s = np.concatenate([c, c[-2::-1]]), np.repeat([1, -1], [len(c), len(c) - 1])
    loads = shape.conditions(np.maximum(1 + n - 2 * c, 0.0), c, s)
    return Line(n, loads.Qf, loads.sf)


def _half_widths(low: float, high: float) -> Array:
    """Half-widths that crowd towards the lower one, and end before zero."""
    return low + (high - low) * np.linspace(1e-4, 1, _ALONG) ** 3


def _zones(Qf: Array, sf: Array, shape: Shape, progress: Callable[[float], None] = lambda _: None) -> LoadedZones:
    """Some at a time, as corners in the pressure take their time; ``progress`` is told the share that is done."""
    parts = []
    for start in range(0, Qf.size, _AT_ONCE):
        progress(start / Qf.size)
        part = slice(start, start + _AT_ONCE)
        parts.append(stick_zones(Qf.ravel()[part], sf.ravel()[part], shape))
    zone = StickZone(*(np.concatenate(values).reshape(Qf.shape) for values in zip(*parts, strict=True)))
    return LoadedZones(Qf, sf, zone)


def _point(scene: Scene, pressed: Contact) -> tuple[Point | None, str]:
    """The scene's point, or why it has none."""
    load, f = scene.load, scene.friction.f
    if not load.in_phase:
        return None, "Q and sigma are out of phase"
    exact = run(scene, ["exact"]).results["exact"]
    if exact.regime == "sliding":
        return None, exact.notes[0]
    Qf, sf = abs(load.dQ) / (2 * f * pressed.P), abs(load.dsigma) / (f * pressed.p0)
    if sf > _HIGHEST:
        return None, f"dsigma = {load.dsigma:g} Pa is more than {_HIGHEST:g} f p0"
    return Point(Qf, sf, load.dQ * load.dsigma < 0, exact), ""
