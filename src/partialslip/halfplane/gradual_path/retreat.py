"""Retreat: both ends of one stick zone give way to slip. Scaled as in :mod:`partialslip.halfplane.shape`, tractions by
f p0, forces by f p0 a.

Where a point slips, q no longer changes. The change D of q since the beginning is therefore known outside the stick
zone: there it takes q to the friction bound. Inside, D follows from its strain, which the tension cancels, and is
bounded at both ends (the conditions and the inversion of docs/theory.md, section 4, for any state at the beginning).
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from partialslip.halfplane.gradual_path.tractions import Tractions
from partialslip.halfplane.shape import Rule, rule_between
from partialslip.tools.arrays import Array

_STEPS = 60  # limit: of Newton's method
_CLOSE = 1e-14  # accuracy: Newton step that is rounding
_BESIDE = 1e-6  # accuracy: Newton step below which an end is beside a break, or as near as rounding lets it come
_MOST = 4.0  # cost: largest growth of a step over the one before
_FIRST, _SMALLEST = 0.02, 1e-6  # cost: steps of the loads
_USUAL = 8  # limit: steps after which an end without stiffness lies beside a break
_ROUNDING = 1e-12  # accuracy: error of the loads that is rounding there
_SOFT = 1e-3  # accuracy: stiffness of an end, over that of the other end, below which it has none
_PASSED = 1e-12  # accuracy: distance beyond a break
_APART = 1e-13  # accuracy: distance from the stick zone below which differences of changes are rounding
_WIDE = 3.0  # accuracy: in theta: the length of a piece at the end of the contact
_FARTHEST = 0.7  # cost: of a slip zone or a stick zone, by which one step may narrow it


class Zone(NamedTuple):
    """Stick zone from ``left`` to ``right``."""

    left: float
    right: float

    @property
    def centre(self) -> float:
        """Middle of the zone."""
        return (self.left + self.right) / 2

    @property
    def half_width(self) -> float:
        """Half of the width of the zone."""
        return (self.right - self.left) / 2


_Step = Callable[[float, float, float, float], float]


class LoadConditions(NamedTuple):
    """Changes of the ``tension`` and of the ``shear`` force that belong to a stick zone, and the stiffness of its ends:
    q is short of its value at the ``right`` end by right sqrt(2 c r) at a small distance r inside, likewise ``left``.
    """

    tension: float
    shear: float
    left: float
    right: float


class _Side(NamedTuple):
    """Change of q in the slip zone on one side: ``rule`` of integration, ``distance`` of its points from the stick
    zone, ``change`` there and ``end``, the change at the end of the stick zone, and the width ``gap`` of the slip
    zone."""

    rule: Rule
    distance: Array
    change: Array
    end: float
    gap: float


class Retreat:
    """Changes of q by slip that grows from the ends of a stick zone, from a state on.

    Parameters
    ----------
    start : Tractions
        The state.
    within : Zone
        Stick zone at the beginning.
    left : int
        Sign of the slip at the left end; at the right end it is positive.
    """

    def __init__(self, start: Tractions, within: Zone, left: int) -> None:
        self.start, self.within, self.sign = start, within, left
        self._breaks = np.array(sorted({*start.breaks, *start.shape.kinks}))
        self._inner = self._breaks[(self._breaks > within.left) & (self._breaks < within.right)]
        self._latest: tuple[Zone | None, dict[int, _Side]] = None, {}  # zone in which changes were asked for

    def outside(self, side: int, x: Array) -> Array:
        """Change of q at ``x`` in the slip zone on one ``side``, 1 (right) or -1 (left)."""
        return self.start.less(1.0 if side > 0 else float(self.sign), x)

    def conditions(self, zone: Zone) -> LoadConditions:
        """Changes of the loads (tension and shear) under which ``zone`` sticks, and the stiffness of its ends."""
        c = zone.half_width
        sides = {side: self._side(zone, side) for side in (1, -1)}
        tension = shear = 0.0
        smooth = dict.fromkeys((1, -1), 0.0)
        for side, of in sides.items():
            weighted = of.rule.weights * of.change
            tension += side * float(weighted.sum())
            shear += float(weighted @ (c + of.distance))
            rest = of.rule.weights * (of.change - of.end)
            apart = of.distance > _APART
            smooth[side] += float((rest[apart] / of.distance[apart]).sum())
            smooth[-side] += float((rest / (of.distance + 2 * c)).sum())
        near = {side: of.end / _tangent(of.gap, c) if of.gap else 0.0 for side, of in sides.items()}
        far = {side: of.end * _tangent(of.gap, c) if of.gap else 0.0 for side, of in sides.items()}
        stiffness = {side: ((near[side] - far[-side]) / c - smooth[side]) / math.pi for side in sides}
        return LoadConditions(4 / math.pi * tension, shear, stiffness[-1], stiffness[1])

    def zone(self, tension: float, shear: float, guess: Zone) -> Zone | None:
        """Stick zone under the changes ``tension`` and ``shear``, by Newton's method from a ``guess``; None if it does
        not converge."""
        return self._newton(tension, shear, guess, self._plainly) or self._newton(
            tension, shear, guess, self._past_breaks
        )

    def _newton(self, tension: float, shear: float, guess: Zone, step: _Step) -> Zone | None:
        """Zone (l, r) with Q(l, r) = ``shear`` and T(l, r) = ``tension`` by Newton's method; None if it fails.

        An increment of the loads adds the adhered traction of the zone, singular at its ends with the strengths
        k = (Q - Q(l, r))/pi +- c (T - T(l, r))/4 (+ right, - left; c: half-width). The ends move by -k/(c S) (right)
        and k/(c S) (left) until k = 0, with the stiffnesses S of :meth:`conditions`; ``step`` takes k/c and S.
        """
        left, right = guess
        for number in range(_STEPS):
            c = (right - left) / 2
            at = self.conditions(Zone(left, right))
            more, pull = (shear - at.shear) / math.pi, c * (tension - at.tension) / 4
            to_right = step(right, -(more + pull) / c, at.right, at.left)
            to_left = step(left, (more - pull) / c, at.left, at.right)
            if not (math.isfinite(to_left) and math.isfinite(to_right)):
                return None
            left, right = _stepped_ends(left, right, to_left, to_right, self.within)
            at_break = step == self._past_breaks and number > _USUAL and max(abs(more), abs(pull)) < _ROUNDING
            if right - left <= 0 or max(abs(to_left), abs(to_right)) < _CLOSE or at_break:
                break
        else:
            return None
        return Zone(left, right) if right > left else None

    def _plainly(self, end: float, push: float, stiffness: float, other: float) -> float:
        """Newton step of an ``end`` that is pushed, with the stiffness of this and of the ``other`` end."""
        del end, other
        return push / stiffness if stiffness else 0.0

    def _past_breaks(self, end: float, push: float, stiffness: float, other: float) -> float:
        """Newton step of an ``end`` that may have no stiffness.

        Points that the same loads took to the friction bound in the previous half cycle reach the bound again at once:
        S = 0 up to the next break of q, and the end jumps just past this break.
        """
        ahead = self._inner[(self._inner - end) * push > 0]
        if abs(stiffness) > _SOFT * abs(other) or not len(ahead):
            return self._plainly(end, push, stiffness, other)
        nearest = float(ahead[np.argmin(np.abs(ahead - end))])
        return nearest - end + math.copysign(_PASSED, push)

    def follow(self, tension: float, shear: float) -> Zone | None:
        """Stick zone under changes of the loads, followed from their beginning; None if it is lost."""
        done, step = 0.0, _FIRST
        width = self.within.right - self.within.left
        zones: list[tuple[float, Zone]] = [(0.0, self.within)]
        guess = Zone(self.within.left + step**2 * width, self.within.right - step * width / 4)
        while done < 1:
            step = min(step, 1 - done)
            if len(zones) > 1:
                (first, early), (second, late) = zones[-2:]
                on = step / (second - first)
                ends = (late[i] + on * (late[i] - early[i]) for i in (0, 1))
                guess = Zone(*ends)
                if not guess.right - guess.left > (late.right - late.left) / 4:
                    guess = late
            found = self.zone((done + step) * tension, (done + step) * shear, guess)
            if found and found.left >= zones[-1][1].left - _CLOSE and found.right <= zones[-1][1].right + _CLOSE:
                done += step
                zones.append((done, found))
                step *= 2
            elif step < _SMALLEST:
                return None
            else:
                step /= 4
        return zones[-1][1]

    def balanced(self, half_width: float, guess: float) -> float | None:
        """Centre of the stick zone of half-width c = ``half_width`` at which the rate of q is bounded at the left end:
        shear/pi = c tension/4.

        By Newton's method from a ``guess``; by bisection where the left end is at a break of q. None if it fails.
        """
        c = half_width

        def newton(centre: float) -> float:
            at = self.conditions(Zone(centre - c, centre + c))
            return -(at.shear / math.pi - c * at.tension / 4) / (c * at.left)

        centre, step, before = guess, math.inf, guess
        for _ in range(_STEPS):
            step, before = newton(centre), centre
            if not math.isfinite(step):
                return None
            room = self.within.right - c - centre if step > 0 else centre - c - self.within.left
            centre += math.copysign(min(abs(step), _FARTHEST * room), step)
            if abs(centre - before) < _CLOSE:
                return centre
        if abs(step) > _BESIDE:
            return None
        low, high = min(centre, before), max(centre, before)
        for _ in range(_STEPS):  # the left end is at a break, on both sides of which it has another stiffness
            middle = (low + high) / 2
            low, high = (middle, high) if newton(middle) > 0 else (low, middle)
        return (low + high) / 2

    def bracketed(self, half_width: float) -> float | None:
        """Centre as for :meth:`balanced`, by bracketing over all centres in the stick zone; None without a change of
        sign."""
        from scipy.optimize import brentq  # takes long to import

        def excess(centre: float) -> float:
            at = self.conditions(Zone(centre - half_width, centre + half_width))
            return at.shear / math.pi - half_width * at.tension / 4

        low, high = self.within.left + half_width, self.within.right - half_width
        if not excess(low) > 0 > excess(high):
            return None
        return float(brentq(excess, low, high, xtol=1e-15))

    def inside(self, zone: Zone, from_left: Array, from_right: Array) -> Array:
        """Change of q in the stick ``zone``, at the distances ``from_left`` and ``from_right`` from its ends."""
        if zone != self._latest[0]:
            self._latest = zone, {side: self._side(zone, side) for side in (1, -1)}
        to = {1: np.sqrt(from_right), -1: np.sqrt(from_left)}
        arcs, rest = np.zeros_like(from_left), np.zeros_like(from_left)
        for side in (1, -1):
            of = self._latest[1][side]
            if not of.gap:
                continue
            tangent = _tangent(of.gap, zone.half_width)
            arcs += 2 * of.end * np.arctan2(tangent * to[-side], to[side])
            rest += (1 / (of.distance + (to[side] ** 2)[:, None])) @ (of.rule.weights * (of.change - of.end))
        return (arcs + to[1] * to[-1] * rest) / math.pi

    def _side(self, zone: Zone, side: int) -> _Side:
        c, end = zone.half_width, zone.right if side > 0 else zone.left
        gap = max(1 - side * end, 0.0)

        def theta(width: Array) -> Array:
            return 2 * np.arcsinh(np.sqrt(np.maximum(width, 0.0) / (2 * c)))

        last = float(theta(np.array(gap)))
        inner = theta(side * (self._breaks - end))
        ends = np.unique(np.clip([0.0, last - _WIDE, *inner, last], 0.0, last))
        if len(ends) < 2:
            ends = np.array([0.0, 0.0])
        rule = rule_between(ends, 1 + zone.left, c, side)
        distance = 2 * c * np.sinh(rule.theta / 2) ** 2
        change = self.outside(side, np.append(rule.t, end))
        return _Side(rule, distance, change[:-1], float(change[-1]) if gap else 0.0, gap)


def _tangent(gap: float, c: float) -> float:
    """tanh(theta/2) at the end of the contact, beyond a slip zone of the width ``gap``."""
    return math.sqrt(gap / (gap + 2 * c))


def _stepped_ends(left: float, right: float, to_left: float, to_right: float, within: Zone) -> tuple[float, float]:
    """Ends after a step, kept within a zone and apart."""
    gone, lost = left - within.left, within.right - right  # widths of new slip: each changes by a limited factor
    to_left = min(max(to_left, -_FARTHEST * gone), _MOST * gone)
    to_right = max(min(to_right, _FARTHEST * lost), -_MOST * lost)
    shrinks = to_left - to_right
    if shrinks > _FARTHEST * (right - left):
        share = _FARTHEST * (right - left) / shrinks
        to_left, to_right = share * to_left, share * to_right
    return left + to_left, right + to_right
