"""Read tractions from files; the suffix tells the format."""

import functools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from partialslip.codes.score.calculix import LoadPoints, read_dat, read_frd, stated_units
from partialslip.codes.score.csvfile import columns_of, where
from partialslip.codes.score.headers import FIRST, NORMAL, Asked
from partialslip.codes.score.kinds import Kind, cells_around, note
from partialslip.codes.score.samples import Samples, samples
from partialslip.codes.score.states import joined
from partialslip.scene import Scene
from partialslip.scene.texttable import TextTable, decoded, read_table
from partialslip.scene.units import Units
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import check_regular, read_bytes

TABLES = (".csv", ".txt", ".tsv", ".rpt", ".dat", ".out", ".lis", ".asc", ".xy")
LARGEST_FILE_READ = 1_000_000_000  # limit: bytes of a file


def check(file: Path) -> None:
    """Raise InputError if ``file`` has no known format or cannot be read."""
    from partialslip_meshes.pointdata import WRITTEN_FORMATS

    if file.suffix.lower() not in (*TABLES, ".frd", *WRITTEN_FORMATS):
        known = ", ".join((*TABLES[:4], ".frd", *TABLES[4:]))
        raise InputError(f"{file}: must end in {known} or {', '.join(sorted(WRITTEN_FORMATS))}")
    check_regular(file, LARGEST_FILE_READ)


def read_tractions(
    files: Path | Sequence[Path],
    scene: Scene,
    factors: tuple[float, float, float] = (1.0, 1.0, 1.0),
    order: int = 1,
    at: tuple[int, int] | None = None,
    chosen: Mapping[str, str] | None = None,
    kind: Kind | None = None,
    kept: Mapping[str, str] | None = None,
    centred: bool = False,
) -> Samples:
    """Read tractions from ``files``: one, or one for each load point, each of which may be two, for p and for q.

    Formats: tables of text; .frd and .dat of CalculiX; formats of meshio with point data. The pressure at load point 1,
    p1, must be there where the scene's pressure varies, and may be where shear changes it. Parameters as for
    :func:`partialslip.score`; ``chosen`` are its ``columns``, ``kept`` its ``where``. Numbers are in the scene's units
    unless the file states others. Half a contact is mirrored where it may be, unless it is ``centred``.

    Raises
    ------
    InputError
        If a file cannot be read or its content is not valid.
    """
    files = [files] if isinstance(files, Path) else list(files)
    origin = " and ".join(map(str, files))
    load, anew = scene.load, True if scene.presses_anew else False if scene.mirrored else None
    results = [file for file in files if file.suffix.lower() in (".frd", ".dat") and not _is_table(file)]
    if at is not None and not results:
        raise InputError(f"--at {at[0]},{at[1]}: must be left out except for .frd and .dat files")
    if results and len(files) > 1:
        raise InputError(f"{results[0]}: must be the only file: it has the load points")
    asked = Asked(origin, anew, scene.friction.f > 0, scales=_Scales(scene))
    faces, units = False, scene.units
    notes: tuple[str, ...] = ()
    if results:
        table, faces, stated = _calculix(files[0], scene, at)
        if stated:
            units, notes = stated, (f"read in {stated.words}, the units of the deck",) if stated != units else ()
        tables = [where(table, kept or {}, origin)]
    else:
        tables = [where(_table(file), kept or {}, str(file)) for file in files]
    if len(tables) == 1 and len(tables[0]) == 1:
        columns = columns_of(tables[0][0], asked, chosen, units)
    else:
        names = [(str(file), each) for file, of in zip(files, tables, strict=True) for each in of]
        parts = [
            (name, columns_of(each, asked._replace(origin=name, part=True), chosen, units)) for name, each in names
        ]
        columns = joined(parts, asked, scene)
    notes += columns.notes
    if columns.moment:
        if not load.fully_reversed:
            raise InputError(
                f"{origin}: {columns.made_of}: shear at one load point, but the loads are not fully reversed: "
                "give both with --columns q1=...,q2=..., or a file for each load point"
            )
        notes += (f"{columns.made_of}: shear at load point 2, taken as half of its change",)
    values, told = _pressed(columns.values, factors[1])
    if len(values) == len({"x", *NORMAL, *FIRST.values()} & set(values)):  # no friction, and no shear
        values = values | {"dFt" if "Fn" in values else "dq": np.zeros_like(values["x"])}
    if not centred and "Fn" not in values:
        values, mirrored = _whole(values, scene)
        told += mirrored
    made = samples(values, origin, factors, order, kind)
    if faces and kind is None:  # compared as means; how the face with an end is averaged remains guessed
        made = replace(made, kind="mean", cells=cells_around(made.x))
    if not load.fully_reversed and {"q", "Ft"} & set(values):  # half of the change, but not q at load point 2
        made = replace(made, q1=None, q2=None)
    if made.guessed and (guess := note(made.averages, "nodal" if "Fn" in values else "sampled")):
        told += (guess,)
    return replace(made, made_of=columns.made_of, notes=(*notes, *told, *made.notes))


class _Scales(Mapping[str, float]):
    """a, p0, fp0 and 2fp0 of half-planes of a scene, SI units, found when they are asked for."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene

    @functools.cached_property
    def _found(self) -> dict[str, float]:
        from partialslip.halfplane import contact

        a, f = contact(self._scene).a, self._scene.friction.f
        p0 = 2 * self._scene.P / (np.pi * a)
        return {"a": a, "p0": p0, "fp0": f * p0, "2fp0": 2 * f * p0}

    def __getitem__(self, name: str) -> float:
        return self._found[name]

    def __contains__(self, name: object) -> bool:
        return name in ("a", "p0", "fp0", "2fp0")

    def __iter__(self) -> Iterator[str]:
        return iter(("a", "p0", "fp0", "2fp0"))

    def __len__(self) -> int:
        return 4


def _pressed(values: dict[str, Array], factor: float) -> tuple[dict[str, Array], tuple[str, ...]]:
    """``values`` with pressures above zero, and a note where a compressive stress was turned; not where the ``factor``
    of the pressure says what its sign is."""
    pressures = [name for name in (*NORMAL, *FIRST.values()) if name in values and factor > 0]
    below = [name for name in pressures if values[name].sum() < 0 and -values[name].min() > values[name].max()]
    notes = tuple(f"{name} is below zero: read as a compressive stress, its sign turned" for name in below)
    return values | {name: -values[name] for name in below}, notes


def _whole(values: dict[str, Array], scene: Scene) -> tuple[dict[str, Array], tuple[str, ...]]:
    """``values`` of the whole contact, where they are of one half, beside x = 0, of tractions that are even in x, and a
    note."""
    x, p = values["x"], np.abs(values["p"])
    even = scene.even and not any(map(any, scene.load.tension)) and (scene.mirrored or not scene.friction.f)
    nearest = np.sort(np.abs(x))[:2]
    if not even or len(nearest) < 2 or (x.min() < -1e-6 * np.ptp(x) and x.max() > 1e-6 * np.ptp(x)):
        return values, ()
    if nearest[0] > 0.6 * (nearest[1] - nearest[0]) or p[np.abs(x).argmin()] < p.max() / 2:
        return values, ()
    beside = np.abs(x) > 1e-6 * np.ptp(x)
    whole = {name: np.append(column, column[beside]) for name, column in values.items()}
    whole["x"][len(x) :] *= -1
    return whole, ("half of the contact: mirrored at x = 0, as tractions of the scene are even in x",)


def _is_table(file: Path) -> bool:
    """Whether a .dat ``file`` is a table, and no results of CalculiX."""
    beside = file.suffix.lower() == ".frd" or file.with_suffix(".frd").exists()
    return not beside and b" contact stress (slave " not in read_bytes(file, LARGEST_FILE_READ)


def _table(file: Path) -> TextTable:
    """The table in a text file or in a file of meshio with point data."""
    if file.suffix.lower() in TABLES:
        content, told = decoded(read_bytes(file, LARGEST_FILE_READ), str(file))
        table = read_table(content, str(file))
        return table._replace(notes=(told, *table.notes)) if told else table
    from partialslip_meshes.pointdata import read_point_data

    check(file)
    points, data = read_point_data(file)
    axes = {f"Points:{k}": column for k, column in enumerate(points.T)}
    return _of_numbers(axes | data)


def _of_numbers(columns: Mapping[str, Array]) -> TextTable:
    count = len(next(iter(columns.values())))
    return TextTable([*columns], [*columns.values()], list(range(1, count + 1)), 1)


def _calculix(file: Path, scene: Scene, at: tuple[int, int] | None) -> tuple[TextTable, bool, Units | None]:
    """Results of CalculiX as a table, whether they are means over faces, and the units that the deck states."""
    load, origin, suffix = scene.load, str(file), file.suffix.lower()
    load_points = LoadPoints(*load.ends, len(load.points), every=not load.in_phase)
    if scene.only_pressed:
        load_points = LoadPoints(0, 0, 1)
    content, _ = decoded(read_bytes(file, LARGEST_FILE_READ), origin)
    beside = file.with_suffix(".frd")
    mesh = content if suffix == ".frd" else decoded(read_bytes(beside, LARGEST_FILE_READ), str(beside))[0]
    if suffix == ".frd":
        found, faces = read_frd(mesh, origin, at, load_points), False
    else:
        found, faces = read_dat(content, mesh, origin, at, load_points)
    return _of_numbers(found), faces, stated_units(mesh)
