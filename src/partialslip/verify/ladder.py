"""Refinement ladders: observed order of convergence and grid convergence index (GCI), by quantity.

The ladder solves a scene by linear elements of one size along the contact, each size half the one before. The ends of
contact and stick zone move by whole elements from mesh to mesh, so that the order of a single triple of meshes scatters
widely. The order is therefore fitted to all changes of the ladder, and the index takes all changes into account: the
change to the finest mesh is the largest one that follows from any of them,

    change_i = C h_i^p,   change = max_i(change_i h^p / h_i^p)

with h the finest size and p the order that :mod:`partialslip.tools.convergence` takes. The formal order is 1: elements
of one size do not resolve the ends.
"""

import itertools
from collections.abc import Sequence

import msgspec
import numpy as np

from partialslip.result import Result
from partialslip.run import run
from partialslip.run.judge import compare
from partialslip.scene import Scene
from partialslip.tools.convergence import LOWEST, fitted_order, grid_convergence_index
from partialslip.verify.case import Case

SIZES = (0.16, 0.08, 0.04, 0.02, 0.01)  # accuracy: in contact half-widths
QUANTITIES = ("a", "m", "n", "p", "q")
_FORMAL = 1.0  # fixed: order


class Convergence(msgspec.Struct, frozen=True):
    """Convergence of one quantity over the ladder.

    Parameters
    ----------
    quantity : str
    changes : tuple of float
        Changes from each mesh to the next: a, m and n as fractions of a, p and q in relative L2 of cell averages.
    order : float
        Observed order; NaN as None if the changes vanish.
    gci : float
        Grid convergence index of the finest mesh, in the unit of the changes.
    error : float or None
        True error of the finest mesh, in the same unit; None if it is unknown.
    """

    quantity: str
    changes: tuple[float, ...]
    order: float | None
    gci: float
    error: float | None


def has_ladder(case: Case) -> bool:
    """Return whether ``case`` can be solved on a ladder of uniform meshes and compared with the exact solution."""
    scene = case.scene
    usual = case.reference == "exact" and not case.meshes and not scene.meshed and scene.fem.size is None
    return usual and "fem" in case.methods and scene.load.in_phase and not scene.sized


def climb(scene: Scene, exact: Result) -> tuple[Convergence, ...]:
    """Solve ``scene`` on all meshes of the ladder and return the convergence by quantity.

    ``exact`` is the exact result. Quantities that do not exist or are undetermined are left out.
    """
    results = [_fem_result(scene, size) for size in SIZES]
    changes = [compare(coarse, fine, scene, None).errors for coarse, fine in itertools.pairwise(results)]
    last = compare(results[-1], exact, scene, None).errors
    found = []
    for quantity in QUANTITIES:
        steps = [each.get(quantity) for each in changes]
        known = [step for step in steps if step is not None and np.isfinite(step)]
        if len(known) == len(steps):
            found.append(convergence(quantity, known, last.get(quantity)))
    return tuple(found)


def convergence(quantity: str, changes: Sequence[float], error: float | None) -> Convergence:
    """Return order and index for the ``changes`` from each mesh to the next, sizes halved each time.

    ``error`` is the true error of the finest mesh, if known.
    """
    steps = np.array(changes, float)
    sizes = 0.5 ** np.arange(len(steps))
    order = fitted_order(sizes.tolist(), steps.tolist())
    used = float(np.clip(LOWEST if order is None else order, LOWEST, _FORMAL))
    change = float((steps * (sizes[-1] / sizes) ** used).max())
    return Convergence(quantity, tuple(steps.tolist()), order, grid_convergence_index(change, 2, order, _FORMAL), error)


def _fem_result(scene: Scene, size: float) -> Result:
    return run(scene.replace(fem={"order": 1, "size": size}), ["fem"]).results["fem"]
