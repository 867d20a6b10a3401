"""A run: one scene, one or more methods, every result compared with the exact one."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from partialslip.compare import Comparison, compare
from partialslip.errors import InputError
from partialslip.plan import Plan, plan
from partialslip.result import Result
from partialslip.scene import Scene

METHODS = ("exact", "march", "fem")
DEFAULT = ("exact", "fem")
Progress = Callable[[str], None]


@dataclass(frozen=True)
class Run:
    """A scene, its plan, the results by method, and the comparisons of all others with the exact one."""

    scene: Scene
    plan: Plan
    results: dict[str, Result]
    comparisons: dict[str, Comparison]

    @property
    def passed(self) -> bool:
        """Whether every comparison is within its bars."""
        return all(comparison.passed for comparison in self.comparisons.values())


def run(
    scene: Scene, methods: Iterable[str] = DEFAULT, *, subsurface: bool = False, progress: Progress = lambda _: None
) -> Run:
    """Solve ``scene`` by each of ``methods`` ("exact", "march", "fem") and compare.

    Parameters
    ----------
    scene : Scene
    methods : iterable of str
    subsurface : bool
        Whether to solve for the displacements inside the bodies, too (finite elements).
    progress : callable
        Called with a line of text now and then.

    Raises
    ------
    InputError
        If a method is unknown.
    MissingLibraryError
        If finite elements are asked for and gmsh, or a system library that it needs, is not there.
    """
    effects = plan(scene, subsurface=subsurface)
    results = {name: _method(name)(scene, effects, _told_by(name, progress)) for name in dict.fromkeys(methods)}
    comparisons = {
        name: compare(result, results["exact"], scene.friction.f, scene.fem.accuracy)
        for name, result in results.items()
        if name != "exact" and "exact" in results
    }
    return Run(scene, effects, results, comparisons)


def _told_by(name: str, progress: Progress) -> Progress:
    return lambda line: progress(f"{name}: {line}")


def _method(name: str) -> Callable[[Scene, Plan, Progress], Result]:
    """A method by its name, imported now: finite elements bring much along."""
    if name == "exact":
        from partialslip.halfplane.method import solve as solve_exactly

        return solve_exactly
    if name == "march":
        from partialslip.halfplane.marching import solve as solve_by_marching

        return solve_by_marching
    if name == "fem":
        from partialslip_fem.model import solve as solve_by_elements

        return solve_by_elements
    raise InputError(f"method {name!r}: must be one of {', '.join(METHODS)}")
