"""Judge a method's own estimates of its errors: beside a reference, an estimate that is too small is missed."""

from collections.abc import Iterable, Iterator

from partialslip.result import Result
from partialslip.run.judge.verdict import NO_BAR, Bar, Outcome, Verdict, judged, plus_estimate
from partialslip.tools.bars import LEAST_SHEAR

# limit: Largest ratio of a true error to the method's own estimate of it.
MOST = 2.0
#: Prefix of the quantity of a verdict on an estimate.
ESTIMATE = "estimate of "
# Estimates do not include rounding: 1e-9 a, or 1e-9 of f p, as in the residuals of converged solvers. Errors of the
# shear are relative to its norm, or to a part of the norm of f p where the shear is smaller.
_ROUNDING = {"q": 1e-9 / LEAST_SHEAR, "q1": 1e-9 / LEAST_SHEAR, "q2": 1e-9 / LEAST_SHEAR}
_NOTHING = 0.01  # accuracy: of the bar: errors that matter to nobody need no estimate


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
