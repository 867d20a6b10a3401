"""The permanent stick zone of the steady state, Hertz contact (paper, section 4).

Everything here is scaled: lengths by a, dQ and dsigma by the friction, as ``Qf`` = dQ/(2 f P) and
``sf`` = dsigma/(f p0).
"""

import math
from typing import NamedTuple

from scipy.optimize import brentq
from scipy.special import elliprd, elliprf, elliprj

_RTOL = 8.9e-16  # the smallest that brentq takes
_LOG_TINY = -230.0  # stick zones narrower than 1e-100 a are not told apart


class StickZone(NamedTuple):
    """Stick zone [-m, n] as fractions of a, by its centre (n - m)/2 and half-width (n + m)/2; ``s`` is +1 where
    both ends slip the same way (small tension) and -1 where they slip opposite ways (large tension)."""

    centre: float
    half_width: float
    s: int


def stick_zone(Qf: float, sf: float) -> StickZone:
    """Stick zone for 0 <= ``Qf`` < 1 and ``sf`` >= 0.

    Other signs follow: mirroring x turns dQ round and keeps dsigma, turning q round turns both round.
    """
    if not (0 <= Qf < 1 and sf >= 0):
        raise ValueError(f"Qf = {Qf}, sf = {sf}: must be 0 <= Qf < 1 (from 1 on the contact slides) and sf >= 0")
    return _small_tension(Qf, sf) if sf <= transition(Qf) else _large_tension(Qf, sf)


def transition(Qf: float) -> float:
    """dsigma/(f p0) at which small tension ends (paper, eq. (23)), for ``Qf`` = dQ/(2 f P) >= 0."""
    return 8 * Qf / (1 + math.sqrt(1 - Qf))  # 8 (1 - sqrt(1 - Qf)) without its cancellation


def _small_tension(Qf: float, sf: float) -> StickZone:
    """Paper, eqs. (21) and (22)."""
    return StickZone(-sf / 8, math.sqrt(1 - Qf), +1)


def _large_tension(Qf: float, sf: float) -> StickZone:
    """Solve the paper's eqs. (25) and (26).

    At a given half-width c the condition on dQ fixes how far the zone lies from the contact's end (0 .. 1 of the
    way to the middle), and along that line the tension falls as c grows, up to the transition at
    c = sqrt(1 - Qf), where the zone touches the end: two nested bracketed roots. The outer unknown is log c,
    because as tension grows the stick zone never vanishes: its half-width falls like
    exp(-pi dsigma/(16 f p(centre))).
    """

    def edge(c: float) -> float:
        def excess(way: float) -> float:
            if way == 0:  # touching the end: eq. (22)
                return 1 - c**2 - Qf
            return (consistency((1 - c) * way, c)[1] if way < 1 else 0.0) - Qf  # in the middle dQ = 0

        if Qf == 0 or excess(0.0) <= 0:  # centred; or, but for rounding, at the transition itself
            return 1 - c if Qf == 0 else 0.0
        return (1 - c) * float(brentq(excess, 0.0, 1.0, xtol=1e-20, rtol=_RTOL, maxiter=500))

    def excess(log_c: float) -> float:
        c = math.exp(log_c)
        return consistency(edge(c), c)[0] - sf

    top = bottom = 0.5 * math.log1p(-Qf)
    while excess(bottom) < 0 and bottom > _LOG_TINY:
        top, bottom = bottom, max(2 * bottom - 1, _LOG_TINY)
    bracketed = _LOG_TINY < bottom < top
    c = math.exp(brentq(excess, bottom, top, xtol=1e-20, rtol=_RTOL, maxiter=500) if bracketed else bottom)
    return StickZone(edge(c) + c - 1, c, -1)


def consistency(edge: float, c: float) -> tuple[float, float]:
    """The loads (dsigma/(f p0), dQ/(2 f P)) whose large-tension stick zone is [edge - 1, edge - 1 + 2c] (a = 1).

    The integrals of the consistency conditions in elliptic form (paper, eqs. (24)-(26)), the second one taken
    about the zone's centre, which leaves dQ/2 alone on its other side. ``chi`` is the modulus. Carlson's forms
    take 1 - chi^2 = 4 c/((1+m)(1+n)); everything that is small with c or the distance ``edge`` = 1 - m from the
    contact's end is formed without cancellation.
    """
    m, n, centre = 1 - edge, edge + 2 * c - 1, edge + c - 1
    root = math.sqrt((2 - edge) * (edge + 2 * c))  # sqrt((1+m)(1+n))
    complement = 4 * c / root**2
    phi, omega = -edge / (2 - edge), 1 - 2 * c / (2 - edge)  # (m-1)/(m+1), (1-n)/(1+m)

    K = elliprf(0.0, complement, 1.0)
    E = K - (1 - complement) / 3 * elliprd(0.0, complement, 1.0)
    Pi_phi = K + phi / 3 * elliprj(0.0, complement, 1.0, 2 / (2 - edge))
    Pi_omega = K + omega / 3 * elliprj(0.0, complement, 1.0, 2 * c / (2 - edge))

    cubic = n**2 - 2 * m * n / 3 + m**2 - 4 / 3
    first = (
        -2 * root * E
        + (2 * centre + 4) * (1 + m) / root * K
        + 4 * centre / root * Pi_phi
        - 4 * centre * c / root * Pi_omega
    )
    second = 1.5 * (
        -2 * centre * root * E
        - (1 + m) / root * ((n / 3 + 2) * m - (m**2 + n**2) / 2 - 2 * (1 + n) / 3) * K
        + cubic / root * Pi_phi
        - c * cubic / root * Pi_omega
    )
    return 8 / math.pi * first, 2 / math.pi * (second - centre * first)
