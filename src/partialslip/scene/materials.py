"""Materials: elastic constants of the two bodies."""

from typing import Annotated, Literal, NamedTuple

import msgspec

from partialslip.scene.table import Positive, Table


class Elastic(Table, frozen=True, kw_only=True):
    """Isotropic linear elasticity: Young's modulus ``E`` (Pa) and Poisson's ratio ``nu``."""

    E: Positive
    nu: Annotated[float, msgspec.Meta(ge=-0.9, lt=0.5)]


class Constants(NamedTuple):
    """Shear modulus ``mu`` (Pa) and Kolosov's constant ``kappa`` of a plane body."""

    mu: float
    kappa: float

    @property
    def A(self) -> float:
        """Compliance (kappa+1)/(2 mu) of a pair of such bodies, 1/Pa (paper, eq. (5))."""
        return (self.kappa + 1) / (2 * self.mu)


class Material(Elastic, frozen=True, kw_only=True):
    """``E`` and ``nu`` of both bodies; ``upper`` or ``lower`` replaces the constants of one body. ``plane``: strain or
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
        return Constants(E / (2 * (1 + nu)), 3 - 4 * nu if self.plane == "strain" else (3 - nu) / (1 + nu))
