"""Coulomb friction at constant pressure: a path of straight legs, each exact in time.

Where slip reverses on a leg, it is followed event by event
(:class:`partialslip.friction.path_following.Follower`). Where every node that slips at the end of the leg is pushed
that way from the beginning and still slips that way at the end, and no other node slips on the way, one step leads to
what gradual loading leads to: the conditions of the step are then those of gradual loading. This is decided by the
rates at both ends of the leg, and by the sides of the nodes on the way.

Scaled as in :mod:`partialslip.friction.history`.
"""

from dataclasses import replace
from functools import cached_property

import numpy as np

from partialslip.friction.active_set import Factored, Sides, Solution, solve_bounded
from partialslip.friction.coulomb_legs import Done, Legs
from partialslip.friction.history import History, resting
from partialslip.friction.load_path import Path
from partialslip.friction.path_following import Bounds, Follower, Leg, NothingSticksError, noise
from partialslip.tools.arrays import Array, Mask

_AT = 1e-12  # accuracy: distance from the bound, relative, at which a node is on it
_LEFT = 0.9, 0.5  # accuracy: of a leg: where slip on the way is looked at
_SLIGHT = 1e-6  # accuracy: of the longest path of slip: what mean loads let slip less in each cycle
# accuracy: of the bound: what forces may be off where a leg is taken for the mirror image of the one before
_MIRRORED = 1e-10
_EXPECTED = 8  # cost: cycles for which factors are prepared


def march(
    tangential: Array,
    stretch: Array,
    normal: Array,
    f: Array,
    path: Path,
    factored: Factored | None = None,
    near: Sides | None = None,
    few: int = 0,
) -> History:
    """Follow the path at constant pressure, leg by leg; every leg has a certificate.

    Parameters
    ----------
    tangential : (n, n) array
        Relative compliance C of the nodes in contact.
    stretch : (2, n) array
        Displacements of the lower surface along x under the tension that strains it by 1, and under the tension that
        strains it by x (:func:`partialslip.friction.load_path.stretched`).
    normal : (n,) array
        Normal forces.
    f : (n,) array
        Coefficient of friction.
    path : Path
        ``substeps`` are the stages of each leg that :attr:`History.around` has at least.
    factored : Factored, optional
        Factors of ``tangential`` to use and to add to.
    near : (n,) int8 array, optional
        Where the search for the sides after the first loading begins.
    few : int
        Nodes that may have the wrong sign where slip does not reverse: beside the ends of slip zones some have in
        finite elements of high order, whose compliance is not that of springs. One step is then taken all the same, if
        the loads are in phase. At the end of the leg these nodes are beside the ends of the contact; beside the stick
        zone a single one that has slipped shows that its end takes points back.
    """
    factored = factored or Factored(tangential)
    skip = (lambda _: None) if path.settled > 0 else None  # nothing else is kept
    if path.half:
        contact = _Contact(factored, stretch, normal, f, path, near, few)
        history = contact.followed(skip)
        if not contact.legs[0].leg:
            return history
        path = replace(path, half=False)
    return _Contact(factored, stretch, normal, f, path, near, few).followed(skip)


class _Contact(Legs):
    """Legs of a path at constant pressure; arguments as for :func:`march`."""

    def __init__(
        self,
        factored: Factored,
        stretch: Array,
        normal: Array,
        f: Array,
        path: Path,
        near: Sides | None,
        few: int,
    ) -> None:
        ways = [Bounds.constant(normal)] * (1 + len(path.cycle))
        super().__init__(factored.C, stretch, f, ways, path, few if path.in_phase else 0)
        self.factored, self._normal, self._bound, self._near = factored, normal, f * normal, near
        factored.expect(1 + self._cycle * (0 if path.half else min(path.cycles, _EXPECTED)))
        self._stretched = factored.refined(stretch.T)

    @cached_property
    def _follower(self) -> Follower:
        return Follower(self.factored.C, self.factored.inverse)

    def _leg(self, start: Array, load: Array, change: Array, pressed: Bounds, bounds: Bounds) -> Done:
        """Go along one leg: in one step, if that suffices."""

        def done(found: Solution, leg: Leg | None = None) -> Done:
            return Done(start, load, change, pressed, bounds, found, leg)

        if not change.any():
            return done(resting(start))
        if not self._followed:
            found = self._one_step(start, float(load[0]), change, self._starting_sides)
            if self._path.tension_stays or (
                self._suffices(start, change, found) and self._agrees(start, load, change, found)
            ):
                return done(found)
        start = np.clip(start, -self._bound, self._bound)
        if mirrored := self._mirrored(start, load, change):
            return mirrored
        try:
            return super()._leg(start, load, change, pressed, bounds)
        except NothingSticksError:  # so near to sliding that rounding lets no node stick: a step still has an answer
            return done(self._one_step(start, float(load[0]), change, None))

    @property
    def _followed(self) -> bool:
        """Whether the next leg is followed without a trial: slip that reversed a cycle before does so again."""
        return len(self.legs) > self._cycle and self.legs[-self._cycle].leg is not None

    @property
    def _starting_sides(self) -> Sides | None:
        """Where the search for the sides after the next leg begins: at those of the previous cycle, or at those after
        the leg before reversed."""
        if not self.legs:
            return self._near
        if len(self.legs) > self._cycle:
            return self.legs[-self._cycle].found.sides
        return -self.legs[-1].found.sides

    def _one_step(self, start: Array, Q: float, change: Array, near: Sides | None) -> Solution:
        factored, bound = self.factored, self._bound
        free = factored.times(start) + change[1:3] @ self._stretch
        all_free = None if self._stretched is None else start + self._stretched @ change[1:3]
        return solve_bounded(factored.C, free, -bound, bound, Q, near, factored, all_free)

    def _suffices(self, start: Array, change: Array, found: Solution) -> bool:
        """Whether the step from the forces ``start`` to those ``found`` leads to what gradual loading leads to."""
        sides, g, Q = found.sides, change[1:3] @ self._stretch, float(change[0])
        all_free = None if self._stretched is None else self._stretched @ change[1:3]
        factored, bound = self.factored, self._bound
        if not (sides == 0).any():
            return False

        def unclear(rate: Array, shift: float) -> Array:
            return np.maximum(noise(rate, g, shift, factored.diagonal), _AT * bound)

        # at the end: all nodes that have slipped slip on
        line = factored.line(sides == 0, g, 0 * g, all_free)
        shift = (Q - line.total) / line.slope
        rate, slip = line.at(shift)
        back = sides * slip > unclear(rate, shift) * factored.diagonal
        if self._clear(back):
            return False
        back &= np.abs(found.rest) > _SLIGHT * np.abs(found.rest).max()
        if back[self._few : len(back) - self._few].any():
            return False
        # at the beginning: these nodes, and no others, are pushed or slip that way
        on = np.where(np.abs(start) >= (1 - _AT) * bound, np.sign(start), 0)
        lower, upper = np.where(on < 0, 0.0, -np.inf), np.where(on > 0, 0.0, np.inf)
        first = solve_bounded(factored.C, g, lower, upper, Q, None, factored, all_free)
        unsure = unclear(first.x, 0.0)
        slips = np.where(np.abs(first.rest) > unsure * factored.diagonal, -np.sign(first.rest), 0)
        return not self._clear((slips * sides < np.abs(slips)) | (sides * first.x < -unsure))

    def _clear(self, wrong: Mask) -> bool:
        """Whether enough nodes (n,) are ``wrong``."""
        return int(np.count_nonzero(wrong)) > self._few

    def _agrees(self, start: Array, load: Array, change: Array, found: Solution) -> bool:
        """Whether nodes that slip on the way, in one step up to there, slip at the end of the step, and the same way.

        Slip that comes and goes shows at neither end of the leg. Half a cycle is solved only where there is none.
        """
        if self._path.half:
            return True
        sides = found.sides
        for left in _LEFT:
            before = self._one_step(start, float(load[0] - left * change[0]), (1 - left) * change, None).sides
            if self._clear(before * sides < np.abs(before)):
                return False
        return True

    def _mirrored(self, start: Array, load: Array, change: Array) -> Done | None:
        """The mirror image of the leg before, if this leg begins at minus the loads and the forces of that one, to
        rounding, and goes the other way; None if not."""
        before = self.legs[-1] if self.legs else None
        if before is None or before.leg is None or not self._path.settled:
            return None
        loads = np.abs(change[:3] + before.change[:3]), np.abs(load[:3] + before.load[:3])
        if any((off > _AT * np.abs(change[:3])).any() for off in loads):
            return None
        off = np.abs(start + before.start)
        if (off > min(self._path.settled, _MIRRORED) * self._bound).any():
            return None
        leg = before.leg.mirrored
        residual = before.found.residual + off
        found = replace(
            before.found, x=leg.forces, rest=leg.rest, residual=residual, iterations=0, changes=0, shift=leg.shift
        )
        return replace(before, start=start, load=load, change=change, found=found, leg=leg)

    def _completed(self, history: History) -> History:
        path, last = history.path, self.legs[-self._cycle :]
        if path.half:
            return replace(history, slipped=np.abs(np.array([history.slip, history.slip])))
        history, slipped = super()._completed(history), np.sum([each.slipped for each in last], axis=0)
        if not path.in_phase:
            # on the way, nodes of high order come to the bound before their neighbours do: the ends of legs alone count
            ends = [each for done in last for each in (done.start, done.found.x)]
            history = replace(history, q1=np.min(ends, axis=0), q2=np.max(ends, axis=0))
        return replace(
            history,
            dissipated=float(self._bound @ slipped.sum(axis=0)),  # of single steps, too
            around=history.around._replace(pressures=self._normal[None]),
            turns=path.in_phase and any(each.leg for each in last),
        )

    def _stages(self, done: Done) -> tuple[tuple[float, ...], Array, Array]:
        if done.leg:
            return super()._stages(done)
        count, Q = self._path.substeps, float(done.load[0] - done.change[0])
        shares = (np.arange(1, count + 1) / count).tolist()
        between = [
            self._one_step(done.start, Q + share * float(done.change[0]), share * done.change, None)
            for share in shares[:-1]
        ]
        states = [*between, done.found]
        return tuple(shares), np.array([each.x for each in states]), np.array([each.shift for each in states])
