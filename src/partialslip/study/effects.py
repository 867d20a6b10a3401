"""The ledger of effects: changes and costs of switching each effect on and off, by finite elements.

All runs have one element size along the contact, so that changes are not due to the mesh.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import msgspec
import numpy as np
from msgspec.structs import replace

from partialslip.report.page import Section
from partialslip.result import Regime, Result
from partialslip.result.record import JsonNumber, record_of
from partialslip.run.judge import cell_errors
from partialslip.scene import Scene
from partialslip.scene.plan import Effect, Plan, plan, reduced
from partialslip.tools.errors import InputError
from partialslip.tools.output.files import csv_text
from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__path__: list[str] = []  # for the names of its former modules (partialslip.tools.moved)

EFFECTS_SCHEMA = "partialslip/effects/1"
SIZE = 0.02  # accuracy: default element size, in contact half-widths
CHANGES = ("a", "m", "n", "q", "q2")
COSTS = {
    "cpu_s": "CPU s",
    "unknowns": "unknowns",
    "multipliers": "multipliers",
    "iterations": "iterations",
    "factorizations": "factored",
    "load_steps": "steps",
    "back_solves": "back-solves",
}
_REPEATS = 2  # cost: runs per setting; the one with the least CPU time counts
_LEAST = 1e-14  # display: smaller changes are drawn here
_MARKS = {"a": ("o", "white"), "m": ("<", "white"), "n": (">", "white"), "q": ("s", "black"), "q2": ("D", "0.7")}


@dataclass(frozen=True)
class SwitchedEffect:
    """One effect, on and off.

    Parameters
    ----------
    effect : str
    called_for : bool
        Whether the scene calls for the effect.
    why : str
        Why the effect is called for or left out.
    refused : str
        Why the effect cannot be switched; empty if it can.
    changes : dict of str to float or None
        Changes between on and off: a, m and n as fractions of a; q = (q2 - q1)/2 as relative L2 of cell averages; q2
        as relative L2. None without values to compare, for example without a stick zone.
    costs : dict of str to (float or None, float or None)
        Costs (on, off) by name; only one of the two if refused.
    """

    effect: Effect
    called_for: bool
    why: str
    refused: str
    changes: dict[str, float | None]
    costs: dict[str, tuple[float | None, float | None]]

    @property
    def worth(self) -> float | None:
        """The largest change of a, m, n and q."""
        known = [change_text for key in ("a", "m", "n", "q") if (change_text := self.changes.get(key)) is not None]
        return max(known, default=None)


@dataclass(frozen=True)
class EffectStudy:
    """The ledger of effects of one scene.

    Parameters
    ----------
    scene : Scene
        Scene as solved.
    plan : Plan
    result : Result
        Result with the effects of the plan.
    entries : tuple of Entry
    """

    scene: Scene
    plan: Plan
    result: Result
    entries: tuple[SwitchedEffect, ...]


class ResultSummary(msgspec.Struct, frozen=True):
    """Summary of a :class:`partialslip.Result`, with the result's names and units."""

    a: JsonNumber
    p0: JsonNumber
    regime: Regime
    m: JsonNumber
    n: JsonNumber
    counts: dict[str, int]
    certificate: dict[str, JsonNumber]


class EffectsRecord(msgspec.Struct, frozen=True):
    """Content of ``effects.json``, SI units: ``schema``, ``scene``, ``result``, and the entries in ``effects``."""

    schema: str
    scene: Scene
    result: ResultSummary
    effects: tuple[SwitchedEffect, ...]


def study_effects(scene: Scene, progress: Callable[[str], None] = lambda _: None) -> EffectStudy:
    """Solve ``scene`` with the effects of its plan, and once more with each effect switched.

    Each setting is meshed and solved twice; the run with less CPU time counts. ``progress`` is called with the name of
    each effect.

    Raises
    ------
    InputError
        If the scene cannot be solved.
    MissingLibraryError
        If gmsh, or a system library of gmsh, is missing.
    """
    scene = replace(scene, fem=replace(scene.fem, size=scene.fem.size or SIZE))
    own = plan(scene)
    _reduced_result(
        replace(scene, fem=replace(scene.fem, size=0.5))
    )  # warm-up: imports, and other costs of a first run
    progress("as planned")
    result = _measured(scene)
    entries = []
    for effect in {**own.called_for, **own.left_out}:
        progress(effect)
        entries.append(_entry(scene, own, result, effect))
    return EffectStudy(scene, own, result, tuple(entries))


def _entry(scene: Scene, own: Plan, result: Result, effect: Effect) -> SwitchedEffect:
    on = own.needs(effect)
    choices = msgspec.to_builtins(scene.effects) | {effect: not on}
    turned = replace(scene, effects=msgspec.convert(choices, type(scene.effects)))
    why = own.called_for[effect] if on else own.left_out[effect]
    try:
        other = _measured(turned)
    except InputError as refusal:
        alone: dict[str, tuple[float | None, float | None]] = {
            key: (cost, None) if on else (None, cost) for key, cost in _costs(result).items()
        }
        return SwitchedEffect(effect, on, why, str(refusal), {}, alone)
    with_it, without = (result, other) if on else (other, result)
    costs = {key: (cost, _costs(without)[key]) for key, cost in _costs(with_it).items()}
    return SwitchedEffect(effect, on, why, "", _changes(with_it, without, scene.friction.f), costs)


def _measured(scene: Scene) -> Result:
    """Solve a few times and return the result with the least CPU time."""
    return min((_reduced_result(scene) for _ in range(_REPEATS)), key=lambda result: result.cost.cpu_s)


def _reduced_result(scene: Scene) -> Result:
    from partialslip_fem import solve

    planned = plan(scene)
    result = solve(reduced(scene), planned)
    planned.accept(result.regime)
    return result


def _changes(on: Result, off: Result, f: float) -> dict[str, float | None]:
    changes: dict[str, float | None] = {"a": abs(off.a - on.a) / on.a}
    for key in ("m", "n"):
        here, there = getattr(on, key), getattr(off, key)
        changes[key] = None if here is None or there is None else abs(there - here) / on.a
    _, changes["q"] = cell_errors(off.traction, on.traction, f)
    changes["q2"] = _traction_change(on, off)
    return changes


def _traction_change(on: Result, off: Result) -> float | None:
    """Return the relative L2 difference of q at load point 2."""
    if on.traction.q2 is None or off.traction.q2 is None:
        return None
    x = on.traction.x
    other = np.interp(x, off.traction.x, off.traction.q2, 0.0, 0.0)
    norm = np.trapezoid(on.traction.q2**2, x)
    return float(np.sqrt(np.trapezoid((other - on.traction.q2) ** 2, x) / norm)) if norm > 0 else None


def _costs(result: Result) -> dict[str, float | None]:
    counts = result.counts
    own: dict[str, float | None] = {
        "cpu_s": result.cost.cpu_s,
        "unknowns": counts["dofs"],
        "multipliers": counts["normal_unknowns"] + counts["tangential_unknowns"],
    }
    return own | {key: counts[key] for key in COSTS if key in counts}


def changes_table(study: EffectStudy) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Return headings and rows of the changes by each effect of ``study``."""
    rows = [
        (entry.effect, "called for" if entry.called_for else "left out", *(change_text(entry, key) for key in CHANGES))
        for entry in study.entries
    ]
    return ("effect", "by the scene", *CHANGES), rows


def costs_table(study: EffectStudy) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Return headings and rows of the costs of ``study``: as planned, and with each effect switched."""
    rows = [("as planned", *map(_digits, _costs(study.result).values()))]
    for entry in study.entries:
        if not entry.refused:
            turned = [costs[entry.called_for] for costs in entry.costs.values()]
            rows.append((turned_over(entry), *map(_digits, turned)))
    return ("", *COSTS.values()), rows


def turned_over(entry: SwitchedEffect) -> str:
    """Return "without EFFECT" or "with EFFECT", for the run in which the effect of ``entry`` is switched."""
    return f"{'without' if entry.called_for else 'with'} {entry.effect}"


def change_text(entry: SwitchedEffect, key: str) -> str:
    """Return the change of ``key`` by the effect of ``entry`` as text; "-" without values to compare."""
    value = entry.changes.get(key)
    return "-" if value is None else "0" if value == 0 else f"{value:.1e}"


def _digits(cost: float | None) -> str:
    return "-" if cost is None else f"{cost:,}" if isinstance(cost, int) else f"{cost:.2f}"


def refusals(study: EffectStudy) -> list[str]:
    """Return why effects of ``study`` cannot be switched, as lines of text."""
    return [entry.refused for entry in study.entries if entry.refused]


def effects_heading(study: EffectStudy) -> str:
    """Return name, regime, a, m and n of the scene of ``study`` as one line."""
    result = study.result
    ends = ", ".join(
        f"{key} = {'none' if getattr(result, key) is None else f'{getattr(result, key) / result.a:.5f} a'}"
        for key in ("m", "n")
    )
    return f"{study.scene.name}: {result.regime}, a = {study.scene.units.text(result.a, 'm', 6)}, {ends}"


def effects_sections(study: EffectStudy, figure: str) -> list[Section]:
    """Return the sections of the report on ``study``, with the ``figure`` (SVG)."""
    changes, costs = changes_table(study), costs_table(study)
    why = [(entry.effect, entry.why) for entry in study.entries]
    return [
        Section(
            "Changes by each effect",
            [effects_heading(study), "Changes of a, m and n are fractions of a; changes of q and q2 are relative L2."],
            figure,
            "Left: change between on and off. Right: CPU seconds with and without each effect.",
            *changes,
            words=(1,),
        ),
        Section("Costs", refusals(study), "", "", *costs),
        Section("Why an effect is called for or left out", (), "", "", ("effect", "reason"), why, (1,)),
    ]


def effects_csv(study: EffectStudy) -> str:
    """Return the ledger of ``study`` as CSV, one row per effect; empty cells where there is no value."""
    costs = [f"{key}_{state}" for key in COSTS for state in ("on", "off")]
    rows = [
        [
            entry.effect,
            entry.called_for,
            *(entry.changes.get(key) for key in CHANGES),
            *(cost for key in COSTS for cost in entry.costs[key]),
            entry.why,
            entry.refused,
        ]
        for entry in study.entries
    ]
    return csv_text(["effect", "called_for", *(f"change_{key}" for key in CHANGES), *costs, "why", "refused"], rows)


def effects_record(study: EffectStudy) -> EffectsRecord:
    """Make the record of ``study``."""
    return EffectsRecord(EFFECTS_SCHEMA, study.scene, record_of(ResultSummary, study.result), study.entries)


def effects_svg(study: EffectStudy) -> str:
    """Return the figure of ``study`` as SVG: changes on the left, CPU seconds with and without each effect on the
    right."""

    def draw(figure: "Figure") -> None:
        changes, costs = figure.subplots(1, 2, sharey=True, width_ratios=(3, 2))
        names = [entry.effect + ("" if entry.called_for else " (off)") for entry in study.entries]
        changes.set_yticks(range(len(names)), names)
        changes.invert_yaxis()
        _draw_changes(changes, study)
        _draw_costs(costs, study)
        figure.suptitle(study.scene.name, x=0.01, ha="left", fontsize=10)
        for axes, columns in ((changes, 5), (costs, 3)):
            axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=columns, frameon=False, fontsize=9,
                        handletextpad=0.3, columnspacing=1.0)  # fmt: skip

    return svg(draw, (8.6, 4.6))


def _draw_changes(axes: "Axes", study: EffectStudy) -> None:
    for place, (key, (mark, fill)) in enumerate(_MARKS.items(), start=-2):
        found = [(row + 0.14 * place, entry.changes.get(key)) for row, entry in enumerate(study.entries)]
        known = [(max(value, _LEAST), row) for row, value in found if value is not None]
        axes.plot(*zip(*known, strict=True), mark, mfc=fill, mec="black", ms=5, ls="", label=key, clip_on=False)
    for row, entry in enumerate(study.entries):
        axes.axhline(row, color="0.9", lw=0.6, zorder=0)
        if entry.refused:
            axes.text(1e-7, row, "must be on" if entry.called_for else "cannot be on", ha="center", va="center",
                      fontsize=9, bbox={"facecolor": "white", "edgecolor": "none", "pad": 1})  # fmt: skip
    axes.axvspan(_LEAST, 1e-10, color="0.93", lw=0, zorder=-1)
    axes.set(xscale="log", xlim=(_LEAST, 10), xlabel="change between on and off (shaded: none)")


def _draw_costs(axes: "Axes", study: EffectStudy) -> None:
    for called_for, label, fill in ((True, "without it", "white"), (False, "with it", "0.6")):
        turned = {
            row: entry.costs["cpu_s"][called_for] or 0.0
            for row, entry in enumerate(study.entries)
            if entry.called_for is called_for and not entry.refused
        }
        axes.barh([*turned], [*turned.values()], 0.5, color=fill, edgecolor="black", lw=0.8, label=label)
    axes.axvline(study.result.cost.cpu_s, color="black", lw=1, ls="--", label="as planned")
    axes.set(xlabel="CPU s")
