"""The order in which a budget is spent on a ladder of settings: from cheap to dear, as far as this is predicted."""

import math
from collections.abc import Iterable, Sequence

import numpy as np

from partialslip.study.batch.job import Job
from partialslip.tools.groups import grouped

# cost: factor of a method's CPU seconds per digit of the accuracy, and per digit of the element size of uniform meshes,
# unless a series has shown a larger one: both 1.0 to 2.4 in the ladder of hertz-small-tension, where meshes for one
# accuracy often serve the next, too, before they grow
_GROWTH = {"exact": 1.0, "march": 2.0, "adapted": 2.0, "uniform": 2.5}

_ALIKE = 2.0  # cost: factor between CPU seconds that are alike: then each series has its turn
_FREE = 0.1  # cost: CPU seconds: less is nothing


class Spending:
    """The settings of a ladder that wait, and the CPU seconds of those that have run, which predict the others.

    Parameters
    ----------
    cases : iterable of Job
        Settings with a label ``series``, the cheapest of each series first.
    """

    def __init__(self, cases: Iterable[Job]) -> None:
        self._waiting = grouped((_series(case)[1], case) for case in cases)
        self._known: dict[tuple[str, str], list[tuple[float, float]]] = {}  # digits and seconds by kind and series
        self._beside: list[float] = []

    @property
    def waiting(self) -> list[Job]:
        """The settings that have not run, series by series."""
        return [case for series in self._waiting.values() for case in series]

    @property
    def least(self) -> float:
        """CPU seconds of the setting that is predicted to be the cheapest of those that wait; NaN if none waits."""
        return min((seconds for _, seconds in self._heads()), default=math.nan)

    def following(self, most: float) -> Job | None:
        """Return the setting to run next: of those that are predicted to take at most so many CPU seconds the cheapest;
        of those that are alike the one with the fewest of its series before it, then the coarsest. None if there is
        none."""

        def order(head: tuple[Job, float]) -> tuple[float, int, float]:
            case, seconds = head
            return math.floor(math.log(max(seconds, _FREE), _ALIKE)), len(self._ran(case)), _digits(case)

        return min((head for head in self._heads() if head[1] <= most), key=order, default=(None, 0.0))[0]

    def ran(self, case: Job, method_s: float, beside_s: float) -> None:
        """Take ``case`` off those that wait: it took CPU seconds of its method, and others beside it, such as the start
        of the process."""
        self._waiting[_series(case)[1]].remove(case)
        self._known.setdefault(_series(case), []).append((_digits(case), method_s))
        self._beside.append(beside_s)

    def _heads(self) -> list[tuple[Job, float]]:
        """The next setting of each series, and its predicted CPU seconds."""
        return [(series[0], self._predicted(series[0])) for series in self._waiting.values() if series]

    def _ran(self, case: Job) -> list[tuple[float, float]]:
        return self._known.get(_series(case), [])

    def _predicted(self, case: Job) -> float:
        """CPU seconds of ``case``: by its own series, else the median by those of its kind; without any, those that a
        setting takes beside its method."""
        kind, _ = _series(case)
        own = self._ran(case)
        alike = [own] if own else [each for (its, _), each in self._known.items() if its == kind]
        seconds = [_extrapolated(each, _digits(case), _GROWTH[kind]) for each in alike]
        return sum(float(np.median(each)) for each in (seconds, self._beside) if each)


def _extrapolated(known: Sequence[tuple[float, float]], digits: float, growth: float) -> float:
    """Seconds at so many ``digits``, from the last two of ``known`` digits and seconds; they grow by ``growth`` a digit
    at least."""
    *before, (last, seconds) = known
    rate = math.log(growth)
    for at, less in before[-1:]:
        rate = max(rate, math.log(seconds / less) / (last - at)) if less > 0 and last > at else rate
    return seconds * math.exp(rate * (digits - last)) if seconds > 0 else 0.0


def _series(case: Job) -> tuple[str, str]:
    """Kind and series of a setting."""
    method = case.methods[-1]
    meshes = "adapted" if case.scene.fem.size is None else "uniform"
    return meshes if method == "fem" else method, str(case.labels["series"])


def _digits(case: Job) -> float:
    """Digits of the accuracy, or of the element size in a; none of the exact method."""
    fem = case.scene.fem
    return 0.0 if case.methods[-1] == "exact" else -math.log10(fem.accuracy if fem.size is None else fem.size)
