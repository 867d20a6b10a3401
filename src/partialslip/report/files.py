"""Write the files of a run."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from partialslip.report.loop import loop_csv
from partialslip.report.page import Section, run_page
from partialslip.report.record import record
from partialslip.run import Run
from partialslip.scene.units import Dimension, Units
from partialslip.tools.origin import Made, made_now
from partialslip.tools.output.files import csv_text, write_files, write_texts
from partialslip.tools.output.page import write_pdf

_DIMENSIONS: dict[str, Dimension] = {"method": "1", "x": "m", "x_over_a": "1"}  # all other columns are stresses

PAGE, PDF = "report.html", "report.pdf"


def write_run(
    run: Run, folder: Path, made: Made | None = None, *, pdf: bool = False, sections: Sequence[Section] = ()
) -> list[Path]:
    """Write results.json, tractions.csv and report.html of ``run`` into ``folder``. Returns the paths.

    ``made`` is the origin of the run (default: now, by a call from Python). With ``pdf``, also write report.pdf. The
    report has further ``sections``.
    Where the plates of two finite bodies are known, also write loop.csv: displacement, Q and load points of the steady
    cycle.
    If fields inside the bodies were asked for, also write surface.csv, bodies.vtu and mesh.msh; lower.msh and upper.msh
    instead of mesh.msh if the bodies are not mirror images.

    Raises
    ------
    InputError
        If the folder cannot be written.
    MissingLibraryError
        If a library for the PDF is missing.
    """
    made = made or made_now()
    data, html = record(run, made=made), run_page(run, made, sections)
    files: dict[str, Callable[[Path], object]] = {
        "results.json": lambda path: path.write_text(data.json, "utf-8"),
        "tractions.csv": lambda path: path.write_text(tractions_csv(run), "utf-8"),
        PAGE: lambda path: path.write_text(html, "utf-8"),
    }
    if loop := loop_csv(run):
        files["loop.csv"] = lambda path: path.write_text(loop, "utf-8")
    fields = run.plan.needs("subsurface")
    if fields and (bodies := next((result.bodies for result in run.results.values() if result.bodies), None)):
        from partialslip_meshes.write import write_msh, write_vtu

        meshes = {"mesh.msh": bodies[0]} if run.scene.mirrored else {f"{body.name}.msh": body for body in bodies}
        files |= {name: partial(write_msh, body=body) for name, body in meshes.items()}
        files["bodies.vtu"] = lambda path: write_vtu(path, bodies)
    if fields and any(result.surface for result in run.results.values()):
        files["surface.csv"] = lambda path: path.write_text(surface_csv(run), "utf-8")
    return write_files(folder, files) + (write_pdf(html, folder, PDF) if pdf else [])


def write_page(html: str, folder: Path, *, pdf: bool = False) -> list[Path]:
    """Write the report ``html`` as report.html and, with ``pdf``, report.pdf into ``folder``. Returns the paths.

    Raises
    ------
    InputError
        If the folder cannot be written.
    MissingLibraryError
        If a library for the PDF is missing.
    """
    return write_texts(folder, {PAGE: html}) + (write_pdf(html, folder, PDF) if pdf else [])


def tractions_csv(run: Run) -> str:
    """Return the tractions of all methods as CSV, one row per point, in the scene's units; empty where a method has no
    value."""
    table = _in_units(run.columns, run.scene.units)
    values = ([("" if number != number else number) for number in column.tolist()] for column in table.values())
    return csv_text(list(table), zip(*values, strict=True))


def surface_csv(run: Run) -> str:
    """Return sigma_xx along the surfaces as CSV, for the methods that compute it, one row per point, in the scene's
    units."""
    surfaces = {name: (result.a, result.surface) for name, result in run.results.items() if result.surface}
    columns = [
        [np.full(surface.x.shape, name), surface.x, surface.x / a, *surface.sigma[0], *surface.sigma[1]]
        for name, (a, surface) in surfaces.items()
    ]
    names = ("method", "x", "x_over_a", "lower_1", "lower_2", "upper_1", "upper_2")
    table = dict(zip(names, map(np.concatenate, zip(*columns, strict=True)), strict=True))
    table = _in_units(table, run.scene.units)
    return csv_text(list(table), zip(*(column.tolist() for column in table.values()), strict=True))


def _in_units(columns: Mapping[str, npt.NDArray[Any]], units: Units) -> dict[str, npt.NDArray[Any]]:
    """Convert ``columns`` from SI units: x, and stresses. The headings name the units if not SI."""
    of = {name: _DIMENSIONS.get(name, "Pa") for name in columns}
    return {units.heading(name, of[name]): units.from_si(column, of[name]) for name, column in columns.items()}
