"""Sweeps over sizes of bodies, or other settings of a scene: half-planes compared with finite elements."""

import math
import warnings
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Executor
from itertools import starmap
from types import MappingProxyType
from typing import Any

import numpy as np
from msgspec.structs import replace

from partialslip.report.record import Record
from partialslip.result.record import ResultRecord
from partialslip.run.judge.reference import error_of
from partialslip.scene import Scene
from partialslip.scene.units import Dimension, Units
from partialslip.study.batch.job import Job, Sharing
from partialslip.study.batch.ledger import Ledger
from partialslip.study.batch.sweep import SweepProgress, work_through
from partialslip.study.fatigue import HotSpot
from partialslip.study.fatigue.spots import SIGMA, off_by
from partialslip.study.size.axes import ACCURACY, Axis, cases
from partialslip.study.size.case import EQUIVALENT, FEM, HALF_PLANE, STRIPS, Sized, solve_sized
from partialslip.study.size.law import CLEAR, Levels, Sizes
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError
from partialslip.tools.groups import grouped

DIFFERENCES = ("a", "p_max", "p", "m", "n", "q")
_COARSER = 8.0  # accuracy: ratio of the accuracies of two successive meshes
_FINER = 3  # limit: largest number of additional meshes where the half-plane's difference is not clear
_FINEST = 1e-8  # limit: finest accuracy that rounding allows


def measure(
    scene: Scene,
    axes: Sequence[Axis],
    ledger: Ledger,
    executor: Executor,
    progress: SweepProgress = lambda *_: None,
    control: bool = True,
) -> list[Sized]:
    """Solve ``scene`` over the grid of ``axes``. Cases in ``ledger`` are not solved again.

    Parameters
    ----------
    scene : Scene
    axes : sequence of Axis
    ledger : Ledger
    executor : Executor
    progress : callable
        ``progress(done, total, seconds_left)``.
    control : bool
        Whether to solve each point on at least two meshes: for the scene's accuracy and for one eight times coarser.
        Where the difference of the half-plane is less than ten times the mesh's error, up to three further meshes
        follow, each eight times finer. Differences of stresses call for no further meshes.

    One axis of sizes is solved at its limit, too, which tells what remains of the differences.

    Returns
    -------
    list of Sized
        Entries of the ledger.

    Raises
    ------
    InputError
        If a key is not in the scene, or a value is not allowed.
    PartialslipError
        If a worker process dies; finished cases are in the ledger.
    """
    solve, meshes = Sharing(solve_sized), (_COARSER, 1.0) if control else (1.0,)
    asked, (limit, outside) = cases(scene, axes, meshes), _at_limit(scene, axes, meshes)
    asked += limit
    work_through([case.task._replace(do=solve) for case in asked], ledger, executor, progress)
    finer = [_COARSER**-k for k in range(1, _FINER + 1)] if control else []
    for accuracy in (each for each in finer if each * scene.fem.accuracy >= _FINEST):
        points = _by_point(axes, (ledger.read(case.key, Sized) for case in asked))
        unclear = {point for point, found in points.items() if not _clear(found)}
        if unclear <= {(axes[0].limit,)}:
            break  # what remains need not be known better than the differences
        asked += [
            case
            for case in (*cases(scene, axes, (accuracy,)), *_at_limit(scene, axes, (accuracy,))[0])
            if _grid_point(axes, case) in unclear
        ]
        work_through([case.task._replace(do=solve) for case in asked], ledger, executor, progress)
    return [*(ledger.read(case.key, Sized) for case in asked), *outside]


def _at_limit(scene: Scene, axes: Sequence[Axis], accuracies: Sequence[float]) -> tuple[list[Job], list[Sized]]:
    """Return the jobs at the limit of one axis; and an entry that says why the scene cannot have such sizes."""
    axis, *others = axes
    if others or math.isinf(axis.limit):
        return [], []
    try:
        return cases(scene, [axis.beyond], accuracies), []
    except InputError as error:
        return [], [Sized(labels={axis.name: axis.limit, ACCURACY: 1.0}, error=str(error))]


def at_limit(axes: Sequence[Axis], of: Job | Sized) -> bool:
    """Return whether a job or entry stands for an infinite size, which nobody asked for."""
    return _grid_point(axes, of) == (axes[0].limit,)


def _grid_point(axes: Sequence[Axis], of: Job | Sized) -> tuple[float, ...]:
    """Return the point of the grid of ``axes`` that a job or entry belongs to."""
    return tuple(float(of.labels[each.name]) for each in axes)


def along(axis: Axis, entries: Iterable[Sized], name: str = HALF_PLANE, levels: Levels = MappingProxyType({})) -> Sizes:
    """Return the sweep along ``axis`` of the half-planes ``name`` from ``entries`` of a ledger, for ``levels`` of the
    differences."""
    entries = list(entries)
    keys = (*DIFFERENCES, *stress_quantities(entries))
    none = dict.fromkeys(keys, math.nan)
    points = {
        point[0]: tuple(none | each for each in found[name])
        for point, meshes in sorted(_by_point([axis], entries).items())
        if name in (found := _differences(meshes))
    }
    errors = {float(entry.labels[axis.name]): entry.error for entry in entries if entry.error}
    return Sizes(
        name,
        np.array(list(points)),
        {key: np.array([off[key] for off, _ in points.values()]) for key in keys},
        {key: np.array([mesh[key] for _, mesh in points.values()]) for key in keys},
        {size: error for size, error in sorted(errors.items()) if size not in points},
        axis.limit,
        levels,
    )


def with_criteria(entries: Iterable[Sized], names: Sequence[str]) -> list[Sized]:
    """Return ``entries`` with the largest sigma_xx and, of fatigue criteria, those with these ``names`` alone."""
    wanted = {SIGMA, *names}
    return [
        replace(entry, stresses={
            by: {key: spot for key, spot in spots.items() if key.partition(".")[0] in wanted}
            for by, spots in entry.stresses.items()
        })
        for entry in entries
    ]  # fmt: skip


def stress_quantities(entries: Iterable[Sized]) -> tuple[str, ...]:
    """Return the stresses of ``entries``, in the order of :func:`partialslip.study.fatigue.hot_spots`."""
    return tuple(dict.fromkeys(key for entry in entries for key in entry.stresses.get(FEM, {})))


def hot_spots_along(axis: Axis, entries: Iterable[Sized]) -> dict[float, Mapping[str, Mapping[str, HotSpot]]]:
    """Return the hot spots on the finest mesh by value along ``axis``, and by :data:`FEM`, :data:`HALF_PLANE`,
    :data:`EQUIVALENT` and :data:`STRIPS`, from ``entries``. Errors are those of :func:`along`."""
    return {
        point[0]: {**meshes[-1].stresses, FEM: _with_mesh_errors(meshes)}
        for point, meshes in sorted(_by_point([axis], entries).items())
        if meshes[-1].stresses
    }


def refused(axes: Sequence[Axis], entries: Iterable[Sized]) -> dict[tuple[float, ...], str]:
    """Return the points of the grid of ``axes`` without equivalent half-planes, and why."""
    points = sorted(_by_point(axes, entries).items())
    return {point: meshes[-1].refused for point, meshes in points if meshes[-1].refused}


def _by_point(axes: Sequence[Axis], entries: Iterable[Sized]) -> dict[tuple[float, ...], list[Sized]]:
    """Return the entries by point of the grid, from the coarsest mesh to the finest, without failed cases."""
    return grouped(
        (_grid_point(axes, entry), entry)
        for entry in sorted(entries, key=lambda entry: -float(entry.labels[ACCURACY]))
        if entry.run
    )


def _differences(meshes: Sequence[Sized]) -> dict[str, tuple[dict[str, float], dict[str, float]]]:
    """Return the changes at one point on the finest mesh, and the errors of the meshes, by half-planes.

    The error of the finite elements is the larger of the method's estimate and an eighth of the change by the last
    refinement; NaN without either, as for a fixed element size. That of the rig, and that of half-planes that are not
    solved exactly, add to it.
    """
    run = _run(meshes[-1])
    found, estimate = _changes(run), _estimate(run.methods["fem"])
    coarser = [each for each in meshes[:-1] if _dofs(each) != _dofs(meshes[-1])]
    rough = _changes(_run(coarser[-1])) if coarser else {}
    changed = {key: abs(rough.get(key, math.nan) - found.get(key, math.nan)) / _COARSER for key in DIFFERENCES}
    mesh = {key: float(np.fmax(estimate.get(key, math.nan), changed[key])) for key in DIFFERENCES}
    differences = {}
    for name, of in ((HALF_PLANE, run), (STRIPS, meshes[-1].strips)):
        if of:
            beside, changes = _half_plane_errors(of), _changes(of)
            both = {key: mesh[key] + beside.get(key, 0.0) for key in DIFFERENCES}
            differences[name] = {key: changes.get(key, math.nan) for key in DIFFERENCES}, both
    if meshes[-1].equivalent:
        left, rig = _left(meshes[-1])
        both = {key: mesh[key] + rig.get(key, 0.0) for key in DIFFERENCES}
        differences[EQUIVALENT] = ({key: left.get(key, math.nan) for key in DIFFERENCES}, both)
    true = _with_mesh_errors(meshes)
    for name, (off, errors) in differences.items():
        for key, spot in meshes[-1].stresses.get(name, {}).items():
            if key in true:
                own = _rig_error(meshes[-1]) if name == EQUIVALENT else spot.error
                off[key] = (spot.value - true[key].value) / abs(true[key].value)
                errors[key] = _sum_or_nan(own, true[key].error)
    return differences


def _with_mesh_errors(meshes: Sequence[Sized]) -> dict[str, HotSpot]:
    """Return the hot spots of the finite elements on the finest mesh; their error is the larger of the estimate and
    the change by the last refinement, as stresses at the ends of the contact converge like square roots."""
    coarser = [each for each in meshes[:-1] if _dofs(each) != _dofs(meshes[-1])]
    rough = coarser[-1].stresses.get(FEM, {}) if coarser else {}
    found = {}
    for key, spot in meshes[-1].stresses.get(FEM, {}).items():
        changed = off_by(rough[key], spot) if key in rough else math.nan
        error = float(np.fmax(_sum_or_nan(spot.error), changed))
        found[key] = replace(spot, error=None if math.isnan(error) else error)
    return found


def _rig_error(entry: Sized) -> float:
    """Return the error of the largest sigma_xx of equivalent half-planes that the mesh of the rig makes."""
    assert entry.equivalent
    return entry.equivalent.methods["equivalent"].shares.get("rig", {}).get(SIGMA) or 0.0


def _sum_or_nan(*errors: float | None) -> float:
    """Return the sum of ``errors``; NaN if one is not known."""
    return sum(math.nan if error is None else error for error in errors)


def _clear(meshes: Sequence[Sized]) -> bool:
    off, mesh = _differences(meshes)[HALF_PLANE]
    return all(not abs(off[key]) < CLEAR * mesh[key] for key in DIFFERENCES)


def _run(entry: Sized) -> Record:
    assert entry.run
    return entry.run


def _dofs(entry: Sized) -> int | None:
    return _run(entry).methods["fem"].counts.get("dofs")


def _estimate(result: ResultRecord) -> dict[str, float]:
    """Return the error estimates of a ``result`` by quantity; that of p for p_max."""
    found = {key: error for key, error in result.estimate.items() if error is not None}
    return found | ({"p_max": found["p"]} if "p" in found else {})


def _half_plane_errors(run: Record) -> dict[str, float]:
    """Return the error estimates of the half-planes (or strips) of a ``run`` by quantity; NaN where they have none."""
    name, result = next((name, found) for name, found in run.methods.items() if name != "fem")
    return {key: error_of(result, key, name) for key in DIFFERENCES}


def _changes(run: Record) -> dict[str, float]:
    """Return the change from the half-planes (or strips) of a ``run`` to its finite elements, by quantity."""
    fem, plain, errors = run.methods["fem"], _half_plane(run), run.comparison["fem"].errors
    a = plain.a or math.nan
    found = {"a": (fem.a or math.nan) / a - 1, "p_max": (fem.p_max or math.nan) / (plain.p_max or math.nan) - 1}
    for key, end, true in (("m", fem.m, plain.m), ("n", fem.n, plain.n)):
        if end is not None and true is not None:
            found[key] = (end - true) / a
    return found | {key: error for key in ("p", "q") if (error := errors[key]) is not None}


def _half_plane(run: Record) -> ResultRecord:
    """Return the half-planes of a ``run``, by whichever method they were solved."""
    return next(found for name, found in run.methods.items() if name != "fem")


def _left(entry: Sized) -> tuple[dict[str, float], dict[str, float]]:
    """Return what is left with equivalent half-planes at one point on one mesh, and the error of the rig, by
    quantity."""
    if not entry.equivalent:
        return {}, {}
    errors = entry.equivalent.comparison["equivalent"].errors
    shares = entry.equivalent.methods["equivalent"].shares.get("rig", {})
    left = {key: errors.get(key) for key in DIFFERENCES}
    rig = {key: shares.get("p" if key == "p_max" else key) for key in DIFFERENCES}
    return _magnitudes(left), _magnitudes(rig)


def _magnitudes(values: Mapping[str, float | None]) -> dict[str, float]:
    return {key: abs(value) for key, value in values.items() if value is not None}


def grid(axes: Sequence[Axis], entries: Iterable[Sized], quantity: str) -> tuple[Array, Array, Array]:
    """Return the values of two ``axes`` and the absolute change of ``quantity``, (second, first), from ``entries``.

    NaN where not solved. The former name ``p0`` of ``p_max`` is deprecated.
    """
    if quantity == "p0":
        warnings.warn("p0: the largest pressure is now p_max; p0 is 2 P/(pi a)", DeprecationWarning, stacklevel=2)
        quantity = "p_max"
    x, y = (np.array(each.values) for each in axes)
    points = {
        point: abs(_differences(meshes)[HALF_PLANE][0].get(quantity, math.nan))
        for point, meshes in _by_point(axes, entries).items()
    }
    return x, y, np.array([[points.get((first, second), math.nan) for first in x.tolist()] for second in y.tolist()])


def case_table(axes: Sequence[Axis], entries: Iterable[Sized], units: Units) -> tuple[list[str], list[list[Any]]]:
    """Return headings and rows for a CSV file, one row per case, from ``axes`` and ``entries``, in ``units``."""
    figures: dict[str, Dimension] = {"a": "m", "p_max": "Pa", "m": "m", "n": "m"}
    head = [
        *(each.heading(units, each.name) for each in axes),
        ACCURACY,
        *starmap(units.heading, figures.items()),
        "regime",
    ]
    head += [f"{name}: {key}" for name in (HALF_PLANE, EQUIVALENT, STRIPS) for key in DIFFERENCES]
    head += ["dofs", "cpu_s", "error", "no equivalent"]
    rows: list[list[Any]] = []
    for entry in entries:
        row = [entry.labels[name] for name in (*(each.name for each in axes), ACCURACY)]
        if entry.run is None:
            rows.append([*row, *[""] * (len(head) - len(row) - 2), entry.error, ""])
        else:
            strips = _changes(entry.strips) if entry.strips else {}
            fem, differences = entry.run.methods["fem"], (_changes(entry.run), _left(entry)[0], strips)
            values = [(getattr(fem, key), of) for key, of in figures.items()]
            row += ["" if value is None else units.from_si(value, of) for value, of in values]
            row.append(fem.regime)
            row += [each.get(key, "") for each in differences for key in DIFFERENCES]
            rows.append([*row, fem.counts["dofs"], fem.cost.cpu_s, "", entry.refused])
    return head, rows
