"""Coulomb's law in every load step of a march, checked on forces, compliances and loads alone.

A leg that is followed event by event is no step, and neither is its mirror image: nodes slip and stick again on it. Of
such legs displacements, bounds and equilibrium are checked here, and Coulomb's law on the way in
test_path_following.py.

Nothing here knows the solver's active sets, rigid shifts, residuals and certificates, nor which steps the solver takes
over from other steps: each step is looked at with the forces that it begins with.
"""

from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cached_property, partial
from typing import NamedTuple
from unittest.mock import patch

import numpy as np

from partialslip.friction import (
    coulomb_constant_pressure,
    coulomb_coupled,
    coulomb_legs,
    coulomb_varying_pressure,
    history,
    path_following,
)

ROUNDING = 1e-13  # in the sizes of the terms that cancel
SUMMED = 1e-12  # the same, of the sums over nodes or over the steps of a cycle
FOLLOWED = 1e-11  # the same, of a leg of some hundred events


class Step(NamedTuple):
    """A load step, scaled: its ``change`` of the loads, the force ``Q`` after it, and (n,) each, before and after it,
    f times the normal forces and the tangential forces; ``slip`` (n,) as the solver counts it. ``followed``: whether it
    is a leg that is followed event by event."""

    Q: float
    change: np.ndarray
    bound_before: np.ndarray
    bound: np.ndarray
    before: np.ndarray
    after: np.ndarray
    slip: np.ndarray
    followed: bool


@dataclass
class March:
    """Relative compliance ``C`` (n, n) along x, ``stretch`` (2, n) by tension, compliance ``across`` (n, n) along x by
    f times the normal forces (None: the bodies are not coupled), the load ``steps``, and the ``history`` of them.
    ``constant``: whether the normal forces are."""

    C: np.ndarray
    stretch: np.ndarray
    across: np.ndarray | None
    constant: bool
    steps: list[Step]
    history: history.History

    def each(self, key):
        """Values (s, ...) of all load steps."""
        return np.array([getattr(step, key) for step in self.steps])

    @cached_property
    def moved(self):
        """Relative displacements (s, n) due to the changes of all forces and loads in each step, and the size (s, n) of
        the terms that cancel in them. They are a rigid shift less the slip."""
        change = self.each("change")[:, 1:3]
        terms = [(self.C, self.each("before"), self.each("after"))]
        if self.across is not None:
            terms.append((self.across, self.each("bound_before"), self.each("bound")))
        moved = sum((after - before) @ C.T for C, before, after in terms) - change @ self.stretch
        size = sum((abs(after) + abs(before)) @ abs(C.T) for C, before, after in terms)
        return moved, size + abs(change) @ abs(self.stretch)

    def complaints(self):
        """What is wrong with the load steps, or with what the history makes of them; one line of each kind."""
        bound, after, slip = (self.each(key) for key in ("bound", "after", "slip"))
        total = bound.sum(axis=1)
        if (worst := (abs(after) - bound).max()) > 0:
            yield f"q beyond the bound by {worst}"
        if (worst := (abs(after.sum(axis=1) - self.each("Q")) / total).max()) > SUMMED:
            yield f"sum of q off by {worst} f P"
        step = ~self.each("followed")[:, None]
        if (step & (slip * after < 0)).any():
            yield f"slip against q at {(step & (slip * after < 0)).sum()} nodes and steps"
        inside = step & (slip != 0) & (abs(after) < (1 - SUMMED) * bound)
        if inside.any():
            yield f"slip where q is not on the bound, at {inside.sum()} nodes and steps"
        yield from self._kinematics()
        if self.constant:
            if (worst := self.gaps()[step[:, 0]].max(initial=0)) > ROUNDING:
                yield f"a better answer by {worst}"
            yield from self._sums()

    def _kinematics(self):
        """Slip is what the displacements leave over, but for a rigid shift, where nodes touch before and after."""
        moved, size = self.moved
        touch = (self.each("bound") > 0) & (self.each("bound_before") > 0)
        touch &= size.max(axis=1, keepdims=True) > 0
        some = touch.any(axis=1)
        left = np.where(touch, moved + self.each("slip"), np.nan)[some]
        left = abs(left - np.nanmedian(left, axis=1, keepdims=True)) / size[some].max(axis=1, keepdims=True)
        allowed = np.where(self.each("followed"), FOLLOWED, ROUNDING)[some, None]
        if (left > allowed).any():
            yield f"slip that is not what the displacements leave over, by {np.nanmax(left)}"

    def gaps(self):
        """(C x - g).(x - y) in each step, by the size of its terms, for the feasible y that makes most of it: the
        duality gap of min x.C x/2 - g.x over |x| <= bound with the sum Q.

        Never negative, it bounds the square of the distance of x from the minimiser in the norm of C, and knows nothing
        of slip: y fills the nodes up in the order of their gradients until it has the sum.
        """
        gradient, size = self.moved
        gradient = gradient - np.median(gradient, axis=1, keepdims=True)  # a rigid shift does no work
        bound, x, Q = (self.each(key) for key in ("bound", "after", "Q"))
        order = np.argsort(gradient, axis=1)
        room = 2 * np.take_along_axis(bound, order, axis=1)
        filled = np.clip((Q + bound.sum(axis=1))[:, None] - (np.cumsum(room, axis=1) - room), 0, room)
        y = np.empty_like(x)
        np.put_along_axis(y, order, filled - room / 2, axis=1)
        return abs((gradient * (x - y)).sum(axis=1)) / (size * (abs(x) + abs(y))).sum(axis=1).clip(np.finfo(float).tiny)

    def _sums(self):
        """From load point 1 to 2, and around the cycle, at constant pressure."""
        found, path, bound = self.history, self.history.path, self.steps[0].bound
        (T1, T2), (first, second) = found.at_ends, path.ends
        change = (np.array(path.cycle[second]) - path.cycle[first])[1:3]
        left = (T2 - T1) @ self.C - change @ self.stretch + found.slip
        size = (abs(T2) + abs(T1)) @ abs(self.C) + abs(change) @ abs(self.stretch)
        if (worst := abs(left - np.median(left)).max() / size.max().clip(np.finfo(float).tiny)) > SUMMED:
            yield f"slip between load points that is not what the displacements leave over, by {worst}"
        last = slice(len(self.steps) - sum(map(len, path.fractions[1:])), None)
        slip = 2 * self.each("slip").sum(axis=0)[None] if path.half else self.each("slip")[last]
        work, worked = (2 if path.half else 1) * float(abs(slip).sum(axis=0) @ bound), found.dissipated
        if (abs(worked - work) > SUMMED * work and not self.each("followed").any()) or worked < (1 - SUMMED) * work:
            yield f"work against friction {worked} in place of {work}"
        if not path.half:
            done = np.cumsum([len(way) for way in path.fractions[1:]])
            (one, other), sign = sorted((done[first], done[second])), 1 if second > first else -1
            slip = sign * slip[one:other]
        if (worst := abs(slip.sum(axis=0) - found.slip).max()) > SUMMED * abs(slip).sum(axis=0).max():
            yield f"slip between load points off its steps by {worst}"


@contextmanager
def recorded():
    """The marches that are followed meanwhile: on all meshes, and with all choices of steps."""
    marches, making, legs = [], [], []

    def following(true, path, advance, before, f, **how):
        if path.followed:  # event by event: there are no steps
            return true(path, advance, before, f, **how)
        (C, stretch, across, bound), done = making[-1], []
        at_first = bound

        def stepping(before, load, change):
            nonlocal bound
            before_it = len(legs)
            found, pressure = advance(before, load, change)
            after = f * pressure
            known = bound if bound is not None else 0 * after
            followed = len(legs) > before_it
            done.append(Step(float(load[0]), change, known, after, before.x, found.x, -found.rest, followed))
            bound = after
            return found, pressure

        found = true(path, stepping, before, f, **how)
        marches.append(March(C, stretch, across, at_first is not None, done, found))
        return found

    def leg(follower, *given):
        legs.append(true_leg(follower, *given))
        return legs[-1]

    def image(leg):
        legs.append(true_image(leg))
        return legs[-1]

    def straight(true, C, stretch, normal, f, *others):
        making.append((C, stretch, None, f * normal))
        found = true(C, stretch, normal, f, *others)
        marches[-1].history = found  # with what is known of its legs
        return found

    def anew(true, x, C, stretch, *others, **more):
        making.append((C, stretch, None, None))
        return true(x, C, stretch, *others, **more)

    def unlike(true, C, gap, stretch, bent, f, *others, **more):
        making.append((C.xx, np.array([stretch[0], bent]), None if C.xy is None else C.xy / f, None))
        return true(C, gap, stretch, bent, f, *others, **more)

    true_leg, true_image = path_following.Follower.leg, path_following.Leg.mirrored.fget
    with ExitStack() as patched:
        patched.enter_context(patch.object(path_following.Follower, "leg", leg))
        patched.enter_context(patch.object(path_following.Leg, "mirrored", property(image)))
        for module in (coulomb_legs, coulomb_varying_pressure, coulomb_coupled):
            patched.enter_context(patch.object(module, "follow", partial(following, module.follow)))
        for module, march in (
            (coulomb_constant_pressure, straight),
            (coulomb_varying_pressure, anew),
            (coulomb_coupled, unlike),
        ):
            patched.enter_context(patch.object(module, "march", partial(march, module.march)))
        yield marches
