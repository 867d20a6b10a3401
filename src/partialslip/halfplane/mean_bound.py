"""Room for a mean of Q: the largest of a steady state (docs/theory.md, section 7); scaled as in
:mod:`partialslip.halfplane.shape`."""

import math

import numpy as np

from partialslip.halfplane.shape import Shape
from partialslip.halfplane.steady import stick_zones
from partialslip.halfplane.traction import half_range, inside
from partialslip.result import StickZone
from partialslip.tools.arrays import Array

_STAGES = 48  # accuracy: of the way from load point to load point, between which dq is looked at for extremes
_ANGLES = 65  # accuracy: at which changes of the sign of dq are looked for
_PARTS = 2  # accuracy: of the stick zone between two places at which the room bends
_INSIDE = 1 - 1e-15  # accuracy: of a stick zone
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(10)


def mean_load_bound(zone: StickZone[float], shape: Shape, Qf: float, sf: float, gf: float, *, reverses: bool) -> float:
    """Largest \\|Q_mean\\|/(f P) of a steady state: int (f p - max \\|dq_t - dq/2\\|) dx over the stick ``zone`` of the
    loads ``Qf``, ``sf`` and ``gf``, where dq_t is the change of q so far on the way between the load points.

    Above it no locked-in mean traction fits under the friction bound all along the way, and the contact ratchets
    (frictional Melan theorem: Barber, Klarbring and Ciavarella, 2008). At the load points \\|dq_t - dq/2\\| is
    \\|dq\\|/2; it is larger in between where dq_t is not monotone, which it is for small tension. If slip ``reverses``
    on the way, the stages are not those of the formula: the bound is then that of the load points.

    The integrand is nowhere negative. Differences of integrals over the whole contact leave 1e-9 where the zone is
    tiny, of either sign.
    """
    monotone = zone.s > 0 and gf <= 0
    turns = [] if monotone else _turns(zone, shape, gf)
    room = _at_load_points(zone, shape, gf, turns)
    taken = 0.0 if monotone or reverses else _taken_between(zone, shape, Qf, sf, gf, turns) * 2 / math.pi
    return max(room - taken, 0.0)


def _at_load_points(zone: StickZone[float], shape: Shape, gf: float, turns: list[float]) -> float:
    """int (f p - \\|dq\\|/2) dx/(f P) over the stick zone, for dq that changes its sign at the angles ``turns``."""
    centre, c = zone.centre, zone.half_width
    edge = 1 + centre - c
    rules = {side: shape.rule(edge, c, side) for side in (1, -1)}
    slips = {side: (rule.weights * shape.pressure(rule.t), rule.theta) for side, rule in rules.items()}
    # f P, half of pi/2, less the slip zones: int p dt, dt = c sinh(theta) dtheta
    room = np.pi / 2 - sum(float(weights @ (c * np.sinh(theta))) for weights, theta in slips.values())
    shares = np.diff([_resultant(angle, slips, zone, gf) for angle in (0.0, *turns, math.pi)])
    return float(room - np.abs(shares).sum()) * 2 / np.pi


def _turns(zone: StickZone[float], shape: Shape, gf: float) -> list[float]:
    """Angles between 0 and pi, ascending, at whose x = e + c cos(angle) dq changes its sign."""

    def sign(angle: float) -> float:
        """Sign of dq/2 at e + c cos(``angle``): positive at n, where dq/2 = p, and negative at -m, where dq/2 = -p."""
        if angle in (0.0, math.pi):
            return 1.0 - (1.0 - zone.s) * (angle > 0)
        return float(half_range(np.array([zone.centre + zone.half_width * math.cos(angle)]), zone, shape, gf)[0])

    from scipy.optimize import brentq  # takes long to import

    if not gf:
        return [brentq(sign, 0.0, math.pi)]
    angles = np.linspace(0.0, math.pi, _ANGLES).tolist()
    signs = [sign(angle) > 0 for angle in angles]
    return [brentq(sign, angles[i], angles[i + 1]) for i in range(len(angles) - 1) if signs[i] != signs[i + 1]]


def _taken_between(zone: StickZone[float], shape: Shape, Qf: float, sf: float, gf: float, turns: list[float]) -> float:
    """int (max \\|dq_t - dq/2\\| - \\|dq\\|/2) dx/(f p0) over the stick zone. dq_t has an extreme at the stage at
    which the adhered traction of its stick zone changes sign."""

    def solved(shares: Array) -> StickZone[Array]:
        return stick_zones(shares * Qf, shares * sf, shape, shares * gf, checked=False)

    def rate(stages: StickZone[Array], x: Array) -> Array:
        """Rate of dq_t, times a positive factor."""
        y = x - stages.centre
        return Qf / 2 + y / 8 * (sf + gf * stages.centre) + gf / 8 * (y**2 - stages.half_width**2 / 2)

    steps = np.arange(_STAGES + 1) / _STAGES
    stages = solved(steps[1:])
    whole = StickZone(*(np.append(first, each)[:, None] for first, each in zip((0.0, 1.0, 1), stages, strict=True)))
    # where extremes begin and end, and where the largest may be another
    zeros, bends = _zeros(Qf, sf, gf, whole), zone.centre + zone.half_width * np.cos(turns)
    places = [zone.left, *bends, *zeros[0], *zeros[-1], *zeros.min(axis=0), *zeros.max(axis=0), zone.right]
    ends = np.unique(np.clip(places, zone.left, zone.right))
    ends = np.unique(ends[:-1] + np.arange(_PARTS + 1)[:, None] / _PARTS * np.diff(ends))
    half = np.diff(ends)[:, None] / 2
    x, weights = (ends[:-1, None] + half * (1 + _NODES)).ravel(), (half * _WEIGHTS).ravel()
    rates = rate(whole, x)
    step, at = np.nonzero((rates[:-1] > 0) != (rates[1:] > 0))
    if not len(at):
        return 0.0
    # the error of an extreme is the square of that of its place
    low, high, x = rates[step, at], rates[step + 1, at], x[at]
    shares = (step + low / (low - high)) / _STAGES
    found = solved(shares)
    y = np.clip((x - found.centre) / found.half_width, -_INSIDE, _INSIDE)
    extreme = inside(found, y[:, None], shape, shares * gf)[1][:, 0]
    final = half_range(x, zone, shape, gf)
    taken = np.zeros(len(weights))
    np.maximum.at(taken, at, np.abs(2 * extreme - final) - np.abs(final))
    return float(weights @ taken)


def _zeros(Qf: float, sf: float, gf: float, stages: StickZone[Array]) -> Array:
    """Places (stages, 2) at which the adhered traction of the stick zones of ``stages`` (stages, 1) changes its sign,
    and the zone's middle in place of those that there are not."""
    square, linear = gf / 8, (sf + gf * stages.centre) / 8
    constant = Qf / 2 - gf / 16 * stages.half_width**2
    with np.errstate(divide="ignore", invalid="ignore"):
        stem = -(linear + np.copysign(np.sqrt(linear**2 - 4 * square * constant), linear)) / 2
        found = stages.centre + np.hstack([np.divide(stem, square), constant / stem])
    return np.where(np.isfinite(found), found, stages.centre)


def _resultant(angle: float, slips: dict[int, tuple[Array, Array]], zone: StickZone[float], gf: float = 0.0) -> float:
    """int dq/2 dx from the stick zone's right end to x = e + c cos(``angle``), with the order of integration swapped:

        int sin^2(y)/(cosh(theta) -+ cos(y)) dy = y cosh(theta) +- sin(y) - 2 sinh(theta) arctan(tan(y/2) r),

    r = coth(theta/2) for traction in the right slip zone and tanh(theta/2) for the left one.
    """
    total = 0.0
    for side, (weights, theta) in slips.items():
        half = np.tanh(theta / 2)
        sine, cosine = math.sin(angle / 2), math.cos(angle / 2)
        arc = np.arctan2(sine, cosine * half) if side > 0 else np.arctan2(sine * half, cosine)
        kernel = angle * np.cosh(theta) + side * math.sin(angle) - 2 * np.sinh(theta) * arc
        total += (1 if side > 0 else zone.s) * float(weights @ kernel)
    by_slope = gf / 16 * zone.half_width**2 * (angle - math.sin(2 * angle) / 2)
    return total * zone.half_width / np.pi - by_slope
