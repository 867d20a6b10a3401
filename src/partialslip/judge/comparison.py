"""A result beside a reference: a verdict on every quantity."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from partialslip.arrays import Array
from partialslip.bars import BARS
from partialslip.judge.measures import Measure, measures
from partialslip.judge.verdict import NAN, NO_BAR, Bar, Outcome, Verdict, conditions, judged, overall
from partialslip.result import Result
from partialslip.scene import Scene

_TENSIONS = {"small tension", "large tension"}


@dataclass(frozen=True)
class Comparison:
    """Verdicts on a result against a reference.

    ``verdicts`` are those on its quantities: the ends of the contact (``a``, ``left``, ``right``, or ``left_1`` to
    ``right_2`` where they differ between the load points) and of the stick zone (``m``, ``n``), |difference| / a;
    the resultants ``P``, int p dx / P - 1, and ``dQ``, (int dq dx - dQ)/(2 f P); ``p``, ``q``, ``q1`` and ``q2``:
    relative L2 over the contact of cell averages (each cell's mean against the reference's mean over the same cell),
    q being (q2 - q1)/2, relative to the larger of q's norm and 1e-3 of f p's; ``p_max`` and ``q_max``: the largest
    values, in p0 and f p0; ``P_1`` and ``p_1`` at load point 1 where the pressure differs between the load points; and
    ``regime``. Where stresses were asked for and both know them, ``surface`` is the relative L2 error of sigma_xx along
    both surfaces as averages over those cells, ``largest`` the relative error of its largest value on the lower body,
    and ``inside`` the relative L2 error of the stresses in the middle of the triangles within 3 a, by area.

    ``conditions`` are verdicts on what the result must meet by itself: finite numbers and small residuals.
    ``p_nodal``, ``q_nodal``: relative L2 of nodal values; ``p_nodal_max``, ``q_nodal_max``: the largest error of a
    node, in p0 and f p0; None if there is no shear, and of p if no node lies within the true contact.
    """

    verdicts: tuple[Verdict, ...]
    conditions: tuple[Verdict, ...]
    p_nodal: float | None
    q_nodal: float | None
    p_nodal_max: float
    q_nodal_max: float | None

    @property
    def outcome(self) -> Outcome:
        """Passed, missed or not judged, as a whole (:func:`partialslip.judge.overall`)."""
        return overall(self.verdicts, self.conditions)

    @property
    def passed(self) -> bool:
        """Whether something was judged and nothing is missed."""
        return self.outcome is Outcome.PASSED

    @property
    def missed(self) -> tuple[str, ...]:
        """What is missed, in words."""
        every = (*self.verdicts, *self.conditions)
        return tuple(verdict.text for verdict in every if verdict.outcome is Outcome.MISSED)

    @property
    def errors(self) -> dict[str, float | None]:
        """Errors by quantity; None where the result or the reference has no value."""
        return {verdict.quantity: verdict.error for verdict in self.verdicts if verdict.quantity != "regime"}

    @property
    def bars(self) -> dict[str, float]:
        """Bars by quantity, of those that have one."""
        return {verdict.quantity: verdict.bar for verdict in self.verdicts if verdict.bar is not None}

    @property
    def a(self) -> float | None:
        """Error of a, as a fraction of a."""
        return self.errors["a"]

    @property
    def m(self) -> float | None:
        """Error of m, as a fraction of a."""
        return self.errors["m"]

    @property
    def n(self) -> float | None:
        """Error of n, as a fraction of a."""
        return self.errors["n"]

    @property
    def p(self) -> float | None:
        """Relative L2 error of the cell averages of p."""
        return self.errors["p"]

    @property
    def q(self) -> float | None:
        """Relative L2 error of the cell averages of q = (q2 - q1)/2."""
        return self.errors["q"]

    def _repr_html_(self) -> str:
        from partialslip.report.notebook import html

        return html(self)


def compare(
    result: Result,
    reference: Result,
    scene: Scene,
    accuracy: float | None,
    bars: Mapping[str, Bar] | None = None,
) -> Comparison:
    """Compare ``result`` with ``reference`` and judge it.

    Parameters
    ----------
    result, reference : Result
        Of the same ``scene``.
    scene : Scene
        Its loads and coefficient of friction scale the resultants and errors of q.
    accuracy : float or None
        Bar for a, m, n and the ends of the contact (fractions of a); p has 10 and q, q1 and q2 have 15 times that, and
        so have the resultants P and dQ. With None no quantity has a bar but those in ``bars``.
    bars : mapping of str to Bar, optional
        By quantity, bars in place of the usual ones.

    To a bar is added what the reference itself may be off by; if that is more than the bar, nothing is judged.
    """
    own = bars or {}
    usual = {} if accuracy is None else {key: Bar(share * accuracy) for key, share in BARS.items()}
    applied = {key: _beside(bar, key, reference) for key, bar in {**usual, **own}.items()}
    verdicts = [decide(each, applied.get(each.quantity), result) for each in measures(result, reference, scene)]
    nodal = _nodal_errors(result, reference, scene.friction.f)
    return Comparison((*verdicts, judge_regime(result, reference, applied)), conditions(result), *nodal)


def _beside(bar: Bar, quantity: str, reference: Result) -> Bar:
    """The bar for differences from a ``reference`` that has errors of its own. What the spacing of a tabulated profile
    makes is no difference: every method is given the same table."""
    key = quantity.removesuffix("_1").removesuffix("_2")
    own = reference.estimate.get(key, 0.0) - reference.shares.get("table", {}).get(key, 0.0)
    if bar.value is None or not own > 0:
        return bar
    if own > bar.value:
        return Bar(None, f"{reference.method} itself is known to {own:.1e} only")
    return Bar(bar.value + own, bar.reason or f"{bar.value:.1e}, and {own:.1e} of {reference.method}'s own")


def decide(measure: Measure, bar: Bar | None, result: Result) -> Verdict:
    """Judge one measure against its bar.

    A value that is NaN is missed whatever the bar; a value that the result does not have, although the reference does,
    is missed if there is a bar. What the reference says does not exist is not judged.
    """
    outcome, reason = _decided(measure, bar)
    return Verdict(
        quantity=measure.quantity,
        outcome=outcome,
        reference=measure.reference,
        found=measure.found,
        error=measure.error,
        bar=None if bar is None or measure.undetermined else bar.value,
        reason=reason,
        scale=measure.scale,
        estimate=result.estimate.get(measure.quantity.removesuffix("_1").removesuffix("_2")),
    )


def _decided(measure: Measure, bar: Bar | None) -> tuple[Outcome, str]:
    """The outcome and its reason."""
    if measure.undetermined:
        return Outcome.NOT_JUDGED, measure.undetermined
    if measure.error is not None and not math.isfinite(measure.error):
        return Outcome.MISSED, NAN
    if measure.error is None and measure.reference is None:
        return Outcome.NOT_JUDGED, "the reference has no value"
    if bar is None or bar.value is None:
        return Outcome.NOT_JUDGED, (bar and bar.reason) or NO_BAR
    if measure.error is None:
        return Outcome.MISSED, "the result has no value where the reference has one"
    return judged(measure.error, bar.value), bar.reason


def judge_regime(result: Result, reference: Result, bars: Mapping[str, Bar]) -> Verdict:
    """Judge the name of the regime. It is not judged if a slip zone or the stick zone that tells two names apart is
    narrower than the bars of m and n, if no quantity has a bar, or if another way leads to another stick zone."""
    found, true = result.regime, reference.regime
    own = bars.get("regime", Bar(1.0))
    known = [bar.value for bar in bars.values() if bar.value is not None]
    width = max((bars[key].value or 0.0 for key in ("m", "n") if key in bars), default=0.0)
    if own.value is None or not known:
        outcome, reason = Outcome.NOT_JUDGED, own.reason or NO_BAR
    elif found == true:
        outcome, reason = Outcome.PASSED, ""
    elif why := _undetermined_regime(result, reference):
        outcome, reason = Outcome.NOT_JUDGED, why
    elif near := _too_near(result, reference, width * reference.a):
        outcome, reason = Outcome.NOT_JUDGED, near
    else:
        outcome, reason = Outcome.MISSED, f"{found}, not {true}"
    return Verdict("regime", outcome, true, found, reason=reason)


def _undetermined_regime(result: Result, reference: Result) -> str:
    """Say which of both is of one way among several; empty if none is."""
    return next((f"{each.method}: {each.undetermined['m']}" for each in (reference, result) if each.path_dependent), "")


def _too_near(result: Result, reference: Result, width: float) -> str:
    """Say which zone, narrower than ``width`` (m), is all that tells the regimes apart; empty if there is none."""
    names, zone = {result.regime, reference.regime}, reference if reference.m is not None else result
    if zone.m is None or zone.n is None or zone.stick_half_width is None:
        return ""
    left, right = zone.ends[1]
    slips = (-zone.m - left, right - zone.n)  # widths of the slip zones
    if names == _TENSIONS and min(slips) <= width:
        return "a slip zone is narrower than the bar: the transition is nearer than the bar can tell"
    if "stuck" in names and not names & {"sliding", "ratchets"} and max(slips) <= width:
        return "both slip zones are narrower than the bar"
    if (names == _TENSIONS or "sliding" in names) and zone.stick_half_width <= width:
        return "the stick zone is narrower than the bar"
    return ""


def _nodal_errors(
    result: Result, reference: Result, f: float
) -> tuple[float | None, float | None, float, float | None]:
    """Relative L2 errors of nodal p and q, and the largest of them, in p0 and f p0."""
    x = result.traction.x
    p, dq = reference.traction.at(x)
    p_off, q_off = result.traction.p - p, (result.traction.dq - dq) / 2
    largest = float(np.abs(p_off).max() / reference.p0)
    if not dq.any() or f == 0 or reference.regime == "ratchets":
        return _relative(p_off, p, x), None, largest, None
    return _relative(p_off, p, x), _relative(q_off, dq / 2, x), largest, float(np.abs(q_off).max() / (f * reference.p0))


def _relative(error: Array, true: Array, x: Array) -> float | None:
    norm = np.trapezoid(true**2, x)
    return float(np.sqrt(np.trapezoid(error**2, x) / norm)) if norm > 0 else None
