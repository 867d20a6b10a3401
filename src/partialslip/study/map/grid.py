"""Data of the stick-zone map: stick zones over a grid of loads, lengths as fractions of a.

The zones are those of gradual loads where slip does not reverse and, for Hertz, where the table of gradual zones has
them. Elsewhere they are those of a single step, and marked.

Loads are scaled by the friction: Qf = dQ/(2 f P) and sf = dsigma/(f p0) with p0 = 2 P/(pi a). The map shows positive
dQ and dsigma; other signs follow by symmetry.
"""

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from partialslip.halfplane.contact import Contact, contact
from partialslip.halfplane.gradual_table import tabled
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.shape import Shape
from partialslip.halfplane.steady import stick_zones, transition
from partialslip.result import Result, StickZone
from partialslip.run import run
from partialslip.run.judge.reference import reference
from partialslip.scene import Scene
from partialslip.scene.gradual import turns_round
from partialslip.tools.arrays import Array, Mask
from partialslip.tools.errors import InputError

_TOP = 10.0  # limit: largest sf, unless the scene's point is higher
_HIGHEST = 40.0  # limit: largest sf of a scene's point on the map
_COUNT = 50  # display: steps along either axis
_COUNT_KINKED = 25  # display: the same for a pressure with corners, which is slower
M_LEVELS = (0.2, 0.4, 0.6, 0.8, 0.9)  # display: of m on the map, in a
N_LEVELS = (-0.8, -0.6, -0.4, -0.2, 0.0, 0.2, 0.4, 0.6, 0.8)  # display: of n on the map, in a
_FINE = 200  # display: points along either axis of the grid through which lines of gradual zones are drawn
_NEXT = 0.04  # display: of the map: distance of the ends of parts of one line
_AT_ONCE = 128  # cost: zones between two calls of progress
_CONSTANT = np.array([0.2, 0.4, 0.6, 0.8])  # Qf of the curves over dsigma a/dQ, which is sf/(pi Qf)
_RATIOS = np.linspace(0, 8, 51)
_ALONG = 101  # display: points per line


class LoadedZones(NamedTuple):
    """Loads ``Qf`` and ``sf`` and their stick zones ``zone``, as fractions of a: arrays of one shape. ``turned``: where
    the zones are those of a single step, and do not hold, as slip reverses between the load points."""

    Qf: Array
    sf: Array
    zone: StickZone[Array]
    turned: Mask


class MapLine(NamedTuple):
    """Line of scaled loads ``Qf`` and ``sf`` (points,) of constant m or n, ``at``, as a fraction of a."""

    at: float
    Qf: Array
    sf: Array


@dataclass(frozen=True)
class Point:
    """Point of a scene on the map.

    Parameters
    ----------
    place : (float, float)
        Absolute values of the scaled loads along the two axes of the map.
    mirrored : bool
        Whether dQ and dsigma differ in sign; m and n are then swapped on the map.
    exact : Result or None
        Result of the exact method; None if it does not hold, or there is no closed form.
    missing : str
        Why.
    """

    place: tuple[float, float]
    mirrored: bool
    exact: Result | None
    missing: str = ""


@dataclass(frozen=True)
class StickMap:
    """The stick-zone map.

    Parameters
    ----------
    grid : LoadedZones
        Stick zones over the loads, (rows of equal sf, columns of equal Qf).
    m_lines, n_lines : list of MapLine
        Lines of equal m and of equal n.
    border : MapLine
        Border between small and large tension, where m = a.
    curves : LoadedZones
        (curves of equal Qf, points), the point on the border included.
    turns : LoadedZones
        Points of the curves on the border, (curves,).
    scene, pressed : Scene and Contact, or None
        The scene and its normal contact; None for Hertz in general.
    point : Point or None
        Point of the scene; None without a scene, or if the scene is not on the map.
    missing : str
        Why the scene is not on the map.
    """

    grid: LoadedZones
    m_lines: list[MapLine]
    n_lines: list[MapLine]
    border: MapLine
    curves: LoadedZones
    turns: LoadedZones
    scene: Scene | None = None
    pressed: Contact | None = None
    point: Point | None = None
    missing: str = ""


def stick_map(scene: Scene | None = None, progress: Callable[[str], None] = lambda _: None) -> StickMap:
    """Compute the stick-zone map.

    Parameters
    ----------
    scene : Scene, optional
        Scene with the profile of the map; default: Hertz.
    progress : callable
        ``progress(line)``: called from time to time with a line of text.

    Raises
    ------
    InputError
        If the bodies differ, there is no friction, P varies (see :func:`varying_map`), or the pressure is not even;
        and as :func:`partialslip.halfplane.contact`.
    """
    if scene is None:
        return _mapped(HertzShape(), _TOP, progress)
    require_stick_zones(scene)
    scene.require_even("for a map", "partialslip.halfplane.one_step_zone takes others, many loads at once")
    if scene.presses_anew:
        given = scene.load.shown("P", scene.units)
        raise InputError(f"load.P = {given}: must be one number for a map over dQ and dsigma")
    pressed = contact(scene.half_planes)
    point, missing = _map_point(scene, pressed)
    top = max(_TOP, math.ceil(1.2 * point.place[1])) if point else _TOP
    data = _mapped(pressed.shape, top, progress)
    return replace(data, scene=scene, pressed=pressed, point=point, missing=missing)


def require_stick_zones(scene: Scene) -> None:
    """Raise InputError if ``scene`` has dissimilar bodies, displacements in place of Q, no friction, or a coefficient
    that varies along x."""
    if not scene.material.alike:
        raise InputError("material.upper, material.lower: the bodies differ; must be of one material for a map")
    scene.load.require_forces(scene.units)
    if scene.friction.f == 0:
        raise InputError("friction.f = 0: must be > 0 for a map: without friction there is no stick zone")
    scene.require_uniform_friction("for a map")


def _mapped(shape: Shape, top: float, progress: Callable[[str], None]) -> StickMap:
    count = _COUNT_KINKED if shape.kinks else _COUNT
    grid = np.meshgrid(np.linspace(0, 1, count, endpoint=False), np.linspace(0, top, count + 1))
    turns = transition(_CONSTANT, shape)
    ratios = np.broadcast_to(_RATIOS, (len(_CONSTANT), len(_RATIOS)))
    tensions = np.sort(np.concatenate([np.pi * _CONSTANT[:, None] * ratios, turns[:, None]], axis=1), axis=1)
    m_lines, n_lines = _hertz_lines() if isinstance(shape, HertzShape) else _lines_of(shape)
    return StickMap(
        grid=_zones(grid[0], grid[1], shape, lambda share: progress(f"map {share:.0%}")),
        m_lines=m_lines,
        n_lines=n_lines,
        border=_m_lines(1.0, shape)[0],
        curves=_zones(_CONSTANT[:, None] + 0 * tensions, tensions, shape, lambda share: progress(f"ends {share:.0%}")),
        turns=_zones(_CONSTANT, turns, shape),
    )


def _m_lines(m: float, shape: Shape) -> tuple[MapLine, MapLine]:
    """Return the lines of equal m for small and large tension.

    n runs from m (dsigma or dQ is zero) to -m (no stick zone is left). The loads are explicit functions of the stick
    zone (docs/theory.md, section 4).
    """
    c = m * _half_widths(0.0, 1.0)
    small, large = (shape.conditions(1 - m + 0 * c, c, s + 0 * c) for s in (1, -1))
    return MapLine(m, small.Qf, small.sf), MapLine(m, large.Qf, large.sf)


def _n_line(n: float, shape: Shape) -> MapLine:
    """Return the line of equal n: m runs from |n| to 1 (small tension), and back (large tension)."""
    c = _half_widths(max(n, 0.0), (1 + n) / 2)
    c, s = np.concatenate([c, c[-2::-1]]), np.repeat([1, -1], [len(c), len(c) - 1])
    loads = shape.conditions(np.maximum(1 + n - 2 * c, 0.0), c, s)
    return MapLine(n, loads.Qf, loads.sf)


def _lines_of(shape: Shape, fine: LoadedZones | None = None) -> tuple[list[MapLine], list[MapLine]]:
    """Return the lines of equal m and of equal n."""
    m_lines = [line for m in M_LEVELS for line in _m_lines(m, shape)]
    n_lines = [_n_line(n, shape) for n in N_LEVELS]
    return _gradual_lines(m_lines, "m", shape, fine), _gradual_lines(n_lines, "n", shape, fine)


@functools.cache
def _hertz_lines() -> tuple[list[MapLine], list[MapLine]]:
    """Return the lines for Hertz, through gradual zones on a fine grid of loads."""
    Qf, sf = np.meshgrid(np.linspace(0, 1, _FINE, endpoint=False), np.linspace(0, _TOP, _FINE))
    return _lines_of(HertzShape(), _zones(Qf, sf, HertzShape()))


def _gradual_lines(once: list[MapLine], of: str, shape: Shape, fine: LoadedZones | None) -> list[MapLine]:
    """Return lines of equal m or n under gradual loads: the lines of a single step, ``once``, and in place of their
    parts where the table of gradual zones has others, lines through the ``fine`` grid of gradual zones, if any."""
    if fine is None:
        return once
    from contourpy import contour_generator  # takes long to import

    contours = contour_generator(fine.Qf, fine.sf, np.where(fine.turned, np.nan, getattr(fine.zone, of)))
    levels = sorted({line.at for line in once})
    there = [MapLine(at, *np.asarray(line, float).T) for at in levels for line in contours.lines(at)]
    parts = [part for line in once for part in _parts(line, ~_tabled(line, shape))]
    parts += [part for line in there for part in _parts(line, _tabled(line, shape))]
    return [line for at in levels for line in _joined([part for part in parts if part.at == at])]


def _joined(parts: list[MapLine]) -> list[MapLine]:
    """Return lines in which ``parts`` of lines, whose ends are next to each other, are one."""
    lines: list[MapLine] = []
    for part in sorted(parts, key=lambda part: -len(part.Qf)):
        points = np.column_stack([part.Qf, part.sf])
        while True:
            ends = ((line, way, turned) for line in lines for way in (1, -1) for turned in (1, -1))
            found = next((each for each in ends if _gap(each, points) < _NEXT), None)
            if found is None:
                break
            line, way, turned = found
            lines = [other for other in lines if other is not line]
            points = np.concatenate([np.column_stack(line[1:])[::way], points[::turned]])
        lines.append(MapLine(part.at, *points.T))
    return lines


def _gap(join: tuple[MapLine, int, int], points: Array) -> float:
    """Return the distance on the map from the end of a line, in one way, to the beginning of ``points``, in one way."""
    line, way, turned = join
    Qf, sf = np.column_stack(line[1:])[::way][-1] - points[::turned][0]
    return math.hypot(Qf, sf / _TOP)


def _tabled(line: MapLine, shape: Shape) -> Mask:
    """Whether slip reverses at the points of a ``line``, and the table of gradual zones has them."""
    on = (line.Qf >= 0) & (line.Qf < 1) & (line.sf >= 0)
    Qf, sf = np.where(on, line.Qf, 0), np.where(on, line.sf, 0)
    zone = stick_zones(Qf, sf, shape)
    turned = turns_round(Qf, sf, zone.s, zone.centre, zone.half_width)
    return on & turned & ~np.isnan(tabled(Qf, sf).centre)


def _parts(line: MapLine, kept: Mask) -> list[MapLine]:
    """Return the parts of a ``line`` whose points are ``kept``."""
    cuts = np.flatnonzero(np.diff(kept)) + 1
    numbers = (part for part in np.split(np.arange(len(kept)), cuts) if kept[part[0]] and len(part) > 1)
    return [MapLine(line.at, line.Qf[part], line.sf[part]) for part in numbers]


def _half_widths(low: float, high: float) -> Array:
    """Return half-widths from just above ``low`` to ``high``, denser towards ``low``."""
    return low + (high - low) * np.linspace(1e-4, 1, _ALONG) ** 3


def _zones(Qf: Array, sf: Array, shape: Shape, progress: Callable[[float], None] = lambda _: None) -> LoadedZones:
    """Compute stick zones in batches and call ``progress`` with the share done: a pressure with corners is slow."""
    parts = []
    for start in range(0, Qf.size, _AT_ONCE):
        progress(start / Qf.size)
        part = slice(start, start + _AT_ONCE)
        parts.append(stick_zones(Qf.ravel()[part], sf.ravel()[part], shape))
    zone = StickZone(*(np.concatenate(values).reshape(Qf.shape) for values in zip(*parts, strict=True)))
    turned = turns_round(Qf, sf, zone.s, zone.centre, zone.half_width)
    if isinstance(shape, HertzShape):
        gradual = tabled(Qf[turned], sf[turned])
        known = ~np.isnan(gradual.centre)
        at = np.flatnonzero(turned)[known]
        for values, found in zip(zone, gradual, strict=True):
            values.flat[at] = found[known]
        turned.flat[at] = False
    return LoadedZones(Qf, sf, zone, turned)


def _map_point(scene: Scene, pressed: Contact) -> tuple[Point | None, str]:
    """Return the scene's point, or None and the reason."""
    load, f = scene.load, scene.friction.f
    if not load.in_phase:
        return None, "Q and sigma are out of phase"
    exact = run(scene, ["exact"]).results["exact"]
    if exact.regime == "sliding":
        return None, exact.notes[0]
    Qf, sf = abs(load.dQ) / (2 * f * pressed.P), abs(load.dsigma) / (f * pressed.p0)
    if sf > _HIGHEST:
        return None, f"dsigma = {scene.units.labelled(load.dsigma, 'Pa')} is more than {_HIGHEST:g} f p0"
    why = reference(scene).unknown.get("m", "")
    return Point((Qf, sf), load.dQ * load.dsigma < 0, None if why else exact, why), ""
