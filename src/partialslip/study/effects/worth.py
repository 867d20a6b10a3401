"""The ledger of effects: each of them on and off, what it changes and what it costs, by finite elements.

All on one element size along the contact, so that an effect is not mixed up with another mesh.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import replace

from partialslip.errors import InputError
from partialslip.judge import cell_errors
from partialslip.output.csv import csv_text
from partialslip.plan import Effect, Plan, plan, reduced
from partialslip.report.rows import engineering
from partialslip.result import Result
from partialslip.scene import Scene

SCHEMA = "partialslip/effects/1"
SIZE = 0.02  # of elements, in contact half-widths, where the scene gives none
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
_REPEATS = 2  # the best CPU time of


@dataclass(frozen=True)
class Entry:
    """An ``effect``, on and off.

    ``called_for`` says whether the scene calls for it, and ``why``. ``changes``, between on and off: of a, m and n in
    a, of q = (q2 - q1)/2 as relative L2 of cell averages, and of q2 as relative L2; None where there is nothing to
    compare, as without a stick zone. ``costs``: (on, off) by name; of what is ``refused`` (why it cannot be switched)
    only one of them is there.
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
        known = [change for key in ("a", "m", "n", "q") if (change := self.changes.get(key)) is not None]
        return max(known, default=None)


@dataclass(frozen=True)
class EffectStudy:
    """A ``scene``, as solved, its ``plan`` and ``result``, and the ledger of its effects, the ``entries``."""

    scene: Scene
    plan: Plan
    result: Result
    entries: tuple[Entry, ...]


def study_effects(scene: Scene, progress: Callable[[str], None] = lambda _: None) -> EffectStudy:
    """Solve ``scene`` as its plan says, and once more with each of the effects turned over.

    ``progress`` is called with the name of each effect. CPU times are the better of two, of meshes that are made anew.

    Raises
    ------
    InputError
        If the scene itself cannot be solved.
    MissingLibraryError
        If gmsh, or a system library that it needs, is not there.
    """
    scene = replace(scene, fem=replace(scene.fem, size=scene.fem.size or SIZE))
    own = plan(scene)
    _solve(replace(scene, fem=replace(scene.fem, size=0.5)))  # imports, and what else only the first one pays
    progress("as planned")
    result = _measured(scene)
    entries = []
    for effect in {**own.called_for, **own.left_out}:
        progress(effect)
        entries.append(_entry(scene, own, result, effect))
    return EffectStudy(scene, own, result, tuple(entries))


def _entry(scene: Scene, own: Plan, result: Result, effect: Effect) -> Entry:
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
        return Entry(effect, on, why, str(refusal), {}, alone)
    with_it, without = (result, other) if on else (other, result)
    costs = {key: (cost, _costs(without)[key]) for key, cost in _costs(with_it).items()}
    return Entry(effect, on, why, "", _changes(with_it, without), costs)


def _measured(scene: Scene) -> Result:
    """By the quickest of a few runs."""
    return min((_solve(scene) for _ in range(_REPEATS)), key=lambda result: result.cost.cpu_s)


def _solve(scene: Scene) -> Result:
    from partialslip_fem import solve

    its = plan(scene)
    result = solve(reduced(scene), its)
    its.accept(result.regime)
    return result


def _changes(on: Result, off: Result) -> dict[str, float | None]:
    changes: dict[str, float | None] = {"a": abs(off.a - on.a) / on.a}
    for key in ("m", "n"):
        here, there = getattr(on, key), getattr(off, key)
        changes[key] = None if here is None or there is None else abs(there - here) / on.a
    _, changes["q"] = cell_errors(off.traction, on.traction)
    changes["q2"] = _apart(on, off)
    return changes


def _apart(on: Result, off: Result) -> float | None:
    """Relative L2 difference of q at load point 2."""
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
    """Headings and rows: what each effect of ``study`` changes."""
    rows = [
        (entry.effect, "called for" if entry.called_for else "left out", *(change(entry, key) for key in CHANGES))
        for entry in study.entries
    ]
    return ("effect", "by the scene", *CHANGES), rows


def costs_table(study: EffectStudy) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Headings and rows: what the scene of ``study`` costs as planned, and with each effect turned over."""
    rows = [("as planned", *map(_digits, _costs(study.result).values()))]
    for entry in study.entries:
        if not entry.refused:
            turned = [costs[entry.called_for] for costs in entry.costs.values()]
            rows.append((turned_over(entry), *map(_digits, turned)))
    return ("", *COSTS.values()), rows


def turned_over(entry: Entry) -> str:
    """What is different where the effect of ``entry`` is not as the scene has it."""
    return f"{'without' if entry.called_for else 'with'} {entry.effect}"


def change(entry: Entry, key: str) -> str:
    """The change of ``key`` by the effect of ``entry`` in digits; "-" where there is nothing to compare."""
    value = entry.changes.get(key)
    return "-" if value is None else "0" if value == 0 else f"{value:.1e}"


def _digits(cost: float | None) -> str:
    return "-" if cost is None else f"{cost:,}" if isinstance(cost, int) else f"{cost:.2f}"


def notes(study: EffectStudy) -> list[str]:
    """What cannot be switched in ``study``, in lines of text."""
    return [entry.refused for entry in study.entries if entry.refused]


def heading(study: EffectStudy) -> str:
    """The scene of ``study``, and what it comes to with its own effects."""
    result = study.result
    ends = ", ".join(
        f"{key} = {'none' if getattr(result, key) is None else f'{getattr(result, key) / result.a:.5f} a'}"
        for key in ("m", "n")
    )
    return f"{study.scene.name}: {result.regime}, a = {engineering(result.a, 'm', 6)}, {ends}"


def effects_csv(study: EffectStudy) -> str:
    """The ledger of ``study``, one row an effect; fractions, CPU seconds and counts, empty where there is nothing."""
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


def effects_record(study: EffectStudy) -> dict[str, Any]:
    """The ledger of ``study`` as plain data."""
    result = study.result
    return {
        "schema": SCHEMA,
        "scene": msgspec.to_builtins(study.scene),
        "result": {key: getattr(result, key) for key in ("a", "p0", "regime", "m", "n")}
        | {"counts": dict(result.counts), "certificate": dict(result.certificate)},
        "effects": [msgspec.to_builtins(entry) for entry in study.entries],
    }
