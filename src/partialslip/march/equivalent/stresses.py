"""Stresses in bodies of a size: those of half-planes under the same tractions, and the smooth rest of each body.

The rest comes from the other sides of the body and leaves the surface near the contact free of tractions. It follows
from the displacements u and v of the surface that it adds, which are polynomials: with S(z) = 4 (u' + i v')/A as a
function of z = x + iy, A the compliance of the body, in the lower body

    sigma_xx + sigma_yy = Re S(z),    sigma_yy - i sigma_xy = (S(z) - S(conj z) + (z - conj z) conj S'(z))/4

(Muskhelishvili's function of a half-plane, continued across its free edge). On the surface sigma_xx = 4 u'/A. The upper
body is the mirror image.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.polynomial import polynomial

from partialslip.march.equivalent.data import Moments, moments_of
from partialslip.result import Result, StressAt, SurfaceStress
from partialslip.result.below import below_surface, under_tension
from partialslip.result.phases import Phases
from partialslip.result.rig import Rig
from partialslip.scene import Scene
from partialslip.tools.arrays import Array, Complex

_Q_ERROR = 2.0  # accuracy: error of the largest sigma_xx, in the error of q, relative L2, times the largest |q|


@dataclass(frozen=True)
class _Bodies:
    """Stresses in the bodies of ``scene``, from ``result``, the half-planes ``seen`` that stand for them."""

    scene: Scene
    rig: Rig
    seen: Scene
    result: Result

    @cached_property
    def _rest(self) -> Complex:
        """Coefficients (points, 2, k) of S, Pa, in powers of z/reach, by load point and body (lower, upper)."""
        return rests(self.scene, self.rig, moments_of(self.rig, self.scene, self.result))

    @cached_property
    def _phases(self) -> Phases:
        return Phases(self.scene.load, ((1.0,),) * len(self.scene.load.points))

    def inside(self, x: Array, y: Array, phases: Array) -> Array:
        """Stresses (s, 3, k), Pa, at points (``x``, ``y``), m, (k,) each, and ``phases`` (s,); NaN beyond the reach of
        the rig."""
        assert self.result.stress_at
        side, depth = np.where(y <= 0, 1.0, -1.0), np.abs(y)
        z = (x - 1j * depth) / self.rig.reach
        loads = self._phases.interpolate(self._tensions, phases)
        rest = self._phases.interpolate(lambda steps: self._rest[steps], phases)
        found = np.array(self.result.stress_at.function(x, y, phases))
        for row, (sigma, slope), own in zip(found, loads, rest, strict=True):
            row += under_tension(sigma + slope * x, slope, depth, side)
            row += np.where(side > 0, _below(own[0], z), _below(own[1], z)) * np.stack([side**2, side**2, side])
        found[..., np.abs(z) > 1] = np.nan
        return found

    def _tensions(self, steps: Sequence[int]) -> Array:
        """Bulk tension at x = 0 and its slope that the bodies have besides that of the half-planes, (steps, 2)."""
        own, other = (np.array(scene.load.along)[:, 1:] for scene in (self.scene, self.seen))
        return (own - other)[steps]

    def surface(self, x: Array) -> Array:
        """sigma_xx (2, 2, k), Pa, by body and load point at ``x`` (k,), m."""
        ends = np.array([0.0, 0.5])
        upper = np.nextafter(0.0, 1.0)  # points of the upper body's surface
        return np.stack([self.inside(x, np.full_like(x, y), ends)[:, 0] for y in (0.0, upper)])


def with_stresses(scene: Scene, rig: Rig, seen: Scene, result: Result) -> Result:
    """Return ``result`` of the half-planes ``seen``, which has stresses, with those of the bodies of ``scene``."""
    assert result.surface
    bodies = _Bodies(scene, rig, seen, result)
    x = result.surface.x[np.abs(result.surface.x) <= rig.reach]
    return replace(
        result, surface=SurfaceStress(x, bodies.surface(x), bodies.surface), stress_at=StressAt(bodies.inside)
    )


def stress_errors(scene: Scene, rig: Rig, result: Result, error: float) -> dict[str, float]:
    """Relative errors of the largest sigma_xx of ``result`` by source: ``half-planes``, by the ``error`` of q; ``rig``,
    by its mesh; and ``pressing``, of bodies that are not mirror images, by the shear that pressing locks in, which is
    not followed: no more than the tension by which pressing strains the surfaces relative to each other."""
    assert result.surface
    moments, (x, largest) = moments_of(rig, scene, result), result.surface.largest
    own, rough = (rests(scene, each, moments)[:, 0] for each in (rig, rig.coarser))
    mesh = polynomial.polyval(x / rig.reach, (own - rough).T).real
    levels = result.traction.values.levels or (result.traction.dq / 2,)
    strain = rig.slopes(np.array([x]), scene.material.A * rig.shift(moments.p, 0 * moments.q))
    errors = {
        "half-planes": _Q_ERROR * error * max(np.abs(q).max() for q in levels),
        "rig": np.abs(mesh).max(),
        "pressing": np.abs(4 / scene.material.A * strain).max(),
    }
    return {source: float(each / abs(largest)) for source, each in errors.items() if each}


def rests(scene: Scene, rig: Rig, moments: Moments) -> Complex:
    """Coefficients (points, 2, k - 1) of S, Pa, in powers of z/reach, by load point and body (lower, upper), under
    tractions with ``moments`` and the bulk tension of ``scene``."""
    compliances = np.array([body.A for body in scene.material.bodies])[:, None, None]
    sigma = np.array([sigma for _, sigma, *_ in scene.load.points])
    pulled = rig.reach * compliances[0] / 4 * sigma[:, None] * rig.terms.pulled[:, None]  # of the lower body
    u, v = (scene.material.A * share for share in rig.shares(*moments))
    u[0] += pulled[0]
    v[0] += pulled[1]
    u[0] *= -1  # the lower body moves against u of the pair; along y both bodies move away from the other
    moved = u - 1j * v
    strains = moved[..., 1:] * np.arange(1, moved.shape[-1]) / rig.reach
    return np.swapaxes(4 / compliances * strains, 0, 1)


def _below(coefficients: Complex, z: Complex) -> Array:
    """Stresses (3, k) of the lower body at ``z`` (k,), in reaches, from the ``coefficients`` of S."""
    at, mirrored = (np.asarray(polynomial.polyval(each, coefficients), complex) for each in (z, z.conj()))
    slope = np.asarray(polynomial.polyval(z, polynomial.polyder(coefficients)), complex)
    return below_surface(at, mirrored, slope, z)
