"""Materials: elastic constants of the two bodies."""

from typing import Annotated, Literal, NamedTuple

import msgspec

from partialslip.scene.table import Positive, Table


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
