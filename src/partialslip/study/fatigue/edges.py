"""Asymptotes at the ends of the contact and of the stick zone, and the slip zones that they predict; SI units.

With d the distance from an end of the contact, p -> K_N sqrt(d), and the change of shear traction that adhered bodies
would have from load point 1 to 2, dq -> K_T/sqrt(d). If the slip zone is small compared with the contact, its length in
a cycle at constant P is K_T/(f K_N); in first loading by such a shear it is 2 K_T/(f K_N). Within the stick zone, at
the distance d from its end, f p - |dq|/2 -> K_S sqrt(d).

Such asymptotes: D. Dini, D. A. Hills, Bounded asymptotic solutions for incomplete contacts in partial slip, Int. J.
Solids Struct. 41 (2004) 7049-7062.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from partialslip.result import Result
from partialslip.run.judge.reference import error_of
from partialslip.scene import Scene
from partialslip.tools.arrays import Array

_REACH = 0.2  # accuracy: of the distance to the next point where tractions are not smooth: points of the fit
_POINTS, _DEGREE = 64, 8  # accuracy: points and degree of a fit
_AWAY = 0.1  # accuracy: of the reach: the nearest points of a fit of adhered shear, beyond the slip zone of the method
_OTHERS = ((0.5, 6), (0.5, 4), (0.25, 6), (0.25, 4))  # accuracy: reach and degree of fits that tell the error
# accuracy: error in the largest difference to these fits: up to 1.8 in 240 coefficients of fem and march whose exact
# values are known
_SCATTER = 2.0
SIDES: tuple[Literal["left"], Literal["right"]] = ("left", "right")


@dataclass(frozen=True)
class Coefficient:
    """A coefficient.

    Parameters
    ----------
    value, error : float
        The coefficient and the estimate of its error, in its unit.
    """

    value: float
    error: float


@dataclass(frozen=True)
class Edge:
    """Asymptotes at an end of the contact.

    Parameters
    ----------
    side : "left" or "right"
    K_N : Coefficient
        Of the pressure, Pa/m^0.5.
    K_T : Coefficient or None
        Of the adhered change of shear traction, Pa m^0.5; None where the adhered solution is not known.
    predicted, found : float or None
        Length of the slip zone in the cycle, m, by the asymptotes, and of the result; None if not known.
    K_S : Coefficient or None
        Of f p - |dq|/2 at the end of the stick zone on this side, Pa/m^0.5; None where nothing sticks.
    """

    side: Literal["left", "right"]
    K_N: Coefficient
    K_T: Coefficient | None
    predicted: float | None
    found: float | None
    K_S: Coefficient | None


def edges(scene: Scene, result: Result, adhered: Result | None = None) -> tuple[Edge, Edge] | tuple[()]:
    """Return the asymptotes at the left and the right end of the contact of ``result``.

    Parameters
    ----------
    scene : Scene
    result : Result
    adhered : Result, optional
        Result of the scene with a coefficient of friction so large that next to nothing slips, for K_T. Default: the
        closed form of half-planes; of finite bodies K_T is then not known.

    Returns
    -------
    (Edge, Edge) or ()
        Empty where P or M varies: the contact has other ends at each load point.
    """
    if scene.presses_anew or scene.friction.f == 0:
        return ()
    left, right = result.ends[1]
    marks = np.array([left, right, *scene.profile.kinks, *scene.friction.kinks])
    stick = (-result.m, result.n) if result.m is not None and result.n is not None else None
    found = []
    for side, end, inwards in ((0, left, 1.0), (1, right, -1.0)):
        K_N = _fitted(lambda x: result.traction.at(x).p, end, inwards, marks, 0.5)
        if adhered is not None:
            K_T: Coefficient | None = _of_adhered(adhered, side, inwards, marks)
        else:
            K_T = None if scene.finite else _of_half_planes(scene, result, -inwards)
        slip, K_S = None, None
        if stick is not None:
            slip = float(abs(stick[side] - end))
            K_S = _fitted(
                lambda x: _reserve(result, scene.friction.at(x), x), stick[side], inwards, np.append(marks, stick), 0.5
            )
        predicted = None if K_T is None else float(abs(K_T.value) / (scene.friction.at(end) * K_N.value))
        found.append(Edge(SIDES[side], K_N, K_T, predicted, slip, K_S))
    return found[0], found[1]


def _of_adhered(adhered: Result, side: int, inwards: float, marks: Array) -> Coefficient:
    """K_T from the shear of a result that slips over a length c next to the end.

    There dq is that of slip up to c, proportional to sqrt(d) - sqrt(d - c), which is an inverse square root of the
    distance from the middle of the slip zone but for (c/d)^2.
    """
    end, corner = adhered.ends[1][side], (adhered.m, adhered.n)[side]
    slip = 0.0 if corner is None else abs((-corner, corner)[side] - end)
    return _fitted(lambda x: adhered.traction.at(x).dq, end + inwards * slip / 2, inwards, marks, -0.5)


def _reserve(result: Result, f: Array, x: Array) -> Array:
    found = result.traction.at(x)
    return f * found.p - np.abs(found.dq) / 2


def _of_half_planes(scene: Scene, result: Result, side: float) -> Coefficient:
    """K_T of half-planes: dq = (dQ/pi + s dsigma/4 + dslope (s^2 - a^2/2)/4)/sqrt(a^2 - s^2), s from the middle. Its
    error is that of the half-width a of the ``result``."""
    (left, right), load = result.ends[1], scene.load
    tension = load.dsigma + load.dslope * (right + left) / 2

    def K_T(a: float) -> float:
        force = load.dQ / np.pi + side * a * tension / 4 + a**2 * load.dslope / 8
        return float(force / np.sqrt(2 * a))

    a = (right - left) / 2
    return Coefficient(K_T(a), abs(K_T(a * (1 + error_of(result, "a", result.method))) - K_T(a)))


def _fitted(at: Callable[[Array], Array], end: float, inwards: float, marks: Array, power: float) -> Coefficient:
    """Coefficient c of ``at`` (x) -> c d**power near the ``end``: least squares of d**power times a polynomial of d.

    The error follows from the differences to fits over parts of the reach, of lower degrees.
    """
    ahead = (marks - end) * inwards
    reach = _REACH * float(ahead[ahead > 1e-9 * np.ptp(marks)].min())

    def fit(reach: float, degree: int) -> float:
        share = (1 - np.cos(np.pi * (np.arange(_POINTS) + 0.5) / _POINTS)) / 2
        share = share if power > 0 else _AWAY + (1 - _AWAY) * share
        values = at(end + inwards * reach * share) * share ** max(-power, 0.0)
        columns = share[:, None] ** (np.arange(degree + 1) + max(power, 0.0))
        first: float = np.linalg.lstsq(columns, values, rcond=None)[0][0]
        return float(first * reach**-power)

    value = fit(reach, _DEGREE)
    return Coefficient(value, _SCATTER * max(abs(value - fit(part * reach, degree)) for part, degree in _OTHERS))
