"""What a code hands over."""

from typing import NamedTuple

from partialslip.result import Result


class CodeOutcome(NamedTuple):
    """Outcome of a code.

    Parameters
    ----------
    result : Result or None
        None if the code did not finish.
    why : str
        Why it did not.
    unknowns : int or None
    cpu_s : float or None
        CPU seconds of the processes.
    memory_mb : float or None
        Peak memory.
    """

    result: Result | None
    why: str = ""
    unknowns: int | None = None
    cpu_s: float | None = None
    memory_mb: float | None = None
