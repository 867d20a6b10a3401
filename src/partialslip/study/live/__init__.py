"""The live page: one self-contained HTML file. Its mechanics are in ``hertz.js``: constant P, without a moment."""

import functools
import math
from importlib.metadata import version
from typing import Any

import numpy as np
from msgspec.structs import fields

from partialslip.halfplane import contact
from partialslip.halfplane.gradual_table import table
from partialslip.scene import Hertz, Scene
from partialslip.scene.units import SI
from partialslip.study.map.files import bodies_left_out
from partialslip.study.map.grid import MapLine, stick_map
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError
from partialslip.tools.output.labels import label_places
from partialslip.tools.output.page import template

_SHAPE = 1.5  # display: width over height of the map on the page
_NAMES = np.array([(0.05, 0.94), (0.12, 0.94), (0.19, 0.94), (0.8, 0.03), (0.88, 0.03), (0.96, 0.03)])  # regime names
_SOLVED = {  # fields that the page takes into account; any other that is given is refused
    "profile": ("R",),
    "load": ("P", "a", "p0", "Q", "sigma", "cycles", "steps"),
    "effects": (),
}
_ROUNDED = 5  # display: decimals of the map's lines
_DECIMALS = 7  # accuracy: of the table of gradual zones: its patches stay within 1e-4 a
# display: dsigma/(f p0) at the map's top, more for scenes with more, up to the second number
_TOP, _HIGHEST = 10.0, 40.0


def live_page(scene: Scene) -> str:
    """Return the live page of ``scene`` as HTML: sliders for the loads, tractions and stick zone.

    The sliders start at the loads of the scene. Finite bodies are left out, and the page says so: it shows
    half-planes under the same loads.

    Raises
    ------
    InputError
        If the profile is not ``hertz``, the bodies' materials differ, an effect is forced on or off, displacements
        drive the bodies, there is no friction, P varies or has a moment, or the loads are out of phase.
    """
    _require_solvable(scene)
    return (
        template("partialslip.study.live", "live.html").render(
            data=_data(scene),
            left_out=bodies_left_out(scene, "the page"),
            units=scene.units,
            version=version("partialslip"),
        )
        + "\n"
    )


def _require_solvable(scene: Scene) -> None:
    """Raise InputError if the page does not solve ``scene``."""
    if not isinstance(scene.profile, Hertz):
        kind = type(scene.profile).__struct_config__.tag
        raise InputError(f'profile.kind = "{kind}": must be "hertz" for a live page (closed form for Hertz only)')
    for name, solved in _SOLVED.items():
        table = getattr(scene, name)
        for field in fields(table):
            if field.name not in solved and getattr(table, field.name) != field.default:
                raise InputError(
                    f"{name}.{field.encode_name}: must not be given for a live page, which shows the steady state of "
                    "two half-planes"
                )
    if not scene.material.alike:
        raise InputError("material.upper, material.lower: the bodies differ; must be of one material for a live page")
    if scene.friction.f == 0:
        raise InputError("friction.f = 0: must be > 0 for a live page: without friction there is no stick zone")
    scene.require_uniform_friction("for a live page")
    if not scene.load.in_phase:
        raise InputError(f"load: {scene.varying} are out of phase; must be in phase for a live page")
    if scene.presses_anew:
        raise InputError("load: P varies; must be constant for a live page")


def _data(scene: Scene) -> dict[str, Any]:
    """Return the page's data of the scene, in SI units; the map's lines are scaled.

    ``units`` has labels and sizes of the units in which the page shows numbers; none for SI with prefixes.
    """
    pressed, load, f, units = contact(scene.half_planes), scene.load, scene.friction.f, scene.units
    sf = abs(load.dsigma) / (f * pressed.p0)
    return {
        "name": scene.name,
        "title": scene.title,
        "a": pressed.a,
        "p0": pressed.p0,
        "P": pressed.P,
        "f": f,
        "most_friction": max(1.5, 2 * f),
        "dQ": load.dQ,
        "dsigma": load.dsigma,
        "Q_mean": load.Q_mean,
        "units": {of: [units.label(of), units.size(of)] for of in ("m", "Pa", "N/m")} if units != SI else {},
        "table": _gradual_table(),
        "map": _map_lines(max(_TOP, math.ceil(1.2 * sf)) if sf <= _HIGHEST else _TOP),
    }


@functools.cache
def _gradual_table() -> dict[str, Any]:
    """Return the table of gradual zones in the page's accuracy: coefficients of series are rounded, and left out beyond
    the last that is not zero."""

    def short(series: list[float]) -> list[float]:
        rounded = np.round(series, _DECIMALS)
        return _trimmed(rounded.tolist())

    panels = [
        {
            **panel,
            "borders": [short(border) for border in panel["borders"]],
            "patches": [[_trimmed([short(row) for row in end]) for end in patch] for patch in panel["patches"]],
        }
        for panel in table()["panels"]
    ]
    return {"panels": panels}


def _trimmed(values: list[Any]) -> list[Any]:
    """Return ``values`` without zeros and empty lists at their end."""
    last = max((number for number, value in enumerate(values) if value), default=-1)
    return values[: last + 1]


@functools.cache
def _map_lines(top: float) -> dict[str, Any]:
    """Return lines of equal m and n up to sf = ``top``, with places of the labels, and the border between the regimes;
    in (Qf, sf)."""
    found = stick_map()
    border, lines = (
        _line_points(found.border, top),
        [_line_points(line, top) for line in (*found.m_lines, *found.n_lines)],
    )
    paper = np.array([_SHAPE, 1 / top])
    avoided = np.vstack([border, _NAMES * (1, top)])
    labelled = [
        {
            "value": line.at,
            "points": _rounded_list(points),
            "label": None if place is None else _rounded_list(place[0] / paper),
        }
        for line, points, place in zip(
            (*found.m_lines, *found.n_lines),
            lines,
            label_places([points * paper for points in lines], avoided * paper, _SHAPE),
            strict=True,
        )
    ]
    count = len(found.m_lines)
    return {"m": labelled[:count], "n": labelled[count:], "border": _rounded_list(border), "top": float(top)}


def _line_points(line: MapLine, top: float) -> Array:
    """Return the points (k, 2) of a line on the map and slightly beyond."""
    on = (line.Qf <= 1) & (line.sf <= 1.5 * top)
    return np.column_stack([line.Qf[on], line.sf[on]])


def _rounded_list(points: Array) -> list[Any]:
    return points.round(_ROUNDED).tolist()
