"""The mean of two pressures, by which a steady cycle under varying normal load and moment is like one under constant
pressure (docs/theory.md, section 11)."""

import math
from functools import cached_property
from typing import NamedTuple

import numpy as np

from partialslip.halfplane.contact import Contact, contact
from partialslip.halfplane.loading import Loading
from partialslip.halfplane.proportional import loading
from partialslip.halfplane.shape import Shape
from partialslip.scene import Scene
from partialslip.tools.arrays import Array

_ENDS = np.array([-1.0, 1.0])


class Mean(Shape):
    """Mean of the pressures of the contacts ``first`` and ``second`` over the union of both, from ``left`` to ``right``
    (m); scaled as in :mod:`partialslip.halfplane.shape`, with the mean of both normal forces."""

    def __init__(self, first: Contact, second: Contact) -> None:
        self._both = first, second
        self.left = min(first.ends[0], second.ends[0])
        self.right = max(first.ends[1], second.ends[1])
        a, self.even = (self.right - self.left) / 2, first.centre == second.centre and first.shape.even
        self.even = self.even and second.shape.even
        p0 = 2 * self.force / (math.pi * a)
        # for each contact: factor of x, and shift, that take x to the scaled x of this contact; factor of the pressure
        self._parts = [
            (each.shape, a / each.a, (self.centre - each.centre) / each.a, each.p0 / p0 / 2) for each in self._both
        ]
        self.kinks = self._places([(-1.0, *part[0].kinks, 1.0) for part in self._parts])
        self._strong = self._places([(-1.0, *part[0].strong_kinks, 1.0) for part in self._parts])

    @property
    def centre(self) -> float:
        """Middle of the union, m."""
        return self._both[0].centre if self.even else (self.right + self.left) / 2

    @property
    def force(self) -> float:
        """Mean of both normal forces, N/m."""
        return (self._both[0].P + self._both[1].P) / 2

    @property
    def contact(self) -> Contact:
        """The union as a contact under the mean pressure."""
        return Contact((self.right - self.left) / 2, self.force, self, self.centre)

    @property
    def strong_kinks(self) -> tuple[float, ...]:
        return self._strong

    def _places(self, kinks: list[tuple[float, ...]]) -> tuple[float, ...]:
        """Kinks of both pressures inside the union; the ends of the contacts among them."""
        found = {
            (kink - shift) / stretch
            for points, (_, stretch, shift, _) in zip(kinks, self._parts, strict=True)
            for kink in points
        }
        return tuple(sorted(kink for kink in found if abs(kink) < 1 - 1e-15))

    def pressure(self, x: Array) -> Array:
        result: Array = np.zeros(np.shape(x))
        for shape, stretch, shift, factor in self._parts:
            result = result + factor * shape.pressure(x * stretch + shift)
        return np.where(np.abs(x) < 1, result, 0.0)

    def difference(self, t: Array, x: Array) -> Array:
        result: Array = np.zeros(np.broadcast_shapes(np.shape(t), np.shape(x)))
        step = t - x
        for shape, stretch, shift, factor in self._parts:
            there, here = t * stretch + shift, x * stretch + shift
            inside = (np.abs(there) <= 1) & (np.abs(here) <= 1)
            within = stretch * shape.difference(np.clip(there, -1, 1), np.clip(here, -1, 1))
            apart = (shape.pressure(there) - shape.pressure(here)) / np.where(step == 0, np.inf, step)
            result = result + factor * np.where(inside, within, apart)
        return result


class Rates(NamedTuple):
    """Increments of p and q in a contact that sticks as a whole, times pi sqrt(a^2 - y^2) (N/m), which is finite at the
    ends: ``pressure`` and ``shear``, (k,) each."""

    pressure: Array
    shear: Array


class PressureStage(NamedTuple):
    """A stage of the way from load point to load point: the contact ``now``, the union ``mean`` of this and of the
    contact at the beginning under their mean pressure, and the ``change`` of shear so far if slip does not reverse."""

    now: Contact
    mean: Contact
    change: Loading

    @property
    def stick(self) -> tuple[float, float]:
        """Ends of the stick zone, m."""
        left, right = self.mean.places(self.change.ends).tolist()
        return left, right


class PressurePath:
    """The contacts of ``scene`` on the straight way between load points 1 and 2 (``back``: from 2 to 1), and the stages
    of the way, each of which is solved once."""

    def __init__(self, scene: Scene, back: bool = False) -> None:
        way = -1 if back else 1
        self._scene = scene
        self._first, self._second = scene.end_pressing[::way]
        load = scene.load
        self.dQ, self.dsigma, self.dslope = way * load.dQ, way * load.dsigma, way * load.dslope
        self._stages: dict[float, PressureStage] = {}

    @classmethod
    def both(cls, scene: Scene) -> "Ways":
        """The ways from load point 1 to 2, and back."""
        return cls(scene), cls(scene, back=True)

    def at(self, share: float) -> Contact:
        """Contact at the ``share`` of the way, from 0 to 1."""
        return contact(self._scene, self._first.towards(self._second, share))

    @cached_property
    def begin(self) -> Contact:
        """Contact at the beginning of the way."""
        return self.at(0.0)

    @cached_property
    def end(self) -> Contact:
        """Contact at the end of the way."""
        return self.at(1.0)

    def stage(self, share: float) -> PressureStage:
        """Stage at the ``share`` of the way, from 0 to 1."""
        if share not in self._stages:
            now = self.at(share)
            mean = Mean(self.begin, now).contact
            loads = (share * load for load in (self.dQ, self.dsigma, self.dslope))
            change = loading(mean, self._scene.friction.f, *loads, bound=2)
            self._stages[share] = PressureStage(now, mean, change)
        return self._stages[share]

    def pressed(self, now: Contact) -> tuple[float, float]:
        """Rates of the increment of p over the way in the contact ``now``, dp = (first + second y/a)/sqrt(a^2 - y^2),
        N/m, y the distance from its middle: the bodies approach, and turn if they can."""
        dP = self._second.P - self._first.P
        if self._first.M is None or self._second.M is None:
            return dP / math.pi, 0.0
        turned = self._second.M - self._first.M - now.centre * dP
        return dP / math.pi, 2 * turned / (math.pi * now.a)

    def rates(self, now: Contact, y: Array = _ENDS) -> Rates:
        """Increments over the way in the contact ``now``, if it sticks as a whole, at the distances a ``y`` (k,) from
        its middle (default: at its ends)."""
        uniform, turned = self.pressed(now)
        tension = self.dsigma + self.dslope * now.centre
        shear = self.dQ + y * math.pi / 4 * now.a * tension + math.pi / 4 * now.a**2 * self.dslope * (y**2 - 0.5)
        return Rates(math.pi * (uniform + y * turned), shear)


def common(first: Contact, second: Contact) -> tuple[float, float]:
    """Left and right end, m, of the part that two contacts have in common."""
    return max(first.ends[0], second.ends[0]), min(first.ends[1], second.ends[1])


Ways = tuple[PressurePath, PressurePath]
