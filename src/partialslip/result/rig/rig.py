"""A rig: what the size and the supports of two bodies add to the displacements of half-planes, as plain data.

The relative displacements of the two surfaces are u (upper body less lower body, along x) and v (opening, along y), as
in :mod:`partialslip.friction.coulomb_coupled`. Forces q and p per unit depth at t add to those of half-planes

    u = A (xx(x, t) q + xy(x, t) p),    v = A (xy(t, x) q + yy(x, t) p),

where A is the compliance of the pair and xx, yy and xy are polynomials in x/reach and t/reach. They do not depend on
loads, friction or, without a pad, on the profile.
"""

import hashlib
from dataclasses import dataclass, replace
from typing import NamedTuple

import msgspec
import numpy as np
from numpy.polynomial import polynomial

from partialslip.scene import Scene
from partialslip.tools.arrays import Array
from partialslip.tools.inputfile import LARGEST_MESH, checksum


class Terms(NamedTuple):
    """Coefficients of the polynomials, dimensionless.

    Parameters
    ----------
    xx, yy, xy : (k, k) array
        Row i and column j belong to (x/reach)^i (t/reach)^j.
    pulled : (2, k) array
        u and v that a tension of the lower body adds to those of uniform strain, relative to reach and to the strain of
        a long body; element i belongs to (x/reach)^i. Zero unless the body is pulled.
    lower_xx, lower_yy, lower_xy : (k, k) array
        Share of the lower body in xx, yy and xy.
    """

    xx: Array
    yy: Array
    xy: Array
    pulled: Array
    lower_xx: Array
    lower_yy: Array
    lower_xy: Array


@dataclass(frozen=True, eq=False)
class Rig:
    """Displacements that two bodies of a size add to those of half-planes.

    Parameters
    ----------
    key : str
        Checksum of the bodies, their supports and materials, and the face of a pad.
    reach : float
        Largest |x| at which the polynomials hold, m.
    terms : Terms
    rough : Terms
        The same from a coarser mesh: the difference shows the error.
    edited : bool
        Whether the rig is from a file that was changed since partialslip wrote it.
    """

    key: str
    reach: float
    terms: Terms
    rough: Terms
    edited: bool = False

    @property
    def note(self) -> str:
        """Remark for the reader of a result with an edited rig; empty otherwise."""
        said = (
            "the file of bodies.equivalent was edited since partialslip wrote it; the results are those of its numbers"
        )
        return said if self.edited else ""

    @property
    def uncoupled(self) -> "Rig":
        """The rig without what p does along x and q along y."""
        terms, rough = (each._replace(xy=0 * each.xy, lower_xy=0 * each.xy) for each in (self.terms, self.rough))
        return replace(self, terms=terms, rough=rough)

    @property
    def coarser(self) -> "Rig":
        """The rig from the coarser mesh."""
        return replace(self, terms=self.rough)

    def moments(self, x: Array, forces: Array) -> Array:
        """Moments sum (x/reach)^j F_j of ``forces`` (..., n) at ``x`` (n,), (..., k)."""
        return forces @ self.powers(x)

    def powers(self, x: Array) -> Array:
        """Powers (x/reach)^j, (n, k), at ``x`` (n,), m."""
        return np.asarray(polynomial.polyvander(x / self.reach, len(self.terms.xx) - 1), float)

    def slopes(self, x: Array, coefficients: Array) -> Array:
        """Derivatives by x, (..., n), at ``x`` (n,), m, of polynomials with the ``coefficients`` (..., k)."""
        powers = np.arange(1, len(self.terms.xx))
        return (coefficients[..., 1:] * powers) @ self.powers(x)[:, :-1].T / self.reach

    def opening(self, p: Array, q: Array) -> Array:
        """Coefficients (..., k) of v/A under tractions with the moments ``p`` and ``q`` (..., k)."""
        return p @ self.terms.yy + q @ self.terms.xy

    def shift(self, p: Array, q: Array) -> Array:
        """Coefficients (..., k) of u/A under tractions with the moments ``p`` and ``q`` (..., k)."""
        return q @ self.terms.xx + p @ self.terms.xy.T

    def shares(self, p: Array, q: Array) -> tuple[Array, Array]:
        """Shares (2, ..., k) of the lower and the upper body in :meth:`shift` and in :meth:`opening` under tractions
        with the moments ``p`` and ``q`` (..., k)."""
        of = self.terms
        shift, opening = q @ of.lower_xx + p @ of.lower_xy.T, p @ of.lower_yy + q @ of.lower_xy
        return np.stack([shift, self.shift(p, q) - shift]), np.stack([opening, self.opening(p, q) - opening])


def key_of(scene: Scene) -> str:
    """Checksum of the bodies of ``scene``, their supports and meshes, E, nu and plane, and the profile of a pad.

    Raises
    ------
    InputError
        If a mesh file cannot be read.
    """
    bodies = msgspec.to_builtins(scene.bodies)
    bodies.pop("equivalent", None)
    for name, body in scene.bodies:
        own = bodies[name.removeprefix("bodies.")]
        del own["pivot_height"]  # no body with a rig pivots
        if not body.gripped:  # a given share of Q is part of the loads
            del own["right_grip"]
        for key in ("body", "groups"):  # of a mesh file; files of rigs from before know none
            if own[key] is None:
                del own[key]
        if body.mesh is not None:
            own["mesh"] = checksum(body.mesh, LARGEST_MESH)
    parts = [bodies, scene.material, scene.profile if scene.bodies.pad else None]
    return hashlib.sha256(msgspec.json.encode(parts, order="sorted")).hexdigest()[:16]
