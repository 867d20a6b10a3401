"""What a run may cost: CPU seconds, handed to the methods, which settle for the accuracy that these suffice for."""

import math
import time
from collections.abc import Callable

from partialslip.errors import InputError


class Allowance:
    """CPU seconds that may be spent from now on.

    Parameters
    ----------
    seconds : float
        Of this process, and of those that make meshes for it.
    spent : callable, optional
        ``spent() -> float``: the CPU seconds of this process up to now.

    Raises
    ------
    InputError
        If ``seconds`` is not a number.
    """

    def __init__(self, seconds: float, spent: Callable[[], float] = time.process_time) -> None:
        if math.isnan(seconds):
            raise InputError(f"allowance of {seconds} s: must be a number of CPU seconds")
        self.seconds = seconds
        self._spent = spent
        self._began = spent()
        self._elsewhere = 0.0

    def remaining(self) -> float:
        """CPU seconds that are left; negative if more have been spent."""
        return self.seconds - (self._spent() - self._began) - self._elsewhere

    def spend(self, seconds: float) -> None:
        """Count CPU ``seconds`` of another process."""
        self._elsewhere += seconds
