"""The scene: what is in the world. Immutable, validated, SI units; knows nothing of methods.

Signs: positive ``dQ`` and positive ``dsigma`` add up at x -> +a, so that the stick zone moves towards -a.
"""

import math
from typing import Annotated, Literal

import msgspec
import numpy as np
import numpy.typing as npt

from partialslip.errors import InputError

Positive = Annotated[float, msgspec.Meta(gt=0)]

# Numbers are zero or within these magnitudes, so that products and squares of a few of them stay finite.
SMALLEST, LARGEST = 1e-100, 1e100


class Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A table of a scene file: immutable, and an unknown key is an error."""


class Material(Table, frozen=True, kw_only=True):
    """Linear elastic, isotropic; both bodies. ``E`` in Pa."""

    E: Positive
    nu: Annotated[float, msgspec.Meta(ge=-0.9, lt=0.5)]
    plane: Literal["strain", "stress"] = "strain"

    @property
    def mu(self) -> float:
        """Shear modulus E/(2(1+nu)), Pa."""
        return self.E / (2 * (1 + self.nu))

    @property
    def kappa(self) -> float:
        """Kolosov's constant: 3-4nu in plane strain, (3-nu)/(1+nu) in plane stress (paper, eq. (6))."""
        return 3 - 4 * self.nu if self.plane == "strain" else (3 - self.nu) / (1 + self.nu)

    @property
    def A(self) -> float:
        """Compliance of the pair, (kappa+1)/(2 mu), 1/Pa (paper, eq. (5)). A bulk tension difference
        sigma strains the two surfaces relative to each other by A sigma/4."""
        return (self.kappa + 1) / (2 * self.mu)


class Hertz(Table, frozen=True, kw_only=True, tag_field="kind", tag="hertz"):
    """Undeformed gap x^2/(2R), with ``R`` the relative radius in m."""

    R: Positive

    @property
    def kinks(self) -> tuple[float, ...]:
        """Where the gap is not smooth, m: nowhere."""
        return ()

    def gap(self, x: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Gap before loading at ``x`` (m), m."""
        return x**2 / (2 * self.R)


class FlatRounded(Table, frozen=True, kw_only=True, tag_field="kind", tag="flat-rounded"):
    """A flat of half-width ``b`` (m) with corners of radius ``R`` (m): undeformed gap (|x| - b)^2/(2R) beyond it."""

    R: Positive
    b: Positive

    @property
    def kinks(self) -> tuple[float, ...]:
        """Where the gap is not smooth, m: the ends of the flat."""
        return (-self.b, self.b)

    def gap(self, x: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """Gap before loading at ``x`` (m), m."""
        return np.maximum(np.abs(x) - self.b, 0.0) ** 2 / (2 * self.R)


Profile = Hertz | FlatRounded


class Friction(Table, frozen=True, kw_only=True):
    """Coulomb friction: |q| <= f p. Without friction (f = 0) any tangential load slides."""

    f: Annotated[float, msgspec.Meta(ge=0, le=1000)]


class Load(Table, frozen=True, kw_only=True):
    """Loads per unit depth. The cycle runs 0 -> point 2 -> point 1 -> point 2 ... with ``Q`` and ``sigma`` in phase.

    ``P`` (N/m) is constant; for Hertz ``a`` (m) or ``p0`` (Pa) may be given instead. ``Q`` (N/m) and ``sigma`` (Pa, the
    difference of the two bodies' bulk tensions) are pairs: their values at load points 1 and 2. Methods that go
    through the history take ``cycles`` of them, and ``steps`` from each load point to the next.
    """

    P: Positive | None = None
    a: Positive | None = None
    p0: Positive | None = None
    Q: tuple[float, float] = (0.0, 0.0)
    sigma: tuple[float, float] = (0.0, 0.0)
    cycles: Annotated[int, msgspec.Meta(ge=1, le=1000)] = 1
    steps: Annotated[int, msgspec.Meta(ge=1, le=1000)] = 1

    @property
    def dQ(self) -> float:
        """Q2 - Q1, N/m (paper, eq. (2))."""
        return self.Q[1] - self.Q[0]

    @property
    def dsigma(self) -> float:
        """sigma2 - sigma1, Pa (paper, eq. (3))."""
        return self.sigma[1] - self.sigma[0]

    @property
    def fully_reversed(self) -> bool:
        """Whether Q1 = -Q2 and sigma1 = -sigma2, so that no mean load is locked in."""
        return self.Q[0] == -self.Q[1] and self.sigma[0] == -self.sigma[1]


class Fem(Table, frozen=True, kw_only=True):
    """Settings of the finite-element method.

    ``accuracy`` is asked of a, m and n, as a fraction of a (of m and n in marching, too); ``order`` is the
    polynomial order of the triangles; ``far_field`` says what holds the block's outer boundary: the half-plane's
    displacements under the contact tractions, or a clamped ``box``; ``width`` is the block's half-width in contact
    half-widths.
    """

    accuracy: Annotated[float, msgspec.Meta(ge=1e-8, le=0.1)] = 2e-5
    order: Literal[2, 3, 4] = 4
    far_field: Literal["half-plane", "box"] = "half-plane"
    width: Annotated[float, msgspec.Meta(ge=4, le=1e6)] | None = None


class Scene(Table, frozen=True, kw_only=True):
    """A whole scene file. See the README for the format; :func:`partialslip.load_scene` reads one, and
    :func:`partialslip.parse_scene` makes one from nested tables. Both check it, the constructor does not."""

    name: Annotated[str, msgspec.Meta(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*\Z", max_length=100)]
    material: Material
    profile: Profile
    load: Load
    friction: Friction
    title: Annotated[str, msgspec.Meta(pattern=r"^[^\x00-\x1f\x7f]*\Z", max_length=200)] = ""
    fem: Fem = Fem()

    def __post_init__(self) -> None:
        given = [key for key in ("P", "a", "p0") if getattr(self.load, key) is not None]
        if len(given) != 1:
            raise InputError(f"load: exactly one of P, a, p0 must be given, not {' and '.join(given) or 'none'}")
        if given != ["P"] and not isinstance(self.profile, Hertz):
            raise InputError(f"load.{given[0]}: only for the profile hertz; give load.P")
        try:
            derived = self.P, self.length
        except (OverflowError, ZeroDivisionError):
            derived = math.nan, math.nan
        if not all(SMALLEST <= value <= LARGEST for value in derived):
            raise InputError(f"load.{given[0]} = {getattr(self.load, given[0])!r}: out of range with this E and R")

    @property
    def P(self) -> float:
        """Normal force, N/m; for Hertz P = pi a^2/(2 A R) and p0 = a/(A R)."""
        A, R = self.material.A, self.profile.R
        if self.load.P is not None:
            return self.load.P
        a = self.load.a if self.load.a is not None else (self.load.p0 or 0.0) * A * R
        return math.pi * a**2 / (2 * A * R)

    @property
    def length(self) -> float:
        """The scene's own length sqrt(A R P), m: the one that dimensional analysis gives."""
        return math.sqrt(self.material.A * self.profile.R * self.P)
