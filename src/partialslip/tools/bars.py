"""Bars: the largest allowed error by quantity, used by the judge and by the methods' error estimates."""

from collections.abc import Mapping
from typing import NamedTuple

from partialslip.tools.errors import InputError

_CONTACT = ("a", "left", "right", "left_1", "right_1", "left_2", "right_2")
_STICK = ("m", "n")
_PRESSURES = ("P", "P_1", "M", "M_1", "p", "p_1", "p_least")
_SHEARS = ("dQ", "q", "q1", "q2")

#: Bars by quantity, in multiples of the accuracy asked for: ends in a, tractions in relative L2. All other quantities
#: have no bar.
BARS = {
    **dict.fromkeys((*_CONTACT, *_STICK), 1.0),
    **dict.fromkeys(_PRESSURES, 10.0),
    **dict.fromkeys(_SHEARS, 15.0),
}

# limit: No bar is larger: a tenth of a, or of the norm. A traction whose error is larger is another traction.
LARGEST = 0.1

# fixed: Errors of q are relative to the larger of q's norm and LEAST_SHEAR times f p's norm.
LEAST_SHEAR = 1e-3

# limit: A converged solver leaves residuals at rounding level, which is 1e-9 f p0 on the finest meshes.
CERTIFICATE_BAR = 1e-7


class Asked(NamedTuple):
    """Accuracy asked for, by kind of quantity.

    Parameters
    ----------
    contact, stick : float
        Largest errors of the ends of the contact and of the stick zone, as fractions of a.
    tractions : float or None
        Largest relative errors of tractions and sums. With None the shares of :data:`BARS` of ``contact``.
    """

    contact: float
    stick: float
    tractions: float | None = None

    @property
    def bars(self) -> Mapping[str, float]:
        """Bars by quantity, none above :data:`LARGEST`."""
        found = {key: share * self.contact if self.tractions is None else self.tractions for key, share in BARS.items()}
        found |= dict.fromkeys(_CONTACT, self.contact) | dict.fromkeys(_STICK, self.stick)
        return {key: min(bar, LARGEST) for key, bar in found.items()}

    @property
    def text(self) -> str:
        """The bars in words."""
        bars = self.bars
        ends, stick, p, q = (share(bars[key]) for key in ("a", "m", "p", "q"))
        lengths = f"{ends} of a" if ends == stick else f"{ends} of a, m and n {stick}"
        return f"within {lengths}, " + (f"{p} of p and q" if p == q else f"{p} of p, {q} of q")


#: Accuracy as users give it: one number, or one each for contact, stick zone and tractions.
Accuracy = float | tuple[float, ...] | Asked


def asked(accuracy: Accuracy | None) -> Asked | None:
    """Return what is asked for as :class:`Asked`; None for None.

    Parameters
    ----------
    accuracy : float, (float, float, float), Asked or None
        One number, of which p has 10 and q 15 times; or one each for contact, stick zone and tractions.

    Raises
    ------
    InputError
        If a number is not above 0 and at most :data:`LARGEST`, or there are not one or three.
    """
    if accuracy is None:
        return None
    if isinstance(accuracy, Asked):
        return accuracy
    numbers = (accuracy,) if isinstance(accuracy, (int, float)) else tuple(accuracy)
    if len(numbers) not in (1, 3) or not all(0 < number <= LARGEST for number in numbers):
        given = ",".join(f"{number:g}" for number in numbers)
        raise InputError(
            f"bar {given}: must be one number, or three for contact, stick zone and tractions, > 0 and <= {LARGEST:g}"
        )
    return Asked(*numbers) if len(numbers) == 3 else Asked(numbers[0], numbers[0])


def share(bar: float) -> str:
    """Return a ``bar`` as text: in percent from 0.1 % on, else as a power of ten."""
    return f"{100 * bar:.3g} %" if bar >= 1e-3 else f"{bar:.1e}".replace(".0e", "e")
