"""Slip, stresses along the surfaces, and deformed bodies."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from partialslip.arrays import Array, Indices


@dataclass(frozen=True)
class Slip:
    """Slip over half a cycle.

    Parameters
    ----------
    x : (k,) array
        Points, ascending, m.
    slip : (k,) array
        Change, from load point 1 to 2, of the displacement of the body that pushes with q against the other, m.
    dissipated : float
        Work against friction over a whole cycle, per unit depth, J/m.
    """

    x: Array
    slip: Array
    dissipated: float


@dataclass(frozen=True)
class SurfaceStress:
    """Direct stress along the surfaces of the bodies, their bulk tensions included.

    Parameters
    ----------
    x : (k,) array
        Points, ascending, within the contact, at its ends and beyond, m.
    sigma : (2, 2, k) array
        sigma_xx by body, lower (which pushes with q against the other, and has the tension) and upper, and by load
        point, Pa.
    at : callable
        ``at(x) -> (2, 2, k)``: the same at any points.
    """

    x: Array
    sigma: Array
    at: Callable[[Array], Array]

    @property
    def largest(self) -> tuple[float, float]:
        """Where along the lower body sigma_xx is largest, m, and that, Pa: as a rule at the trailing edge, x = +-a."""
        highest = self.sigma[0].max(axis=0)
        return float(self.x[highest.argmax()]), float(highest.max())


@dataclass(frozen=True)
class DeformedBody:
    """A body's mesh and its displacements.

    Parameters
    ----------
    name : str
    points : (n, 2) array
        Undeformed, m.
    triangles : (t, 3) int array
    lines : dict of (k, 2) int arrays
        Named groups of boundary edges.
    displacements : dict of (n, 2) arrays
        By name, m.
    stresses : dict of (t, 3) arrays
        sigma_xx, sigma_yy and sigma_xy in the middle of the triangles, by name, Pa.
    """

    name: str
    points: Array
    triangles: Indices
    lines: Mapping[str, Indices]
    displacements: Mapping[str, Array]
    stresses: Mapping[str, Array] = field(default_factory=dict)
