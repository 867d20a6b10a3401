"""Targets: values that two independent methods agree on, with their uncertainty."""

from collections.abc import Callable, Mapping

from msgspec.structs import replace

from partialslip.benchmark.measured import Quantity, quantities
from partialslip.benchmark.problem import Problem, Target
from partialslip.result import Result
from partialslip.run import run

_DIGITS = 1e-9  # uncertainty of closed forms, in the scale of the quantity
_ENDS = ("left_1", "right_1", "left_2", "right_2")
_NEAR = 1e-3  # another method that is farther off does not check the digits of a closed form
_EVEN = 1e-4  # of a: nearer to x = 0 the middle of a contact is there
_FINE, _COARSER = 1e-5, 8.0  # accuracy asked of march and fem, and factor of the second accuracy of one method


def ways(problem: Problem) -> tuple[tuple[str, float], ...]:
    """Methods, with their accuracies, that find the targets of ``problem``: the first gives the values, the others
    check them."""
    from partialslip.halfplane.method import has_closed_form, path_dependent

    scene = problem.scene
    if not scene.material.alike:
        return ("fem", _FINE), ("fem", _FINE * _COARSER)
    if scene.finite:
        return ("fem", _FINE), ("equivalent", _FINE)
    by_steps = ("march", _FINE), ("fem", _FINE)
    sticks = scene.friction.f > 0 and not scene.slides
    if not scene.load.in_phase or (sticks and (not has_closed_form(scene) or path_dependent(scene))):
        return by_steps
    return ("exact", _FINE), *by_steps


def frozen_parts(problem: Problem, progress: Callable[[str], None] = lambda _: None) -> tuple[dict[str, Target], str]:
    """Find the targets of ``problem``, and its regime.

    The uncertainty is that of a closed form, or the largest of the method's estimate and the differences between the
    methods.

    Parameters
    ----------
    problem : Problem
    progress : callable, optional
        Called with a line of text from time to time.
    """
    found: list[tuple[str, Result, Mapping[str, Quantity]]] = []
    for method, accuracy in ways(problem):
        progress(f"{problem.number}: {method}")
        result = run(problem.scene.replace(fem={"accuracy": accuracy}), method)[method]
        a = found[0][1].a if found else result.a
        found.append((method, result, quantities(problem.scene, result, problem.places, a)))
    (method, result, values), *checks = found
    found_targets = {
        key: _target(key, method, result, value, checks)
        for key, value in values.items()
        if any(key in others for *_, others in checks)  # known in two ways
    }
    if not _off_middle(values):  # a tells it all
        found_targets = {key: target for key, target in found_targets.items() if key not in _ENDS}
    scene = problem.scene
    tension = any(sigma or slope for _, sigma, slope in scene.load.along)
    if scene.even and not tension and {"m", "n"} <= found_targets.keys():
        # by symmetry m = n: a difference is an error
        apart = abs(found_targets["m"].value - found_targets["n"].value) / found_targets["m"].scale
        for key in "mn":
            found_targets[key] = replace(found_targets[key], uncertainty=max(apart, found_targets[key].uncertainty))
    return found_targets, result.regime


def _of_closed_form(checked: float) -> float:
    """Uncertainty of a closed form that the nearest other method finds within ``checked``: its digits, unless no other
    method comes near."""
    return _DIGITS if checked <= _NEAR else checked


def _off_middle(values: Mapping[str, Quantity]) -> bool:
    """Whether the middle of the contact is off x = 0 at a load point."""
    ends = [values[key] for key in _ENDS if key in values]
    return any(
        abs(left.value + right.value) > _EVEN * left.scale for left, right in zip(ends[::2], ends[1::2], strict=True)
    )


def _target(
    key: str,
    method: str,
    result: Result,
    quantity: Quantity,
    checks: list[tuple[str, Result, Mapping[str, Quantity]]],
) -> Target:
    apart = {
        f"{name}, accuracy {other.settings['accuracy']:.0e}" if name == method else name: abs(
            values[key].value - quantity.value
        )
        / quantity.scale
        for name, other, values in checks
        if key in values
    }
    said = [f"{name} within {max(off, 1e-16):.0e}" for name, off in apart.items()]
    exact = method == "exact"
    known = "closed form" if exact else f"{method}, estimate {result.estimate.get(quantity.estimate, float('nan')):.0e}"
    return Target(
        value=quantity.value,
        unit=quantity.unit,
        scale=quantity.scale,
        uncertainty=_of_closed_form(min(apart.values()))
        if exact
        else max([result.estimate.get(quantity.estimate, 0.0), *apart.values()]),
        known="; ".join([known, *said]),
        group=quantity.group,
    )
