"""Noise of a measured profile: how far it moves the ends of the contact and of the stick zone.

This error is one of the input. It is the same for all methods, and no part of their estimates, bars and verdicts.
"""

from collections.abc import Sequence

import msgspec
import numpy as np

from partialslip.halfplane import contact, stick_zone
from partialslip.scene import Scene
from partialslip.scene.measured import refitted, smoothest
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

COPIES = 20  # limit: of the profile with other noise
_WORTH = 2.0  # cost: smallest factor between smoothing lengths, and between scatters, for which another one is advised


class Noise(msgspec.Struct, frozen=True):
    """Scatter of the results of noisy copies of a measured profile.

    Parameters
    ----------
    copies : int
        Number of copies (:func:`partialslip.refitted`).
    a, m, n : float or None
        Standard deviations, in contact half-widths; None where half-planes have no closed form under these loads.
    smooth : float or None
        A longer ``profile.smooth`` (m) that fits the points as well and scatters less; None if there is none.
    a_then, m_then, n_then : float or None
        Standard deviations with this smoothing length.
    """

    copies: int
    a: float
    m: float | None
    n: float | None
    smooth: float | None = None
    a_then: float | None = None
    m_then: float | None = None
    n_then: float | None = None


def noise_of(scene: Scene, copies: int = COPIES) -> Noise | None:
    """Return the scatter of a, m and n due to the noise of the measured profile of ``scene``. Copies are solved as
    half-planes, in closed form. None if the profile is not measured, or the contact of a copy leaves its table.

    The smoothing length that is advised is half of the longest one, by factors of two, whose gap follows the points
    within the noise.

    Raises
    ------
    InputError
        If the file of the profile cannot be read.
    """
    known = getattr(scene.profile, "measured", None)
    if known is None:
        return None
    if (here := _scatter(refitted(scene, copies))) is None:
        return None
    longer = smoothest(known) / 2
    if longer < _WORTH * known.smooth * (1 - 1e-9):
        return Noise(copies, *here)
    then = _scatter(refitted(scene, copies, smooth=longer))
    worth = then and _worst(here) >= _WORTH * _worst(then)
    return Noise(copies, *here, longer, *then) if then and worth else Noise(copies, *here)


def _scatter(copies: Sequence[Scene]) -> tuple[float, float | None, float | None] | None:
    """Standard deviations of a, m and n, in a; None where a is not known."""
    try:
        found = np.array([_contact_and_stick_ends(copy) for copy in copies])
    except InputError:  # the contact leaves the table
        return None
    a, m, n = (found.std(axis=0, ddof=1) / found[:, 0].mean()).tolist()
    return a, None if np.isnan(m) else m, None if np.isnan(n) else n


def _worst(scatter: tuple[float, float | None, float | None]) -> float:
    return max(each for each in scatter if each is not None)


def _contact_and_stick_ends(scene: Scene) -> Array:
    """a, m and n, m; NaN for m and n without a closed form."""
    pressed, load = contact(scene), scene.load
    ends = np.nan, np.nan
    if load.in_phase and not (scene.presses_anew or scene.free or scene.slides) and scene.material.alike:
        try:
            zone = stick_zone(pressed, pressed.f, load.dQ, load.dsigma, load.dslope)
            ends = float(zone.m), float(zone.n)
        except InputError:  # loads without a closed form
            pass
    return np.array([pressed.a, *ends])
