"""Materials: elastic constants of the two bodies."""

from collections.abc import Iterator
from typing import Annotated, Literal, NamedTuple

import msgspec

from partialslip.scene.table import Positive, Table
from partialslip.tools.errors import InputError

_Nu = Annotated[float, msgspec.Meta(ge=-0.9, lt=0.5)]


class Elastic(Table, frozen=True, kw_only=True):
    """Isotropic linear elasticity: Young's modulus ``E`` (Pa) and Poisson's ratio ``nu``."""

    E: Positive
    nu: _Nu


class Constants(NamedTuple):
    """Shear modulus ``mu`` (Pa) and Kolosov's constant ``kappa`` of a plane body."""

    mu: float
    kappa: float

    @property
    def A(self) -> float:
        """Compliance (kappa+1)/(2 mu) of a pair of such bodies, 1/Pa (paper, eq. (5))."""
        return (self.kappa + 1) / (2 * self.mu)


class Material(Table, frozen=True, kw_only=True):
    """Young's modulus ``E`` (Pa) and Poisson's ratio ``nu`` of both bodies; ``upper`` or ``lower`` replaces the
    constants of one body. ``E`` and ``nu`` may be None if ``upper`` and ``lower`` are given. ``plane``: strain or
    stress."""

    E: Positive | None = None
    nu: _Nu | None = None
    plane: Literal["strain", "stress"] = "strain"
    upper: Elastic | None = None
    lower: Elastic | None = None

    def __post_init__(self) -> None:
        own = [body for body in ("upper", "lower") if getattr(self, body)]
        missing = [key for key in ("E", "nu") if getattr(self, key) is None]
        if len(missing) == 1:
            raise InputError(f"material.{missing[0]}: missing")
        if missing and len(own) == 1:
            other = "lower" if self.upper else "upper"
            raise InputError(f"material.{other}: missing; or give E and nu in material, for the body without its own")
        if missing and not own:
            raise InputError("material.E: missing")

    def __iter__(self) -> Iterator[tuple[str, Elastic]]:
        """Tables of the scene file that hold for a body, by name: one if both bodies share it."""
        tables = [(f"material.{body}", getattr(self, body)) for body in ("lower", "upper")]
        if self.E is not None and self.nu is not None and not all(own for _, own in tables):
            yield "material", Elastic(E=self.E, nu=self.nu)
        yield from ((name, own) for name, own in tables if own)

    @property
    def alike(self) -> bool:
        """Whether both bodies are of one material."""
        lower, upper = self.bodies
        return lower == upper

    @property
    def bodies(self) -> tuple[Constants, Constants]:
        """Elastic constants of the lower and the upper body."""
        return self._constants(self.lower), self._constants(self.upper)

    @property
    def A(self) -> float:
        """Compliance of the pair, the mean of (kappa+1)/(2 mu) over the two bodies, 1/Pa (paper, eq. (5)).

        A bulk tension sigma of the lower body, of compliance A_l, strains the surfaces relative to each other by
        A_l sigma/4.
        """
        lower, upper = self.bodies
        return (lower.A + upper.A) / 2

    def _constants(self, own: Elastic | None) -> Constants:
        """Constants of a body: mu = E/(2(1+nu)); kappa = 3-4nu in plane strain, (3-nu)/(1+nu) in plane stress (paper,
        eq. (6))."""
        E, nu = (self.E, self.nu) if own is None else (own.E, own.nu)
        assert E is not None
        assert nu is not None
        return Constants(E / (2 * (1 + nu)), 3 - 4 * nu if self.plane == "strain" else (3 - nu) / (1 + nu))
