"""The line on which contact forces act, and what is read from these: ends of contact and stick zone, and kinks.

A node bears the force int p phi dx, with its own function phi of x, and cells bear integrals of the traction. Cells of
constant traction are nodes of their own; on elements a cell has several nodes, and shares some.
"""

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from partialslip.friction.active_set import spread
from partialslip.friction.history import History
from partialslip.friction.pressing import Pressed
from partialslip.friction.zone_ends import (
    ROUNDED,
    VERTICES,
    StickInterval,
    contact_ends,
    kinks,
    read_stick_zone,
    within,
)
from partialslip.tools.arrays import Array, Indices

Ends = tuple[float, float]  # left and right

_ROUGH = 3  # accuracy: cells at each end of the contact in which tractions are not smooth
_SAMPLES = 32  # accuracy: points in each other cell, between which the force is nearly linear


def _alone(forces: Array) -> Array:
    """Forces on cells of which each has one node."""
    return forces


@dataclass(frozen=True)
class ContactLine:
    """Nodes and cells of the contact line.

    Parameters
    ----------
    x : (n,) array
        Nodes, ascending.
    weights : (n,) array
        Factors that turn tractions at the nodes into forces.
    vertices : (c + 1,) array
        Ends of the cells.
    beta : float
        Dundurs' constant, as for :func:`partialslip.friction.zone_ends.contact_ends`.
    cell_forces : callable
        ``cell_forces(forces)``: integrals (c,) over the cells of the traction with the nodal ``forces`` (n,). By
        default each node has its own cell.
    left_of : callable, optional
        ``left_of(forces, points)``: the integrals from the left end to ``points`` (k,).
    """

    x: Array
    weights: Array
    vertices: Array
    beta: float = 0.0
    cell_forces: Callable[[Array], Array] = _alone
    left_of: Callable[[Array, Array], Array] | None = None

    def on(self, nodes: Indices) -> "ContactLine":
        """Contact line on which the ``nodes`` (indices) alone carry forces."""
        whole, count = self.cell_forces, len(self.x)
        return replace(
            self,
            x=self.x[nodes],
            weights=self.weights[nodes],
            cell_forces=lambda forces: whole(spread(forces, nodes, count)),
        )

    def means(self, forces: Array) -> Array:
        """Means over the cells, (c,), of the traction with the nodal ``forces`` (n,), times the roots of the cells'
        widths: their norm is an L2 norm."""
        return self.cell_forces(forces) / np.sqrt(np.diff(self.vertices))

    def change(self, forces: Array, others: Array) -> float:
        """Relative L2 difference of the means over the cells of two nodal forces (n,)."""
        size = float(np.linalg.norm(self.means(forces)))
        return float(np.linalg.norm(self.means(forces - others))) / size if size > 0 else 0.0

    def ends(self, p: Array, q: Array | None = None, rise: float = ROUNDED, count: int = VERTICES) -> Ends:
        """Ends of the contact under nodal forces ``p`` and ``q`` (n,) along y and x; ``rise`` and ``count`` as for
        :func:`partialslip.friction.zone_ends.contact_ends`."""
        shear = self.cell_forces(q) if q is not None and self.beta else None
        return contact_ends(self.vertices, self.cell_forces(p), self.x[p > 0], shear, self.beta, rise, count)

    def ends_at_points(self, history: History) -> tuple[Ends, Ends]:
        """Ends of the contact at load points 1 and 2."""
        return self.ends(history.pressures[0], history.q1), self.ends(history.pressures[1], history.q2)

    def resultants(self, p: Array, q: Array) -> tuple[Array, tuple[Array, Array]]:
        """Points (k,) well inside the contact under nodal forces ``p`` and ``q`` (n,), and the forces along y and x on
        their left, (k,) each. Near the ends, where tractions are not smooth, there are none."""
        assert self.left_of
        touching = self.x[np.flatnonzero(p > 0)[[0, -1]]]
        first, last = np.searchsorted(self.vertices, touching, "right") - 1
        ends = self.vertices[first + _ROUGH : last + 2 - _ROUGH]
        points = (ends[:-1, None] + np.diff(ends)[:, None] * np.linspace(0, 1, _SAMPLES, endpoint=False)).ravel()
        return points, (self.left_of(p, points), self.left_of(q, points))

    def stick_zone(self, history: History, common: Ends | None = None, pressed: Pressed | None = None) -> StickInterval:
        """Stick zone of the ``history`` of the nodes, within the ends ``common`` to the contacts at both load points
        (default: as its forces tell).

        Bodies that were ``pressed`` together (:meth:`Pressed.on` the nodes) and bear no other load stick where they
        have stuck since they touched: where the growth of q is less than that of f p.
        """
        both = common or common_ends(self.ends_at_points(history))
        bound, change = history.bound, history.change
        alone = pressed if pressed and not history.path.moves else None
        if alone:
            p, q = alone.growth
            bound, change = alone.f * np.maximum(p, 0.0), 2 * q
        on = np.flatnonzero(history.bound > 0)
        here, line = history.of(on), self.on(on)
        known = here.lasting, here.unsteady, here.stuck
        found = read_stick_zone(line.x, bound[on], change[on], self.vertices, line.cell_forces, *known)
        found = alone.scaled(found, *both) if alone else found
        if history.path.presses_anew:
            return within(found, both, self.vertices)
        # on coarse cells the ends may lie outside the contact
        return replace(found, left=max(found.left, both[0]), right=min(found.right, both[1]))

    def kinks_at(self, q: Array, bound: Array) -> list[float]:
        """Points where tangential forces ``q`` leave their ``bound`` f p, (n,) each."""
        return kinks(self.x, bound, q, self.vertices, self.cell_forces)

    def kinks(self, history: History) -> list[float]:
        """Points where slip leaves a kink in q at a load point, those of the last cycle first."""
        found = itertools.chain.from_iterable(self.kinks_at(*state) for state in reversed(history.visited))
        return [*found, *history.turning(self.x)]


def common_ends(ends: Sequence[Ends]) -> Ends:
    """Ends of what all contacts with the ``ends`` have in common."""
    left, right = zip(*ends, strict=True)
    return max(left), min(right)


def passing(kinks: Sequence[float], stick: StickInterval | None, history: History | None) -> tuple[float, ...]:
    """``kinks`` of q at single load points that q1 and q2 do not have, kinks in the stick zone last: out of phase at
    constant pressure, q1 and q2 are -f p and f p beside the stick zone, and smooth."""
    if not stick or not history or history.path.in_phase or history.path.presses_anew:
        return ()
    return tuple(kink for kink in kinks if not stick.left < kink < stick.right)
