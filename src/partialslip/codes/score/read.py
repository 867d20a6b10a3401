"""Read tractions from a file; the suffix tells the format."""

import codecs
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from partialslip.codes.score.calculix import LoadPoints, read_dat, read_frd, stated_units
from partialslip.codes.score.csvfile import Columns, read_csv
from partialslip.codes.score.headers import COLUMN_DIMENSIONS, SHEAR_COLUMNS
from partialslip.codes.score.kinds import Kind, cells_around, note
from partialslip.codes.score.rows import Label, check_equal_x
from partialslip.codes.score.samples import Samples, samples
from partialslip.scene import Scene
from partialslip.scene.units import Units
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import check_regular, read_bytes

TABLES = (".csv", ".txt", ".tsv", ".rpt")
LARGEST_FILE_READ = 1_000_000_000  # limit: bytes of a file
_FLAT = 0.05  # limit: of the points' extent along x: largest extent across


def check(file: Path) -> None:
    """Raise InputError if ``file`` has no known format or cannot be read."""
    from partialslip_meshes.pointdata import WRITTEN_FORMATS

    if file.suffix.lower() not in (*TABLES, ".frd", ".dat", *WRITTEN_FORMATS):
        raise InputError(f"{file}: must end in {', '.join(TABLES)}, .frd, .dat or {', '.join(sorted(WRITTEN_FORMATS))}")
    check_regular(file, LARGEST_FILE_READ)


def read_tractions(
    file: Path,
    scene: Scene,
    factors: tuple[float, float, float] = (1.0, 1.0, 1.0),
    order: int = 1,
    at: tuple[int, int] | None = None,
    chosen: Mapping[str, str] | None = None,
    kind: Kind | None = None,
) -> Samples:
    """Read tractions from ``file``.

    Formats: .csv, .txt, .tsv and .rpt tables; .frd and .dat of CalculiX; formats of meshio with point data p and dq, q,
    or q1 and q2. The pressure at load point 1, p1, must be there where the scene's pressure varies, and may be where
    shear changes it. Parameters as for :func:`partialslip.score`; ``chosen`` are its ``columns``. Numbers are in the
    scene's units unless the file states others.

    Raises
    ------
    InputError
        If the file cannot be read or its content is not valid.
    """
    origin, suffix, faces = str(file), file.suffix.lower(), False
    load, anew = scene.load, True if scene.presses_anew else False if scene.mirrored else None
    load_points = LoadPoints(*load.ends, len(load.points), every=not load.in_phase)
    if scene.only_pressed:
        load_points = LoadPoints(0, 0, 1)
    if at is not None and suffix not in (".frd", ".dat"):
        raise InputError(f"--at {at[0]},{at[1]}: must be left out except for .frd and .dat files")
    if chosen and suffix not in TABLES:
        raise InputError(f"--columns: must be left out except for tables ({', '.join(TABLES)})")
    if suffix in TABLES:
        columns = read_csv(text(file), origin, chosen, scene.units, anew)
    elif suffix in (".frd", ".dat"):
        content = text(file)
        mesh = content if suffix == ".frd" else text(file.with_suffix(".frd"))
        if suffix == ".frd":
            found = read_frd(mesh, origin, at, load_points)
        else:
            found, faces = read_dat(content, mesh, origin, at, load_points)
        if anew is False:
            del found["p1"]
        units = stated_units(mesh) or scene.units
        columns = _in_si(found, units)
        if units != scene.units:
            columns = columns._replace(notes=(f"read in {units.words}, the units of the deck",))
    else:
        columns = _in_si(_point_data(file, ("p", "p1") if anew else ("p",)), scene.units)
    notes = columns.notes
    if columns.moment:
        if not load.fully_reversed:
            raise InputError(
                f"{origin}: {columns.made_of}: shear at one load point, but the loads are not fully reversed: "
                "give both with --columns q1=...,q2=..."
            )
        notes += (f"{columns.made_of}: shear at load point 2, taken as half of its change",)
    made = samples(columns.values, origin, factors, order, kind)
    if faces and kind is None:  # compared as means; how the face with an end is averaged remains guessed
        made = replace(made, kind="mean", cells=cells_around(made.x))
    if not load.fully_reversed and {"q", "Ft"} & set(columns.values):  # half of the change, but not q at load point 2
        made = replace(made, q1=None, q2=None)
    if made.guessed and (guess := note(made.averages, "nodal" if "Fn" in columns.values else "sampled")):
        notes += (guess,)
    return replace(made, made_of=columns.made_of, notes=(*notes, *made.notes))


def _in_si(values: dict[str, Array], units: Units) -> Columns:
    """Convert columns in ``units`` to SI units."""
    return Columns({name: units.to_si(column, COLUMN_DIMENSIONS[name]) for name, column in values.items()})


def text(file: Path) -> str:
    """Decode ``file``, UTF-8 or UTF-16. Raises InputError if it is neither."""
    data = read_bytes(file, LARGEST_FILE_READ)
    try:
        return data.decode("utf-16" if data[:2] in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE) else "utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{file}: must be UTF-8 text; byte {error.start} is not") from None


def _point_data(file: Path, pressures: tuple[str, ...]) -> dict[str, Array]:
    """Columns x, ``pressures`` and shear of a file of meshio with point data."""
    from partialslip_meshes.pointdata import read_point_data

    check(file)
    points, data = read_point_data(file)
    shears = [shear for shear in SHEAR_COLUMNS if set(shear) <= set(data) and shear[0].startswith(("q", "dq"))]
    if not set(pressures) <= set(data) or len(shears) != 1:
        shown = ", ".join(map(repr, data))[:100] or "none"
        asked = " and ".join(pressures)
        raise InputError(f"{file}: point data {shown}: must have {asked}, and one of dq, q, or q1 and q2")
    names = (*pressures, *shears[0])
    columns = [points[:, 0], *(data[name] for name in names)]
    known = np.isfinite(np.stack(columns[1:])).all(axis=0)
    x, across = points[known, 0], points[known, 1:]
    if len(x) and np.ptp(across[:, 0]) > _FLAT * np.ptp(x):
        raise InputError(f"{file}: points with p lie {np.ptp(across[:, 0]):.3g} m apart across x: must be on one line")
    values = dict(zip(("x", *names), (column[known] for column in columns), strict=True))
    labels = [
        Label(name, number, column.tolist()) for name, number, column in zip("yz", (2, 3), across.T, strict=False)
    ]
    check_equal_x(values, labels, str(file), "keep the points with one {name}, those of the contact")
    return values
