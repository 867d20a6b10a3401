"""A rig: what the size and the supports of two bodies add to the displacements of half-planes, as plain data.

The relative displacements of the two surfaces are u (upper body less lower body, along x) and v (opening, along y), as
in :mod:`partialslip.condensed.coupled`. Forces q and p per unit depth at t add to those of half-planes

    u = A (xx(x, t) q + xy(x, t) p),    v = A (xy(t, x) q + yy(x, t) p),

where A is the compliance of the pair and xx, yy and xy are polynomials in x/reach and t/reach. The data do not depend on
loads, friction or, without a pad, on the profile.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numpy.polynomial import polynomial

from partialslip.arrays import Array


@dataclass(frozen=True, eq=False)
class Rig:
    """Displacements that two bodies of a size add to those of half-planes.

    Parameters
    ----------
    key : str
        Checksum of the bodies, their supports and materials, and the face of a pad.
    reach : float
        Largest |x| at which the polynomials hold, m.
    xx, yy, xy : (k, k) array
        Coefficients of the polynomials, dimensionless: row i and column j belong to (x/reach)^i (t/reach)^j.
    pulled : (2, k) array
        u and v, relative to reach and to the strain of a long body, that a tension of the lower body adds to those of
        uniform strain: coefficients of (x/reach)^i; zero unless the body is pulled.
    errors : mapping of str to float
        Estimated errors of ``xx``, ``yy``, ``xy`` and ``pulled``: the largest over the range of x and t.
    """

    key: str
    reach: float
    xx: Array
    yy: Array
    xy: Array
    pulled: Array
    errors: dict[str, float]

    def moments(self, x: Array, forces: Array) -> Array:
        """Moments sum (x/reach)^j F_j of ``forces`` (..., n) at ``x`` (n,), (..., k)."""
        result: Array = forces @ self.powers(x)
        return result

    def powers(self, x: Array) -> Array:
        """Powers (x/reach)^j, (n, k), at ``x`` (n,), m."""
        result: Array = polynomial.polyvander(np.asarray(x) / self.reach, len(self.xx) - 1)
        return result

    def slopes(self, x: Array, coefficients: Array) -> Array:
        """Derivatives by x, (..., n), at ``x`` (n,), m, of polynomials with the ``coefficients`` (..., k)."""
        powers = np.arange(1, len(self.xx))
        result: Array = (coefficients[..., 1:] * powers) @ self.powers(x)[:, :-1].T / self.reach
        return result

    def opening(self, p: npt.ArrayLike, q: npt.ArrayLike) -> Array:
        """Coefficients (..., k) of v/A under tractions with the moments ``p`` and ``q`` (..., k)."""
        result: Array = np.asarray(p) @ self.yy + np.asarray(q) @ self.xy
        return result

    def shift(self, p: npt.ArrayLike, q: npt.ArrayLike) -> Array:
        """Coefficients (..., k) of u/A under tractions with the moments ``p`` and ``q`` (..., k)."""
        result: Array = np.asarray(q) @ self.xx + np.asarray(p) @ self.xy.T
        return result
