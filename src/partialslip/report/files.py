"""Files: whole ones or none, whenever it is stopped; and those of a run."""

import csv
import io
import json
import os
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import numpy as np

from partialslip.errors import InputError
from partialslip.report.figure import traction_svg
from partialslip.report.page import page
from partialslip.report.record import record
from partialslip.run import Run


def write_run(run: Run, folder: Path) -> list[Path]:
    """Write results.json, tractions.csv and report.html into ``folder``; where fields inside the bodies were asked for,
    surface.csv, bodies.vtu and mesh.msh, too (lower.msh and upper.msh of bodies that are not mirror images). Returns
    the files' paths. Raises InputError if the folder cannot be written.
    """
    data = record(run)
    files: dict[str, Callable[[Path], object]] = {
        "results.json": lambda path: path.write_text(json.dumps(data, indent=1, allow_nan=False) + "\n", "utf-8"),
        "tractions.csv": lambda path: path.write_text(tractions_csv(run), "utf-8"),
        "report.html": lambda path: path.write_text(page(run, data, traction_svg(run)), "utf-8"),
    }
    if bodies := next((result.bodies for result in run.results.values() if result.bodies), None):
        from partialslip_meshes.write import write_msh, write_vtu

        meshes = {"mesh.msh": bodies[0]} if run.scene.mirrored else {f"{body.name}.msh": body for body in bodies}
        files |= {name: partial(write_msh, body=body) for name, body in meshes.items()}
        files["bodies.vtu"] = lambda path: write_vtu(path, bodies)
    if any(result.surface for result in run.results.values()):
        files["surface.csv"] = lambda path: path.write_text(surface_csv(run), "utf-8")
    return write_files(folder, files)


def write_files(folder: Path, files: Mapping[str, Callable[[Path], object]]) -> list[Path]:
    """Write each of ``files``, by name the function that takes the path to write to, into ``folder``. Returns their
    paths. Raises InputError if the folder cannot be written.
    """
    for name in files:
        if os.path.isdir(folder / name):
            raise InputError(f"{folder / name}: cannot be written: is a folder")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, write in files.items():
            with _replacing(folder / name) as path:
                write(path)
    except (OSError, ValueError) as error:  # ValueError: a name that no file can have
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(f"--out {folder}: cannot be written: {reason}") from None
    return [folder / name for name in files]


def tractions_csv(run: Run) -> str:
    """Tractions of every method, one row a point; SI units, empty where a method does not determine a value."""
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\n")
    writer.writerow(["method", *next(iter(run.results.values())).columns])
    for name, result in run.results.items():
        columns = result.columns.values()
        listed = [[""] * len(result.traction.x) if column is None else column.tolist() for column in columns]
        writer.writerows([name, *row] for row in zip(*listed, strict=True))
    return table.getvalue()


def surface_csv(run: Run) -> str:
    """sigma_xx along the surfaces by every method that knows it, one row a point; SI units."""
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\n")
    writer.writerow(["method", "x", "x_over_a", "lower_1", "lower_2", "upper_1", "upper_2"])
    for name, result in run.results.items():
        if surface := result.surface:
            columns = np.vstack([surface.x, surface.x / result.a, *surface.sigma[0], *surface.sigma[1]])
            writer.writerows([name, *row] for row in columns.T.tolist())
    return table.getvalue()


@contextmanager
def _replacing(path: Path) -> Iterator[Path]:
    """A path beside ``path`` to write to, which takes its place when the block ends well."""
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.stem}-", suffix=path.suffix)
    os.close(handle)
    beside = Path(name)
    try:
        yield beside
        beside.chmod(0o666 & ~_umask())
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
