"""A run: one scene is solved by one or more methods, and every result is compared with the reference."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from msgspec.structs import replace

from partialslip.allowance import Allowance
from partialslip.errors import InputError
from partialslip.frame import frame
from partialslip.gradual import may_turn_round
from partialslip.judge import Comparison, Outcome, Verdict, compare, conditions, overall
from partialslip.judge.reference import ALL_EFFECTS, METHODS, reference_for, reference_of
from partialslip.plan import Plan, plan, reduced
from partialslip.result import Result
from partialslip.result.state import State
from partialslip.scene import Effects, Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from partialslip.frame import DataFrame
    from partialslip_fem import Kept

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Run:
    """A solved ``scene``.

    Parameters
    ----------
    scene : Scene
    plan : Plan
    results : dict of str to Result
        By method; also "all effects" where effects of the scene were forced off.
    comparisons : dict of str to Comparison
        By method: each result but the reference's, compared with the reference.
    accuracy : float or None
        The bar for a, m and n, as a fraction of a; None if there are no bars.
    """

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
        """Verdicts on each result by itself: its numbers are finite, and its residuals are small."""
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

    def plot(self, axes: "Axes | None" = None) -> "Axes":
        """Draw p/p0 and q/(f p0), q = (q2 - q1)/2, of every method over x/a on matplotlib ``axes``, as a rule new ones;
        returns them."""
        from partialslip.report.notebook import plot

        return plot(self, axes)

    def _repr_html_(self) -> str:
        from partialslip.report.notebook import html

        return html(self)


def default_methods(scene: Scene) -> tuple[str, ...]:
    """The methods that solve ``scene`` unless others are asked for: finite elements, and the reference of half-planes.
    Both exact and march where slip turns round between the load points of half-planes."""
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
        tasks[ALL_EFFECTS] = reference_for(whole), whole, plan(whole, subsurface=subsurface, start=start is not None)
    results = {
        name: _method(method, keep, allowance)(what, its, _told_by(name, progress), start)
        for name, (method, what, its) in tasks.items()
    }
    for result in results.values():
        effects.accept(result.regime)
    # no bars for finite bodies or for a fixed element size: there is no reference; nor for effects that are forced off:
    # their errors are the effects' worth
    judged = not scene.finite and scene.fem.size is None and not effects.missing
    reached = results["fem"].settings.get("accuracy") if allowance and "fem" in results else None
    return compared(scene, effects, results, float(reached or scene.fem.accuracy) if judged else None)


def compared(scene: Scene, plan: Plan, results: dict[str, Result], accuracy: float | None) -> Run:
    """Compare all ``results`` with the reference among them; ``accuracy`` is the bar for a, m and n (fractions of a),
    None for no bars."""
    reference = reference_of(results)
    comparisons = {
        name: compare(result, results[reference], scene, accuracy)
        for name, result in results.items()
        if reference and name != reference
    }
    return Run(scene, plan, results, comparisons, accuracy)


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
