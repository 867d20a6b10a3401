"""Quantities of the benchmark, taken from a result: what a target is, and what a method's values are."""

import math
from collections import defaultdict
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from partialslip.result import Result
from partialslip.result.peak import peak_error
from partialslip.run.judge.measures import norm_errors
from partialslip.scene import Scene
from partialslip.scene.units import Dimension
from partialslip.verify.benchmark.curves import read_curves
from partialslip.verify.benchmark.problem import Problem
from partialslip.verify.benchmark.submission import Answer

# tractions: the norms of p and q; points: p and dq at places; levels: q1 and q2
GROUPS = ("contact", "stick", "tractions", "points", "levels", "slip", "stress")

#: Groups that a problem must have answered in full, and that make the whole.
HEADLINE = ("contact", "stick", "tractions")


class Quantity(NamedTuple):
    """A quantity of a result.

    Parameters
    ----------
    value : float
        SI units.
    unit : str
        Dimension.
    scale : float
        Size to which an error is relative, in the same unit.
    group : str
        One of :data:`GROUPS`.
    error : float
        The method's own estimate of its error, in the scale; NaN if there is none.
    """

    value: float
    unit: Dimension
    scale: float
    group: str
    error: float


def quantities(scene: Scene, result: Result, places: tuple[float, ...], a: float | None = None) -> dict[str, Quantity]:
    """Quantities of ``result``, by key.

    Parameters
    ----------
    scene : Scene
    result : Result
    places : tuple of float
        x/a at which tractions are taken.
    a : float, optional
        Half-width that places and scales refer to, m; default: that of the result.

    Notes
    -----
    ``a``, ``left``, ``right`` (contact, ends where it is not even), ``m``, ``n``; ``p_max``, ``p@x``, ``dq@x`` and,
    where determined, ``q1@x`` and ``q2@x`` at x/a; ``slip`` (the largest) and ``dissipated``; ``sigma_xx`` (the largest
    of the lower surface, where the result has stresses); ``swt`` and ``swt_line`` (the largest Smith-Watson-Topper
    parameter of the lower surface, and that of stresses averaged below it). A quantity that the method does not
    determine is not there.
    """
    found = _quantities(scene, result, places, a or result.a)
    return {key: each._replace(value=float(each.value), scale=float(each.scale)) for key, each in found}


def targeted(problem: Problem, result: Result) -> dict[str, Quantity]:
    """Quantities of ``result`` that ``problem`` is measured by, by key, at the places of the target's a, and the norms
    of p and q."""
    found = quantities(problem.scene, result, problem.places, problem.targets["a"].value)
    found |= norms(problem, result)
    return {key: found[key] for key in problem.measured if key in found}


def norms(problem: Problem, result: Result) -> dict[str, Quantity]:
    """Relative L2 errors of p and q of ``result`` over the contact (:func:`partialslip.run.judge.measures.norm_errors`
    against the problem's curve); q where it is determined."""
    curve, shear = read_curves().get(problem.number), result.regime != "ratchets" and "q" not in result.undetermined
    if not curve:
        return {}
    keys = ("p", "q") if shear else ("p",)
    off = norm_errors(result.traction, curve.traction, problem.scene.friction.f, keys)
    return {
        key: Quantity(error, "1", 1.0, "tractions", result.estimate.get(key, math.nan)) for key, error in off.items()
    }


def answer_of(problem: Problem, result: Result) -> Answer:
    """Answer to ``problem`` from a ``result``, with what it has of the targets."""
    found = targeted(problem, result)
    headline = {key for key, target in problem.measured.items() if target.group in HEADLINE}
    own = {key: each.error for key, each in found.items() if key in headline and math.isfinite(each.error)}
    return Answer(
        values={key: each.value for key, each in found.items()},
        estimate={key: float(f"{error:.2g}") for key, error in own.items()},
        cpu_s=result.cost.cpu_s,
        memory_mb=result.cost.peak_rss_mb,
    )


def _quantities(scene: Scene, result: Result, places: tuple[float, ...], a: float) -> Iterator[tuple[str, Quantity]]:
    f, of = scene.friction.f, result.traction
    p0 = 2 * scene.P / (np.pi * a)
    own = defaultdict(lambda: math.nan, result.estimate)
    yield "a", Quantity(result.a, "m", a, "contact", own["a"])
    if result.contact_ends:
        names = ("left_1", "right_1", "left_2", "right_2")
        for name, end in zip(names, (end for ends in result.contact_ends for end in ends), strict=True):
            yield name, Quantity(end, "m", a, "contact", own[name.partition("_")[0]])
    for key in ("m", "n"):
        end = getattr(result, key)
        if end is not None and key not in result.undetermined and result.regime != "ratchets":
            yield key, Quantity(end, "m", a, "stick", own[key])
    x = a * np.array(places)
    at = of.at(x)
    yield "p_max", Quantity(of.p_max, "Pa", p0, "tractions", own["p"])
    for place, value in zip(places, at.p.tolist(), strict=True):
        yield f"p@{place:g}", Quantity(value, "Pa", p0, "tractions", own["p"])
    if not f or not np.any(at.dq) or result.regime == "ratchets":
        return
    if "q" not in result.undetermined:
        for place, value in zip(places, at.dq.tolist(), strict=True):
            yield f"dq@{place:g}", Quantity(value, "Pa", 2 * f * p0, "tractions", own["q"])
    if at.levels and "q1" not in result.undetermined:
        for key, values in zip(("q1", "q2"), at.levels, strict=True):
            for place, value in zip(places, values.tolist(), strict=True):
                yield f"{key}@{place:g}", Quantity(value, "Pa", f * p0, "levels", own[key])
    if result.slip and not {"q", "m"} & set(result.undetermined):
        most = float(np.abs(result.slip.slip).max())
        if most > 0:
            yield "slip", Quantity(most, "m", most, "slip", own["q"])
            work, off = result.slip.dissipated, result.slip.dissipated_error
            yield (
                "dissipated",
                Quantity(work, "J/m", work, "slip", off / work if off is not None and work else math.nan),
            )
    if result.surface:
        off = peak_error(result)
        error = math.nan if off is None else off / p0
        yield "sigma_xx", Quantity(result.surface.largest[1], "Pa", p0, "stress", error)
    if result.stress_at and scene.fatigue.distance:
        from partialslip.study.fatigue import assess  # takes long to import

        rating = assess(scene, result, ["swt"]).ratings["swt"]
        errors = rating.errors or (math.nan, math.nan)
        for key, spot, error in zip(
            ("swt", "swt_line"), (rating.surface, rating.averages["line"]), errors, strict=True
        ):
            yield key, Quantity(spot.value, "Pa", spot.value, "stress", error)
