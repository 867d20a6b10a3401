"""Sweeps of a scene over values of its keys, as a data frame."""

import itertools
import math
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from partialslip.report.record import Record
from partialslip.run import chosen_methods
from partialslip.scene import Scene
from partialslip.scene.plan import asks_for_stresses
from partialslip.scene.reading import AnyScene, as_scene
from partialslip.study.batch.job import Job, Sharing, Solved
from partialslip.study.batch.ledger import Ledger
from partialslip.study.batch.sweep import SweepProgress, Task, work_through, workers
from partialslip.study.fatigue import HotSpot
from partialslip.study.fatigue.spots import off_by
from partialslip.tools.errors import InputError
from partialslip.tools.frame import frame

if TYPE_CHECKING:
    from partialslip.tools.frame import DataFrame

_VALUES = ("regime", "a", "p0", "m", "n")
_QUANTITIES = ("a", "m", "n", "p", "q")  # with columns for errors and estimates
_SESSION = Ledger()  # solved points of sweeps without a file


def sweep(
    scene: AnyScene,
    over: Mapping[str, Iterable[Any]] | Sequence[Mapping[str, Any]],
    methods: str | Iterable[str] | None = None,
    *,
    check: float = 0.0,
    cores: int | None = None,
    cluster: str | None = None,
    ledger: str | Path | None = None,
    progress: SweepProgress | None = None,
) -> "DataFrame":
    """Solve ``scene`` at many points and return a table with one row for each point.

    Every solved point is kept at once: in the file ``ledger``, or without a file in this Python process. After Ctrl-C
    or a crash the same call solves only what is missing.

    Parameters
    ----------
    scene : Scene, str or path
        A scene, the name of a shipped one, or the path of a scene file.
    over : mapping of str to values, or sequence of mappings
        Values by dotted key (:meth:`Scene.replace`), e.g. ``{"friction.f": [0.3, 0.4], "load.P": [1e5, 2e5]}``: the
        points are all combinations, and the last key varies fastest. A value of ``load.Q`` is a list of numbers. A
        sequence ``[{"friction.f": 0.3, "load.P": 1e5}, ...]`` gives the points themselves.
    methods : str or iterable of str, optional
        As for :func:`partialslip.run`. By equivalent, each geometry is characterised once per process.
    check : float, optional
        Share of the points, from 0 to 1, that are also solved by fem. The points are drawn at random, the same in each
        call.
    cores : int, optional
        Number of processes; default: all cores, and this process for the exact method, or equivalent and one
        geometry, alone: the start of another process takes longer than many points. 1 means this process.
    cluster : str, optional
        Address of a Dask scheduler, ``tcp://host:port``, whose workers solve the points.
    ledger : str or Path, optional
        File of solved points; created if it does not exist.
    progress : callable, optional
        ``progress(done, total, seconds_left)``; default: a bar on the terminal.

    Returns
    -------
    DataFrame
        SI units. The keys of ``over``; ``method``, ``regime``, ``a``, ``p0``, ``m``, ``n``, ``estimate.*`` (the
        method's own estimates) and ``cpu_s`` of the reference method; the same with the prefix ``fem.`` (or
        ``march.``) of other methods, with ``fem.error.*`` against the reference. With ``check`` the columns without a
        prefix stay those of the method asked for, and ``error.*`` are its errors against fem. ``outcome``: passed,
        missed or not judged; ``failure``: why the point could not be solved, empty if it was. Errors and estimates of
        a, m and n are fractions of a, those of p and q are relative L2. ``fem.factorizations``: 0 where a point
        found its meshes factored by another point. Values that do not exist are NaN or None.

        A scene with constants of the table ``fatigue``, or with ``effects.subsurface = true``, also has ``sigma_xx``,
        the largest along the surface of the lower body, Pa, and ``sigma_xx.x``, its place; of each criterion ``swt``,
        ``swt.x`` and, with ``fatigue.distance``, ``swt.point``, ``swt.line`` and ``swt.area``
        (:func:`partialslip.assess`); and ``error.*`` and ``estimate.*``, relative.

    Raises
    ------
    InputError
        If a key or a value is not allowed in the scene, before any point is solved.
    PartialslipError
        If a worker process dies or the cluster is lost; solved points are kept.
    """
    scene = as_scene(scene)
    if cores is not None and not (isinstance(cores, (int, np.integer)) and cores >= 1):
        raise InputError(f"cores = {cores}: must be a whole number >= 1")
    if not 0 <= check <= 1:
        raise InputError(f"check = {check}: must be from 0 to 1")
    points = _grid_points(over)
    if methods is not None:
        methods = chosen_methods(scene, methods)
    if ledger is not None and not isinstance(ledger, (str, os.PathLike)):
        raise InputError(f"ledger = {ledger!r:.60}: must be the path of a file")
    jobs = [_job(scene.replace(point), methods, point) for point in points]
    leading = [job.methods[0] if "fem" not in job.methods else None for job in jobs]
    for k in np.random.default_rng(0).choice(len(jobs), math.ceil(check * len(jobs)), replace=False):
        jobs[k] = replace(jobs[k], methods=tuple(dict.fromkeys((*jobs[k].methods, "fem"))))
    known, solve = _SESSION if ledger is None else Ledger(Path(ledger)), Sharing()
    tasks = [job.task._replace(do=solve) for job in jobs]
    quick = all({*job.methods} <= {"exact", "equivalent"} for job in jobs) and len({*map(_geometry, tasks)}) == 1
    cores = 1 if cores is None and quick else cores
    with _told(progress, scene.name) as tell, workers(cluster, cores) as executor:
        work_through(sorted(tasks, key=_geometry), known, executor, tell)
    rows = [
        _point_row(point, known.read(task.key, Solved), first)
        for point, task, first in zip(points, tasks, leading, strict=True)
    ]
    keys = dict.fromkeys(key for row in rows for key in row)
    last = ("outcome", "failure")
    return frame({key: [row.get(key) for row in rows] for key in (*(key for key in keys if key not in last), *last)})


def _grid_points(over: Mapping[str, Iterable[Any]] | Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Values by key of each point."""
    if not isinstance(over, Mapping):
        points = list(over) if isinstance(over, Iterable) else []
        if not points or not all(isinstance(point, Mapping) for point in points):
            raise InputError("over: must be values by key, or a list of points, each with a value by key")
        return [{key: _python_value(value) for key, value in point.items()} for point in points]
    values = {key: _values(key, given) for key, given in over.items()}
    return [dict(zip(values, point, strict=True)) for point in itertools.product(*values.values())]


def _values(key: str, given: Any) -> list[Any]:
    if isinstance(given, (str, Mapping)) or not np.iterable(given):
        raise InputError(f"over: {key} = {given!r}: must be a list of values")
    if not (values := [_python_value(value) for value in given]):
        raise InputError(f"over: {key}: must be a list of at least one value")
    return values


def _python_value(value: Any) -> Any:
    """A value as Python's number, string or tuple."""
    value = value.tolist() if hasattr(value, "tolist") else value
    return tuple(value) if isinstance(value, list) else value


def _job(scene: Scene, methods: Iterable[str] | None, point: Mapping[str, Any]) -> Job:
    return Job(
        scene,
        chosen_methods(scene, methods),
        {key: value if isinstance(value, float) else str(value) for key, value in point.items()},
        asks_for_stresses(scene),
    )


def _geometry(task: Task) -> str:
    """Sort key of a ``task``: points of one geometry, by fem also under one P, follow each other, as few rigs and few
    meshes are kept."""
    scene, methods = task.argument.scene, task.argument.methods
    if not {"equivalent", "fem"} & {*methods}:
        return ""
    geometry = scene.bodies, scene.material, scene.profile
    return str((*geometry, scene.fem, scene.pressing) if "fem" in methods else geometry)


def _point_row(point: Mapping[str, Any], solved: Solved, first: str | None = None) -> dict[str, Any]:
    """Columns of a point; those of fem do not precede those of the ``first`` method."""
    if solved.run is None:
        return {**point, **dict.fromkeys(("method", *_VALUES, "cpu_s", "outcome")), "failure": solved.error}
    return {**point, **_columns(solved, solved.run, first), "outcome": str(solved.run.outcome), "failure": ""}


def _columns(solved: Solved, run: Record, first: str | None) -> dict[str, Any]:
    """Columns of a solved point and its ``run``, those of the reference first, or of the ``first`` method instead of
    fem."""
    reference = run.reference or next(iter(run.methods))
    reference = first if first and reference == "fem" else reference
    columns: dict[str, Any] = {"method": reference}
    for name in sorted(run.methods, key=lambda name: name != reference):
        result, own = run.methods[name], "" if name == reference else f"{name}."
        columns |= {own + key: getattr(result, key) for key in _VALUES}
        if name in run.comparison:
            errors = run.comparison[name].errors
            columns |= {f"{own}error.{key}": errors.get(key) for key in _QUANTITIES}
        columns |= {f"{own}estimate.{key}": result.estimate[key] for key in _QUANTITIES if key in result.estimate}
        columns[f"{own}cpu_s"] = result.cost.cpu_s
        if "factorizations" in result.counts:
            columns[f"{own}factorizations"] = result.counts["factorizations"]
        true = {} if name == run.reference else solved.stresses.get(run.reference or "", {})
        columns |= {own + key: value for key, value in _stresses(solved.stresses.get(name, {}), true).items()}
    return columns


def _stresses(spots: Mapping[str, HotSpot], true: Mapping[str, HotSpot]) -> dict[str, float | None]:
    """Columns of hot spots: values, places of those at the surface, errors against the ``true`` ones, and estimates."""
    values: dict[str, float | None] = {key: spot.value for key, spot in spots.items()}
    places = {f"{key}.x": spot.x for key, spot in spots.items() if "." not in key}
    errors = {f"error.{key}": off_by(spot, true[key]) for key, spot in spots.items() if key in true}
    return values | places | errors | {f"estimate.{key}": spot.error for key, spot in spots.items()}


@contextmanager
def _told(progress: SweepProgress | None, name: str) -> Iterator[SweepProgress]:
    """Yield ``progress``, or the progress of a bar that is shown on a terminal while the block runs."""
    if progress:
        yield progress
        return
    from rich import progress as rich
    from rich.console import Console

    columns = (rich.TextColumn(f"sweep of {name}"), rich.BarColumn(), rich.MofNCompleteColumn())
    bar = rich.Progress(*columns, rich.TimeRemainingColumn(), console=Console(stderr=True), transient=True)
    task = bar.add_task("", total=None)
    with bar if bar.console.is_interactive else nullcontext():
        yield lambda done, total, _: bar.update(task, completed=done, total=total)
