"""Fatigue criteria on the critical plane, as functions of the stress path at points of any shape; SI units."""

from typing import Literal, NamedTuple

import numpy as np

from partialslip.result import Result
from partialslip.study.fatigue.planes import (
    Critical,
    OnPlanes,
    PlaneMeasure,
    critical_plane,
    largest,
    longest_chord,
    range_of,
)
from partialslip.tools.arrays import Array


def with_zz(stress: Array, nu: float, plane: Literal["strain", "stress"] = "strain") -> Array:
    """Return a stress path (s, 4, ...) with the components xx, yy, xy and zz, Pa.

    sigma_zz = nu (sigma_xx + sigma_yy) in plane strain, and 0 in plane stress.

    Parameters
    ----------
    stress : (s, 3, ...) array
        Components xx, yy and xy, Pa.
    nu : float
        Poisson's ratio of the body.
    plane : "strain" or "stress"
    """
    zz = (nu if plane == "strain" else 0.0) * (stress[:, 0] + stress[:, 1])
    return np.concatenate([stress, zz[:, None]], axis=1)


def principal_range(stress: Array) -> Critical:
    """Largest range of the normal stress on any plane, Pa: the largest principal stress range.

    max over planes n and load points i, j of n . (sigma_i - sigma_j) . n, which is the largest principal value of all
    differences of two stresses: a closed form without search (Rayleigh's quotient).

    Parameters
    ----------
    stress : (s, 4, ...) array
        Pa.

    References
    ----------
    As used with critical distances: D. Taylor, Geometrical effects in fatigue: a unifying theoretical model, Int. J.
    Fatigue 21 (1999) 413-420.
    """
    value, angle, tilt = (np.zeros(stress.shape[2:]) for _ in range(3))
    for lag in range(1, len(stress) // 2 + 1):
        xx, yy, xy, zz = np.moveaxis(np.roll(stress, lag, axis=0) - stress, 1, 0)
        middle, half = (xx + yy) / 2, (xx - yy) / 2
        sign = np.where(middle < 0, -1.0, 1.0)  # sigma_j - sigma_i counts as well
        inside = np.abs(middle) + np.hypot(half, xy)
        across = np.abs(zz) > inside
        ranges = np.where(across, np.abs(zz), inside)
        best = ranges.argmax(axis=0)[None]
        here = (ranges, np.arctan2(sign * xy, sign * half) / 2, np.where(across, np.pi / 2, 0.0))
        new, new_angle, new_tilt = (np.take_along_axis(each, best, axis=0)[0] for each in here)
        higher = ~(new <= value)  # NaN stays NaN
        value, angle, tilt = (
            np.where(higher, one, other) for one, other in ((new, value), (new_angle, angle), (new_tilt, tilt))
        )
    return Critical(value, angle, tilt)


def smith_watson_topper(stress: Array, E: float, nu: float) -> Critical:
    """Smith-Watson-Topper parameter, Pa: max over planes of sigma_max eps_a.

    sigma_max is the largest normal stress on the plane during the cycle (0 if it is always compressive) and eps_a half
    the range of the normal strain eps = ((1 + nu) sigma_n - nu (sigma_xx + sigma_yy + sigma_zz))/E. Multiply by ``E``
    for the form sigma_max eps_a E.

    Parameters
    ----------
    stress : (s, 4, ...) array
        Pa.
    E : float
        Young's modulus, Pa.
    nu : float
        Poisson's ratio.

    References
    ----------
    K. N. Smith, P. Watson, T. H. Topper, A stress-strain function for the fatigue of metals, J. Mater. 5 (1970)
    767-778; on the critical plane: D. Socie, Multiaxial fatigue damage models, J. Eng. Mater. Technol. 109 (1987)
    293-298; in fretting: M. P. Szolwinski, T. N. Farris, Mechanics of fretting fatigue crack formation, Wear 198 (1996)
    93-107.
    """
    return critical_plane(stress, swt_measure(E, nu))


def fatemi_socie(stress: Array, E: float, nu: float, k: float, sigma_y: float) -> Critical:
    """Fatemi-Socie parameter, a shear strain: max over planes of gamma_a (1 + k sigma_max/sigma_y).

    gamma_a = tau_a/mu, mu = E/(2 (1 + nu)), is the amplitude of the engineering shear strain on the plane, half the
    longest chord of its path, and sigma_max is the largest normal stress on the plane during the cycle.

    Parameters
    ----------
    stress : (s, 4, ...) array
        Pa.
    E, sigma_y : float
        Young's modulus and yield stress, Pa.
    nu : float
        Poisson's ratio.
    k : float
        Influence of the normal stress, of the material.

    References
    ----------
    A. Fatemi, D. F. Socie, A critical plane approach to multiaxial fatigue damage including out-of-phase loading,
    Fatigue Fract. Eng. Mater. Struct. 11 (1988) 149-165. There the critical plane is that of the largest gamma_a; here
    the plane of the largest parameter is sought, as is usual in fretting.
    """
    return critical_plane(stress, fatemi_socie_measure(E, nu, k, sigma_y))


def findley(stress: Array, k: float) -> Critical:
    """Findley's parameter, Pa: max over planes of tau_a + k sigma_max.

    tau_a is the shear amplitude on the plane, half the longest chord of the path of the shear stress, and sigma_max the
    largest normal stress on the plane during the cycle.

    Parameters
    ----------
    stress : (s, 4, ...) array
        Pa.
    k : float
        Influence of the normal stress, of the material.

    References
    ----------
    W. N. Findley, A theory for the effect of mean stress on fatigue of metals under combined torsion and axial load or
    bending, J. Eng. Ind. 81 (1959) 301-306.
    """
    return critical_plane(stress, findley_measure(k))


def range_measure(at: OnPlanes) -> Array:
    """Range of the normal stress on planes, Pa, of :func:`principal_range`."""
    return range_of(at.normal)


def swt_measure(E: float, nu: float) -> PlaneMeasure:
    """Return sigma_max eps_a on planes, of :func:`smith_watson_topper`."""

    def measure(at: OnPlanes) -> Array:
        strain = ((1 + nu) * at.normal - nu * at.trace) / E
        return np.maximum(largest(at.normal), 0.0) * range_of(strain) / 2

    return measure


def fatemi_socie_measure(E: float, nu: float, k: float, sigma_y: float) -> PlaneMeasure:
    """Return gamma_a (1 + k sigma_max/sigma_y) on planes, of :func:`fatemi_socie`."""
    mu = E / (2 * (1 + nu))
    return lambda at: longest_chord(at.shear) / (2 * mu) * (1 + k / sigma_y * largest(at.normal))


def findley_measure(k: float) -> PlaneMeasure:
    """Return tau_a + k sigma_max on planes, of :func:`findley`."""
    return lambda at: longest_chord(at.shear) / 2 + k * largest(at.normal)


class Ruiz(NamedTuple):
    """Ruiz's parameters, Pa^2 m.

    Parameters
    ----------
    F1 : float
        Largest sigma_T times largest tau delta, wherever each of them is.
    F2 : float
        Largest product sigma_T tau delta of one point.
    x1, x2 : float
        Where tau delta, and where the product is largest, m.
    x : (k,) array
        Points of the contact, m.
    product : (k,) array
        sigma_T tau delta at these points, Pa^2 m.
    work : (k,) array
        tau delta at these points, Pa m.
    errors : (float, float) or None
        Estimated relative errors of F1 and F2; None if they are not known.
    """

    F1: float
    F2: float
    x1: float
    x2: float
    x: Array
    product: Array
    work: Array
    errors: tuple[float, float] | None = None


def ruiz(result: Result, sigma: Array, x: Array | None = None) -> Ruiz:
    """Return Ruiz's parameters F1 and F2 of a result with slip.

    sigma_T is the largest tangential stress sigma_xx of the surface during the cycle (0 under compression), tau the
    amplitude \\|q2 - q1\\|/2 of the shear traction, and delta the amplitude of slip, half of its change between load
    points 1 and 2.

    Parameters
    ----------
    result : Result
        With ``slip``.
    sigma : (s, k) array
        sigma_xx along the load path at the points ``x``, Pa.
    x : (k,) array, optional
        Points of the contact, m; default: those of ``result.slip``.

    References
    ----------
    C. Ruiz, P. H. B. Boddington, K. C. Chen, An investigation of fatigue and fretting in a dovetail joint, Exp. Mech.
    24 (1984) 208-217.
    """
    assert result.slip
    x = result.slip.x if x is None else x
    tension = np.maximum(sigma.max(axis=0), 0.0)
    delta = np.abs(np.interp(x, result.slip.x, result.slip.slip)) / 2
    work = np.abs(result.traction.at(x).dq) / 2 * delta
    product = tension * work
    most, both = int(work.argmax()), int(product.argmax())
    return Ruiz(
        float(tension.max() * work[most]), float(product[both]), float(x[most]), float(x[both]), x, product, work
    )
