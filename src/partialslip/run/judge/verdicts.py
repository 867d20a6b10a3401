"""Bars, verdicts and outcomes: how one quantity, a result or a run is judged, with a reason.

A comparison passes only if every headline quantity was judged and nothing is missed. The regime of the reference tells
which quantities are the headline.
"""

import math
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, NamedTuple, Self

import numpy as np

from partialslip.result import Result
from partialslip.result.record import ResultRecord, plain
from partialslip.run.judge.measures import Measure, calls, unsteady
from partialslip.run.judge.reference import base, error_of
from partialslip.scene import Scene
from partialslip.tools.bars import BARS, CERTIFICATE_BAR, LEAST_SHEAR

# Bars on traction errors, in multiples of the accuracy asked of a, m and n.
P_BAR, Q_BAR = BARS["p"], BARS["q"]

NAN, NO_BAR = "not a number", "no bar"
READ = "read"  # fixed: setting of a result that was read from a table

_TENSIONS = {"small tension", "large tension"}
_STICKING = {"sticking ends", "no slip"}  # regimes of varying pressure in which an end does not slip throughout

# limit: Largest ratio of a true error to the method's own estimate of it.
MOST = 2.0
#: Prefix of the quantity of a verdict on an estimate.
ESTIMATE = "estimate of "
# Estimates do not include rounding: 1e-9 a, or 1e-9 of f p, as in the residuals of converged solvers. Errors of the
# shear are relative to its norm, or to a part of the norm of f p where the shear is smaller.
_ROUNDING = {"q": 1e-9 / LEAST_SHEAR, "q1": 1e-9 / LEAST_SHEAR, "q2": 1e-9 / LEAST_SHEAR}
_NOTHING = 0.01  # limit: of the bar: errors that matter to nobody need no estimate
_STICK = ("a", "m", "n", "p", "q")  # with a stick zone
#: Quantities that must be judged, by the regime of the reference where there is no stick zone to ask for. The regime
#: itself must be judged there: nothing else says that nothing sticks.
_OTHERS: Mapping[str, tuple[str, ...]] = {
    "sliding": ("regime", "a", "p", "q"),  # q = f p
    "frictionless": ("regime", "a", "p", "q"),  # q = 0
    "ratchets": ("regime", *_STICK),  # asked for, and never judged: there is no steady state
}
#: Quantities that must be judged where both results have them and they have a bar: what comes beside a, p and q where
#: the contact is not even, the pressure varies, or the shear at the load points is known.
_WHERE_KNOWN = ("left", "right", "left_1", "right_1", "left_2", "right_2", "p_1", "q1", "q2")

PASSED, MISSED, UNJUDGED = 0, 1, 4  # fixed: exit codes


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
        return plain(self)

    @property
    def text(self) -> str:
        """The verdict as text: quantity, then error and bar, or the reason."""
        if self.error is None or self.bar is None or not math.isfinite(self.error):
            return f"{self.quantity}: {self.reason or self.outcome}"
        return f"{self.quantity}: error {self.error:.3g} {'<=' if self.error <= self.bar else '>'} {self.bar:.3g}"


def judged(error: float, bar: float, unsure: float = 0.0) -> Outcome:
    """Return PASSED if ``error`` <= ``bar``, MISSED otherwise and for NaN; NOT_JUDGED if an error that may be larger or
    smaller by ``unsure`` decides."""
    outcomes = {Outcome.PASSED if each <= bar else Outcome.MISSED for each in (error - unsure, error + unsure)}
    return outcomes.pop() if len(outcomes) == 1 else Outcome.NOT_JUDGED


def read_to(quantity: str, result: Result | ResultRecord) -> float:
    """Return the error estimate of reading a length from a table, in a; 0 for results not read from a table and for
    quantities that are compared like with like."""
    key = base(quantity)
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
        if not reference.estimate and reference.method == "fem":
            return Bar(
                None, "fem has no error estimate on a given mesh or size: give sizes of the bodies and an accuracy"
            )
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
        return outcome, f"this table tells {measure.quantity} to {unsure:.2g} {measure.scale}"
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
    else:
        why = (
            unknown.get("m")
            or ("" if all(map(math.isfinite, own_errors)) else f"{reference.method} has no error estimate of m and n")
            or unsteady(result, reference)
            or _untold(result, reference)
            or _too_near(result, reference, width * reference.a)
            or _barely(result, reference, scene, width)
        )
        outcome, reason = (Outcome.NOT_JUDGED, why) if why else (Outcome.MISSED, f"{found}, not {true}")
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
    ratchets = "ratchets" in {result.regime, reference.regime}
    return next(iter(calls("regime", result, reference)), "") if ratchets else ""


def _barely(result: Result, reference: Result, scene: Scene, share: float) -> str:
    """Return that the mean of Q is within ``share`` f P of a bound of the ``reference``, if one of both ratchets."""
    limits, room = reference.limits, share * scene.friction.f * scene.P
    most = limits.get("Q_mean_most", limits.get("Q_mean", math.inf))
    least = limits.get("Q_mean_least", -most)
    names, mean = {result.regime, reference.regime}, scene.load.Q_mean
    if "ratchets" not in names or "sliding" in names or min(abs(mean - least), abs(mean - most)) > room:
        return ""
    return "the mean of Q is nearer to the bound for a steady state than the bar can tell"


def conditions(result: Result | ResultRecord, told: Iterable[Verdict] = ()) -> tuple[Verdict, ...]:
    """Judge a ``result`` alone, without a reference.

    ``finite`` counts the numbers that are NaN or infinite, and must be 0. Each residual of the certificate must be at
    most :data:`partialslip.tools.bars.CERTIFICATE_BAR`. A number that was not finite is None in a file. Those ``told``
    in the file count, too: an end of a stick zone may also be None because there is none.
    """
    counted = (verdict.error for verdict in told if verdict.quantity == "finite")
    lost = max(_not_finite(result), *(int(each or 0) for each in counted), 0)
    reason = f"NaN or infinite: {lost:,} of the result's numbers" if lost else ""
    finite = Verdict("finite", judged(lost, 0.0), error=float(lost), bar=0.0, reason=reason, scale="numbers")
    residuals = {name: math.nan if value is None else value for name, value in result.certificate.items()}
    certificate = (
        Verdict(
            f"certificate {name}",
            judged(residual, CERTIFICATE_BAR),
            error=residual,
            bar=CERTIFICATE_BAR,
            reason="" if math.isfinite(residual) else NAN,
            scale="f p0 or f P",
        )
        for name, residual in residuals.items()
    )
    return finite, *certificate


def _not_finite(result: Result | ResultRecord) -> int:
    """Return how many numbers of a result are NaN or infinite; None counts in a file, but for ends of a stick zone."""
    traction, slip = result.traction, result.slip
    ends = result.ends if isinstance(result, Result) else result.contact_ends
    zone = [each for each in (result.stick_centre, result.stick_half_width) if each is not None]
    numbers: list[Any] = [[result.a, result.p0, *zone], *ends]
    numbers += [[*some.values()] for some in (result.certificate, result.estimate, result.limits)]
    numbers += [slip.x, slip.slip, slip.dissipated] if slip else []
    if traction:
        numbers += [traction.x, traction.p, traction.dq, traction.q1, traction.q2, traction.p1]
    return sum(int((~np.isfinite(np.array(each, float))).sum()) for each in numbers if each is not None)


def estimate_verdicts(verdicts: Iterable[Verdict], reference: Result) -> Iterator[Verdict]:
    """Yield a verdict on each estimate in ``verdicts``: the true error must be at most twice the estimate.

    Parameters
    ----------
    verdicts : iterable of Verdict
        Verdicts of a comparison with ``reference``. Those without an estimate or an error, and those that are not
        judged for another reason than that there is no bar, are left out.
    reference : Result
        Its own error is added to the bar. No estimate that is smaller than this error is judged.
    """
    for verdict in verdicts:
        unknown = verdict.outcome is Outcome.NOT_JUDGED and verdict.reason != NO_BAR
        if verdict.estimate is None or verdict.error is None or unknown:
            continue
        least = max(_ROUNDING.get(verdict.quantity, 1e-9), _NOTHING * (verdict.bar or 0.0))
        bar = plus_estimate(Bar(max(MOST * verdict.estimate, least)), verdict.quantity, reference)
        outcome = Outcome.NOT_JUDGED if bar.value is None else judged(verdict.error, bar.value)
        yield Verdict(
            f"{ESTIMATE}{verdict.quantity}",
            outcome,
            error=verdict.error,
            bar=bar.value,
            reason=f"estimated to be {verdict.estimate:.1e}" if outcome is Outcome.MISSED else "",
            scale=verdict.scale,
        )


@dataclass(frozen=True)
class Conclusion:
    """Outcome of several verdicts.

    Parameters
    ----------
    outcome : Outcome
    missed : tuple of str
        Missed verdicts as text.
    unjudged : tuple of str
        Headline quantities that were not judged.
    asked : bool
        Whether there were bars. Without bars the outcome is NOT_JUDGED, or MISSED if a condition is missed.
    """

    outcome: Outcome
    missed: tuple[str, ...] = ()
    unjudged: tuple[str, ...] = ()
    asked: bool = True

    def __str__(self) -> str:
        return self.text

    @property
    def text(self) -> str:
        """The outcome in words, with what was missed or not judged."""
        if self.outcome is Outcome.MISSED:
            return "missed: " + "; ".join(self.missed)
        if self.outcome is Outcome.PASSED:
            return "all bars met"
        if not self.asked:
            return "no bars"
        return f"not judged: {', '.join(self.unjudged) or 'no result beside the reference claims to hold'}"

    @property
    def code(self) -> int:
        """Exit code: 1 if missed, 4 if bars were asked for and headline quantities were not judged, 0 otherwise."""
        if self.outcome is Outcome.MISSED:
            return MISSED
        return UNJUDGED if self.outcome is Outcome.NOT_JUDGED and self.asked else PASSED


def headline(verdicts: Iterable[Verdict]) -> tuple[str, ...]:
    """Return the quantities that must be judged, by the regime of the reference in ``verdicts``.

    Without a verdict on the regime these are the regime and the quantities of a stick zone.
    """
    known = {verdict.quantity: verdict for verdict in verdicts}
    regime = known["regime"].reference if "regime" in known else None
    required = _OTHERS.get(str(regime), _STICK if regime else ("regime", *_STICK))
    further = (key for key in _WHERE_KNOWN if key in known and known[key].known and known[key].reason != NO_BAR)
    return (*required, *further)


def conclude(
    verdicts: Iterable[Verdict], conditions: Iterable[Verdict] = (), waived: Collection[str] = ()
) -> Conclusion:
    """Return the outcome of the ``verdicts`` on one comparison and of the ``conditions`` of its result.

    MISSED if any is missed; PASSED if every headline quantity was judged; otherwise NOT_JUDGED. Passed ``conditions``
    alone do not pass a result.

    Parameters
    ----------
    verdicts : iterable of Verdict
        One per quantity, with that on the regime.
    conditions : iterable of Verdict
        Checks of the result alone.
    waived : collection of str
        Headline quantities that need not be judged.
    """
    verdicts = tuple(verdicts)
    judged = {verdict.quantity for verdict in verdicts if verdict.outcome is not Outcome.NOT_JUDGED}
    asked = bool(judged) or any(verdict.bar is not None for verdict in verdicts)
    unjudged = tuple(key for key in headline(verdicts) if key not in judged and key not in waived) if asked else ()
    missed = tuple(verdict.text for verdict in (*verdicts, *conditions) if verdict.outcome is Outcome.MISSED)
    passed = asked and bool(judged) and not unjudged
    return Conclusion(_outcome(bool(missed), passed), missed, unjudged, asked)


def together(conclusions: Iterable[Conclusion]) -> Conclusion:
    """Return the outcome of several ``conclusions``: PASSED only if all with bars passed, and at least one had bars."""
    conclusions = tuple(conclusions)
    missed = tuple(text for each in conclusions for text in each.missed)
    unjudged = tuple(dict.fromkeys(key for each in conclusions for key in each.unjudged))
    asked = [each for each in conclusions if each.asked]
    passed = bool(asked) and all(each.outcome is Outcome.PASSED for each in asked)
    return Conclusion(_outcome(bool(missed), passed), missed, unjudged, bool(asked))


def of_run(compared: Mapping[str, Conclusion], missed: Iterable[str], hold: Mapping[str, bool]) -> Conclusion:
    """Return the outcome of a run of several methods.

    Parameters
    ----------
    compared : mapping of str to Conclusion
        Conclusions by method; none for the reference.
    missed : iterable of str
        What any method, the reference included, missed, as text.
    hold : mapping of str to bool
        By method, whether the result claims to hold. A closed form that says that it does not hold for the scene needs
        not pass; nor does it make a run pass.
    """
    asking = [each for name, each in compared.items() if hold[name]]
    whole, missed = together(asking or compared.values()), tuple(missed)
    passed = bool(asking) and whole.outcome is Outcome.PASSED
    return Conclusion(_outcome(bool(missed), passed), missed, whole.unjudged, whole.asked)


def missed_by(verdicts: Mapping[str, Iterable[Verdict]]) -> tuple[str, ...]:
    """Return missed ``verdicts``, by method, as text."""
    return tuple(
        f"{name}: {verdict.text}"
        for name, some in verdicts.items()
        for verdict in some
        if verdict.outcome is Outcome.MISSED
    )


def _outcome(missed: bool, passed: bool) -> Outcome:
    return Outcome.MISSED if missed else Outcome.PASSED if passed else Outcome.NOT_JUDGED
