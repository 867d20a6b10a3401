"""Verdicts of a file, judged anew from the numbers of the file: what it says of outcomes is not believed."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

from partialslip.result.record import ResultRecord
from partialslip.run.judge.verdict import NAN, Outcome, Verdict, judged, read_to
from partialslip.tools.bars import CERTIFICATE_BAR

# accuracy: Difference, in a, of an error from that of the lengths of the file. Below it the error of the file counts:
# errors of tiny stick zones are computed without cancellation.
_ROUNDING = 1e-9


def judged_again(verdict: Verdict, result: ResultRecord, reference: ResultRecord) -> Verdict:
    """Return the ``verdict`` on a ``result`` with values, error and outcome found anew.

    Errors of lengths and the regimes follow from both results. Norms and sums are integrals of tractions over cells,
    which a file does not have: their errors are those of the file, and only their outcome is found anew.
    """
    if verdict.quantity == "regime":
        return _regime(replace(verdict, reference=reference.regime, found=result.regime))
    own, true = _lengths(result), _lengths(reference)
    key = verdict.quantity if verdict.quantity in own else f"{verdict.quantity}_2"
    if key in own and reference.a and verdict.error is not None:
        error = _apart(key, result, reference)
        if error is not None and abs(error - verdict.error) > _ROUNDING * max(1.0, error):
            at, is_at = ((each or 0.0) / reference.a for each in (true[key], own[key]))
            verdict = replace(verdict, reference=at, found=is_at, error=error)
    return replace(verdict, outcome=_outcome(verdict, read_to(verdict.quantity, result)))


def conditions_again(result: ResultRecord, told: Iterable[Verdict] = ()) -> tuple[Verdict, ...]:
    """Return the verdicts on a ``result`` alone, as :func:`partialslip.run.judge.conditions`: finite numbers and small
    residuals. A number that was not finite is None in a file; those ``told`` in the file count, too, as the ends of a
    stick zone may also be None because there is none."""
    counted = (verdict.error for verdict in told if verdict.quantity == "finite")
    lost = max(sum(each is None for each in _numbers(result)), *(int(each or 0) for each in counted), 0)
    reason = f"NaN or infinite: {lost:,} of the result's numbers" if lost else ""
    finite = Verdict("finite", judged(lost, 0.0), error=float(lost), bar=0.0, reason=reason, scale="numbers")
    residuals = (
        Verdict(
            f"certificate {name}",
            Outcome.MISSED if residual is None else judged(residual, CERTIFICATE_BAR),
            error=residual,
            bar=CERTIFICATE_BAR,
            reason=NAN if residual is None else "",
            scale="f p0 or f P",
        )
        for name, residual in result.certificate.items()
    )
    return finite, *residuals


def _outcome(verdict: Verdict, unsure: float) -> Outcome:
    """Return the outcome that follows from error and bar, as :func:`partialslip.run.judge.verdict.decide` finds it."""
    if verdict.error is None:
        lost = verdict.reason == NAN or (verdict.reference is not None and verdict.bar is not None)
        return Outcome.MISSED if lost else Outcome.NOT_JUDGED
    return Outcome.NOT_JUDGED if verdict.bar is None else judged(verdict.error, verdict.bar, unsure)


def _regime(verdict: Verdict) -> Verdict:
    """Return the verdict on the regime. The reason why two regimes cannot be told apart, such as a zone that is too
    narrow, is taken from the file."""
    same, other = verdict.found == verdict.reference, f"{verdict.found}, not {verdict.reference}"
    if verdict.outcome is Outcome.NOT_JUDGED and verdict.reason not in ("", other):
        return verdict
    outcome, reason = (Outcome.PASSED, "") if same else (Outcome.MISSED, other)
    return replace(verdict, outcome=outcome, reason=reason)


def _lengths(result: ResultRecord) -> dict[str, float | None]:
    """Return a, m, n and the ends of the contact, m."""
    (left1, right1), (left2, right2) = result.contact_ends
    ends = {"left_1": left1, "right_1": right1, "left_2": left2, "right_2": right2}
    return {"a": result.a, "m": result.m, "n": result.n, **ends}


def _apart(key: str, result: ResultRecord, reference: ResultRecord) -> float | None:
    """Return the error of the length ``key``, in a of the reference; None if one of both has no such length."""
    own, true, a = _lengths(result)[key], _lengths(reference)[key], reference.a
    return None if own is None or true is None or not a else abs(own - true) / a


def _numbers(result: ResultRecord) -> Iterator[float | None]:
    """Yield the numbers of which none may be lost."""
    yield from (result.a, result.p0)
    yield from (end for ends in result.contact_ends for end in ends)
    for some in (result.certificate, result.estimate, result.limits):
        yield from some.values()
    if result.slip:
        yield from (*result.slip.x, *result.slip.slip, result.slip.dissipated)
    if result.traction:
        traction = result.traction
        for column in (traction.x, traction.p, traction.dq, traction.q1, traction.q2, traction.p1):
            yield from column or ()
