"""Scoring somebody else's results against a scene's exact solution."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Literal

from partialslip.errors import InputError
from partialslip.judge.reference import METHODS
from partialslip.result import Result
from partialslip.run import Run, compared, run
from partialslip.scene import Scene
from partialslip.score.method import centred, scored
from partialslip.score.mistakes import in_another_unit, mistakes
from partialslip.score.read import read


def score(
    scene: Scene,
    file: str | Path,
    *,
    bar: float | None = None,
    reference: str | None = None,
    factors: tuple[float, float, float] = (1.0, 1.0, 1.0),
    order: int = 1,
    at: tuple[int, int] | None = None,
    columns: Mapping[str, str] | None = None,
    centre: Literal["given", "auto"] = "given",
    progress: Callable[[str], None] = lambda _: None,
) -> Run:
    """Compare the tractions in ``file`` with those of ``scene``. The result in the run has the file's name.

    Parameters
    ----------
    scene : Scene
    file : str or Path
        A table (.csv, .txt, .tsv, .rpt) with a header line: x (m); p (Pa), or Fn (N per m of depth) of nodes; and one
        of dq = q2 - q1, q = dq/2, q1 and q2, or of dFt, Ft, Ft1 and Ft2; or the names that other codes give them. Or
        CalculiX's .frd, or .dat with the .frd beside it; or a format of meshio's with p and dq, q, or q1 and q2 as
        point data.
    bar : float, optional
        What errors of a, m and n may be, as fractions of a; p and q have 10 and 15 times that. Otherwise no bars.
    reference : str, optional
        The method to compare with. As a rule exact; march where Q and sigma are out of phase; fem for bodies of
        different materials or of a size.
    factors : (float, float, float)
        By which x, p (Fn), and q (Ft) are multiplied: for other units, and other signs.
    order : int
        Of the elements that nodal forces are from, 1 or 2.
    at : (int, int), optional
        Of CalculiX's contact results, counted from 1, those of load points 1 and 2; as a rule those at the ends of the
        last steps.
    columns : mapping of str to str, optional
        Of tables: what x, p (or Fn) and the shear are made of, by name or number (from 1), or sums and differences:
        ``{"x": "X", "p": "CPRESS", "dq": "S2-S1"}``.
    centre : "given" or "auto"
        Whether x = 0 is in the middle of the contact as the file has it, or is put there.
    progress : callable
        Called with a line of text now and then.

    Raises
    ------
    InputError
        With one line that says what is wrong.
    """
    file = Path(file)
    name = "".join(c if c.isprintable() else "?" for c in file.name)
    if reference is None:
        halfplanes = scene.material.alike and not scene.finite
        reference = ("exact" if scene.load.in_phase else "march") if halfplanes else "fem"
    if reference not in METHODS:
        raise InputError(f"reference {reference!r}: must be one of {', '.join(METHODS)}")
    if centre not in ("given", "auto"):
        raise InputError(f"centre {centre!r}: must be given or auto")
    found = read(file, scene, factors, order, at, columns)
    if centre == "auto":
        found = centred(found, str(file))
    result = scored(scene, found, name, str(file))
    outcome = run(scene, [reference], progress=progress)
    return compared(
        scene, outcome.plan, outcome.results | {name: _read_as(scene, result, outcome.results[reference])}, bar
    )


def _read_as(scene: Scene, result: Result, reference: Result) -> Result:
    """``result``, as it was read from a file, with notes on likely mistakes in it; what they make meaningless is taken
    out."""
    result = replace(result, notes=(*mistakes(scene, result, reference), *result.notes))
    if in_another_unit(result, reference):
        why = dict.fromkeys(("m", "n"), "x is in another unit than the scene")
        result = replace(result, stick_centre=None, stick_half_width=None, undetermined=why)
    if reference.regime == "ratchets":  # of slip that adds up, tractions say nothing
        result = replace(result, regime="ratchets")
    return result
