"""Verdicts: how one quantity, or the regime, is judged: passed, missed or not judged, with a reason."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import NamedTuple, Self, TypeVar

import numpy as np

from partialslip.result import Result
from partialslip.result.record import ResultRecord
from partialslip.run.judge.known import base, error_of
from partialslip.run.judge.measures import Measure, unsteady
from partialslip.scene import Scene
from partialslip.tools.bars import BARS, CERTIFICATE_BAR

# Bars on traction errors, in multiples of the accuracy asked of a, m and n.
P_BAR, Q_BAR = BARS["p"], BARS["q"]

NAN, NO_BAR = "not a number", "no bar"
READ = "read"  # fixed: setting of a result that was read from a table

_TENSIONS = {"small tension", "large tension"}
_STICKING = {"sticking ends", "no slip"}  # regimes of varying pressure in which an end does not slip throughout

_Value = TypeVar("_Value", float | str | None, float | None)


class Outcome(StrEnum):
    """Outcome of a verdict: passed, missed or not judged."""

    PASSED = "passed"
    MISSED = "missed"
    NOT_JUDGED = "not judged"


class Bar(NamedTuple):
    """A bar: ``value`` is the largest allowed error, None if not judged; ``reason`` is given for an unusual bar."""

    value: float | None
    reason: str = ""


@dataclass(frozen=True)
class Verdict:
    """The verdict on one quantity.

    Parameters
    ----------
    quantity : str
        Key of the quantity, for example ``m`` or ``q_max``.
    outcome : Outcome
    reference, found : float, str or None
        Value of the reference and of the result, in units of ``scale``, or as text; None for norms.
    error : float or None
        Error or residual, in units of ``scale``; None if there is no error.
    bar : float or None
        Largest error that passes, in units of ``scale``; None if there is no bar.
    reason : str
        Why the quantity is missed or not judged, or why the bar is not the usual one.
    scale : str
        Unit of values, error and bar, for example ``a``, ``f p0`` or ``norm`` (relative).
    estimate : float or None
        The method's own estimate of the error, in units of ``scale``.
    """

    quantity: str
    outcome: Outcome
    reference: float | str | None = None
    found: float | str | None = None
    error: float | None = None
    bar: float | None = None
    reason: str = ""
    scale: str = ""
    estimate: float | None = None

    @property
    def share(self) -> float | None:
        """Error as a fraction of the bar; None without error or bar, or if the bar is 0."""
        return None if self.error is None or not self.bar else self.error / self.bar

    @property
    def known(self) -> bool:
        """Whether there is a value or an error to show."""
        return (self.reference, self.found, self.error) != (None, None, None)

    @property
    def finite(self) -> Self:
        """The verdict for JSON: Python floats, with None in place of NaN and infinity."""
        return replace(
            self,
            reference=_known(self.reference),
            found=_known(self.found),
            error=_known(self.error),
            bar=_known(self.bar),
            estimate=_known(self.estimate),
        )

    @property
    def text(self) -> str:
        """The verdict as text: quantity, then error and bar, or the reason."""
        if self.error is None or self.bar is None or not math.isfinite(self.error):
            return f"{self.quantity}: {self.reason or self.outcome}"
        return f"{self.quantity}: error {self.error:.3g} {'<=' if self.error <= self.bar else '>'} {self.bar:.3g}"


def _known(value: _Value) -> _Value | None:
    if not isinstance(value, float):
        return value
    return float(value) if math.isfinite(value) else None


def judged(error: float, bar: float, unsure: float = 0.0) -> Outcome:
    """Return PASSED if ``error`` <= ``bar``, MISSED otherwise and for NaN; NOT_JUDGED if an error that may be larger or
    smaller by ``unsure`` decides."""
    outcomes = {Outcome.PASSED if each <= bar else Outcome.MISSED for each in (error - unsure, error + unsure)}
    return outcomes.pop() if len(outcomes) == 1 else Outcome.NOT_JUDGED


def read_to(quantity: str, result: Result | ResultRecord) -> float:
    """Return what a table tells of a length to, in a: the error estimate of reading it. 0 for results that are not read
    from a table, and for quantities that are compared like with like."""
    key = quantity.removesuffix("_1").removesuffix("_2")
    if READ not in result.settings or key not in result.estimate:
        return 0.0
    found = result.estimate[key]
    return math.inf if found is None else found


def plus_estimate(bar: Bar, quantity: str, reference: Result) -> Bar:
    """Return the bar plus the error estimate of the ``reference``; none without an estimate.

    The estimate's share of the state at the beginning does not count: every method is given the same state. Neither
    does that of a table, which results of earlier versions have.
    """
    if bar.value is None or quantity == "regime":
        return bar
    own = error_of(reference, quantity, reference.method)
    if math.isnan(own):
        return Bar(None, f"{reference.method} has no error estimate of {quantity}")
    own -= sum(reference.shares.get(source, {}).get(base(quantity), 0.0) for source in ("table", "start"))
    if not own > 0:
        return bar
    if own > bar.value:
        return Bar(None, f"{reference.method} itself is known to {own:.1e} only")
    return Bar(bar.value + own, bar.reason or f"{bar.value:.1e}, and {own:.1e} of {reference.method}'s own")


def decide(measure: Measure, bar: Bar | None, result: Result) -> Verdict:
    """Judge one ``measure`` of the ``result`` against the ``bar``.

    NaN is missed with or without a bar. A value that only the reference has is missed if there is a bar. A quantity
    that does not exist for the reference is not judged; nor is one missed because too few cycles were asked for.
    """
    outcome, reason = _decided(measure, bar, read_to(measure.quantity, result))
    if few := outcome is Outcome.MISSED and measure.unsteady:
        outcome, reason = Outcome.NOT_JUDGED, few
    return Verdict(
        quantity=measure.quantity,
        outcome=outcome,
        reference=measure.reference,
        found=measure.found,
        error=measure.error,
        bar=None if bar is None or measure.undetermined or few else bar.value,
        reason=reason,
        scale=measure.scale,
        estimate=result.estimate.get(base(measure.quantity)),
    )


def _decided(measure: Measure, bar: Bar | None, unsure: float) -> tuple[Outcome, str]:
    """Return the outcome and the reason for it; the error may be larger or smaller by ``unsure``."""
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
    outcome = judged(measure.error, bar.value, unsure)
    if outcome is Outcome.NOT_JUDGED:
        return outcome, f"this table tells {measure.quantity} to {unsure:.1g} {measure.scale}"
    return outcome, bar.reason


def judge_regime(
    result: Result, reference: Result, scene: Scene, bars: Mapping[str, Bar], unknown: Mapping[str, str]
) -> Verdict:
    """Judge the name of the regime of ``result`` against ``reference``, with ``bars`` by quantity.

    The regime is not judged in seven cases: no quantity has a bar; the reference has no error estimate of a stick zone;
    the slip or stick zone that distinguishes the two names is narrower than the bars of m and n, or than the
    reference's estimates; the mean of Q is nearer to its bound, in f P, than these bars in a: the room for it is an
    integral over the stick zone; one of both ratchets, and slip of the other adds up, too, but less than it calls
    ratcheting; one result alone is not of the steady state; the stick zone is ``unknown`` (by quantity, why).
    """
    found, true = result.regime, reference.regime
    own = bars.get("regime", Bar(1.0))
    known = [bar.value for bar in bars.values() if bar.value is not None]
    own_errors = [error_of(reference, key, reference.method) for key in "mn" if reference.m is not None]
    width = max((*(bars[key].value or 0.0 for key in "mn" if key in bars), *own_errors), default=0.0)
    if own.value is None or not known:
        outcome, reason = Outcome.NOT_JUDGED, own.reason or NO_BAR
    elif found == true:
        outcome, reason = Outcome.PASSED, ""
    elif "m" in unknown:
        outcome, reason = Outcome.NOT_JUDGED, unknown["m"]
    elif not all(map(math.isfinite, own_errors)):
        outcome, reason = Outcome.NOT_JUDGED, f"{reference.method} has no error estimate of m and n"
    elif why := unsteady(result, reference) or _untold(result, reference):
        outcome, reason = Outcome.NOT_JUDGED, why
    elif near := _too_near(result, reference, width * reference.a) or _barely(result, reference, scene, width):
        outcome, reason = Outcome.NOT_JUDGED, near
    else:
        outcome, reason = Outcome.MISSED, f"{found}, not {true}"
    return Verdict("regime", outcome, true, found, reason=reason)


def _too_near(result: Result, reference: Result, width: float) -> str:
    """Return which zone, narrower than ``width`` (m), alone distinguishes the regimes; empty if there is none."""
    width += max(read_to(key, result) for key in "mn") * reference.a
    names, zone = {result.regime, reference.regime}, reference if reference.m is not None else result
    if zone.m is None or zone.n is None or zone.stick_half_width is None:
        return ""
    lefts, rights = zip(*zone.ends, strict=True)
    slips = (-zone.m - max(lefts), min(rights) - zone.n)  # widths of the slip zones
    if (names == _TENSIONS or names & _STICKING) and min(slips) <= width:
        return "a slip zone is narrower than the bar: the transition is nearer than the bar can tell"
    if "stuck" in names and not names & {"sliding", "ratchets"} and max(slips) <= width:
        return "both slip zones are narrower than the bar"
    if (names == _TENSIONS or "sliding" in names) and zone.stick_half_width <= width:
        return "the stick zone is narrower than the bar"
    return ""


def _untold(result: Result, reference: Result) -> str:
    """Return which result does not tell whether it ratchets, as the other one does, and why."""
    if "ratchets" not in {result.regime, reference.regime}:
        return ""
    calls = (
        f"{each.method}: {each.undetermined['regime']}" for each in (result, reference) if "regime" in each.undetermined
    )
    return next(calls, "")


def _barely(result: Result, reference: Result, scene: Scene, share: float) -> str:
    """Return that the mean of Q is within ``share`` f P of a bound of the ``reference``, if one of both ratchets."""
    limits, room = reference.limits, share * scene.friction.f * scene.P
    most = limits.get("Q_mean_most", limits.get("Q_mean", math.inf))
    least = limits.get("Q_mean_least", -most)
    names, mean = {result.regime, reference.regime}, scene.load.Q_mean
    if "ratchets" not in names or "sliding" in names or min(abs(mean - least), abs(mean - most)) > room:
        return ""
    return "the mean of Q is nearer to the bound for a steady state than the bar can tell"


def conditions(result: Result) -> tuple[Verdict, ...]:
    """Judge a ``result`` alone, without a reference.

    ``finite`` counts the numbers that are NaN or infinite, and must be 0. Each residual of the certificate must be at
    most :data:`partialslip.tools.bars.CERTIFICATE_BAR`.
    """
    lost = _not_finite(result)
    reason = f"NaN or infinite: {lost:,} of the result's numbers" if lost else ""
    finite = Verdict("finite", judged(lost, 0.0), error=float(lost), bar=0.0, reason=reason, scale="numbers")
    certificate = (
        Verdict(
            f"certificate {name}",
            judged(residual, CERTIFICATE_BAR),
            error=residual,
            bar=CERTIFICATE_BAR,
            reason="" if math.isfinite(residual) else NAN,
            scale="f p0 or f P",
        )
        for name, residual in result.certificate.items()
    )
    return finite, *certificate


def _not_finite(result: Result) -> int:
    """Return how many numbers of a result are NaN or infinite."""
    traction, slip = result.traction, result.slip
    arrays = [traction.x, traction.p, traction.dq, traction.q1, traction.q2, traction.p1]
    arrays += [slip.x, slip.slip, np.array(slip.dissipated)] if slip else []
    numbers = [result.a, result.p0, result.stick_centre, result.stick_half_width]
    numbers += [*result.certificate.values(), *result.estimate.values(), *result.limits.values()]
    numbers += [end for pair in result.ends for end in pair]
    arrays.append(np.array([number for number in numbers if number is not None]))
    return sum(int((~np.isfinite(array)).sum()) for array in arrays if array is not None)
