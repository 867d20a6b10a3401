"""Coulomb friction at constant pressure: a path of straight legs, each exact in time.

Where slip turns round on a leg, it is followed event by event
(:class:`partialslip.friction.path_following.Follower`). Where every node that slips at the end of the leg is pushed
that way from the beginning and still slips that way at the end, and no other node slips on the way, one step leads to
what gradual loading leads to: the conditions of the step are then those of gradual loading. This is decided by the
rates at both ends of the leg, and by the sides of the nodes on the way.

Scaled as in :mod:`partialslip.friction.history`.
"""

from dataclasses import dataclass, replace

import numpy as np

from partialslip.friction.active_set import Factored, Sides, Solution, solve_bounded
from partialslip.friction.history import History, Steps, follow, resting, still
from partialslip.friction.load_path import Missed, Path
from partialslip.friction.path_following import Bounds, Follower, Leg, NothingSticksError, joined, noise
from partialslip.scene.model import require_carried
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
        Nodes that may have the wrong sign where slip does not turn round: beside the ends of slip zones some have in
        finite elements of high order, whose compliance is not that of springs. One step is then taken all the same, if
        the loads are in phase. At the end of the leg these nodes are beside the ends of the contact; beside the stick
        zone a single one that has slipped shows that its end takes points back.
    """
    factored = factored or Factored(tangential)
    require_carried([load[0] for load in path.cycle], float((f * normal).sum()))
    path = replace(path, ways=((1.0,),) * (1 + len(path.cycle)), missed=Missed(0.0, 0.0))
    if path.half:
        contact = _Contact(factored, stretch, normal, f, path, near, few)
        history = contact.followed()
        if not contact.legs[0].turns:
            return history
        path = replace(path, half=False)
    return _Contact(factored, stretch, normal, f, path, near, few).followed()


@dataclass(frozen=True)
class _Done:
    """A leg from ``load`` on with the ``change`` of the loads: ``leg``, what is known of it, or None if it was taken in
    one step, the ``start`` and ``found`` forces."""

    start: Array
    load: Array
    change: Array
    found: Solution
    leg: Leg | None = None

    @property
    def turns(self) -> bool:
        """Whether one step would not have sufficed."""
        return self.leg is not None

    @property
    def slipped(self) -> Array:
        """Slip along +x and along -x, (2, n)."""
        if self.leg:
            return self.leg.slipped
        return np.array([-self.found.rest, self.found.rest]).clip(0)

    @property
    def range(self) -> tuple[Array, Array]:
        """Smaller and larger forces at the ends of the leg, (n,) each.

        On the way, nodes of high order come to the bound before their neighbours do; the range would count them in.
        """
        return np.minimum(self.start, self.found.x), np.maximum(self.start, self.found.x)

    @property
    def changed(self) -> Array | None:
        """As of :meth:`Leg.changed`; None if the leg was taken in one step."""
        return self.leg.changed(self.leg.path > _SLIGHT * self.leg.path.max()) if self.leg else None

    @property
    def stuck(self) -> Array | None:
        """Share of the leg at which each node last stuck again, (n,); nan where it never did."""
        return self.leg.stuck if self.leg else None


class _Contact:
    """Legs of a path in turn; arguments as for :func:`march`."""

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
        self._f, self._normal, self._bound = f, normal, f * normal
        self._few = few if path.in_phase else 0
        self.factored, self._stretch, self._path, self._near = factored, stretch, path, near
        self.legs: list[_Done] = []
        self._cycle = len(path.cycle)
        factored.expect(1 + self._cycle * (0 if path.half else min(path.cycles, _EXPECTED)))
        self._stretched = factored.refined(stretch.T)
        self._follower: Follower | None = None

    def followed(self) -> History:
        """Follow the path."""
        before = self._path.before
        begin = resting(0 * self._bound if before is None else before)
        skip = (lambda _: None) if self._path.settled > 0 else None  # nothing else is kept
        history = follow(self._path, self._advance, begin, self._f, skip=skip)
        return self._completed(history)

    def _advance(self, before: Solution, load: Array, change: Array) -> tuple[Solution, Array]:
        """Go along one leg, as :func:`partialslip.friction.history.follow` asks for it."""
        done = _Done(before.x, load, change, still(before)) if not change.any() else self._leg(before.x, load, change)
        self.legs.append(done)
        return done.found, self._normal

    def _leg(self, start: Array, load: Array, change: Array) -> _Done:
        if self._followed:
            return self._follow(start, load, change)
        found = self._one_step(start, float(load[0]), change, self._known)
        if self._path.tension_stays or (
            self._suffices(start, change, found) and self._agrees(start, load, change, found)
        ):
            return _Done(start, load, change, found)
        return self._follow(start, load, change)

    @property
    def _followed(self) -> bool:
        """Whether the next leg is followed without a trial: slip that turned round a cycle before does so again."""
        return len(self.legs) > self._cycle and self.legs[-self._cycle].turns

    @property
    def _known(self) -> Sides | None:
        """Where the search for the sides after the next leg begins: at those of the previous cycle, or at those after
        the leg before turned round."""
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

    def _follow(self, start: Array, load: Array, change: Array) -> _Done:
        self._follower = self._follower or Follower(self.factored.C, self.factored.inverse)
        # a state of another mesh has the load, and keeps the bounds, to an error of that mesh only
        start = np.clip(start, -self._bound, self._bound)
        if (mirrored := self._mirrored(start, load, change)) is not None:
            return mirrored
        off = float(load[0] - change[0]) - float(start.sum())
        Q = float(change[0]) + (off if abs(off) > _AT * float(self._bound.sum()) else 0.0)
        try:
            leg = self._follower.leg(
                Bounds.constant(self._bound), start, change[1:3] @ self._stretch, Q, self._path.stages
            )
        except NothingSticksError:  # so near to sliding that rounding lets no node stick: a step still has an answer
            return _Done(start, load, change, self._one_step(start, float(load[0]), change, None))
        return _Done(start, load, change, leg.solution, leg)

    def _mirrored(self, start: Array, load: Array, change: Array) -> _Done | None:
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
        return _Done(start, load, change, found, leg)

    def _completed(self, history: History) -> History:
        """``history`` with what is known of its legs."""
        path, events = history.path, sum(each.leg.events for each in self.legs if each.leg)
        if path.half:
            return replace(history, slipped=np.abs(np.array([history.slip, history.slip])))
        last = self.legs[-self._cycle :]
        slipped = np.sum([each.slipped for each in last], axis=0)
        if not path.in_phase:
            lows, highs = zip(*(each.range for each in last), strict=True)
            history = replace(history, q1=np.min(lows, axis=0), q2=np.max(highs, axis=0))
        stages = [self._around(each) for each in last]
        ways, forces = tuple(way for way, _, _ in stages), np.concatenate([states for _, states, _ in stages])
        shifts = joined([shifts for *_, shifts in stages])
        return replace(
            history,
            slipped=slipped,
            dissipated=float(self._bound @ slipped.sum(axis=0)),
            around=Steps(ways, forces, self._normal[None], self._f, shifts),
            turns=path.in_phase and any(each.turns for each in last),
            changed=last[path.ends[1]].changed if path.in_phase else None,
            stuck=last[path.ends[1]].stuck if path.in_phase else None,
            events=events,
        )

    def _around(self, done: _Done) -> tuple[tuple[float, ...], Array, Array]:
        """Fractions of a leg, ascending to 1, the forces (s, n) there, and the rigid shifts (s,) up to there."""
        if done.leg:
            return self._path.stages, done.leg.stages, done.leg.shifts
        count, Q = self._path.substeps, float(done.load[0] - done.change[0])
        shares = (np.arange(1, count + 1) / count).tolist()
        between = [
            self._one_step(done.start, Q + share * float(done.change[0]), share * done.change, None)
            for share in shares[:-1]
        ]
        states = [*between, done.found]
        return tuple(shares), np.array([each.x for each in states]), np.array([each.shift for each in states])
