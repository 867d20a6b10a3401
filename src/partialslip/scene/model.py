"""The scene as a whole. Signs: positive ``dQ`` and positive ``dsigma`` add up at x -> +a, so that the stick zone moves
towards -a."""

import math
from typing import Annotated

import msgspec
import numpy as np

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.scene.bodies import Bodies
from partialslip.scene.limits import LARGEST, NO_TEXT, SMALLEST, STEEPEST
from partialslip.scene.loads import Load
from partialslip.scene.materials import Material
from partialslip.scene.profiles import Hertz, Profile
from partialslip.scene.settings import Effects, Fem
from partialslip.scene.table import Table
from partialslip.units import UNITS, System, Units


class Friction(Table, frozen=True, kw_only=True):
    """Coulomb friction with the coefficient ``f``: |q| <= f p. With f = 0 any shear force makes the contact slide."""

    f: Annotated[float, msgspec.Meta(ge=0, le=1000)]


class Scene(Table, frozen=True, kw_only=True):
    """Contents of a scene file; docs/reference/scene.md lists the keys.

    :func:`partialslip.load_scene` reads a scene from a file, :func:`partialslip.parse_scene` makes one from nested
    tables. Both validate types and ranges; the constructor does not.

    ``name`` (letters, digits, ".", "_" and "-"), ``title``, and the tables ``material``, ``profile``, ``load``,
    ``friction``, ``bodies``, ``fem`` and ``effects``. All numbers are in SI units. ``shown_in``: units of tables,
    reports and CSV files, and of tables to score.
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
        for name, body in self.bodies:
            if body.kind == "pad" and body.width is not None and body.height is not None:
                self._check_pad(name, body.width, body.height)

    def _check_pad(self, name: str, width: float, height: float) -> None:
        if not width <= 2 * self.profile.widest:
            raise InputError(f"{name}.width = {width}: must be <= {2 * self.profile.widest} m, the profile's width")
        if not (edge := float(self.profile.face_at(np.array(width / 2)))) <= STEEPEST * height:
            least = f"{edge / STEEPEST:g} m, as the face recedes by {edge:g} m"
            raise InputError(f"{name}.height = {height}: must be > {least}")

    def _repr_html_(self) -> str:
        from partialslip.report.notebook import html

        return html(self)

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
    def slides(self) -> bool:
        """Whether the contact slides: friction cannot carry Q, |Q| >= f P at a load point."""
        return not self.free and max(abs(Q) for Q, _ in self.load.points) >= self.friction.f * self.P

    @property
    def free(self) -> bool:
        """Whether there is neither friction nor shear force: nothing sticks, and the bodies do not slide."""
        return self.friction.f == 0 and not any(Q for Q, _ in self.load.points)

    @property
    def meshed(self) -> bool:
        """Whether a mesh file is given for a body."""
        return any(body.mesh is not None for _, body in self.bodies)

    def gap_at(self, x: Array) -> Array:
        """Gap before loading at ``x`` (m), m: the profile's gap, or the true distance of a pad's face."""
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
        """Characteristic length sqrt(A R P), m."""
        return math.sqrt(self.material.A * self.profile.R * self.P)
