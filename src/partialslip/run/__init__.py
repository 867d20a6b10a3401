"""A run: solve one scene by one or more methods, and compare each result with the reference."""

import dataclasses
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from msgspec.structs import replace

from partialslip.result import Result
from partialslip.result.rig import Rig, key_of, load_rig
from partialslip.result.state import State
from partialslip.result.traction import sliding
from partialslip.run.judge import Comparison, Conclusion, Outcome, Verdict, compare, conditions, of_run
from partialslip.run.judge.reference import ALL_EFFECTS, estimated, reference, reference_among
from partialslip.run.judge.verdicts import missed_by
from partialslip.run.methods import SOLVERS, Means, Progress
from partialslip.run.tolerance import Propagation
from partialslip.scene import Effects, Scene
from partialslip.scene.plan import Plan, plan, reduced
from partialslip.scene.reading import AnyScene, as_scene
from partialslip.tools.allowance import Allowance
from partialslip.tools.bars import LARGEST, Accuracy, Asked, asked
from partialslip.tools.errors import InputError
from partialslip.tools.frame import frame
from partialslip.tools.shown import ByMethod, Drawn
from partialslip.tools.telling import told_to

if TYPE_CHECKING:
    from partialslip.halfplane.noise import Noise
    from partialslip.tools.frame import DataFrame
    from partialslip_fem import Kept

_ONE = "the contact slides at one of the load points: q at the other is not solved for"
_KEPT = 8  # cost: rigs kept in a process
_rigs: dict[str, Rig] = {}


@dataclass(frozen=True, repr=False)
class Run(ByMethod[Result], Drawn):
    """A solved scene with its comparisons: ``run["fem"]`` is ``run.results["fem"]``.

    Parameters
    ----------
    scene : Scene
    plan : Plan
    results : dict of str to Result
        Results by method; also "all effects" if effects of the scene were forced off.
    comparisons : dict of str to Comparison
        Comparisons with the reference, by method; none for the reference.
    asked : Asked or None
        The accuracy asked for (:class:`partialslip.tools.bars.Asked`); None if there are no bars.
    spacing : dict of str to float
        Errors of a, m and n (in a), p and q (relative L2) due to the spacing of a tabulated profile, which are no part
        of estimates, bars and verdicts (:func:`partialslip.halfplane.method.spacing_error`).
    tolerance : Propagation or None
        What the tolerances of the scene allow (:func:`partialslip.study.tolerance.with_tolerance`).
    """

    scene: Scene
    plan: Plan
    results: dict[str, Result]
    comparisons: dict[str, Comparison]
    asked: Asked | None = None
    spacing: Mapping[str, float] = field(default_factory=dict)
    tolerance: Propagation | None = None

    @property
    def _by_method(self) -> Mapping[str, Result]:
        return self.results

    def __repr__(self) -> str:
        """Scene and outcome, then a line for each result and each comparison."""
        results = [
            line
            for name, result in self.results.items()
            for line in (result, *([self.comparisons[name]] if name in self.comparisons else []))
        ]
        return "\n  ".join([f"Run of {self.scene.name}: {self.conclusion.text}", *map(repr, results)])

    @property
    def reference(self) -> str | None:
        """Name of the reference (:func:`partialslip.run.judge.reference.reference_among`); None without results."""
        return reference_among(self.scene, self.results)

    @property
    def answering(self) -> str:
        """Name of the method whose result answers: the reference of the scene if it is among the methods; of finite
        bodies fem, then equivalent half-planes; else the first. Of half-planes a result that claims to hold and tells
        its errors goes before one that does not."""
        best = reference(self.scene).method
        wanted = (best, "equivalent") if self.scene.sized else (best,)
        names = [name for name in (*wanted, *self.results) if name in self.results]
        if self.scene.sized:
            return names[0]
        telling = (name for name in names if name == best or not self.results[name].path_dependent)
        return next((name for name in telling if estimated(self.results[name], name)), names[0])

    @cached_property
    def noise(self) -> "Noise | None":
        """Scatter of a, m and n due to the noise of a measured profile (:func:`partialslip.halfplane.noise.noise_of`),
        which is no part of estimates, bars and verdicts. None without a measured profile, or if its file is gone.

        It takes about a CPU second, once, when it is first asked for."""
        from partialslip.halfplane.noise import noise_of  # takes long to import

        try:
            return noise_of(self.scene)
        except InputError:  # the file of the points
            return None

    @property
    def judged(self) -> bool:
        """Whether errors have bars."""
        return self.asked is not None

    @property
    def accuracy(self) -> float | None:
        """The bar for m and n, as a fraction of a; None if there are no bars."""
        return self.asked.stick if self.asked else None

    @property
    def conditions(self) -> dict[str, tuple[Verdict, ...]]:
        """Verdicts on each result alone, by method: finite numbers and small residuals."""
        return {name: conditions(result) for name, result in self.results.items()}

    @property
    def conclusion(self) -> Conclusion:
        """What the verdicts of all methods amount to (:func:`partialslip.run.judge.of_run`)."""
        compared = {name: comparison.conclusion for name, comparison in self.comparisons.items()}
        hold = {name: not result.path_dependent for name, result in self.results.items()}
        return of_run(compared, self.missed, hold)

    @property
    def outcome(self) -> Outcome:
        """Overall outcome: passed only if every headline quantity of every method that claims to hold was judged."""
        return self.conclusion.outcome

    @property
    def missed(self) -> tuple[str, ...]:
        """Missed bars and certificates as text."""
        compared = {name: comparison.verdicts for name, comparison in self.comparisons.items()}
        return missed_by({name: (*compared.get(name, ()), *own) for name, own in self.conditions.items()})

    @property
    def passed(self) -> bool:
        """Whether every headline quantity was judged and nothing is missed."""
        return self.outcome is Outcome.PASSED

    @property
    def columns(self) -> dict[str, npt.NDArray[Any]]:
        """Tractions of all methods as columns of one table, SI units; NaN for values that a method does not give."""
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
        """Return the table of ``tractions.csv`` in SI units: :meth:`Result.to_dataframe` of all methods, and a column
        ``method``.
        """
        return frame(self.columns)


def chosen_methods(scene: Scene, methods: object = None) -> tuple[str, ...]:
    """Return the names of ``methods``, one name or several, each once; by default :func:`default_methods`.

    Raises
    ------
    InputError
        If there is none, or one of them is unknown.
    """
    if methods is None:
        return default_methods(scene)
    named = [*methods] if isinstance(methods, Iterable) and not isinstance(methods, str) else [methods]
    if not named or not all(isinstance(each, str) and each in SOLVERS for each in named):
        shown = ", ".join(map(str, named)) or "none"
        raise InputError(f"methods = {shown:.60}: must be one or several of {', '.join(SOLVERS)}")
    return tuple(dict.fromkeys(map(str, named)))


def default_methods(scene: Scene) -> tuple[str, ...]:
    """Return the default methods for ``scene``: fem, and for half-planes the reference
    (:func:`partialslip.run.judge.reference.reference`); beside finite bodies half-planes; with a rig exact and
    equivalent."""
    from partialslip.halfplane.method import has_closed_form  # takes long to import

    if not scene.material.alike:
        return ("fem",)
    if scene.bodies.equivalent is not None:
        return ("exact", "equivalent")
    if any(body.width == "infinite" for _, body in scene.bodies):
        return tuple(dict.fromkeys((reference(scene).method, "march")))
    if scene.sized:
        return ("exact" if scene.load.in_phase and has_closed_form(reduced(scene)) else "march", "fem")
    return (reference(scene).method, "fem")


def run(
    scene: AnyScene,
    methods: str | Iterable[str] | None = None,
    *,
    subsurface: bool = False,
    stresses: bool = False,
    progress: Progress = lambda _: None,
    start: State | None = None,
    keep: "Kept | None" = None,
    allowance: Allowance | None = None,
) -> Run:
    """Solve ``scene`` by each of ``methods`` and compare the results.

    Parameters
    ----------
    scene : Scene, str or path
        A scene, the name of a shipped one, or the path of a scene file.
    methods : str or iterable of str, optional
        Of "exact", "march", "fem" and "equivalent", one or several; default: :func:`default_methods`.
    subsurface : bool
        Whether to compute fields inside the bodies: displacements (fem) and stresses.
    stresses : bool
        Whether a method that holds for the scene computes stresses along the surfaces, even if fields inside the bodies
        are not asked for: exact and march, and fem if neither of these knows them. None does if ``[effects]`` force
        subsurface off.
    progress : callable
        ``progress(line)``: called from time to time with a line of text.
    start : State, optional
        State at the start of the load path (:attr:`Result.state`, :func:`partialslip.load_state`); default: no shear.
    keep : partialslip_fem.Kept, optional
        Factored meshes shared between runs. With ``fem.size`` given, runs that differ only in shear, tension and
        friction factor once; without, they share the first mesh. Default: nothing is shared.
    allowance : Allowance, optional
        CPU seconds that the run may take. Finite elements then stop at the accuracy reached within the allowance,
        ``settings["accuracy"]`` of the result; the bars follow from the accuracy reached.

    Raises
    ------
    InputError
        If a method is unknown; P or the materials of ``start`` differ; the exact method is asked for loads out of
        phase or dissimilar bodies; or an effect is forced off that the scene cannot be solved without.
    MissingLibraryError
        If finite elements are asked for and gmsh, or a system library of gmsh, is missing.
    """
    scene = as_scene(scene)
    if start is not None:
        if not isinstance(start, State):
            raise InputError(f"start = {start!r:.60}: must be a State; partialslip.load_state reads one from a file")
        start.check(scene)
        if scene.load.displacement is not None:
            given = scene.load.shown("displacement", scene.units)
            raise InputError(f"load.displacement = {given}: must be left out with a start, whose plates are not known")
    effects = plan(scene, subsurface=subsurface, start=start is not None)
    chosen = chosen_methods(scene, methods)
    if scene.load.displacement is not None:
        if "fem" not in chosen:
            shown = ", ".join(chosen)
            raise InputError(f"methods = {shown}: must have fem among them, which finds Q from load.displacement")
        chosen = tuple(sorted(chosen, key=lambda name: name != "fem"))
    # cheap methods come first unless they need Q of fem: what they refuse is refused at once
    order = chosen if scene.load.displacement is not None else sorted(chosen, key=[*SOLVERS].index)
    what = reduced(scene)
    tasks = {name: (name, what, effects) for name in order}
    if effects.missing:
        whole = replace(scene, effects=Effects())
        tasks[ALL_EFFECTS] = reference(whole).method, whole, plan(whole, subsurface=subsurface, start=start is not None)
    results: dict[str, Result] = {}
    means = Means(rig_of, keep, allowance)
    for name, (method, what, its) in tasks.items():
        if stresses and _finds_stresses(what, method, results):
            its = its.with_stresses
        if method != "fem" and "fem" in results:
            what = _forced(what, results["fem"])
        with told_to(tell := _told_by(name, progress)):
            results[name] = _slid(what, SOLVERS[method](what, its, tell, start, means))
    results = {name: results[name] for name in (*chosen, *results)}
    if "fem" in results and (plates := results["fem"].plates):
        scene = plates.told(scene)
    for result in results.values():
        effects.accept(result.regime)
    # no bars for finite bodies but strips, for dissimilar bodies or for a fixed element size: there is no reference;
    # none for effects forced off: the error measures the effect
    judged = not scene.sized and scene.material.alike and scene.fem.size is None and not effects.missing
    reached = results["fem"].settings.get("accuracy") if allowance and "fem" in results else None
    accuracy = min(float(reached or scene.fem.accuracy), LARGEST)
    return compared(scene, effects, results, accuracy if judged else None)


def _finds_stresses(scene: Scene, method: str, before: Mapping[str, Result]) -> bool:
    """Return whether ``method`` is to find the stresses of ``scene``, after the results ``before``."""
    if scene.effects.subsurface is False:
        return False
    if scene.sized or not scene.material.alike:
        return method == "fem"
    return method in ("exact", "march") or not any(result.surface for result in before.values())


def _forced(scene: Scene, result: Result) -> Scene:
    """Return ``scene`` under the forces that its ``result`` found, for methods that know no plates."""
    if scene.load.displacement is None or not result.plates:
        return scene
    Q = result.plates.told(scene).load.Q_found
    return replace(scene, load=replace(scene.load, Q=Q, displacement=None, spring=None, Q_found=None))


def _slid(scene: Scene, result: Result) -> Result:
    """Return ``result`` with q = f p if the contact slides, which no method solves for; otherwise as it is.

    Dissimilar bodies are left out: there shear changes the pressure.
    """
    if result.regime != "sliding" or not scene.material.alike:
        return result
    if signs := scene.sliding_signs:
        return dataclasses.replace(result, traction=sliding(result.traction, scene.friction.at, signs))
    return dataclasses.replace(result, undetermined={**result.undetermined, **dict.fromkeys(("q", "q1", "q2"), _ONE)})


def solved_with_stresses(scene: AnyScene, method: str | None = None, progress: Progress = lambda _: None) -> Result:
    """Solve ``scene`` with the stresses in the bodies.

    By default the method is the reference (:func:`partialslip.run.judge.reference.reference`), and march where exact
    does not know q1 and q2: mean loads, for instance, under which the first cycles lock in what no closed form gives.

    Raises
    ------
    InputError
        As :func:`run`.
    """
    scene = as_scene(scene)
    chosen = method or reference(scene).method
    found = run(scene, chosen, subsurface=True, progress=progress)[chosen]
    if method is None and chosen == "exact" and not found.stress_at and not scene.slides:
        return run(scene, "march", subsurface=True, progress=progress)["march"]
    return found


def compared(scene: Scene, plan: Plan, results: dict[str, Result], accuracy: Accuracy | None) -> Run:
    """Compare ``results`` of ``scene``, by method, with the reference among them.

    Parameters
    ----------
    scene : Scene
    plan : Plan
    results : dict of str to Result
    accuracy : float, (float, float, float) or None
        Bar for a, m and n, as a fraction of a, or bars for contact, stick zone and tractions; None for no bars.

    Raises
    ------
    InputError
        If a number of ``accuracy`` is not above 0 and at most 0.1.
    """
    from partialslip.halfplane.method import spacing_error  # takes long to import

    chosen = reference_among(scene, results)
    comparisons = {
        name: compare(result, results[chosen], scene, accuracy)
        for name, result in results.items()
        if chosen and name != chosen
    }
    return Run(scene, plan, results, comparisons, asked(accuracy), spacing=spacing_error(scene))


def characterise(scene: AnyScene) -> Rig:
    """Find what the bodies of ``scene``, a scene, name or path, add to half-planes, its rig: by finite elements, of two
    equal strips by closed kernels.

    The rig depends on the bodies, their supports and materials, and on the profile only if a body is a pad. It is kept
    for further calls with the same bodies. :func:`partialslip.result.rig.write_rig` writes it to a file, which a scene
    may refer to.

    Raises
    ------
    InputError
        If no body is finite, or a mesh file cannot be read.
    """
    scene = as_scene(scene)
    key = key_of(scene)
    if key not in _rigs:
        while len(_rigs) >= _KEPT:
            _rigs.pop(next(iter(_rigs)))
        from partialslip.halfplane.layer import Layer  # takes long to import
        from partialslip.march.equivalent.strips import rig_of_strips

        if layer := Layer.of(scene):
            _rigs[key] = rig_of_strips(scene, layer)
        else:
            from partialslip_fem.characterise import characterise_bodies

            _rigs[key] = characterise_bodies(scene)
    return _rigs[key]


def rig_of(scene: Scene) -> Rig:
    """The rig of ``scene``: from the file ``bodies.equivalent`` if given, otherwise :func:`characterise`.

    Raises
    ------
    InputError
        If the file is not a rig, or is one of other bodies; and as :func:`characterise`.
    """
    path = scene.bodies.equivalent
    return characterise(scene) if path is None else load_rig(path, scene)


def _told_by(name: str, progress: Progress) -> Progress:
    return lambda line: progress(f"{name}: {line}")
