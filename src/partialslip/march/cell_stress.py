"""Stresses of marching: those of the exact pressure, and of shear that is smoothed from the forces on cells."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from partialslip.friction.history import Steps
from partialslip.halfplane.contact import Contact, contact
from partialslip.halfplane.layer import Acting
from partialslip.halfplane.stress import Fields, Integrals, Points, SlipZones, StressState
from partialslip.march.pressing import NormalLoads
from partialslip.result.below import PiecewiseCauchy, under_shear
from partialslip.result.phases import Phases
from partialslip.tools.arrays import Array, Complex, Mask

_SLIPS = 1e-9  # accuracy: distance of |q| from f p, relative, at which a cell slips
_WINDOW = 5  # accuracy: vertices of the polynomial through the resultants around a vertex
_LOAD_POINTS = np.array([0.0, 0.5])
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(3)  # accuracy: of the shear of a cell that layers see


@dataclass(frozen=True)
class CellStresses:
    """Stresses at load steps and between them (:class:`partialslip.result.phases.Phases`).

    Parameters
    ----------
    f : (c + 1,) array
        Coefficient of friction at the vertices.
    frame : Contact
        Scales the ``vertices``.
    vertices : (c + 1,) array
        Ends of the cells.
    phases : Phases
    states : tuple of StressState
        Contact, shear of the cells that slip beside its ends, and bulk tension at each step.
    steps : Steps
        Shear and normal forces of cells, in P of the ``frame``.
    """

    f: Array
    frame: Contact
    vertices: Array
    phases: Phases
    states: tuple[StressState, ...]
    steps: Steps

    @classmethod
    def of(cls, normal: NormalLoads, vertices: Array, steps: Steps) -> "CellStresses":
        """Stresses of the last cycle in ``steps``."""
        scene, phases = normal.scene, Phases(normal.scene.load, steps.ways)
        known: dict[object, Contact] = {}
        states = []
        for (_, sigma, slope, share, number), force, bound in zip(
            phases.loads.tolist(), steps.forces, steps.bounds, strict=True
        ):
            pressed = normal.frame
            if scene.presses_anew:
                points = scene.pressing
                pressing = points[int(number)].towards(points[(int(number) + 1) % len(points)], share)
                if pressing not in known:
                    known[pressing] = contact(scene, pressing)
                pressed = known[pressing]
            first, last = _end_runs(force, bound)
            inner = pressed.scaled(normal.frame.places(vertices[[first, last]])).tolist()
            signs = int(np.sign(force[first - 1])), int(np.sign(force[last % len(force)]))
            zones = SlipZones(pressed, inner[0], inner[1], signs)
            states.append(StressState(pressed, ((1.0, zones),), sigma, slope))
        f = scene.friction.at(normal.frame.places(vertices))
        return cls(f, normal.frame, vertices, phases, tuple(states), steps)

    def inside(self, x: Array, y: Array, phases: Array) -> Array:
        """Stresses (s, 3, k), Pa, at points (``x``, ``y``), m, (k,) each, and ``phases`` (s,) from 0 to 1."""
        return self.phases.interpolate(partial(self._at, Points.of(x, y)), phases)

    def surface(self, x: Array) -> Array:
        """sigma_xx (Pa) along the surfaces at ``x`` (k,), m: (2, 2, k), by body (lower, upper) and load point."""
        along = partial(self._along, Points.on_both_sides(x))
        return np.moveaxis(self.phases.interpolate(along, _LOAD_POINTS), 1, 0)

    def _along(self, sides: Sequence[Points], steps: Sequence[int]) -> Array:
        """sigma_xx (s, 2, k), by step and body, on both ``sides``, whose integrals are the same."""
        sheared, integrals = self._sheared(sides[0].scaled(self.frame), steps), Integrals()
        return np.stack([self._sum(at, steps, sheared, integrals)[:, 0] for at in sides], axis=1)

    def _at(self, at: Points, steps: Sequence[int]) -> Array:
        return self._sum(at, steps, self._sheared(at.scaled(self.frame), steps))

    def _sum(self, at: Points, steps: Sequence[int], sheared: Complex, integrals: Integrals | None = None) -> Array:
        """Stresses from those of pressure and from the Cauchy integrals of shear, ``sheared``."""
        result = self._pressed.at(at, [self.states[step] for step in steps], integrals)
        T, T_z = sheared
        result += np.moveaxis(under_shear(T, -at.depth / self.frame.a * T_z, at.side), 1, 0)
        if layer := self.frame.layer:
            result += np.stack([layer.stresses(*at, self._seen_by_layers(step), "shear") for step in steps])
        return result

    def _seen_by_layers(self, step: int) -> Acting:
        """The shear of :attr:`_sheared` at a ``step``, at the nodes of Gauss's rule in each cell."""
        assert self.frame.layer
        half, c = np.diff(self.vertices)[:, None] / 2, self._smoothed[step][:, :, None]
        t = half * (1 + _NODES)
        forces = self.frame.a * half * _WEIGHTS * ((c[0] * t + c[1]) * t + c[2])
        places = self.frame.places(self.vertices[:-1, None] + t)
        return Acting.of(self.frame.layer, places.ravel(), forces.ravel())

    @cached_property
    def _pressed(self) -> Fields:
        return Fields(self.states[-1].pressed.f, self.states[-1:])

    @cached_property
    def _sheared(self) -> PiecewiseCauchy:
        return PiecewiseCauchy(self.vertices, self._smoothed)

    @cached_property
    def _smoothed(self) -> Array:
        """Shear beside the slip zones at the ends of the contact, Pa, (s, 3, c), as of :func:`smoothed`."""
        places, forces = self.frame.places(self.vertices), self.frame.P / self.frame.a * self.steps.forces
        bounds = self.steps.bounds * (self.frame.P / self.frame.a)
        limits = {state.pressed: self.f * state.pressed.pressure(places) for state in self.states}
        rows = [
            smoothed(self.vertices, force, bound, limits[state.pressed])
            for force, bound, state in zip(forces, bounds, self.states, strict=True)
        ]
        return np.array(rows)


def _end_runs(forces: Array, bounds: Array) -> tuple[int, int]:
    """Vertices at which the cells end that slip, one way each, beside the left and the right end of the contact."""
    ways = _ways(forces, bounds)
    on = np.flatnonzero(bounds > 0)
    low, high = int(on[0]), int(on[-1]) + 1
    other = np.flatnonzero(ways[low:high] != ways[low]) if ways[low] else np.zeros(1, np.int64)
    first = low + int(other[0]) if len(other) else high
    back = ways[first:high][::-1]
    other = np.flatnonzero(back != ways[high - 1]) if ways[high - 1] else np.zeros(1, np.int64)
    return first, high - int(other[0]) if len(other) else first


def _ways(forces: Array, bounds: Array) -> Array:
    r"""Sign of the ``forces`` (c,) on cells that slip, at which \|force\| is the bound; 0 on others."""
    slips = (np.abs(forces) >= (1 - _SLIPS) * bounds) & (bounds > 0)
    return np.where(slips, np.sign(forces), 0.0)


def smoothed(vertices: Array, forces: Array, bounds: Array, limits: Array) -> Array:
    """Continuous shear traction with given ``forces`` (c,) on the cells between ``vertices`` (c + 1,): coefficients
    (3, c) of quadratic polynomials, as in :class:`scipy.interpolate.PPoly`.

    Next to cells that slip, q is f p in size, in ``limits`` (c + 1,). Elsewhere q is the derivative of a polynomial
    through the resultants at the vertices around. Cells that slip beside the ends of the contact are left out.
    """
    widths, means = np.diff(vertices), forces / np.diff(vertices)
    ways, open_ = _ways(forces, bounds), bounds <= 0
    at = _inner(vertices, forces, (ways == 0) & ~open_)
    beside, sum_ = (np.append(each, 0) + np.append(0, each) for each in (np.abs(ways), ways))
    at = np.where(beside > 0, sum_ / np.maximum(beside, 1) * limits, at)
    ends = np.append(open_, True) | np.append(True, open_)  # where q ends like a square root
    at = np.where(ends, 0.0, at)
    left, right = at[:-1], at[1:]
    first, last = _end_runs(forces, bounds)
    left_out = (np.arange(len(forces)) < first) | (np.arange(len(forces)) >= last)
    quadratics = np.array(
        [3 * (left + right - 2 * means) / widths**2, (6 * means - 4 * left - 2 * right) / widths, left]
    )
    return np.where(left_out, 0.0, quadratics)


def _inner(vertices: Array, forces: Array, sticks: Mask) -> Array:
    """q at the vertices (c + 1,) inside the runs of cells that stick."""
    resultant = np.append(0.0, np.cumsum(forces))
    count, numbers = len(forces), np.arange(len(vertices))
    edges = np.flatnonzero(np.diff(sticks.astype(np.int8), prepend=0, append=0))
    firsts, lasts = edges[::2], edges[1::2]  # first and last vertex of each run
    result = np.zeros(count + 1)
    for first, last in zip(firsts.tolist(), lasts.tolist(), strict=True):
        size = min(_WINDOW, last - first + 1)
        inner = numbers[first : last + 1]
        start = np.clip(inner - size // 2, first, last + 1 - size)
        window = start[:, None] + np.arange(size)
        result[first : last + 1] = _slope(vertices[window], resultant[window], vertices[inner])
    return result


def _slope(nodes: Array, values: Array, x: Array) -> Array:
    """Slopes (k,) at ``x`` (k,), each one of its ``nodes`` (k, n), of the polynomials through ``values`` (k, n)."""
    apart = nodes[:, :, None] - nodes[:, None, :] + np.eye(nodes.shape[1])
    weights = 1 / apart.prod(axis=2)
    step = x[:, None] - nodes
    here = step == 0
    own = (weights * here).sum(axis=1)
    quotient = np.where(here, 0.0, weights / np.where(here, 1.0, step)) / own[:, None]
    at = (values * here).sum(axis=1)
    return (quotient * (values - at[:, None])).sum(axis=1)
