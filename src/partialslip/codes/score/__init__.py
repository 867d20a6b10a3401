"""Score results of other codes against the solution of a scene."""

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np

from partialslip.codes.score.ends import FEWEST
from partialslip.codes.score.kinds import KINDS, Kind
from partialslip.codes.score.method import centred, scored
from partialslip.codes.score.mistakes import at_one_load_point, in_another_unit, mistakes
from partialslip.codes.score.observed import hidden
from partialslip.codes.score.read import read_tractions
from partialslip.codes.score.samples import FEWEST_POINTS
from partialslip.result import Result
from partialslip.run import Run, compared, run
from partialslip.run.judge import reference as references
from partialslip.run.judge.measures import levels_of, pressures_of
from partialslip.scene import Scene
from partialslip.scene.reading import AnyScene, as_scene
from partialslip.tools.bars import LARGEST, Accuracy, asked
from partialslip.tools.errors import InputError
from partialslip.tools.methods import REFERENCES

_STRIPS = 2.0  # accuracy: widths of a strip that is not resolved: largest error that it may cause


def score(
    scene: AnyScene,
    file: str | Path | Sequence[str | Path],
    *,
    bar: Accuracy | None = None,
    reference: str | None = None,
    factors: tuple[float, float, float] = (1.0, 1.0, 1.0),
    order: int = 1,
    at: tuple[int, int] | None = None,
    columns: Mapping[str, str] | None = None,
    where: Mapping[str, str] | None = None,
    centre: Literal["given", "auto"] = "given",
    kind: Kind | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Run:
    """Compare the tractions in ``file`` with the solution of ``scene``. The result in the run has the file's name.

    Parameters
    ----------
    scene : Scene, str or path
        A scene, the name of a shipped one, or the path of a scene file.
    file : str or Path, or a list of them
        One file, or one for each load point, of which p and q may be in two. One of:

        - a table (.csv, .txt, .tsv, .rpt) with a header line: x (m); p (Pa) or nodal forces Fn (N/m); and dq = q2 - q1,
          q = dq/2, or q1 and q2 (Pa), or dFt, Ft, or Ft1 and Ft2 (N/m). Names of other codes are known, too. If P or M
          varies, p (Fn) is of load point 2, and p1 (Fn1) of load point 1 must be there, too. Columns x/a, p/p0 and
          q/(f p0) are times a and p0 of the scene. Without a header line three columns are x, p and q.
        - CalculiX's .frd, or .dat with the .frd of the same name;
        - a format of meshio with the same as point data.

        Numbers are in the units in which the scene is shown (:attr:`Scene.shown_in`), in other units if the table's
        header states them, and in those of the deck if CalculiX ran a deck of :func:`partialslip.codes.export.export`.
    bar : float or (float, float, float), optional
        Largest errors of a, m and n, as fractions of a; p and q have 10 and 15 times this bar, none above 0.1. Or one
        number each for contact, stick zone and tractions. None above 0.1. By default no bars.
    reference : str, optional
        Method to compare with; by default the reference (:func:`partialslip.run.judge.reference.reference`).
    factors : (float, float, float)
        Further factors of x, p and p1 (Fn) and q (Ft), for other units and signs.
    order : int
        Order of the elements of nodal forces, 1 or 2.
    at : (int, int), optional
        Numbers of CalculiX's contact results, from 1, of load points 1 and 2; by default the ends of the last steps.
    columns : mapping of str to str, optional
        For tables: x, p (or Fn), p1 (or Fn1) and the shear by name or number (from 1) of a column, or sums and
        differences: ``{"x": "X", "p": "CPRESS", "dq": "S2-S1"}``.
    where : mapping of str to str, optional
        Rows to keep, by the values of columns: ``{"surface": "FLAT"}``; two values with a comma between them are those
        of load points 1 and 2.
    centre : "given" or "auto"
        "auto" moves x = 0 to the middle of the contact; not with a moment or an uneven gap.
    kind : "sampled", "mean" or "nodal", optional
        What the values are: values at points, means over cells, or nodal forces of linear elements over the nodes'
        weights. By default guessed, with a note.
    progress : callable
        Called with one line of text at a time.

    Raises
    ------
    InputError
        If the file cannot be read, or an argument is not allowed.
    """
    scene = as_scene(scene)
    given = [file] if isinstance(file, (str, os.PathLike)) or not isinstance(file, Sequence) else list(file)
    if not given or not all(isinstance(each, (str, os.PathLike)) for each in given):
        raise InputError(f"file = {file!r:.60}: must be the path of a file, or a list of them")
    files, wanted = [Path(each) for each in given], asked(bar)
    name, told = _printable("+".join(each.name for each in files)), " and ".join(map(str, files))
    reference = references.reference(scene).method if reference is None else reference
    if reference not in REFERENCES:
        raise InputError(f"reference {reference!r}: must be one of {', '.join(REFERENCES)}")
    if centre not in ("given", "auto"):
        raise InputError(f"centre {centre!r}: must be 'given' or 'auto'")
    if kind not in (None, *KINDS):
        raise InputError(f"kind {kind!r}: must be one of {', '.join(KINDS)}")
    if centre == "auto" and not scene.even:
        raise InputError("centre 'auto': must be 'given' with a moment or an uneven gap: the middle is not at x = 0")
    found = read_tractions(files, scene, factors, order, at, columns, kind, where, centre == "auto")
    if centre == "auto":
        found = centred(found, told, scene.units)
    result = scored(scene, found, name, told)
    outcome = run(scene, [reference], progress=progress)
    known = outcome.results[reference]
    seen = _read_as(scene, result, known, wanted.bars if wanted else None)
    if seen.traction.q1 is None:
        outcome.results[reference] = _of_the_change(known)
    return compared(scene, outcome.plan, outcome.results | {name: seen}, wanted)


def _printable(name: str) -> str:
    return "".join(c if c.isprintable() else "?" for c in name)


def _of_the_change(reference: Result) -> Result:
    """The ``reference`` of a table without q1 and q2, which need not know them."""
    unknown = {key: why for key, why in reference.undetermined.items() if key in ("q1", "q2")}
    told = {f"q1 and q2: {why}" for why in unknown.values()}
    return replace(
        reference,
        notes=tuple(note for note in reference.notes if note not in told),
        undetermined={**reference.undetermined, **dict.fromkeys(unknown, "not needed, as only the change is scored")},
    )


def _read_as(scene: Scene, result: Result, reference: Result, bars: Mapping[str, float] | None = None) -> Result:
    """Add notes on likely mistakes to ``result``, and remove quantities that they make meaningless, or that the table
    does not show to the ``bars``."""
    result = replace(result, notes=(*mistakes(scene, result, reference), *result.notes))
    if in_another_unit(scene, result, reference):
        result = _without_stick_zone(result, "x is in another unit than the scene")
    if why := at_one_load_point(scene, result):
        result = _without_stick_zone(replace(result, regime=reference.regime), why)
        shears = dict.fromkeys(("dQ", "q", "q1", "q2"), why)
        result = replace(result, undetermined={**result.undetermined, **shears})
    result = _unresolved(result, reference, bars or {})
    result = _too_far_apart(scene, result, reference)
    if reference.regime == "ratchets":  # not visible in tractions
        result = replace(result, regime="ratchets")
    return result


def _unresolved(result: Result, reference: Result, bars: Mapping[str, float]) -> Result:
    """``result`` with an estimate of m and n that is not below their error where an end of the stick zone went out and
    came back on the way, over a strip in which too few points of the table lie to show it; without m and n where that
    error is above the bar. The strip is that of the ``reference``: between the points that never slip and the zone of
    the tractions."""
    m, n, permanent = reference.m, reference.n, reference.permanent
    if m is None or n is None or permanent is None or result.m is None or result.n is None:
        return result
    x, estimate, notes, hidden = result.traction.x, dict(result.estimate), list(result.notes), False
    for key, end, inner, found in zip("mn", (-m, n), permanent, (-result.m, result.n), strict=True):
        low, high = min(end, inner), max(end, inner)
        width, off = (high - low) / reference.a, abs(found - end) / reference.a
        seen = int(np.count_nonzero((x > low) & (x < high)))
        if seen < FEWEST and estimate[key] < off <= _STRIPS * width:
            estimate[key], hidden = off, hidden or off > bars.get(key, np.inf)
            back = f"{key}: on the way the end of the stick zone takes back {width:.1g} a"
            notes.append(f"{back}, too little for points so far apart")
    result = replace(result, estimate=estimate, notes=tuple(notes))
    why = "the points are too far apart where an end of the stick zone comes back on the way"
    return _without_stick_zone(result, why) if hidden else result


def _too_far_apart(scene: Scene, result: Result, reference: Result) -> Result:
    """``result`` with what the spacing of its points hides of the ``reference``; it does not tell a traction of which
    that is more than the largest bar, nor one within which
    hardly a point lies."""
    of, to = result.traction, reference.traction
    hides = hidden(of.x, to, scene.friction.f, (*pressures_of(of, to), "q", *levels_of(of, to)))
    unseen = {key: f"points are too far apart: {off:.1g} of it lies between them" for key, off in hides.items()
              if off > LARGEST}  # fmt: skip
    left, right = to.breaks.min(), to.breaks.max()
    if (count := int(np.count_nonzero((of.x > left) & (of.x < right)))) < FEWEST_POINTS:
        unseen = dict.fromkeys(hides, f"{count} of its points lie within the contact: must be at least {FEWEST_POINTS}")
    sums = {"p": ("P", "M"), "p_1": ("P_1", "M_1"), "q": ("dQ",)}
    unseen |= {each: why for key, why in unseen.items() for each in sums.get(key, ())}
    return replace(
        result,
        settings={**result.settings, **{f"spacing_hides_{key}": float(f"{hides[key]:.2g}") for key in ("p", "q")}},
        undetermined={**unseen, **result.undetermined},
    )


def _without_stick_zone(result: Result, why: str) -> Result:
    without = {**result.undetermined, "m": why, "n": why}
    return replace(result, stick_centre=None, stick_half_width=None, undetermined=without)
