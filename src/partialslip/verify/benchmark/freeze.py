"""Targets: values that two methods find, with their uncertainty. The methods share code (docs/howto/benchmark.md)."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from msgspec.structs import replace

from partialslip.result import Result
from partialslip.run import run
from partialslip.run.judge.measures import means, norm_errors
from partialslip.run.judge.reference import reference
from partialslip.scene import Hertz
from partialslip.tools.arrays import Array
from partialslip.verify.benchmark.curves import Curve, curve_of
from partialslip.verify.benchmark.measured import Quantity, quantities
from partialslip.verify.benchmark.problem import Problem, Target
from partialslip.verify.benchmark.turning import event_by_event, slip_reverses

_DIGITS = 1e-9  # accuracy: uncertainty of exact solutions, in the scale of the quantity
_FOLLOWED = 1e-6  # accuracy: uncertainty where slip reverses, unless the second way is farther off
_ENDS = ("left_1", "right_1", "left_2", "right_2")
_GRADUAL = "quadratures and an integral equation along the gradual path"
_NEAR = 1e-3  # limit: another method that is farther off does not check the digits of an exact solution
_EVEN = 1e-4  # accuracy: of a: nearer to each other places are one
_FINE = 1e-5  # accuracy: asked of march and fem; a hundredth of fem of finite bodies, which exact does not solve
_CONSISTENT = 3.0  # limit: difference from a rough method, in its own estimate, that confirms a value
_STEPS = (16, 64, 256)  # accuracy: load steps from which slip is extrapolated, where it is of first order in them
_PIECES = 31  # accuracy: points of a tabulated parabola


@dataclass(frozen=True)
class Derivation:
    """A way to the targets: a ``method`` with ``changes`` of the scene, in ``words``. A ``rough`` way confirms values
    to its own estimate of its error only, and does not say how sure they are."""

    method: str
    words: str
    changes: Mapping[str, Any] = field(default_factory=dict)
    rough: bool = False


Quantities = Mapping[str, Quantity]


def derivations(problem: Problem) -> tuple[Derivation, ...]:
    """Ways that find the targets of ``problem``: the first gives the values, the others check them."""
    scene = problem.scene
    march = Derivation("march", "march", {"fem.accuracy": _FINE})
    fem = Derivation("fem", "fem", {"fem.accuracy": _FINE})
    if scene.sized:
        # p changes on the way: slip in one step takes more work, 6e-4 in PS-24
        fine = {"fem.accuracy": _FINE / 100, "load.steps": _STEPS[0]}
        return (
            Derivation("fem", "fem", fine),
            Derivation("fem", "fem on meshes that do not match", fine | {"fem.lower_size": 0.8}),
            Derivation("equivalent", "equivalent half-planes", {"fem.accuracy": _FINE}, rough=True),
        )
    if not scene.material.alike:
        if not any(scene.load.Q):
            return march, fem
        x = np.linspace(0, 3 * problem.targets["a"].value if problem.targets else 6e-4, _PIECES)
        assert isinstance(scene.profile, Hertz)
        table = {"kind": "tabulated", "x": x.tolist(), "gap": (x**2 / (2 * scene.profile.R)).tolist()}
        stepped = {"profile": table, "load.steps": 64, "fem.accuracy": 2e-3}
        return (
            march,
            Derivation("march", "march, pressed in 128 steps", stepped),
            Derivation("fem", "fem", {"fem.accuracy": 1e-4}, rough=True),
        )
    if reference(scene).method != "exact":
        return fem, march
    return Derivation("exact", _GRADUAL if slip_reverses(scene) else "exact solution"), march, fem


def frozen_parts(problem: Problem, progress: Callable[[str], None] = lambda _: None) -> tuple[dict[str, Target], str]:
    """Find the targets of ``problem``, and its regime.

    The uncertainty is that of an exact solution; where slip reverses, the difference from the nearest other method;
    or the largest of the method's estimate and the differences between the methods.

    Parameters
    ----------
    problem : Problem
    progress : callable, optional
        Called with a line of text from time to time.
    """
    first, *others = derivations(problem)
    progress(f"{problem.number}: {first.words}")
    result = _derived_result(problem, first)
    values = quantities(problem.scene, result, problem.places)
    checks: list[tuple[Derivation, Result, Quantities]] = []
    for way in others:
        progress(f"{problem.number}: {way.words}")
        other = _derived_result(problem, way)
        checks.append((way, other, quantities(problem.scene, other, problem.places, result.a)))
    if first.method == "exact" and problem.scene.presses_anew and "slip" in values:
        extrapolated = Derivation("fem", "fem, extrapolated from 16, 64 and 256 load steps")
        progress(f"{problem.number}: {extrapolated.words}")
        checks.append((extrapolated, result, _slip_and_energy(problem, result.a)))
    if first.words == _GRADUAL:
        followed = Derivation("events", "boundary elements, event by event,")
        progress(f"{problem.number}: {followed.words}")
        found = event_by_event(problem.scene, problem.places)
        checks.append((followed, result, {key: values[key]._replace(value=value) for key, value in found.items()}))
    targets = {
        key: _target(problem, key, first, result, value, checks)
        for key, value in values.items()
        if any(key in found for *_, found in checks)  # known in two ways
    }
    if not _has_ends(values):  # a tells it all
        targets = {key: target for key, target in targets.items() if key not in _ENDS}
    scene = problem.scene
    tension = any(sigma or slope for _, sigma, slope in scene.load.along)
    symmetric = scene.even and not tension and (scene.material.alike or not any(scene.load.Q))
    if symmetric and {"m", "n"} <= targets.keys():
        # m = n: a difference is an error. The first loading of dissimilar bodies leaves a trace of its direction
        apart = abs(targets["m"].value - targets["n"].value) / targets["m"].scale
        for key in "mn":
            targets[key] = replace(targets[key], uncertainty=max(apart, targets[key].uncertainty))
    return targets, result.regime


def frozen_curve(problem: Problem) -> Curve:
    """Tractions of ``problem`` as a curve, by which norms of errors are measured: exact, or by finite elements that are
    far nearer than the best grade that the targets allow."""
    way, scene = derivations(problem)[0], problem.scene
    method, accuracy = "exact" if way.method == "exact" else "fem", _FINE if scene.material.alike else 10 * _FINE
    found = run(scene.replace({**way.changes, "fem.accuracy": accuracy}), method)[method]
    curve, off = curve_of(found, scene.profile.curvature.breaks), [0.0]
    for key, target in problem.targets.items():
        name, _, place = key.partition("@")
        if place and name in ("p", "dq"):
            value = getattr(curve.at(np.array([float(place) * problem.targets["a"].value])), name)[0]
            off.append(abs(float(value) - target.value) / target.scale)
    # the series itself, where shear is steep beside the contact's ends
    keys = ("p", "q") if np.any(found.traction.dq) else ("p",)
    off += norm_errors(found.traction, curve.traction, scene.friction.f, keys).values()
    return replace(curve, error=float(f"{1.05 * max(off):.1e}"))  # not rounded down


def covering(target: Target, words: str, off: float, unsure: float) -> Target:
    """``target`` whose uncertainty covers what another way, called ``words``, finds: it is ``off`` from the target, and
    ``unsure`` itself, both in the scale of the target."""
    reached = max(target.uncertainty, abs(off) + unsure)
    return replace(target, uncertainty=reached, known=f"{target.known}; {words} within {abs(off):.0e}")


def _derived_result(problem: Problem, way: Derivation) -> Result:
    return run(problem.scene.replace(way.changes), way.method)[way.method]


def _slip_and_energy(problem: Problem, a: float) -> dict[str, Quantity]:
    """Slip and dissipated energy of finite elements: slip extrapolated from runs with more and more load steps."""
    found = []
    for steps in _STEPS:
        changes = {"fem.size": 0.01, "fem.order": 2, "load.steps": steps}
        found.append(
            quantities(problem.scene, _derived_result(problem, Derivation("fem", "", changes)), problem.places, a)
        )
    first, second, last = (each["slip"].value for each in found)
    ratio = (first - second) / (second - last)
    value = last - (second - last) / (ratio - 1) if ratio > 1 else last
    return {"slip": found[-1]["slip"]._replace(value=value), "dissipated": found[-1]["dissipated"]}


def _of_exact(checked: float, turns: bool) -> float:
    """Uncertainty of an exact value that the nearest other method finds within ``checked``. Of one step's: its
    digits, unless no other method comes near. Where slip ``turns`` round there is none, and it is ``checked``."""
    if turns:
        return max(checked, _FOLLOWED)
    return _DIGITS if checked <= _NEAR else checked


def _has_ends(values: Quantities) -> bool:
    """Whether the ends of the contact say more than its half-width: the middle is off x = 0, or the contact is not the
    same at both load points."""
    if not all(key in values for key in _ENDS):
        return False
    left1, right1, left2, right2 = (values[key].value for key in _ENDS)
    apart = max(abs(left1 + right1), abs(left2 + right2), abs(left1 - left2), abs(right1 - right2))
    return apart > _EVEN * values["a"].scale


def _target(
    problem: Problem,
    key: str,
    way: Derivation,
    result: Result,
    quantity: Quantity,
    checks: list[tuple[Derivation, Result, Quantities]],
) -> Target:
    exact = way.method == "exact"
    said, counted = [], []
    for other, its, values in checks:
        if key not in values:
            continue
        # shear of the march of alike bodies is constant on cells, and is compared with the mean over the cell
        on_cells = other.method == "march" and problem.scene.material.alike
        value = (_mean(key, result, its) if on_cells else None) or quantity.value
        off = abs(values[key].value - value) / quantity.scale
        told = f"{other.words} within {max(off, 1e-16):.0e}"
        own = values[key].error
        if other.rough and off <= _CONSISTENT * own:
            said.append(f"{told}, its own error {own:.0e}")
        else:
            said.append(told)
            counted.append(off)
    own = quantity.error
    known = way.words if exact else way.words + ("" if math.isnan(own) else f", estimate {own:.0e}")
    return Target(
        value=quantity.value,
        unit=quantity.unit,
        scale=quantity.scale,
        uncertainty=_of_exact(min(counted), way.words == _GRADUAL)
        if exact
        else max([0.0 if math.isnan(own) else own, *counted, _DIGITS]),
        known="; ".join([known, *said]),
        group=quantity.group,
    )


def _mean(key: str, result: Result, other: Result) -> float | None:
    """Mean of a shear traction of ``result`` over the cell of the ``other`` result at the place of the ``key``; None if
    the key is none of a shear traction."""
    name, _, place = key.partition("@")
    of, cells = result.traction, other.traction.cells
    if name not in ("dq", "q1", "q2") or cells is None:
        return None
    first = int(np.clip(np.searchsorted(cells, float(place) * result.a) - 1, 0, len(cells) - 2))

    def values(x: Array) -> Array:
        return getattr(of.at(x), name)

    return float(means(values, cells[first : first + 2], of.breaks)[0])
