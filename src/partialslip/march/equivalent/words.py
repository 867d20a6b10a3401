"""The data of equivalent half-planes in words."""

from typing import NamedTuple

import numpy as np

from partialslip.halfplane.contact import contact
from partialslip.march.equivalent.data import HalfPlaneData
from partialslip.result.rig import Rig
from partialslip.scene import Hertz, Scene

_ROUNDING = 1e-10  # display: of terms


class Share(NamedTuple):
    """What a unit of a load adds to half-planes.

    Parameters
    ----------
    load : str
        P, Q or sigma.
    unit : str
        Unit of the load, SI.
    curvature, tilt : float
        Curvature (1/m) and slope (rad) of the gap at x = 0.
    sigma, sigma_slope : float
        Tension at x = 0 (Pa) and its slope (Pa/m).
    """

    load: str
    unit: str
    curvature: float
    tilt: float
    sigma: float
    sigma_slope: float


def shares(rig: Rig, scene: Scene) -> tuple[Share, ...]:
    """What units of P and Q at x = 0, and of sigma, add to half-planes; 0 for what is not more than the rig's error.

    Parameters
    ----------
    rig : Rig
    scene : Scene
        A scene with the bodies of the rig.
    """
    fine, rough = _shares(rig, scene), _shares(rig.coarser, scene)
    return tuple(
        Share(
            *one[:2],
            *(own if abs(own) > abs(own - other) else 0.0 for own, other in zip(one[2:], two[2:], strict=True)),
        )
        for one, two in zip(fine, rough, strict=True)
    )


def _shares(rig: Rig, scene: Scene) -> tuple[Share, ...]:
    A, reach = scene.material.A, rig.reach
    xx, yy, xy, pulled = (np.where(np.abs(terms) > _ROUNDING, terms, 0.0) for terms in rig.terms[:4])
    strain = scene.material.bodies[0].A / 4
    columns = (
        ("P", "N/m", A * yy[:, 0], A * xy[:, 0]),
        ("Q", "N/m", A * xy[0], A * xx[:, 0]),
        ("sigma", "Pa", reach * strain * pulled[1], reach * strain * pulled[0]),
    )
    return tuple(
        Share(load, unit, 2 * v[2] / reach**2, v[1] / reach, -4 / A * u[1] / reach, -8 / A * u[2] / reach**2)
        for load, unit, v, u in columns
    )


def in_words(scene: Scene, seen: Scene, data: HalfPlaneData) -> str:
    """The ``data`` of the half-planes ``seen`` that stand for the bodies of ``scene``, in a line."""
    units, (first, second) = scene.units, scene.load.ends
    if isinstance(scene.profile, Hertz) and isinstance(seen.profile, Hertz):
        bent = f"R = {units.length(seen.profile.R)}, not {units.length(scene.profile.R)}"
    else:
        more = float(data.curvature.mean()) * units.size("m")
        bent = f"a gap of {more:.4g} 1/{units.label('m')} more curvature"
    told = [bent]
    ends = [(first, "1"), (second, "2")]
    if np.ptp(data.sigma - [sigma for _, sigma, *_ in scene.load.points]) or np.any(data.sigma_slope):
        grows = np.abs(data.sigma_slope).max() * contact(seen, seen.pressing[0]).a
        rounding = _ROUNDING * max(np.abs(data.sigma).max(), grows)
        sigma = np.where(np.abs(data.sigma) > rounding, data.sigma, 0.0)
        values = " and ".join(units.labelled(float(sigma[end]), "Pa", 4) for end, _ in ends)
        slopes = " and ".join(units.labelled(float(data.sigma_slope[end]), "Pa/m", 4) for end, _ in ends)
        told.append(f"sigma = {values} at load points 1 and 2, growing along x by {slopes}")
    if data.tilt.any():
        turned = " and ".join(f"{float(data.tilt[end]):.4g}" for end, _ in ends)
        told.append(f"turned by {turned} rad")
    return f"the bodies act like half-planes with {'; '.join(told)}"
