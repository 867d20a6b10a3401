"""Bars and verdicts: a verdict is passed, missed or not judged, for one quantity, with a reason."""

import math
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import NamedTuple, Self, TypeVar

import numpy as np

from partialslip.bars import BARS, CERTIFICATE_BAR
from partialslip.result import Result

# Bars on traction errors, in multiples of the accuracy asked of a, m and n.
P_BAR, Q_BAR = BARS["p"], BARS["q"]

NAN, NO_BAR = "not a number", "no bar"

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


def judged(error: float, bar: float) -> Outcome:
    """Return PASSED if ``error`` <= ``bar``, MISSED otherwise and for NaN."""
    return Outcome.PASSED if error <= bar else Outcome.MISSED


def conditions(result: Result) -> tuple[Verdict, ...]:
    """Judge a ``result`` alone, without a reference.

    ``finite`` counts the numbers that are NaN or infinite, and must be 0. Each residual of the certificate must be at
    most :data:`partialslip.bars.CERTIFICATE_BAR`.
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
