"""The error that a coarse table of the profile itself makes."""

import numpy as np
from msgspec.structs import replace

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.halfplane.contact import Contact, contact
from partialslip.halfplane.loading import Loading, loading
from partialslip.scene import Scene, Tabulated

_LESS = 3.0  # halving the spacing of a table of second order leaves a quarter: the rest is a third of the change
_FEWEST = 5
_NODES = 200


def table_error(scene: Scene, pressed: Contact, cycle: Loading | None) -> dict[str, float]:
    """Estimate what the spacing of a tabulated profile does to a, m, n (fractions of a), p and q (relative L2).

    Richardson's: the same with every second point of the table. A table is of second order in its spacing, so that a
    third of the difference is left. Empty for other profiles, and where half of the points make no contact.

    Parameters
    ----------
    scene : Scene
    pressed : Contact
        The contact of ``scene``.
    cycle : Loading, optional
        The change of the loads over half a cycle; None where the contact slides.
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
    x, weights = -a * np.cos(angle), np.sin(angle)
    errors = {"a": abs(other.a - a) / a, "p": _apart(pressed.pressure(x), other.pressure(x), weights)}
    if cycle and not cycle.nothing:
        f, load = scene.friction.f, scene.load
        its = loading(other, f, load.dQ, load.dsigma, bound=2)
        ends, moved = np.array(cycle.ends), np.array(its.ends) * other.a / a
        errors["m"], errors["n"] = np.abs(moved - ends).tolist()
        dq, its_dq = pressed.p0 * cycle.traction(x / a), other.p0 * its.traction(x / other.a)
        errors["q"] = _apart(dq, its_dq, weights)
    return {key: error / _LESS for key, error in errors.items()}


def _every_second(scene: Scene) -> Scene | None:
    """The scene with every second point of its table, and the last one; None if there is no table, or too short."""
    profile = scene.profile
    if not isinstance(profile, Tabulated) or len(profile.x) < _FEWEST:
        return None
    count = len(profile.x)
    kept = sorted({*range(0, count, 2), count - 1})
    x, gap = (tuple(values[i] for i in kept) for values in (profile.x, profile.gap))
    return replace(scene, profile=Tabulated(x=x, gap=gap))


def _apart(values: Array, others: Array, weights: Array) -> float:
    return float(np.sqrt((values - others) ** 2 @ weights / (values**2 @ weights)))
