"""The benchmark from Python: grade tractions in the tests of any code, without files.

>>> import numpy as np
>>> from partialslip.benchmark import grade
>>> a, p0 = 2.066976e-4, 418.1044e6  # Hertz, without friction
>>> x = np.linspace(-1.1, 1.1, 441) * a
>>> found = grade("PS-01", x, p0 * np.sqrt(np.maximum(1 - (x / a) ** 2, 0)))
>>> found.grade <= "C", found.groups["contact"]
(True, 'A')
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from partialslip.codes.score.kinds import KINDS, Kind
from partialslip.codes.score.samples import Samples, samples
from partialslip.tools.errors import InputError
from partialslip.verify import benchmark
from partialslip.verify.benchmark.grade import BEYOND, NOT_OFFERED, graded
from partialslip.verify.benchmark.problem import Problem, numbered
from partialslip.verify.benchmark.submission import Answer
from partialslip.verify.benchmark.tables import likely_mistakes, table_values


@dataclass(frozen=True)
class Grade:
    """Grade of tractions.

    Parameters
    ----------
    problem : str
    grade : str
        A to E, "not graded" or "not offered", in this order, so that ``grade <= "C"`` is A, B or C.
    worst : str
        Key of the target that decides; empty without one.
    groups : dict of str to str
        Grades by group of targets: contact, stick, tractions (these three make the grade), levels, slip, stress.
    values : dict of str to float
        What was read from the tractions, by key of the target, SI units.
    errors : dict of str to float
        Differences of the values from the targets, in the scale of the target.
    reading : dict of str to float
        Errors with which the values can be read at such points, in the scale of the target. No part of the grade.
    notes : tuple of str
        What was assumed; likely mistakes (units, signs) where the grade is E or none.
    """

    problem: str
    grade: str
    worst: str
    groups: dict[str, str]
    values: dict[str, float]
    errors: dict[str, float]
    reading: dict[str, float]
    notes: tuple[str, ...] = ()

    def __str__(self) -> str:
        """One line: grade, the target that decides, and the grades of the groups."""
        off = f", {self.worst} off by {self.errors[self.worst]:.1e}" if self.worst in self.errors else ""
        told = ", ".join(f"{group} {grade}" for group, grade in self.groups.items() if grade != NOT_OFFERED)
        return "; ".join((f"{self.problem}: {self.grade}{off}", told, *self.notes))


def grade(
    problem: str,
    x: npt.ArrayLike,
    p: npt.ArrayLike,
    q1: npt.ArrayLike | None = None,
    q2: npt.ArrayLike | None = None,
    *,
    p1: npt.ArrayLike | None = None,
    kind: Kind | None = "sampled",
) -> Grade:
    """Grade the tractions that a code found for a ``problem``, as ``partialslip benchmark score`` does.

    Parameters
    ----------
    problem : str
        Number of the problem, such as "PS-02".
    x : (n,) array
        Points along the contact, m, in any order, with x = 0 as in the statement of the problem.
    p : (n,) array
        Pressure, positive in compression, Pa; at load point 2 if it varies.
    q1, q2 : (n,) arrays
        Shear tractions that the lower body exerts on the upper one, at load points 1 and 2, Pa; left out without
        friction.
    p1 : (n,) array, optional
        Pressure at load point 1, where P or M varies, or shear changes the pressure.
    kind : "sampled", "mean" or "nodal", optional
        What the values are: at points, means over cells, or nodal forces over the nodes' weights. None guesses, as
        :func:`partialslip.score` does, and takes three times as long.

    Raises
    ------
    InputError
        If no problem has this number, an array is missing, of another shape, or has values that are not finite, or the
        pressure does not exceed its noise.
    """
    known = numbered(problem)
    read = _samples(known, {"x": x, "p": p, "p1": p1, "q1": q1, "q2": q2}, kind)
    table = table_values(known, read, problem)
    found = graded(known, Answer(dict(table.values)))
    unclear = found.overall.grade in (BEYOND, NOT_OFFERED)
    return Grade(
        problem,
        found.overall.grade,
        found.overall.worst,
        {group: mark.grade for group, mark in found.groups.items()},
        table.values,
        found.errors,
        table.errors,
        (*(likely_mistakes(known, read, problem) if unclear else ()), *table.notes),
    )


def _samples(problem: Problem, given: dict[str, npt.ArrayLike | None], kind: Kind | None) -> Samples:
    if kind not in (None, *KINDS):
        raise InputError(f"kind = {kind!r}: must be one of {', '.join(KINDS)}, or None")
    scene, number = problem.scene, problem.number
    needed = ["x", "p", *(["q1", "q2"] if scene.friction.f else []), *(["p1"] if scene.presses_anew else [])]
    if missing := [name for name in needed if given[name] is None]:
        why = "P or M varies" if missing == ["p1"] else "the problem has friction"
        raise InputError(f"{missing[0]}: must be given for {number}, as {why}")
    columns = {name: np.asarray(each, dtype=float) for name, each in given.items() if each is not None}
    for name, column in columns.items():
        if column.ndim != 1 or column.shape != columns["x"].shape:
            raise InputError(f"{name}: shape {column.shape}: must be (n,), that of x, {columns['x'].shape}")
    if not {"q1", "q2"} <= columns.keys():
        columns = {name: columns[name] for name in columns if name not in ("q1", "q2")}
        columns["dq"] = np.zeros_like(columns["x"])
    return samples(columns, number, (1.0, 1.0, 1.0), 1, kind)


def __getattr__(name: str) -> Any:
    """Other public names of the benchmark (:mod:`partialslip.verify.benchmark`)."""
    if name not in benchmark.__all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(benchmark, name)
