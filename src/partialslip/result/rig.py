"""A rig: what the size and the supports of two bodies add to the displacements of half-planes, as plain data.

The relative displacements of the two surfaces are u (upper body less lower body, along x) and v (opening, along y), as
in :mod:`partialslip.friction.coulomb_coupled`. Forces q and p per unit depth at t add to those of half-planes

    u = A (xx(x, t) q + xy(x, t) p),    v = A (xy(t, x) q + yy(x, t) p),

where A is the compliance of the pair and xx, yy and xy are polynomials in x/reach and t/reach. They do not depend on
loads, friction or, without a pad, on the profile.
"""

import hashlib
import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, NamedTuple

import msgspec
import numpy as np
from numpy.polynomial import polynomial

from partialslip.scene import Scene
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import LARGEST_MESH, checksum
from partialslip.tools.output.files import write_texts
from partialslip.tools.seal import read_sealed, sealed_text

__path__: list[str] = []  # for the names of its former modules (partialslip.tools.moved)

RIG_SCHEMA = "partialslip/rig/2"
_LARGEST = 2**20  # limit: bytes
_MOST = 64  # limit: terms
_Row = Annotated[list[float], msgspec.Meta(min_length=2, max_length=_MOST)]
_Rows = Annotated[list[_Row], msgspec.Meta(min_length=2, max_length=_MOST)]


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


class _Terms(msgspec.Struct, forbid_unknown_fields=True):
    xx: _Rows
    yy: _Rows
    xy: _Rows
    pulled: _Rows
    lower_xx: _Rows
    lower_yy: _Rows
    lower_xy: _Rows


class _File(msgspec.Struct, forbid_unknown_fields=True, omit_defaults=True):
    schema: str
    key: str
    reach: Annotated[float, msgspec.Meta(gt=0)]
    terms: _Terms
    rough: _Terms
    edited: bool = False  # whether the rig was read from an edited file


def write_rig(rig: Rig, path: str | os.PathLike[str]) -> None:
    """Write ``rig`` to a file at ``path``; a file that is there is replaced.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    terms, rough = (_Terms(*(each.tolist() for each in terms)) for terms in (rig.terms, rig.rough))
    data = _File(RIG_SCHEMA, rig.key, rig.reach, terms, rough, rig.edited)
    write_texts(Path(path).parent, {Path(path).name: sealed_text(data)})


def load_rig(path: str | os.PathLike[str], scene: Scene | None = None) -> Rig:
    """Read a rig from ``path``. If the file was edited since partialslip wrote it, :attr:`Rig.edited` is True, and
    results with the rig have a note.

    Parameters
    ----------
    path : str or path
    scene : Scene, optional
        A scene whose bodies the rig must have.

    Raises
    ------
    InputError
        If the file cannot be read or is not a rig, or is that of other bodies than those of ``scene``.
    """
    found, changed = read_sealed(path, _LARGEST, _File, RIG_SCHEMA, "not a rig", "partialslip equivalent makes it")
    count = len(found.terms.xx)
    terms, rough = (_arrays(f"{path}: {name}", getattr(found, name), count) for name in ("terms", "rough"))
    if scene and found.key != key_of(scene):
        raise InputError(
            f"{path}: this rig has other bodies, supports or materials than {scene.name}; "
            "must be made from them: partialslip equivalent"
        )
    return Rig(found.key, found.reach, terms, rough, bool(changed) or found.edited)


def _arrays(name: str, found: _Terms, count: int) -> Terms:
    shapes = dict.fromkeys(("xx", "yy", "xy", "lower_xx", "lower_yy", "lower_xy"), (count, count)) | {
        "pulled": (2, count)
    }
    arrays = {}
    for key, shape in shapes.items():
        rows = getattr(found, key)
        if len(rows) != shape[0] or any(len(row) != shape[1] for row in rows):
            raise InputError(f"{name}.{key}: must have {shape[0]} rows of {shape[1]} numbers")
        arrays[key] = np.array(rows)
        if key in ("xx", "yy", "lower_xx", "lower_yy") and not np.array_equal(arrays[key], arrays[key].T):
            raise InputError(f"{name}.{key}: must be symmetric")
    return Terms(**arrays)
