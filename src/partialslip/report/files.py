"""Files: whole ones or none, whenever it is stopped; and those of a run."""

import csv
import glob
import io
import json
import os
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import tomli_w

from partialslip.errors import InputError
from partialslip.report.figure import traction_svg
from partialslip.report.lock import lock
from partialslip.report.page import page
from partialslip.report.record import record
from partialslip.run import Run
from partialslip.scene import Scene


def write_run(run: Run, folder: Path) -> list[Path]:
    """Write results.json, tractions.csv and report.html of ``run`` into ``folder``; where fields inside the bodies were
    asked for, surface.csv, bodies.vtu and mesh.msh, too (lower.msh and upper.msh of bodies that are not mirror images).
    Returns the files' paths. Raises InputError if the folder cannot be written.
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


def write_texts(folder: Path, texts: Mapping[str, str]) -> list[Path]:
    """Write files of UTF-8 text, by name, as :func:`write_files` does."""

    def writer(text: str) -> Callable[[Path], object]:
        return lambda path: path.write_text(text, "utf-8")

    return write_files(folder, {name: writer(text) for name, text in texts.items()})


def csv_text(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table as the text of a CSV file."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(rows)
    return text.getvalue()


def scene_toml(scene: Scene) -> str:
    """A scene as the text of a scene file, every setting that it has written out."""
    return tomli_w.dumps(_set(msgspec.to_builtins(scene)))


def _set(table: Mapping[str, Any]) -> dict[str, Any]:
    """Without what is None, which TOML does not know, and without empty tables."""
    known = {key: _set(value) if isinstance(value, dict) else value for key, value in table.items()}
    return {key: value for key, value in known.items() if value is not None and value != {}}


def tractions_csv(run: Run) -> str:
    """Tractions of every method, one row a point; SI units, empty where a method does not determine a value."""
    columns = run.columns
    values = ([("" if number != number else number) for number in column.tolist()] for column in columns.values())
    return csv_text(list(columns), zip(*values, strict=True))


def surface_csv(run: Run) -> str:
    """sigma_xx along the surfaces by every method that knows it, one row a point; SI units."""
    rows: list[list[object]] = []
    for name, result in run.results.items():
        if surface := result.surface:
            columns = np.vstack([surface.x, surface.x / result.a, *surface.sigma[0], *surface.sigma[1]])
            rows += [[name, *row] for row in columns.T.tolist()]
    return csv_text(["method", "x", "x_over_a", "lower_1", "lower_2", "upper_1", "upper_2"], rows)


@contextmanager
def _replacing(path: Path) -> Iterator[Path]:
    """A path beside ``path`` to write to, which takes its place when the block ends well. What a write that was killed
    has left there goes."""
    beginning, ending = f".{path.stem}-", f".partial{path.suffix}"
    for left in path.parent.glob(glob.escape(beginning) + "*" + glob.escape(ending)):
        _unlink_if_free(left)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=beginning, suffix=ending)
    beside = Path(name)
    try:
        lock(handle)
        yield beside
        beside.chmod(0o666 & ~_umask())
        os.fsync(handle)  # its content must be there before its name is
        beside.replace(path)
    finally:
        os.close(handle)
        beside.unlink(missing_ok=True)


def _unlink_if_free(path: Path) -> None:
    """Remove a file that no process writes any more."""
    try:
        handle = os.open(path, os.O_RDWR)
    except OSError:
        return
    try:
        if lock(handle):
            path.unlink(missing_ok=True)
    finally:
        os.close(handle)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
