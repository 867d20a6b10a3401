"""A run: one scene, one or more methods, every result compared with the exact one."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from msgspec.structs import replace

from partialslip import views
from partialslip.allowance import Allowance
from partialslip.errors import InputError
from partialslip.frame import frame
from partialslip.gradual import may_turn_round
from partialslip.judge import Comparison, Outcome, Verdict, compare, conditions, overall
from partialslip.plan import Plan, plan, reduced
from partialslip.result import Result
from partialslip.scene import Effects, Scene
from partialslip.state import State

if TYPE_CHECKING:
    from partialslip.frame import DataFrame
    from partialslip_fem.level import Kept

METHODS = ("exact", "march", "fem")
ALL_EFFECTS = "all effects"
Progress = Callable[[str], None]


@dataclass(frozen=True)
class Run:
    """A ``scene``, its ``plan``, the ``results`` by method, and ``comparisons`` of all others with the reference: the
    exact one, or, where there is none, the march's, or else that of the finite elements; with :data:`ALL_EFFECTS` where
    some that matter have been forced off. ``accuracy`` is the bar for a, m and n, as a fraction of a; None if there are
    no bars."""

    scene: Scene
    plan: Plan
    results: dict[str, Result]
    comparisons: dict[str, Comparison]
    accuracy: float | None = None

    @property
    def reference(self) -> str | None:
        """The method that the others are compared with (:func:`reference_of`)."""
        return reference_of(self.results)

    @property
    def judged(self) -> bool:
        """Whether errors have bars."""
        return self.accuracy is not None

    @property
    def conditions(self) -> dict[str, tuple[Verdict, ...]]:
        """What each result must meet by itself: finite numbers and small residuals."""
        return {name: conditions(result) for name, result in self.results.items()}

    @property
    def outcome(self) -> Outcome:
        """Passed, missed or not judged, as a whole: a run without bars, or without a comparison, is not judged unless a
        result does not meet its own conditions."""
        verdicts = [verdict for comparison in self.comparisons.values() for verdict in comparison.verdicts]
        return overall(verdicts, [verdict for each in self.conditions.values() for verdict in each])

    @property
    def missed(self) -> tuple[str, ...]:
        """Bars and certificates that are missed, in words."""
        compared = {name: comparison.verdicts for name, comparison in self.comparisons.items()}
        return tuple(
            f"{name}: {verdict.text}"
            for name, own in self.conditions.items()
            for verdict in (*compared.get(name, ()), *own)
            if verdict.outcome is Outcome.MISSED
        )

    @property
    def passed(self) -> bool:
        """Whether something was judged and nothing is missed."""
        return self.outcome is Outcome.PASSED

    @property
    def columns(self) -> dict[str, npt.NDArray[Any]]:
        """Tractions of every method as columns of one table, SI units; NaN what a method does not determine."""
        tables = [result.columns for result in self.results.values()]
        keys = dict.fromkeys(key for table in tables for key in table)
        sizes = [len(result.traction.x) for result in self.results.values()]
        names = np.repeat(list(self.results), sizes)
        return {"method": names} | {
            key: np.concatenate(
                [
                    np.full(size, np.nan) if table.get(key) is None else table[key]
                    for table, size in zip(tables, sizes, strict=True)
                ]
            )
            for key in keys
        }

    def to_dataframe(self) -> "DataFrame":
        """:meth:`Result.to_dataframe` of every method, after a column with its name: the table of ``tractions.csv``.

        Raises
        ------
        MissingLibraryError
            If pandas is not installed.
        """
        return frame(self.columns)

    def plot(self, axes: "views.Axes | None" = None) -> "views.Axes":
        """Draw p/p0 and q/(f p0), q = (q2 - q1)/2, of every method over x/a on matplotlib ``axes``, as a rule new ones;
        returns them."""
        return views.plot(self, axes)

    def _repr_html_(self) -> str:
        return views.html(self)


def reference_of(results: Mapping[str, Result]) -> str | None:
    """The method that the others are compared with: the first of exact, march and fem that can judge. Where slip turns
    on the way between the load points the exact one cannot, if there is the march."""
    known = [name for name in (ALL_EFFECTS, *METHODS) if name in results]
    if known[:1] == ["exact"] and results["exact"].path_dependent and "march" in known:
        return "march"
    return next(iter(known), None)


def default_methods(scene: Scene) -> tuple[str, ...]:
    """Finite elements, and what they are compared with: the exact method, or march where Q and sigma are out of phase;
    both where slip turns round between the load points of half-planes; nothing where the bodies are of different
    materials."""
    if not scene.material.alike:
        return ("fem",)
    if not scene.load.in_phase:
        return ("march", "fem")
    if not scene.finite and may_turn_round(scene):
        from partialslip.halfplane.method import path_dependent

        if path_dependent(scene):
            return ("exact", "march", "fem")
    return ("exact", "fem")


def run(
    scene: Scene,
    methods: Iterable[str] | None = None,
    *,
    subsurface: bool = False,
    progress: Progress = lambda _: None,
    start: State | None = None,
    keep: "Kept | None" = None,
    allowance: Allowance | None = None,
) -> Run:
    """Solve ``scene`` by each of ``methods`` ("exact", "march", "fem") and compare.

    Parameters
    ----------
    scene : Scene
    methods : iterable of str, optional
        As a rule :func:`default_methods`.
    subsurface : bool
        Whether to solve for what is inside the bodies, too: displacements (finite elements), stresses (exact).
    progress : callable
        Called with a line of text now and then.
    start : State, optional
        What the path of the loads begins with (:attr:`Result.state`, :func:`partialslip.load_state`); otherwise bodies
        without shear.
    keep : partialslip_fem.Kept, optional
        Factored meshes that runs share: where ``fem.size`` is given, runs that differ only in loads and friction then
        factor once. As a rule nothing is kept from one run to the next.

    allowance : Allowance, optional
        CPU seconds that the run may take. Finite elements then settle for the accuracy that these suffice for:
        ``settings["accuracy"]`` of their result, which is the bar, too.

    Raises
    ------
    InputError
        If a method is unknown, ``start`` is of another P or other materials, the exact method is asked for loads
        out of phase or bodies that are not similar, or an effect is forced off that the scene cannot do without.
    MissingLibraryError
        If finite elements are asked for and gmsh, or a system library that it needs, is not there.
    """
    if start:
        start.check(scene)
    effects = plan(scene, subsurface=subsurface, start=start is not None)
    chosen = dict.fromkeys(default_methods(scene) if methods is None else methods)
    tasks = {name: (name, reduced(scene), effects) for name in chosen}
    if effects.missing:
        whole = replace(scene, effects=Effects())
        tasks[ALL_EFFECTS] = _best(whole), whole, plan(whole, subsurface=subsurface, start=start is not None)
    results = {
        name: _method(method, keep, allowance)(what, its, _told_by(name, progress), start)
        for name, (method, what, its) in tasks.items()
    }
    for result in results.values():
        effects.accept(result.regime)
    # half-planes are no truth for finite bodies, a mesh of a given element size is as good as it is, and of effects
    # that are forced off errors are what they are worth
    judged = not scene.finite and scene.fem.size is None and not effects.missing
    reached = results["fem"].settings.get("accuracy") if allowance and "fem" in results else None
    return compared(scene, effects, results, float(reached or scene.fem.accuracy) if judged else None)


def compared(scene: Scene, plan: Plan, results: dict[str, Result], accuracy: float | None) -> Run:
    """Results with their comparisons; ``accuracy`` is the bar for a, m and n (fractions of a), None for no bars."""
    outcome = Run(scene, plan, results, {}, accuracy)
    for name, result in results.items():
        if outcome.reference and name != outcome.reference:
            reference = results[outcome.reference]
            outcome.comparisons[name] = compare(result, reference, scene, accuracy)
    return outcome


def _best(scene: Scene) -> str:
    """The method that knows most of ``scene``: what is missing is measured by it."""
    return "fem" if scene.finite else default_methods(scene)[0]


def _told_by(name: str, progress: Progress) -> Progress:
    return lambda line: progress(f"{name}: {line}")


def _method(
    name: str, keep: "Kept | None", allowance: Allowance | None
) -> Callable[[Scene, Plan, Progress, State | None], Result]:
    """A method by its name, imported now: finite elements bring much along."""
    if name == "exact":
        from partialslip.halfplane.method import solve as solve_exactly

        return solve_exactly
    if name == "march":
        from partialslip.halfplane.marching import solve as solve_by_marching

        return partial(solve_by_marching, allowance=allowance)
    if name == "fem":
        from partialslip_fem.model import solve as solve_by_elements

        return partial(solve_by_elements, keep=keep, allowance=allowance)
    raise InputError(f"method {name!r}: must be one of {', '.join(METHODS)}")
