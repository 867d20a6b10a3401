"""Slip, surface stresses and deformed bodies."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from partialslip.arrays import Array, Indices
from partialslip.result.points import at_points
from partialslip.shown import Short


@dataclass(frozen=True, repr=False)
class Slip(Short):
    """Slip over half a cycle.

    Parameters
    ----------
    x : (k,) array
        Points, ascending, m.
    slip : (k,) array
        Change, from load point 1 to 2, of the displacement of the lower body, which exerts q, relative to the upper
        body, m.
    dissipated : float
        Work against friction over one cycle, per unit depth, J/m.
    """

    x: Array
    slip: Array
    dissipated: float


@dataclass(frozen=True, repr=False)
class SurfaceStress(Short):
    """Direct stress sigma_xx along the surfaces of the bodies, bulk tension included.

    Parameters
    ----------
    x : (k,) array
        Points, ascending, within the contact, at its ends and beyond, m.
    sigma : (2, 2, k) array
        sigma_xx by body (lower, upper) and load point, Pa. The lower body carries the bulk tension and exerts q on the
        upper body.
    at : callable
        ``at(x) -> (2, 2, ...)``: sigma_xx, Pa, at points ``x``, m: a number, a list or an array of any shape.
    """

    x: Array
    sigma: Array
    at: Callable[[Array], Array]

    def __post_init__(self) -> None:
        object.__setattr__(self, "at", at_points(self.at))

    @property
    def largest(self) -> tuple[float, float]:
        """Position, m, and value, Pa, of the largest sigma_xx of the lower body; usually a contact edge, x = +-a."""
        highest = self.sigma[0].max(axis=0)
        return float(self.x[highest.argmax()]), float(highest.max())


@dataclass(frozen=True, repr=False)
class DeformedBody(Short):
    """Mesh of a body with displacements and stresses.

    Parameters
    ----------
    name : str
    points : (n, 2) array
        Undeformed, m.
    triangles : (t, 3) int array
    lines : dict of (k, 2) int arrays
        Named groups of boundary edges.
    displacements : dict of (n, 2) arrays
        Displacements of the nodes by name, m.
    stresses : dict of (t, 3) arrays
        sigma_xx, sigma_yy and sigma_xy at the triangles' centroids by name, Pa.
    """

    name: str
    points: Array
    triangles: Indices
    lines: Mapping[str, Indices]
    displacements: Mapping[str, Array]
    stresses: Mapping[str, Array] = field(default_factory=dict)
