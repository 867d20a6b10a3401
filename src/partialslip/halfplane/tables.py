"""Discretisation error due to the spacing of a tabulated profile."""

import numpy as np
from msgspec.structs import replace

from partialslip.halfplane.change import Change
from partialslip.halfplane.contact import Contact, contact
from partialslip.halfplane.turning import half_cycle
from partialslip.scene import Scene, Tabulated
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

_LESS = 3.0  # accuracy: second order: the error at full spacing is a third of the change from twice the spacing
_FEWEST = 5  # limit: points of a table
_NODES = 200  # accuracy: quadrature points of norms


def table_error(scene: Scene, pressed: Contact, cycle: Change | None) -> dict[str, float]:
    """Estimate the error of a, m, n (fractions of a), p and q (relative L2) due to the spacing of a tabulated profile;
    of a contact that is not even, of its ``left`` and ``right`` end, too.

    Richardson extrapolation: a third of the change if every second point of the table is left out, as a table is of
    second order in the spacing. Empty for other profiles, and if the coarser table cannot be pressed.

    Parameters
    ----------
    scene : Scene
    pressed : Contact
        The contact of ``scene``.
    cycle : Change, optional
        Change of the loads over half a cycle; None if the contact slides.
    """
    try:
        coarse = _every_second(scene)
        other = contact(coarse) if coarse else None
    except InputError:
        return {}
    if coarse is None or other is None:
        return {}
    a = pressed.a
    angle = (np.arange(_NODES) + 0.5) / _NODES * np.pi
    x, weights = pressed.centre - a * np.cos(angle), np.sin(angle)
    errors = {"a": abs(other.a - a) / a, "p": _relative_l2(pressed.pressure(x), other.pressure(x), weights)}
    if not pressed.shape.even:
        moved = other.centre - pressed.centre + (other.a - a) * np.array([-1, 1])
        errors["left"], errors["right"] = (np.abs(moved) / a).tolist()
    if cycle and not cycle.nothing:
        load = scene.load
        coarse_cycle = half_cycle(other, other.f, load.dQ, load.dsigma, load.dslope, parts=False)
        ends, moved = np.array(cycle.ends), pressed.scaled(other.centre + np.array(coarse_cycle.ends) * other.a)
        errors["m"], errors["n"] = np.abs(moved - ends).tolist()
        dq, coarse_dq = (
            each.p0 * way.traction(each.scaled(x)) for each, way in ((pressed, cycle), (other, coarse_cycle))
        )
        errors["q"] = _relative_l2(dq, coarse_dq, weights)
    return {key: error / _LESS for key, error in errors.items()}


def _every_second(scene: Scene) -> Scene | None:
    """Scene with every second point of the table and the last point; None without a table or with a short one."""
    profile = scene.profile
    if not isinstance(profile, Tabulated) or len(profile.x) < _FEWEST:
        return None
    count = len(profile.x)
    kept = sorted({*range(0, count, 2), count - 1})
    x, gap = (tuple(values[i] for i in kept) for values in (profile.x, profile.gap))
    return replace(scene, profile=Tabulated(x=x, gap=gap, tilt=profile.tilt))


def _relative_l2(values: Array, others: Array, weights: Array) -> float:
    return float(np.sqrt((values - others) ** 2 @ weights / (values**2 @ weights)))
