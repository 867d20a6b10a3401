"""The scene as a whole. Signs: positive ``dQ`` and positive ``dsigma`` add up at x -> +a, so that the stick zone moves
towards -a."""

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import msgspec
import numpy as np
import numpy.typing as npt

from partialslip.scene.bodies import Bodies, Strips
from partialslip.scene.loads import Load
from partialslip.scene.materials import Material
from partialslip.scene.profiles import FlatRounded, Hertz, Profile
from partialslip.scene.settings import Effects, Fatigue, Fem
from partialslip.scene.table import LARGEST, NO_TEXT, ROUGH, SMALLEST, STEEPEST, Table
from partialslip.scene.tolerance import Tolerance, inputs
from partialslip.scene.units import UNITS, System, Units
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError
from partialslip.tools.shown import Notebook, short

# limit: Largest distance of P's line of action from x = 0, in sqrt(A R P): the rounding of x^2 is below 1e-9.
_FARTHEST = 1e3
_SHARP = 1e-2  # accuracy: jump of the slope of f, in f over a length, from which on its kink counts


Coefficients = Annotated[
    tuple[Annotated[float, msgspec.Meta(gt=0, le=1000)], ...], msgspec.Meta(min_length=2, max_length=100)
]


class Pressing(NamedTuple):
    """Normal force ``P`` (N/m), and moment ``M`` (N) of the pressure about x = 0, None if the bodies do not turn."""

    P: float
    M: float | None

    def towards(self, other: "Pressing", share: float) -> "Pressing":
        """P and M at the ``share``, from 0 to 1, of the straight way to the ``other``."""
        if share in (0.0, 1.0):
            return other if share else self
        M = None if self.M is None or other.M is None else self.M + share * (other.M - self.M)
        return Pressing(self.P + share * (other.P - self.P), M)


class Friction(Table, frozen=True, kw_only=True):
    """Coulomb friction with the coefficient ``f``: |q| <= f p. With f = 0 any shear force makes the contact slide.

    Where f varies along the contact, it is given as numbers at ``x`` (m, ascending), between which it is linear; beyond
    the first and the last x it stays. The property ``f`` is then the largest of them, the unit of tractions.
    """

    given: Annotated[float, msgspec.Meta(ge=0, le=1000)] | Coefficients = msgspec.field(name="f")
    x: Annotated[tuple[float, ...], msgspec.Meta(min_length=2, max_length=100)] | None = None

    if TYPE_CHECKING:  # keys are those of a scene file

        def __init__(self, *, f: float | Sequence[float], x: Sequence[float] | None = None) -> None: ...

    def __post_init__(self) -> None:
        if not isinstance(self.given, tuple):
            if self.x is not None:
                raise InputError("friction.x: must be left out where friction.f is one number")
            return
        if self.x is None:
            raise InputError("friction.x: missing; must give the places of the numbers of friction.f")
        if len(self.x) != len(self.given):
            raise InputError(
                f"friction.x: must have as many numbers as friction.f, {len(self.given)}, not {len(self.x)}"
            )
        for i, (before, x) in enumerate(itertools.pairwise(self.x)):
            if not x > before:
                raise InputError(f"friction.x[{i + 1}] = {x}: must be > friction.x[{i}] = {before}")

    @property
    def f(self) -> float:
        """Coefficient of friction; the largest where it varies."""
        return max(self.given) if isinstance(self.given, tuple) else self.given

    @property
    def varies(self) -> bool:
        """Whether the coefficient varies along the contact."""
        return isinstance(self.given, tuple) and len(set(self.given)) > 1

    @property
    def kinks(self) -> tuple[float, ...]:
        """Places at which the coefficient is not smooth, m."""
        return self.x if self.varies and self.x else ()

    @property
    def jumps(self) -> Array:
        """Jumps of the slope of the coefficient at its kinks, over the largest coefficient, (k,), 1/m."""
        x = np.array(self.kinks)
        slopes = np.diff(np.asarray(self.at(x)) / self.f) / np.diff(x) if len(x) else x
        return np.abs(np.diff(slopes, prepend=0.0, append=0.0))[: len(x)]

    def sharp_kinks(self, length: float) -> tuple[float, ...]:
        """Kinks, m, at which the slope jumps by more than a hundredth of f over the ``length`` (m): a fit of the shear
        traction over such a length must not reach across them."""
        return tuple(np.array(self.kinks)[self.jumps * length > _SHARP].tolist())

    @property
    def shown(self) -> str:
        """The coefficient as text."""
        return f"{min(self.given):.10g} to {self.f:.10g}" if self.varies else f"{self.f:.10g}"  # type: ignore[arg-type]

    def at(self, x: npt.ArrayLike) -> Array:
        """Coefficient at ``x`` (m, of any shape)."""
        x = np.asarray(x, float)
        return np.interp(x, self.kinks, self.given) if self.varies else np.full(x.shape, self.f)


def require_carried(Q: Sequence[float], most: float) -> None:
    """Raise InputError if friction, which carries at ``most`` int f p dx, does not carry all of ``Q`` (any unit).

    Where f is one number the scene knows this: :attr:`Scene.slides`. Where f varies along x, the pressure tells.
    """
    largest = max(map(abs, Q), default=0.0)
    if largest > most * (1 + ROUGH):
        carried = f"{most / largest:.4g} of its largest value"
        raise InputError(f"friction.f: must carry load.Q: it carries {carried}, and the contact slides")


class Scene(Notebook, Table, frozen=True, kw_only=True):
    """Contents of a scene file; docs/reference/scene.md lists the keys.

    :func:`partialslip.load_scene` reads a scene from a file, :func:`partialslip.parse_scene` makes one from nested
    tables. The constructor takes the tables of :mod:`partialslip.scene`, or mappings. All of them validate types and
    ranges and raise InputError with the same one line. A scene is immutable: :meth:`replace` makes a changed one.

    ``name`` (letters, digits, ".", "_" and "-"), ``title``, and the tables ``material``, ``profile``, ``load``,
    ``friction``, ``bodies``, ``fem``, ``effects``, ``fatigue`` and ``tolerance``. All numbers are in SI units.
    ``shown_in``: units of tables, reports and CSV files, and of tables to score.
    """

    name: Annotated[str, msgspec.Meta(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*\Z", max_length=100)]
    material: Material
    profile: Profile
    load: Load
    friction: Friction
    title: Annotated[str, msgspec.Meta(pattern=rf"^[^{NO_TEXT}]*\Z", max_length=200)] = ""
    bodies: Bodies = Bodies()
    fem: Fem = Fem()
    effects: Effects = Effects()
    fatigue: Fatigue = Fatigue()
    tolerance: Tolerance | None = None
    shown_in: System = "SI"

    def __post_init__(self) -> None:
        given = [key for key in ("P", "a", "p0") if getattr(self.load, key) is not None]
        if len(given) != 1:
            raise InputError(f"load: exactly one of P, a, p0 must be given, not {' and '.join(given) or 'none'}")
        if given != ["P"] and not isinstance(self.profile, Hertz):
            raise InputError(f"load.{given[0]}: must be given only for the profile hertz; give load.P")
        try:
            derived = self.P, self.length
        except (OverflowError, ZeroDivisionError):
            derived = math.nan, math.nan
        if not all(SMALLEST <= value <= LARGEST for value in derived):
            value = getattr(self.load, given[0])
            sizes = f"from {SMALLEST} to {LARGEST} with this E and R"
            raise InputError(f"load.{given[0]} = {value!r}: must give P and sqrt(A R P) {sizes}")
        self._check_moment()
        if self.load.displacement is not None:
            self._check_driven(self.load.shown("displacement"))
        if self.finite and any(self.load.sigma_slope):
            raise InputError(
                f"load.sigma_slope = {self.load.shown('sigma_slope')}: must be 0 or left out with finite bodies"
            )
        if self.finite and self.fatigue.sigma_upper is not None:
            raise InputError(
                f"fatigue.sigma_upper = {list(self.fatigue.sigma_upper)}: must be left out with finite bodies"
            )
        if self.bodies.pad and isinstance(self.profile, FlatRounded) and self.profile.crown is not None:
            raise InputError(f"profile.crown = {self.profile.crown}: must be left out with a pad, {self.bodies.pad}")
        for name, body in self.bodies:
            if body.kind == "pad" and body.width is not None and body.height is not None:
                self._check_pad(name, body.span, body.height)
        inputs(self)

    def _check_driven(self, displacement: str) -> None:
        """Raise InputError if plates cannot drive the bodies."""
        if self.bodies.upper is None or self.bodies.lower is None:
            why = "bodies.upper and bodies.lower; a half-plane has no plate, and its displacement is infinite"
            raise InputError(f"load.displacement = {displacement}: must be given only with {why}")
        if self.friction.f == 0:
            raise InputError(f"friction.f = {self.friction.shown}: must be > 0 with load.displacement")
        if share := self.bodies.lower.right_share:
            instead = "must be 'stiffness' or left out with load.displacement; it is a share of a given Q"
            raise InputError(f"bodies.lower.right_grip = {share}: {instead}")

    def _check_moment(self) -> None:
        """Raise InputError if a moment is given to bodies that do not turn, or an uneven gap to a pad."""
        key = next((key for key in ("M", "e") if getattr(self.load, key) is not None), None)
        if (pivots := self.bodies.pivots) and not self.profile.turns:
            raise InputError(f"{pivots}.support = 'pivot': must not be given with profile.tilt = 'fixed'")
        if key and not self.profile.turns:
            raise InputError(f"load.{key} = {self.load.shown(key)}: must not be given with profile.tilt = 'fixed'")
        still = ""  # bodies that do not turn
        if self.finite:
            still = "" if pivots else "finite bodies, whose plates do not turn; one must have support 'pivot'"
        elif not self.material.alike:
            still = "bodies of different materials, which are not turned"
        if key and still:
            raise InputError(f"load.{key} = {self.load.shown(key)}: must not be given with {still}")
        if not self.profile.even and self.profile.turns and still:
            raise InputError(f"profile.tilt = 'free': must be 'fixed' with {still}")
        if not self.profile.even and self.bodies.pad:
            raise InputError(f"{self.bodies.pad}.kind = 'pad': must be 'block' with a profile that is not even")

        lines = [abs((moment or 0.0) / force) for force, moment in self.pressing]
        if key and not max(lines) <= (most := _FARTHEST * self.length):
            near = f"must keep the line of action of P within {most:g} m of x = 0"
            raise InputError(f"load.{key} = {self.load.shown(key)}: {near}")

    def require_even(self, purpose: str, instead: str = "") -> None:
        """Raise InputError if the pressure of half-planes is not even, or the tension varies along x, which the
        ``purpose`` (in words) needs; ``instead`` says what takes a gap that is not even."""
        if not self.profile.even:
            raise InputError(f"profile.x: must begin at 0 {purpose}; only even gaps{instead and '; '}{instead}")
        for key in ("M", "e", "sigma_slope"):
            if np.any(getattr(self.load, key) or 0.0):
                raise InputError(f"load.{key} = {self.load.shown(key, self.units)}: must be 0 or left out {purpose}")

    def require_no_moment(self, purpose: str) -> None:
        """Raise InputError if the bodies turn, which the ``purpose`` (in words) does not know: those of an uneven gap,
        or under a moment."""
        if not self.even and self.M is not None:
            key = "load.e" if self.load.e is not None else "load.M" if self.load.M is not None else "profile.tilt"
            raise InputError(f"{key}: must be left out {purpose}, which are not turned")

    def require_uniform_friction(self, purpose: str) -> None:
        """Raise InputError if the coefficient of friction varies along x, which the ``purpose`` (in words) does not
        know."""
        if self.friction.varies:
            raise InputError(f"friction.f = {self.friction.shown}: must be one number {purpose}")

    def _check_pad(self, name: str, width: float, height: float) -> None:
        if not width <= 2 * self.profile.widest:
            raise InputError(f"{name}.width = {width}: must be <= {2 * self.profile.widest:g} m, the profile's width")
        if not (edge := float(self.profile.face_at(np.array(width / 2)))) <= STEEPEST * height:
            least = f"{edge / STEEPEST:g} m, as the face recedes by {edge:g} m"
            raise InputError(f"{name}.height = {height}: must be > {least}")

    def __repr__(self) -> str:
        """Name and title, then a line for each table that is not the default."""
        title = f"{self.name}: {self.title}" if self.title else self.name
        entries = (getattr(self, key) for key in self.__struct_fields__)
        tables = (
            each for each in entries if isinstance(each, Table) and each not in (Bodies(), Fem(), Effects(), Fatigue())
        )
        return "\n  ".join([f"Scene {title}", *map(short, tables)])

    def replace(self, changes: Mapping[str, Any] | None = None, /, **tables: Any) -> "Scene":
        """Return a changed scene, validated like a scene file.

        ``scene.replace(load={"Q": [-2e4, 2e4]}, friction={"f": 0.4}, name="mine")`` changes keys of tables and keeps
        the other keys. None unsets a key: ``load={"P": None, "a": 2e-4}``. A profile of another kind replaces the
        profile. A table such as :class:`partialslip.scene.Load` replaces the whole table.

        Parameters
        ----------
        changes : mapping, optional
            Values by dotted key, ``{"friction.f": 0.4}``. ``*`` stands for any one table: ``bodies.*.width``.
        **tables
            Keys and values by table; values of ``name`` and ``title``.

        Raises
        ------
        InputError
            With the same line as for a scene file.
        """
        from partialslip.scene.reading import changed

        given = changes if changes is not None else {}
        return changed(self, {**given, **tables} if isinstance(given, Mapping) else given)

    @property
    def units(self) -> Units:
        """Units in which the scene and its results are shown; all numbers of the scene itself are in SI units."""
        return UNITS[self.shown_in]

    @property
    def mirrored(self) -> bool:
        """Whether the two bodies are mirror images of each other."""
        return self.material.alike and self.bodies.upper == self.bodies.lower

    @property
    def finite(self) -> bool:
        """Whether a body is finite."""
        return self.bodies != Bodies()

    @property
    def strips(self) -> Strips | None:
        """The bodies, if they are two equal long strips of one material, which exact and march solve as such: unless a
        pressure that varies drags them."""
        found = self.bodies.strips if self.material.alike else None
        return None if found and self.presses_anew and len(set(found.held)) > 1 else found

    @property
    def sized(self) -> bool:
        """Whether a body has a size that exact and march do not know: in its place they solve half-planes."""
        return self.finite and not self.strips

    @property
    def half_planes(self) -> "Scene":
        """The scene with half-planes in the place of its bodies."""
        return self.replace(bodies=Bodies(), effects={"finite-size": None})

    def at_right_grip(self, Q: npt.ArrayLike, sigma: npt.ArrayLike) -> Array:
        """Tension on the right side of a ``pulled`` body, Pa: the bulk tension ``sigma`` (Pa), and what the grip there
        carries of the shear force ``Q`` (N/m) by a given share, of any shape."""
        tension, lower = np.asarray(sigma, float), self.bodies.lower
        if lower is None or not lower.right_share:
            return tension
        height = (lower.holder.height if lower.holder else lower.height) or 0.0
        return tension + lower.right_share * np.asarray(Q, float) / height

    @property
    def left_gripped(self) -> "Scene":
        """The scene with the tension of :meth:`at_right_grip` as sigma, and no given share of Q on the right
        side."""
        if self.bodies.lower is None or not self.bodies.lower.right_share:
            return self
        return self._gripped(None, self.at_right_grip(*zip(*self.load.points, strict=True)).tolist())

    @property
    def evenly_gripped(self) -> "Scene":
        """The scene of strips whose grips carry half of Q each, with the tension that other shares add as sigma; a
        scene without strips as it is."""
        if not self.strips or not self.strips.skew:
            return self
        return self._gripped(0.5, [sigma + self.strips.skew * Q for Q, sigma in self.load.points])

    def _gripped(self, share: float | None, sigma: Sequence[float]) -> "Scene":
        """The scene with the ``share`` of Q on the right side of the lower body, and ``sigma`` at the load points."""
        assert self.bodies.lower
        lower = msgspec.structs.replace(self.bodies.lower, right_grip=share)
        return msgspec.structs.replace(
            self,
            load=msgspec.structs.replace(self.load, sigma=tuple(sigma)),
            bodies=msgspec.structs.replace(self.bodies, lower=lower),
        )

    @property
    def pin(self) -> float | None:
        """Height of the pin of a body that pivots over the contact line, m, negative for the lower body; None if no
        body pivots. The moment of pressure and shear about it is M."""
        return None if self.effects.moment is False else self.bodies.pin

    @property
    def slides(self) -> bool:
        """Whether the contact slides: friction cannot carry Q, |Q| >= f P at a load point. Plates that are moved by
        displacements never let it: a contact that slides is refused where it is solved."""
        if self.load.displacement is not None:
            return False
        pairs = zip(self.load.points, self.pressing, strict=True)
        return not self.free and any(abs(Q) >= self.friction.f * P for (Q, _), (P, _) in pairs)

    @property
    def sliding_signs(self) -> tuple[int, int] | None:
        """Signs of q at load points 1 and 2 of a contact that slides at both; None if it sticks at one of them."""
        Q1, Q2 = (self.load.points[end][0] for end in self.load.ends)
        limits = (self.friction.f * P for P, _ in self.end_pressing)
        if self.free or any(abs(Q) < limit for Q, limit in zip((Q1, Q2), limits, strict=True)):
            return None
        return (Q1 > 0) - (Q1 < 0), (Q2 > 0) - (Q2 < 0)

    @property
    def free(self) -> bool:
        """Whether there is neither friction nor shear force: nothing sticks, and the bodies do not slide."""
        return self.friction.f == 0 and not any(self.load.driving)

    @property
    def meshed(self) -> bool:
        """Whether a mesh file is given for a body."""
        return any(body.mesh is not None for _, body in self.bodies)

    def gap_at(self, x: npt.ArrayLike) -> Array:
        """Gap before loading at ``x`` (m, of any shape), m: the profile's gap, or the true distance of a pad's face."""
        x = np.asarray(x, float)
        return self.profile.face_at(x) if self.bodies.pad else self.profile.gap_at(x)

    @property
    def pressing(self) -> tuple[Pressing, ...]:
        """P and M at the load points."""
        load, A, R = self.load, self.material.A, self.profile.R
        a = load.a if load.a is not None else (load.p0 or 0.0) * A * R
        loads = load.pressing(math.pi * a**2 / (2 * A * R) if load.P is None else 0.0)
        turns = self.profile.turns and self.effects.moment is not False
        return tuple(Pressing(P, M if turns else None) for P, M in loads)

    @property
    def end_pressing(self) -> tuple[Pressing, Pressing]:
        """P and M at load points 1 and 2."""
        (first, second), pressing = self.load.ends, self.pressing
        return pressing[first], pressing[second]

    @property
    def presses_anew(self) -> bool:
        """Whether the pressure varies: P varies, or M of bodies that turn."""
        return len(set(self.pressing)) > 1

    @property
    def only_pressed(self) -> bool:
        """Whether no load follows the pressing: Q and sigma are zero, and the pressure does not vary."""
        return not self.presses_anew and not any(map(any, (self.load.driving, *self.load.tension)))

    @property
    def largest(self) -> int:
        """1 or 2, the load point with the larger P. Its a and p0 are those of the scene; 2 if both are equal."""
        first, second = self.end_pressing
        return 1 if first.P > second.P else 2

    @property
    def P(self) -> float:
        """Normal force at the load point :attr:`largest`, N/m; for Hertz P = pi a^2/(2 A R) and p0 = a/(A R)."""
        first, second = self.end_pressing
        return max(first.P, second.P)

    @property
    def M(self) -> float | None:
        """Moment int x p dx of the pressure about x = 0 at the load point :attr:`largest`, N; None if the bodies do not
        turn."""
        return self.end_pressing[self.largest - 1].M

    @property
    def varying(self) -> str:
        """The loads that vary, in words; Q and sigma always count."""
        values = zip("PM", zip(*self.pressing, strict=True), strict=True)
        return "".join(f"{key}, " for key, each in values if len(set(each)) > 1) + "Q and sigma"

    @property
    def even(self) -> bool:
        """Whether the pressure of half-planes is always even in x: an even gap, and no moment."""
        return self.profile.even and not any(M for _, M in self.pressing)

    @property
    def origin(self) -> float:
        """x of the line of action of P, M/P, at the load point :attr:`largest`, m; zero if the bodies do not turn, and
        of finite bodies."""
        return 0.0 if self.finite else (self.M or 0.0) / self.P

    @property
    def length(self) -> float:
        """Characteristic length sqrt(A R P), m."""
        return math.sqrt(self.material.A * self.profile.R * self.P)
