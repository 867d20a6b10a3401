"""The scene: what is in the world. Immutable, validated, SI units; knows nothing of methods.

Signs: positive ``dQ`` and positive ``dsigma`` add up at x -> +a, so that the stick zone moves towards -a.
"""

import itertools
import math
from typing import Annotated, Literal, NamedTuple

import msgspec
import numpy as np
import numpy.typing as npt

from partialslip import views
from partialslip.bodies import Bodies as Bodies
from partialslip.bodies import Body as Body
from partialslip.errors import InputError
from partialslip.table import Positive
from partialslip.table import Table as Table

# Numbers are zero or within these magnitudes, so that products and squares of a few of them stay finite.
SMALLEST, LARGEST = 1e-100, 1e100

WIDTHS = {"half-plane": 16.0, "box": 4096.0}  # half-widths of a block in contact half-widths, as a rule

# What may be off by how many times the accuracy asked for: ends of zones in a, tractions in relative L2.
ALLOWED = {
    **dict.fromkeys(("a", "left", "right", "m", "n"), 1.0),
    "p": 10.0,
    **dict.fromkeys(("q", "q1", "q2"), 15.0),
}

# Errors of q are relative to q's norm, or to so much of f p's norm where q's is less.
LEAST_SHEAR = 1e-3

_ROUGH = 1e-9  # changes of slope and curvature in a table, in the largest one, that are taken for rounding
_SHARP = 0.05
_STEEPEST = 0.9  # sine of the angle to which a pad's round face may go

# What may not be in text that terminals, pages and figures show: control characters, line and paragraph separators,
# marks that turn the direction of writing round, halves of surrogate pairs, and what XML does not allow.
_NO_TEXT = (
    r"\x00-\x1f\x7f-\x9f\u2028\u2029"
    r"\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069"
    r"\ud800-\udfff\ufffe\uffff"
)

Array = npt.NDArray[np.float64]


class Elastic(Table, frozen=True, kw_only=True):
    """Linear elastic, isotropic: Young's modulus ``E`` (Pa) and Poisson's ratio ``nu``."""

    E: Positive
    nu: Annotated[float, msgspec.Meta(ge=-0.9, lt=0.5)]


class Constants(NamedTuple):
    """Shear modulus ``mu``, Pa, and Kolosov's constant ``kappa`` of a plane body."""

    mu: float
    kappa: float

    @property
    def A(self) -> float:
        """(kappa+1)/(2 mu), 1/Pa: the compliance of a pair of such bodies (paper, eq. (5))."""
        return (self.kappa + 1) / (2 * self.mu)


class Material(Elastic, frozen=True, kw_only=True):
    """``E`` and ``nu`` of both bodies, but for one that has its own, ``upper`` or ``lower``; ``plane`` strain or
    stress."""

    plane: Literal["strain", "stress"] = "strain"
    upper: Elastic | None = None
    lower: Elastic | None = None

    @property
    def alike(self) -> bool:
        """Whether both bodies are of one material."""
        return self._constants(self.upper) == self._constants(self.lower)

    @property
    def bodies(self) -> tuple[Constants, Constants]:
        """Of the lower and the upper body."""
        return self._constants(self.lower), self._constants(self.upper)

    @property
    def A(self) -> float:
        """Compliance of the pair, the mean of the two bodies' (kappa+1)/(2 mu), 1/Pa (paper, eq. (5)). A bulk tension
        sigma of the lower body, of compliance A_l, strains the two surfaces relative to each other by A_l sigma/4."""
        lower, upper = self.bodies
        return (lower.A + upper.A) / 2

    def _constants(self, own: Elastic | None) -> Constants:
        """mu = E/(2(1+nu)); kappa = 3-4nu in plane strain, (3-nu)/(1+nu) in plane stress (paper, eq. (6))."""
        E, nu = (self.E, self.nu) if own is None else (own.E, own.nu)
        return Constants(E / (2 * (1 + nu)), 3 - 4 * nu if self.plane == "strain" else (3 - nu) / (1 + nu))


class Hertz(Table, frozen=True, kw_only=True, tag_field="kind", tag="hertz"):
    """Undeformed gap x^2/(2R), with ``R`` the relative radius in m."""

    R: Positive

    @property
    def kinks(self) -> tuple[float, ...]:
        """Where the gap is not smooth, m: nowhere."""
        return ()

    def gap_at(self, x: Array) -> Array:
        """Gap before loading at ``x`` (m), m."""
        result: Array = x**2 / (2 * self.R)
        return result

    @property
    def widest(self) -> float:
        """Half-width of the widest pad of this shape, m."""
        return _STEEPEST * self.R

    def face_at(self, x: Array) -> Array:
        """How far a pad of this shape, a cylinder, lies back at ``x`` (m), m."""
        return _arc(x, self.R)


class FlatRounded(Table, frozen=True, kw_only=True, tag_field="kind", tag="flat-rounded"):
    """A flat of half-width ``b`` (m) with corners of radius ``R`` (m): undeformed gap (|x| - b)^2/(2R) beyond it."""

    R: Positive
    b: Positive

    @property
    def kinks(self) -> tuple[float, ...]:
        """Where the gap is not smooth, m: the ends of the flat."""
        return (-self.b, self.b)

    @property
    def reach(self) -> float:
        """How far the profile is known, m."""
        return math.inf

    def gap_at(self, x: Array) -> Array:
        """Gap before loading at ``x`` (m), m."""
        result: Array = np.maximum(np.abs(x) - self.b, 0.0) ** 2 / (2 * self.R)
        return result

    @property
    def widest(self) -> float:
        """Half-width of the widest pad of this shape, m."""
        return self.b + _STEEPEST * self.R

    def face_at(self, x: Array) -> Array:
        """How far a pad of this shape, whose corners are arcs, lies back at ``x`` (m), m."""
        return _arc(np.maximum(np.abs(x) - self.b, 0.0), self.R)

    def curvature_steps(self) -> tuple[Array, Array]:
        """Where the gap's curvature steps up (|x|, m), and by how much (1/m)."""
        return np.array([self.b]), np.array([1 / self.R])


class Tabulated(Table, frozen=True, kw_only=True, tag_field="kind", tag="tabulated"):
    """An even, convex gap by a table: ``gap`` (m) at ``x`` (m), both from 0 on.

    The slope goes linearly from the middle of each interval, where it is that of the chord, to the next: second-order
    accurate, exact for a parabola, and convex as the table is. Beyond the last middle the curvature stays as it is.
    """

    x: Annotated[tuple[float, ...], msgspec.Meta(min_length=3, max_length=1000)]
    gap: Annotated[tuple[float, ...], msgspec.Meta(min_length=3, max_length=1000)]

    def __post_init__(self) -> None:
        if len(self.x) != len(self.gap):
            raise InputError(f"profile.gap: must have as many numbers as profile.x, {len(self.x)}, not {len(self.gap)}")
        for name, values in (("x", self.x), ("gap", self.gap)):
            if values[0] != 0:
                raise InputError(f"profile.{name}[0] = {values[0]}: must be 0, the middle of the contact")
        for i, (before, x) in enumerate(itertools.pairwise(self.x)):
            if not x > before:
                raise InputError(f"profile.x[{i + 1}] = {x}: must be > {before}, the one before it")
        slopes = np.diff(self.gap) / np.diff(self.x)
        falls = np.flatnonzero(np.diff(slopes, prepend=0.0) < -_ROUGH * max(slopes.max(), 0.0))
        if len(falls):
            x = self.x[falls[0]]
            raise InputError(f"profile.gap: must be convex, a slope that never falls: it does at x = {x}")
        if not slopes[-1] > 0:
            raise InputError("profile.gap: must rise somewhere")

    @property
    def R(self) -> float:
        """Radius of the parabola through the last point, m: a measure of size only."""
        return self.x[-1] ** 2 / (2 * self.gap[-1])

    @property
    def reach(self) -> float:
        """How far the profile is known, m."""
        return self.x[-1]

    @property
    def kinks(self) -> tuple[float, ...]:
        """Where the gap is not smooth, m: where its curvature steps by more than a twentieth of the largest one."""
        at, steps = self.curvature_steps()
        sharp = at[(np.abs(steps) > _SHARP * np.cumsum(steps).max()) & (at > 0)]
        return (*(-sharp[::-1]).tolist(), *sharp.tolist())

    def gap_at(self, x: Array) -> Array:
        """Gap before loading at ``x`` (m), m."""
        at, steps = self.curvature_steps()
        beyond = np.maximum(np.abs(x)[..., None] - at, 0.0)
        result: Array = beyond**2 @ steps / 2
        return result

    @property
    def widest(self) -> float:
        """Half-width of the widest pad of this shape, m."""
        return self.reach

    def face_at(self, x: Array) -> Array:
        """How far a pad of this shape lies back at ``x`` (m), m."""
        return self.gap_at(x)

    def curvature_steps(self) -> tuple[Array, Array]:
        """Where the gap's curvature steps (|x|, m), and by how much (1/m)."""
        x = np.array(self.x)
        middles = np.concatenate([[0.0], (x[1:] + x[:-1]) / 2])
        slopes = np.maximum.accumulate(np.concatenate([[0.0], np.diff(self.gap) / np.diff(x)]))
        curvatures = np.diff(slopes) / np.diff(middles)
        steps = np.diff(curvatures, prepend=0.0)
        real = np.abs(steps) > _ROUGH * curvatures.max()
        return middles[:-1][real], steps[real]


def _arc(x: Array, R: float) -> Array:
    """R - sqrt(R^2 - x^2), without cancellation; not a number beyond the circle."""
    with np.errstate(invalid="ignore"):
        result: Array = x**2 / (R + np.sqrt(R**2 - x**2))
    return result


Profile = Hertz | FlatRounded | Tabulated


class Friction(Table, frozen=True, kw_only=True):
    """Coulomb friction with the coefficient ``f``: |q| <= f p. Without friction (f = 0) any tangential load slides."""

    f: Annotated[float, msgspec.Meta(ge=0, le=1000)]


Turns = Annotated[tuple[float, ...], msgspec.Meta(min_length=2, max_length=1000)]


class Load(Table, frozen=True, kw_only=True):
    """Loads per unit depth, along straight lines from one load point of the cycle to the next.

    ``P`` (N/m) is constant; for Hertz ``a`` (m) or ``p0`` (Pa) may be given instead. ``Q`` (N/m) and ``sigma`` (Pa, the
    difference of the two bodies' bulk tensions) are their values at the load points: as a rule at points 1 and 2,
    between which they cycle in phase, or at more of them. The path begins without shear, goes to the last point, and
    then ``cycles`` times through all of them; methods that follow it take ``steps`` from each to the next, or more.
    """

    P: Positive | None = None
    a: Positive | None = None
    p0: Positive | None = None
    Q: Turns = (0.0, 0.0)
    sigma: Turns = (0.0, 0.0)
    cycles: Annotated[int, msgspec.Meta(ge=1, le=1000)] = 1
    steps: Annotated[int, msgspec.Meta(ge=1, le=1000)] = 1

    def __post_init__(self) -> None:
        others = [values for values in (self.Q, self.sigma) if any(values) or len(values) > 2]
        if len(self.Q) != len(self.sigma) and len(others) > 1:
            raise InputError(f"load.sigma: must have as many numbers as load.Q, {len(self.Q)}, not {len(self.sigma)}")

    @property
    def points(self) -> tuple[tuple[float, float], ...]:
        """(Q, sigma) at the load points of the cycle."""
        count = max(len(self.Q), len(self.sigma))
        Q, sigma = (values if any(values) else (0.0,) * count for values in (self.Q, self.sigma))
        return tuple(zip(Q, sigma, strict=True))

    @property
    def ends(self) -> tuple[int, int]:
        """Indices of load points 1 and 2, the first and the second to be visited: the extremes of the cycle. Where Q
        and sigma are out of phase, those of Q."""
        Q, sigma = np.array(self.points).T
        values = Q if np.ptp(Q) > 0 else sigma
        first, second = sorted((int(np.argmin(values)), int(np.argmax(values))))
        return (first, second) if first != second else (0, len(values) - 1)

    @property
    def in_phase(self) -> bool:
        """Whether Q and sigma go up and down together, on one straight line."""
        Q, sigma = np.array(self.points).T
        first, second = self.ends
        Q, sigma = Q - Q[first], sigma - sigma[first]
        return bool((np.abs(Q * sigma[second] - sigma * Q[second]) <= _ROUGH * np.ptp(Q) * np.ptp(sigma)).all())

    @property
    def dQ(self) -> float:
        """Q2 - Q1, N/m (paper, eq. (2))."""
        first, second = self.ends
        return self.points[second][0] - self.points[first][0]

    @property
    def dsigma(self) -> float:
        """sigma2 - sigma1, Pa (paper, eq. (3))."""
        first, second = self.ends
        return self.points[second][1] - self.points[first][1]

    @property
    def Q_mean(self) -> float:
        """(Q1 + Q2)/2, N/m."""
        first, second = self.ends
        return (self.points[first][0] + self.points[second][0]) / 2

    @property
    def fully_reversed(self) -> bool:
        """Whether Q1 = -Q2 and sigma1 = -sigma2, in phase, so that no mean load is locked in."""
        (Q1, sigma1), (Q2, sigma2) = (self.points[end] for end in self.ends)
        return self.in_phase and Q1 == -Q2 and sigma1 == -sigma2


class Fem(Table, frozen=True, kw_only=True):
    """Settings of the finite-element method.

    ``accuracy`` is asked of a, m and n, as a fraction of a (of m and n in marching, too); ``order`` is the
    polynomial order of the triangles; ``far_field`` says what holds the block's outer boundary: the half-plane's
    displacements under the contact tractions, or a clamped ``box``; ``width`` is the block's half-width in contact
    half-widths. Both are of bodies without a size of their own. ``lower_size`` is the size of the lower body's elements
    in that of the upper body's: with any other than 1 the nodes of the two do not match. ``size`` asks for one mesh of
    that element size, in contact half-widths, all along the contact, instead of refinement to an accuracy. ``factor``
    names what factors the stiffness: as a rule cholmod, if cvxopt is installed.
    """

    accuracy: Annotated[float, msgspec.Meta(ge=1e-9, le=0.1)] = 2e-5
    order: Literal[1, 2, 3, 4] = 4
    far_field: Literal["half-plane", "box"] = "half-plane"
    width: Annotated[float, msgspec.Meta(ge=4, le=1e6)] | None = None
    lower_size: Annotated[float, msgspec.Meta(ge=0.1, le=10)] = 1.0
    size: Annotated[float, msgspec.Meta(ge=1e-4, le=0.5)] | None = None
    factor: Literal["superlu", "cholmod"] | None = None


class Effects(Table, frozen=True, kw_only=True, rename="kebab"):
    """Effects that are forced on (true) or off (false), whatever the scene calls for; see :mod:`partialslip.plan`.

    ``normal``, ``friction``, ``shear``, ``tension``, ``opposing_slip``, ``history``, ``coupling``, ``finite_size``,
    ``far_field``, ``subsurface``; in a scene file with hyphens.
    """

    normal: bool | None = None
    friction: bool | None = None
    shear: bool | None = None
    tension: bool | None = None
    opposing_slip: bool | None = None
    history: bool | None = None
    coupling: bool | None = None
    finite_size: bool | None = None
    far_field: bool | None = None
    subsurface: bool | None = None


class Scene(Table, frozen=True, kw_only=True):
    """A whole scene file, whose keys docs/reference/scene.md lists; :func:`partialslip.load_scene` reads one, and
    :func:`partialslip.parse_scene` makes one from nested tables. Both check it, the constructor does not.

    Its ``name`` (letters, digits, ".", "_" and "-") and ``title``, and the tables ``material``, ``profile``, ``load``,
    ``friction``, ``bodies``, ``fem`` and ``effects``.
    """

    name: Annotated[str, msgspec.Meta(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*\Z", max_length=100)]
    material: Material
    profile: Profile
    load: Load
    friction: Friction
    title: Annotated[str, msgspec.Meta(pattern=rf"^[^{_NO_TEXT}]*\Z", max_length=200)] = ""
    bodies: Bodies = Bodies()
    fem: Fem = Fem()
    effects: Effects = Effects()

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
        for name, body in self.bodies:
            if body.kind == "pad" and body.width is not None and body.height is not None:
                self._check_pad(name, body.width, body.height)

    def _check_pad(self, name: str, width: float, height: float) -> None:
        if not width <= 2 * self.profile.widest:
            raise InputError(f"{name}.width = {width}: must be <= {2 * self.profile.widest}, as the profile is")
        if not (edge := float(self.profile.face_at(np.array(width / 2)))) <= _STEEPEST * height:
            raise InputError(f"{name}.height = {height}: must be > {edge / _STEEPEST:g}, as its face goes back so far")

    def _repr_html_(self) -> str:
        return views.html(self)

    @property
    def mirrored(self) -> bool:
        """Whether the two bodies are mirror images of each other."""
        return self.material.alike and self.bodies.upper == self.bodies.lower

    @property
    def finite(self) -> bool:
        """Whether a body is finite."""
        return self.bodies != Bodies()

    @property
    def slides(self) -> bool:
        """Whether friction cannot carry Q: no forces within the bound could sum to it."""
        return not self.free and max(abs(Q) for Q, _ in self.load.points) >= self.friction.f * self.P

    @property
    def free(self) -> bool:
        """Whether there is neither friction nor shear force: nothing sticks, and nothing drives the bodies apart."""
        return self.friction.f == 0 and not any(Q for Q, _ in self.load.points)

    @property
    def meshed(self) -> bool:
        """Whether a body's mesh is given."""
        return any(body.mesh is not None for _, body in self.bodies)

    def gap_at(self, x: Array) -> Array:
        """Gap before loading at ``x`` (m), m: the profile's, and of a pad the true distance of its face."""
        return self.profile.face_at(x) if self.bodies.pad else self.profile.gap_at(x)

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
