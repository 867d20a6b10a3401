"""How the plates of two finite bodies move, from the forces between the bodies; scaled."""

import numpy as np
import scipy.linalg as la

from partialslip.arrays import Array, Indices, submatrix
from partialslip.friction.coupled_step import Relative
from partialslip.friction.history import History
from partialslip.result.plates import Plates


def plates_of(
    C: Relative, history: History | None, nodes: Indices, pressures: tuple[Array, Array], gaps: tuple[Array, Array]
) -> Plates | None:
    """Plates of two bodies with the relative compliances ``C``; None without friction.

    Parameters
    ----------
    C : Relative
    history : History or None
        Of the ``nodes`` of the contact line that are in contact.
    nodes : (k,) int array
    pressures, gaps : two of (n,) array
        Normal forces, and gap without them, at load points 1 and 2.
    """
    if not history:
        return None
    on_line = np.zeros((2, len(C.yy)))
    on_line[:, nodes] = history.at_ends
    approach = [_approach(C, *each) for each in zip(pressures, on_line, gaps, strict=True)]
    around = history.around
    moved, Q = around.shifts, around.forces.sum(axis=1)
    loop = np.column_stack([np.append(0.0, moved), np.append(Q[-1], Q)])
    return Plates(
        Q=on_line.sum(axis=1),
        at_points=np.array([float(each.x.sum()) for each in history.points[-len(history.path.cycle) :]]),
        displacement=np.array(history.shifts),
        approach=np.array(approach),
        compliance=_stuck(C, np.flatnonzero(pressures[1] > 0)),
        loop=loop,
    )


def _approach(C: Relative, p: Array, q: Array, gap: Array) -> float:
    """Approach of the plates under the forces ``p`` and ``q``, by which the ``gap`` closes: (n,) each."""
    on = p > 0
    opening = C.yy[on] @ p + gap[on]
    if C.xy is not None:
        opening = opening + C.opening[on] @ q
    return float(opening.mean())


def _stuck(C: Relative, on: Indices) -> Array:
    """Displacements (2, 2), along x and y, of plates under unit forces, of bodies that stick to each other at the nodes
    ``on``: C F - R u = 0 and R^T F = 1, with one column of R for each direction."""
    assert C.xx is not None
    count = len(on)
    across = np.zeros((count, count)) if C.xy is None else submatrix(C.xy, on, on)
    every = np.block([[submatrix(C.xx, on, on), across], [across.T, submatrix(C.yy, on, on)]])
    uniform = np.kron(np.eye(2), np.ones((count, 1)))
    stiffness = uniform.T @ la.solve(every, uniform, assume_a="pos")
    result: Array = np.linalg.inv(stiffness)
    return result
