"""Shear traction of a contact that slides, by Coulomb's law: \\|q\\| = f p."""

from dataclasses import dataclass, replace

from partialslip.arrays import Array
from partialslip.result.traction import Traction


@dataclass(frozen=True)
class Sliding:
    """Shear of a contact that slides at both load points: q = ``signs`` f p, with the pressure of ``traction``.

    Parameters
    ----------
    traction : Traction
        The pressure counts.
    f : float
    signs : (int, int)
        Signs of q at load points 1 and 2.
    """

    traction: Traction
    f: float
    signs: tuple[int, int]

    def levels_at(self, x: Array) -> tuple[Array, Array]:
        """q1 and q2 at ``x`` (m), Pa."""
        of = self.traction
        p1, p2 = of.pressures_at(x) if of.pressures_at else (of.at(x)[0],) * 2
        return self.signs[0] * self.f * p1, self.signs[1] * self.f * p2

    def at(self, x: Array) -> tuple[Array, Array]:
        """p at load point 2 and dq at ``x`` (m), Pa."""
        q1, q2 = self.levels_at(x)
        return self.traction.at(x)[0], q2 - q1


def sliding(traction: Traction, f: float, signs: tuple[int, int]) -> Traction:
    """Return ``traction`` with the shear of a contact that slides at both load points, in the directions ``signs``."""
    slides = Sliding(traction, f, signs)
    q1, q2 = slides.levels_at(traction.x)
    return replace(traction, dq=q2 - q1, q1=q1, q2=q2, at=slides.at, levels_at=slides.levels_at)
