"""An allowance of CPU seconds for a run. Methods stop at the accuracy reached within the allowance."""

import math
import time
import warnings
from collections.abc import Callable

from partialslip.tools.errors import InputError


class Allowance:
    """CPU seconds that may be spent from now on.

    Parameters
    ----------
    seconds : float
        CPU seconds of this process and of its meshing processes.
    spent : callable, optional
        ``spent() -> float``: CPU seconds of this process up to now.
    finest, overdraft : float, optional
        Deprecated, without effect.

    Raises
    ------
    InputError
        If ``seconds`` is NaN.
    """

    def __init__(
        self,
        seconds: float,
        spent: Callable[[], float] = time.process_time,
        finest: float | None = None,
        overdraft: float | None = None,
    ) -> None:
        if math.isnan(seconds):
            raise InputError(f"allowance of {seconds} s: must be a number of CPU seconds")
        if finest is not None or overdraft is not None:
            warnings.warn("Allowance: finest and overdraft have no effect any more", DeprecationWarning, stacklevel=2)
        self.seconds = seconds
        self._spent = spent
        self._began = spent()
        self._elsewhere = 0.0

    def remaining(self) -> float:
        """Return the CPU seconds left; negative if the allowance is exceeded."""
        return self.seconds - (self._spent() - self._began) - self._elsewhere

    def spend(self, seconds: float) -> None:
        """Add CPU ``seconds`` of another process to the seconds spent."""
        self._elsewhere += seconds
