"""Contact half-widths: how far the contact reaches under a normal force."""

import math

from partialslip.halfplane.shape import FlatRounded, Hertz, Shape, root
from partialslip.scene import Hertz as HertzProfile
from partialslip.scene import Scene


def contact(scene: Scene) -> tuple[float, Shape]:
    """Contact half-width a (m) and the shape of the pressure.

    Hertz: P = pi a^2/(2 A R). Flat and rounded (Ciavarella, Hills and Monno, 1998), with b = a cos(psi):
    P = a^2/(A R) (psi - sin(psi) cos(psi)).
    """
    A, R, P = scene.material.A, scene.profile.R, scene.P
    if isinstance(scene.profile, HertzProfile):
        return math.sqrt(2 * A * R * P / math.pi), Hertz()
    b = scene.profile.b
    load = A * R * P / b**2

    def excess(log_psi: float) -> float:
        psi = math.exp(log_psi)
        # psi - sin(psi) cos(psi) cancels in a contact hardly wider than its flat
        rest = 2 / 3 * psi**3 * (1 - psi**2 / 5) if psi < 1e-3 else psi - math.sin(psi) * math.cos(psi)
        return load - rest / math.cos(psi) ** 2

    psi = math.exp(root(excess, -60.0, math.log(math.pi / 2)))
    return b / math.cos(psi), FlatRounded(math.cos(psi))
