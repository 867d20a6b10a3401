"""Stick zones of one pair of bodies under many loads at once."""

import numpy as np
import numpy.typing as npt

from partialslip.halfplane import Contact, contact
from partialslip.halfplane.contact import one_step_zone
from partialslip.halfplane.steady import drive
from partialslip.march.equivalent.method import stand_ins
from partialslip.result import StickZone
from partialslip.result.rig import Rig, Terms
from partialslip.scene import Pressing, Scene
from partialslip.tools.arrays import Array

_SETTLED, _MOST = 1e-8, 20  # accuracy: change of the tension in an iteration, in f p0; iterations
_LEAST = 1e-10  # accuracy: power that counts, in the largest
_POINTS = 16  # accuracy: of quadrature in a slip zone
# the slope of the strain is of degree 9: the rule is exact
_PLACES = np.cos(np.pi * (np.arange(8) + 0.5) / 8)
_CHUNK = 2**13  # cost: loads at a time: their arrays fit the processor's cache


def stick_zone(scene: Scene, rig: Rig, dQ: npt.ArrayLike, dsigma: npt.ArrayLike) -> StickZone[Array]:
    """Permanent stick zones of the bodies of ``scene`` in cycles with these changes of the loads, m.

    P, f and the bodies are those of the scene, the loads fully reversed: between their extremes the contact moves
    evenly about its place under P alone. As :func:`partialslip.halfplane.stick_zone`, for half-planes that act like the
    bodies; shapes follow NumPy's broadcasting. Where slip reverses between the load points, the stick zones are those
    of a single step; the method ``equivalent`` marches then.

    Parameters
    ----------
    scene : Scene
    rig : Rig
        The rig of the scene's bodies (:func:`partialslip.run.characterise`).
    dQ, dsigma : array_like
        Changes of the shear force (N/m) and of the bulk tension of the lower body (Pa) over half a cycle.

    Raises
    ------
    InputError
        As the method ``equivalent``, and as :func:`partialslip.halfplane.stick_zone`.
    """
    still = scene.replace(load={"Q": [0.0, 0.0], "sigma": [0.0, 0.0], "cycles": 1})
    seen = stand_ins(still, rig).scene
    pressed = contact(seen, Pressing(seen.P, seen.M))
    rig = _shortened(rig, max(map(abs, pressed.ends)))
    loads = np.broadcast_arrays(np.asarray(dQ, float), np.asarray(dsigma, float))
    if not (shape := loads[0].shape):
        one_step_zone(pressed, pressed.f, dQ, dsigma)  # raises if the contact slides
    flat_Q, flat_sigma = loads[0].ravel(), scene.at_right_grip(*loads).ravel()
    centre, c, s = np.empty(flat_Q.size), np.empty(flat_Q.size), np.empty(flat_Q.size, int)
    for start in range(0, flat_Q.size, _CHUNK):
        part = slice(start, start + _CHUNK)
        centre[part], c[part], s[part] = _solved(scene, rig, pressed, flat_Q[part], flat_sigma[part])
    return StickZone(*(values.reshape(shape)[()] for values in (centre, c, s)))


def _shortened(rig: Rig, farthest: float) -> Rig:
    """``rig`` without the highest powers, which do not count within the distance ``farthest`` (m) of x = 0."""
    powers = (farthest / rig.reach) ** np.arange(len(rig.terms.xx))
    size = np.abs(rig.terms.xx * powers * powers[:, None]).max(axis=0)
    size += np.abs(rig.terms.pulled[0]) * powers
    count = max(int(np.flatnonzero(size >= _LEAST * size.max())[-1]) + 1, 2)
    xx, yy, xy = (each[:count, :count] for each in rig.terms[:3])
    lower = (each[:count, :count] for each in rig.terms[4:])
    own = Terms(xx, yy, xy, rig.terms.pulled[:, :count], *lower)
    return Rig(rig.key, rig.reach, own, own)


def _solved(scene: Scene, rig: Rig, pressed: Contact, dQ: Array, dsigma: Array) -> tuple[Array, Array, Array]:
    """Centres and half-widths of the stick zones, m, and s, for loads (k,)."""
    f, unit = pressed.f, pressed.f * pressed.p0
    slope = np.zeros_like(dQ)
    sigma = dsigma.copy()
    zone = one_step_zone(pressed, f, dQ, sigma)
    centre, c, s = (np.array(each) for each in zone)
    active = np.flatnonzero(s)  # the others slide
    for _ in range(_MOST):
        own = StickZone(centre[active], c[active], s[active])
        moments = _moments(rig, pressed, f, own, dQ[active], sigma[active], slope[active])
        new, new_slope = _tension(rig, scene, moments, own, dsigma[active])
        changed = (
            np.maximum(np.abs(new - sigma[active]), np.abs(new_slope - slope[active]) * pressed.a) > _SETTLED * unit
        )
        sigma[active], slope[active] = new, new_slope
        active = active[changed]
        if not len(active):
            break
        zone = one_step_zone(pressed, f, dQ[active], sigma[active], slope[active], checked=False)
        centre[active], c[active], s[active] = zone
    zone = one_step_zone(pressed, f, dQ, sigma, slope)
    return np.asarray(zone.centre), np.asarray(zone.half_width), np.asarray(zone.s)


def _tension(rig: Rig, scene: Scene, moments: Array, zone: StickZone[Array], dsigma: Array) -> tuple[Array, Array]:
    """Changes of tension at x = 0 and of its slope, (k,) each, for shear tractions with ``moments`` (k, j)."""
    A, own = scene.material.A, scene.material.bodies[0].A
    shift = A * moments @ rig.terms.xx[: moments.shape[1]] + own / 4 * rig.reach * dsigma[:, None] * rig.terms.pulled[0]
    places = _PLACES
    x = zone.centre[:, None] + zone.half_width[:, None] * places
    powers = np.arange(1, shift.shape[1])
    slopes = np.zeros_like(x)
    for power in powers[::-1]:  # Horner's scheme
        slopes = slopes * (x / rig.reach) + power * shift[:, power, None]
    lost = -4 / A * slopes / rig.reach
    slope = 2 * (lost * places).mean(axis=1) / zone.half_width
    return dsigma + lost.mean(axis=1) - slope * zone.centre, slope


def _moments(
    rig: Rig, pressed: Contact, f: float, zone: StickZone[Array], dQ: Array, dsigma: Array, dslope: Array
) -> Array:
    """Moments int (x/reach)^j dq dx (k, j), N/m, of changes of shear with the stick zones ``zone``.

    In the slip zones dq = +-2 f p. In the stick zone it is an integral over the slip zones (:mod:`partialslip.
    halfplane.traction`); with the order of integration swapped, each point t of a slip zone adds p(t) times

        t^j + 1/(pi sqrt(tau^2 - 1)) int sqrt(1 - zeta^2) x^j/|tau - zeta| dzeta,    x = e + c zeta,  t = e + c tau.
    """
    a, count = pressed.a / rig.reach, len(rig.terms.xx)
    offset = pressed.centre / rig.reach
    e, c = (zone.centre - pressed.centre) / pressed.a, zone.half_width / pressed.a
    middle = dsigma + dslope * pressed.centre
    turn = np.where(drive(dQ / (2 * f * pressed.P), dslope * pressed.a / (f * pressed.p0)) < 0, -1, 1)
    mirrored = turn * np.where(middle < 0, -1, 1) < 0
    signs = {1: np.where(mirrored, turn * zone.s, turn), -1: np.where(mirrored, turn, turn * zone.s)}
    # moments of sqrt(1 - zeta^2)
    angles = np.pi * np.arange(1, _POINTS + 1) / (_POINTS + 1)
    inner = offset + a * (e[:, None] + c[:, None] * np.cos(angles))
    weights = np.pi / (_POINTS + 1) * np.sin(angles) ** 2
    own = np.empty((count, len(e)))
    power = np.broadcast_to(weights, inner.shape)
    for j in range(count):
        own[j] = power.sum(axis=1)
        power = power * inner
    gauss, factors = np.polynomial.legendre.leggauss(_POINTS)
    phi = np.pi / 2 * (1 + gauss)
    result = np.zeros((len(e), count))
    for side, sign in signs.items():
        width = np.maximum(1 - side * e - c, 0.0)[:, None]
        beyond = width * (1 - np.cos(phi)) / 2
        t = e[:, None] + side * (c[:, None] + beyond)
        p = pressed.friction_bound.pressure(t) * width * np.sin(phi) / 2 * factors * np.pi / 2 * sign[:, None]
        tau = 1 + beyond / c[:, None]
        root = np.sqrt(beyond / c[:, None] * (tau + 1))
        root = np.where(root == 0, np.inf, root)  # no slip zone
        J, place, power = np.pi * (tau - root), offset + a * t, p
        for j in range(count):
            result[:, j] += (power + p * J / (np.pi * root)).sum(axis=1)
            J = place * J - side * a * c[:, None] * own[j][:, None]
            power = power * place
    result *= 2 * f * pressed.p0 * pressed.a
    result -= (dslope * zone.half_width**2 / 4)[:, None] * own.T
    return result
