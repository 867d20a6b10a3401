"""Solving on finer and finer meshes: one driver for marching and finite elements.

A problem makes the meshes, solves on them, estimates the errors and says whether a finer mesh is of use.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import Generic, Protocol, TypeVar

from partialslip.result.cost import Clock
from partialslip.tools.bars import BARS


def worst(errors: Mapping[str, float]) -> float:
    """The largest of ``errors``, each divided by its bar relative to the bar of an end; 0 if there are none."""
    return max((error / BARS[key] for key, error in errors.items()), default=0.0)


class Pace:
    """CPU seconds of meshes one after the other, and whether the next one fits the allowance of a ``clock``.

    The next mesh is taken to grow as the last two did.
    """

    def __init__(self, clock: Clock) -> None:
        self._clock, self._left = clock, clock.remaining()
        self._took: list[float] = []

    def took(self) -> None:
        """Attribute the seconds since the last call to one mesh."""
        if self._clock.limited:
            left = self._clock.remaining()
            self._took.append(self._left - left)
            self._left = left

    def fits(self, times: float = 1.0) -> bool:
        """Return whether ``times`` the seconds of the next mesh are left; true without an allowance."""
        if not self._clock.limited:
            return True
        before, last = [self._took[-1], *self._took][-2:]
        growth = max(last / before, 1.0) if before > 0 else 1.0
        return times * growth * last <= self._left


class OnMesh(Protocol):
    """A solution on one mesh."""

    @property
    def unknowns(self) -> str:
        """Number of unknowns, in words."""

    @property
    def errors(self) -> Mapping[str, float]:
        """Estimated errors, of ends in a and of tractions relative; empty where they are not known."""


S = TypeVar("S", bound=OnMesh)


class Refinable(ABC, Generic[S]):
    """Problem that is solved on finer and finer meshes; ``clock`` counts the CPU seconds and may limit them."""

    clock: Clock
    meshes = 0  # made up to now

    @abstractmethod
    def refined(self, before: S | None) -> S:
        """Solve on the mesh that follows that of ``before``; estimate the errors if two solutions allow it."""

    @abstractmethod
    def finished(self, found: S) -> bool:
        """Whether ``found`` is accurate enough, or a finer mesh is of no use."""

    @abstractmethod
    def fits(self, pace: Pace, found: S) -> bool:
        """Whether the mesh after that of ``found`` fits the allowance, at the ``pace`` of those before."""

    def valid(self, found: S) -> bool:  # noqa: ARG002
        """Whether ``found`` can be the answer."""
        return True

    def checked(self, found: S) -> S:
        """The solution ``found`` on the last mesh, after what is checked on that mesh alone."""
        return found

    def estimated(self, found: S) -> S:
        """``found`` with its errors, whatever they cost."""
        return found


def refine(problem: Refinable[S], progress: Callable[[str], None]) -> S:
    """Solve ``problem`` on finer and finer meshes, until a finer one is of no use or does not fit the allowance of its
    clock. Errors are estimated once at least; of an allowance the solution with the smallest ones is the answer.
    ``progress`` is called with a line after each mesh."""
    pace = Pace(problem.clock)
    found = best = None
    while True:
        found = problem.refined(found)
        pace.took()
        known = f", {', '.join(found.errors)} known to {worst(found.errors):.1e} a" if found.errors else ""
        progress(f"mesh {problem.meshes}: {found.unknowns}{known}")
        if last := problem.finished(found):
            found = problem.checked(found)
        if not problem.valid(found):
            continue
        if last or not problem.fits(pace, found):
            return _better(best, found if best else problem.estimated(found)) or found
        if problem.clock.limited:
            best = _better(best, found)


def _better(one: S | None, other: S) -> S | None:
    """The one with the smaller estimate; None where neither has one."""
    known = [each for each in (one, other) if each and each.errors]
    return min(known, key=lambda each: worst(each.errors), default=None)
