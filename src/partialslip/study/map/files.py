"""Files of a stick-zone map, and the scene's place on the map as text."""

from pathlib import Path

import numpy as np

from partialslip.report import rows
from partialslip.result import RATCHETS
from partialslip.scene import Scene
from partialslip.study.map.figure import ends_svg, map_svg, varying_svg
from partialslip.study.map.grid import StickMap
from partialslip.study.map.varying import VaryingMap
from partialslip.tools.output.files import csv_text, write_texts


def write_map(data: StickMap | VaryingMap, folder: Path) -> list[Path]:
    """Write the map ``data`` into ``folder``: map.svg, map.csv and, under constant P, ends.svg. Returns the paths.

    Raises
    ------
    InputError
        If the folder cannot be written.
    """
    if isinstance(data, VaryingMap):
        return write_texts(folder, {"map.svg": varying_svg(data), "map.csv": varying_csv(data)})
    texts = {"map.svg": map_svg(data), "ends.svg": ends_svg(data), "map.csv": map_csv(data)}
    return write_texts(folder, texts)


def map_csv(data: StickMap) -> str:
    """Return the grid's stick zones of ``data`` as CSV, one row per point; with dQ and dsigma in a scene's units. The
    last column tells where gradual ``loads`` have these zones, and where only a single step has."""
    grid, zone = data.grid, data.grid.zone
    regime = np.where(zone.s > 0, "small tension", "large tension")
    regime[(grid.Qf == 0) & (grid.sf == 0)] = "stuck"
    columns = {"Qf": grid.Qf, "sf": grid.sf}
    if data.scene and data.pressed:
        f, units = data.scene.friction.f, data.scene.units
        columns |= {
            units.heading("dQ", "N/m"): units.from_si(2 * f * data.pressed.P * grid.Qf, "N/m"),
            units.heading("dsigma", "Pa"): units.from_si(f * data.pressed.p0 * grid.sf, "Pa"),
        }
    columns |= {"m_over_a": zone.m, "n_over_a": zone.n, "half_width_over_a": zone.half_width}
    holds = np.where(grid.turned, "one step", "gradual")
    values = (column.ravel().tolist() for column in (*columns.values(), regime, holds))
    return csv_text([*columns, "regime", "loads"], zip(*values, strict=True))


def varying_csv(data: VaryingMap) -> str:
    """Return the grid of ``data`` as CSV, one row per point; m and n only where both ends slip."""
    scene, units = data.scene, data.scene.units
    dQ, both = scene.friction.f * scene.P * data.Q_change, data.both
    columns = {
        "dP_over_P": data.P_change,
        "dQ_over_fP": data.Q_change,
        units.heading("dP", "N/m"): units.from_si(scene.P * data.P_change, "N/m"),
        units.heading("dQ", "N/m"): units.from_si(dQ, "N/m"),
        units.heading("dsigma", "Pa"): units.from_si(data.ratio / data.pressed.a * dQ, "Pa"),
        "m_over_a": np.where(both, data.m.astype(object), ""),
        "n_over_a": np.where(both, data.n.astype(object), ""),
        "regime": data.regime,
    }
    return csv_text(list(columns), zip(*(column.ravel().tolist() for column in columns.values()), strict=True))


def bodies_left_out(scene: Scene, what: str) -> list[str]:
    """Return that ``what`` shows half-planes under the loads of ``scene``, as a line; empty without finite bodies."""
    finite = ", ".join(key for key, _ in scene.bodies)
    return [f"{what} shows half-planes: {finite} left out"] if finite else []


def place(data: StickMap | VaryingMap) -> list[str]:
    """Return regime, stick zone and limits of the scene of the map ``data`` as lines of text; empty without a scene."""
    if data.scene is None:
        return []
    name, point = data.scene.name, data.point
    if point is None:
        missing = data.missing if isinstance(data, StickMap) else "the contact slides: |Q| >= f P at a load point"
        return [f"{name}: not on the map: {missing}"]
    left_out = bodies_left_out(data.scene, "the map")
    exact = point.exact
    if point.missing:
        return [f"{name}: {point.missing}", *left_out]
    assert exact
    ends = ", ".join(f"{key} = {rows.value(exact, key)}" for key in ("m", "n")) if exact.steady else RATCHETS
    mirrored = " (dQ and dsigma differ in sign: on the map m and n change places)" if point.mirrored else ""
    limits = rows.limits(exact, data.scene.units)
    return [f"{name}: {exact.regime}, {ends}{mirrored}", *filter(None, [limits]), *left_out]
