"""Coulomb friction under a constant normal force, step by step through the load history."""

from collections.abc import Iterable

from partialslip.result import Array
from partialslip_fem.bounded import Solution, solve_bounded


def march(tangential: Array, x: Array, bound: Array, loads: Iterable[tuple[float, float]]) -> list[Solution]:
    """Nodal tangential forces after each load step.

    At constant pressure a step is a convex problem: where nothing slips, the relative displacement keeps what it
    was, so that C (T - T_before) follows the increment of the free relative displacement.

    Parameters
    ----------
    tangential : (n, n) array
        Relative compliance C of the nodes in contact.
    x : (n,) array
        Where they are.
    bound : (n,) array
        f times their normal forces.
    loads : iterable of (Q, strain)
        Tangential force and relative strain of the two surfaces due to bulk tension, at the end of each step.
    """
    steps: list[Solution] = []
    before, strain_before = 0 * x, 0.0
    for Q, strain in loads:
        free = tangential @ before + (strain - strain_before) * x
        steps.append(solve_bounded(tangential, free, -bound, bound, Q))
        before, strain_before = steps[-1].x, strain
    return steps
