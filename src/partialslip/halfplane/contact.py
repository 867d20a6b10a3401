"""Contact half-width and pressure of two half-planes, and stick zones under changes of load; SI units."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import numpy.typing as npt

from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.layer import Layer
from partialslip.halfplane.pressed_layers import on_layers
from partialslip.halfplane.punch import Punch, punch_force
from partialslip.halfplane.shape import Bound, Given, Shape
from partialslip.halfplane.steady import TOO_STEEP, UNEVEN_FRICTION, drive, stick_zones
from partialslip.halfplane.uneven import press_uneven
from partialslip.result import StickZone
from partialslip.result.fields import AtPoints
from partialslip.scene import FlatRounded, Hertz, Pressing, Scene
from partialslip.scene.profiles import Curvature
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

_INSIDE = np.cos(np.arange(1, 200) / 200 * np.pi)  # places, in a, at which a hollow flat must be in contact
# limit: Of the flat's half-width: narrower corners, which carry the load, are not told from the ends of the flat. With
# d = a/b - 1 rounding leaves p an error of 1e-16/(2 d)^(3/2), and no method makes cells much smaller than this.
_HARDLY = 1e-7
_SAME = 1e-9  # limit: relative difference of two coefficients of friction that is rounding


@dataclass(frozen=True, repr=False)
class Contact:
    """Two half-planes pressed together: contact half-width ``a`` (m), normal force ``P`` (N/m), ``shape``, the scaled
    pressure (:mod:`partialslip.halfplane.shape`), middle of the contact ``centre`` (m), and ``tilt`` (rad), the angle
    by which the bodies have turned. ``f`` is the coefficient of friction of the scene, and where it varies along x its
    mean over the pressure; ``bound`` is then f(x) p over f p0 (None if f does not vary). ``layer`` is what the bodies
    add to half-planes, if they are two equal layers."""

    a: float
    P: float
    shape: Shape
    centre: float = 0.0
    tilt: float = 0.0
    f: float = math.nan
    bound: Shape | None = None
    layer: Layer | None = None

    def __repr__(self) -> str:
        shape = type(self.shape).__name__
        return f"Contact: a = {self.a:.7g} m, P = {self.P:.7g} N/m, p0 = {self.p0:.7g} Pa, pressure {shape}"

    @property
    def p0(self) -> float:
        """2 P/(pi a), Pa; for Hertz the largest pressure."""
        return 2 * self.P / (math.pi * self.a)

    @property
    def friction_bound(self) -> Shape:
        """Largest shear traction, over f p0: the scaled pressure, unless f varies along x."""
        return self.bound or self.shape

    @property
    def moment(self) -> float:
        """Moment int x p dx of the pressure about x = 0, N."""
        if self.shape.even:
            return self.P * self.centre
        # by the rule for a slip zone beside a stick zone that shrinks to nothing; the resultant of p/p0 is pi/2
        rules = (self.shape.rule(1.0, 1e-30, side) for side in (1, -1))
        arm = sum(float((weights * self.shape.pressure(t) * np.abs(t) * t).sum()) for t, _, weights in rules)
        return self.P * (self.centre + 2 / math.pi * self.a * arm)

    @property
    def ends(self) -> tuple[float, float]:
        """Left and right end, m."""
        return self.centre - self.a, self.centre + self.a

    def places(self, scaled: npt.ArrayLike) -> Array:
        """Places, m, at the ``scaled`` distances (any shape) from the middle of the contact, fractions of a."""
        return self.centre + self.a * np.asarray(scaled, float)

    def pressure(self, x: npt.ArrayLike) -> Array:
        """Pressure, Pa, at ``x``, m: a number, a list or an array of any shape."""
        return AtPoints(lambda points: self.p0 * self.shape.pressure(self.scaled(points)))(x)

    def scaled(self, x: npt.ArrayLike) -> Array:
        """Distance of ``x`` (m) from the middle of the contact, as a fraction of a."""
        return (np.asarray(x, float) - self.centre) / self.a


def contact(scene: Scene, pressing: Pressing | None = None) -> Contact:
    """Contact of ``scene`` as two half-planes, or two equal strips, of one material, under
    ``pressing``; default: P and M of the scene.

    Hertz: P = pi a^2/(2 A R). Profiles whose curvature steps by w at |x| = b (flat and rounded: by 1/R at b):
    P = a^2/(2 A) sum w (2 psi - sin 2 psi), b = a cos(psi) (Ciavarella, Hills and Monno, 1998). A moment moves a Hertz
    contact along x by M/P; other contacts that are not even: :mod:`partialslip.halfplane.uneven`.

    Raises
    ------
    InputError
        If the materials differ, the contact extends beyond the table of the profile, or P is too small for the contact
        to extend beyond the flat.
    """
    P, M = pressing or (scene.P, scene.M)
    layer = Layer.of(scene)
    if not layer:
        return rubbing(_normal_contact(scene, Pressing(P, M)), scene)
    return rubbing(on_layers(layer, scene.material.A, P, partial(_half_planes, scene), scene.profile.even), scene)


def rubbing(pressed: Contact, scene: Scene) -> Contact:
    """The contact ``pressed`` with the friction of the ``scene``."""
    friction, shape = scene.friction, pressed.shape
    if not friction.varies:
        return replace(pressed, f=friction.f)
    kinks = *shape.kinks, *pressed.scaled(friction.kinks).tolist()
    sharp = pressed.scaled(friction.sharp_kinks(pressed.a)).tolist()
    bound = Bound(lambda x: friction.at(pressed.places(x)) * shape.pressure(x), kinks, sharp)
    return replace(pressed, f=bound.scale, bound=bound)


def _normal_contact(scene: Scene, pressing: Pressing) -> Contact:
    if not scene.material.alike:
        raise InputError(
            "material.upper, material.lower: the bodies differ; must be of one material for exact, use march or fem"
        )
    A, profile, (P, M) = scene.material.A, scene.profile, pressing
    if isinstance(profile, Hertz):
        a, origin = math.sqrt(2 * A * profile.R * P / math.pi), (M or 0.0) / P
        return Contact(a, P, HertzShape(), origin, origin / profile.R)
    if not profile.even or M:
        return _uneven(scene, profile.curvature, Pressing(P, M))
    at, steps = profile.curvature_steps()
    inner, reach = float(at[0]), profile.reach

    def psi(beyond: float) -> Array:
        """arccos(b/a) by the half-angle form, accurate if the contact is hardly wider than the flat."""
        return 2 * np.arcsin(np.sqrt(np.maximum(beyond - (at - inner), 0.0) / (2 * (inner + beyond))))

    def excess(log_beyond: float) -> float:
        beyond = math.exp(log_beyond)
        return float(((inner + beyond) * math.sqrt(1 / (2 * A * P))) ** 2 * (steps @ punch_force(psi(beyond)))) - 1

    scale = math.log(max(inner, scene.length))
    low = math.log(_HARDLY * inner) if inner > 0 else scale - 120.0
    if excess(low) > 0:
        shown, least = scene.units.plain(P, "N/m"), f"{_HARDLY:g} of the flat's half-width"
        raise InputError(f"load.P = {shown}: must press the contact beyond its flat, by more than {least}")
    high = math.log(reach - inner) if reach < math.inf else scale + 120.0
    if excess(high) < 0:
        shown, end = scene.units.plain(P, "N/m"), scene.units.labelled(reach, "m")
        raise InputError(f"load.P = {shown}: must keep the contact within profile.x, which ends at {end}")
    from scipy.optimize import brentq  # takes long to import

    beyond = math.exp(brentq(excess, low, high, xtol=1e-15, rtol=8.9e-16))
    a = inner + beyond
    within = at < a
    return _closed(Contact(a, P, Punch(at[within] / a, steps[within], psi(beyond)[within])), scene)


def tilted_contact(scene: Scene, P: float, tilt: float) -> Contact:
    """Contact of the profile of ``scene`` as two half-planes under ``P`` (N/m), turned by the rigid ``tilt`` (rad),
    which adds tilt x to the approach, whatever moment (:attr:`Contact.moment`) it takes. A Hertz contact moves by
    tilt R.

    Raises
    ------
    InputError
        As :func:`contact`.
    """
    return rubbing(_half_planes(scene, P, tilt), scene)


def _half_planes(scene: Scene, P: float, tilt: float) -> Contact:
    """As :func:`tilted_contact`, without friction."""
    if tilt == 0:
        return _normal_contact(scene, Pressing(P, None))
    if isinstance(scene.profile, Hertz):
        turned = replace(_normal_contact(scene, Pressing(P, None)), centre=tilt * scene.profile.R)
    else:
        turned = _uneven(scene, scene.profile.curvature.tilted(tilt), Pressing(P, None))
    return replace(turned, tilt=tilt)


def _uneven(scene: Scene, gap: Curvature, pressing: Pressing) -> Contact:
    """Contact of a ``gap`` that is not even, or under a moment."""
    A, (P, M) = scene.material.A, pressing
    pressed = press_uneven(gap, A * P, None if M is None else A * M, scene.length)
    if not pressed:
        shown, span = scene.units.plain(P, "N/m"), scene.units.span(gap.reach, "m")
        raise InputError(f"load.P = {shown}: must keep the contact within profile.x, between {span}")
    return _closed(Contact(pressed.a, P, pressed.shape, pressed.centre, pressed.tilt), scene)


def _closed(pressed: Contact, scene: Scene) -> Contact:
    """The contact ``pressed``, if a hollow flat is in contact everywhere."""
    if isinstance(scene.profile, FlatRounded) and scene.profile.bow < 0:
        x = pressed.places(_INSIDE)
        if (pressed.pressure(x[np.abs(x) < scene.profile.b]) <= 0).any():
            crown, P = scene.units.labelled(scene.profile.bow**-1, "m"), scene.units.labelled(pressed.P, "N/m")
            raise InputError(
                f"profile.crown = {crown}: must be less hollow: the flat is not in contact everywhere under {P}"
            )
    return pressed


def contact_of(
    pressure: Callable[[Array], Array], a: float, kinks: Sequence[float] = (), centre: float = 0.0
) -> Contact:
    """Contact with a given pressure.

    Parameters
    ----------
    pressure : callable
        ``pressure(x) -> p``: points (n,) in [centre - a, centre + a], m, to pressures (n,), Pa. Positive inside, and
        zero at both ends like a square root, as under any smooth profile.
    a : float
        Contact half-width, m.
    kinks : sequence of float
        Points at which p is not smooth, m; of an even pressure, the point -x need not be given beside x.
    centre : float
        Middle of the contact, m.

    Raises
    ------
    InputError
        If the pressure is not finite and positive, ``a`` not finite and positive, or ``centre`` not finite.
    """
    if not (math.isfinite(a) and a > 0):
        raise InputError(f"a = {a}: must be finite and > 0")
    if not math.isfinite(centre):
        raise InputError(f"centre = {centre}: must be finite")
    shape = Given(lambda x: pressure(centre + x * a), [(kink - centre) / a for kink in kinks])
    return Contact(a, shape.scale * math.pi * a / 2, shape, centre)


def one_step_zone(
    contact: Contact,
    f: npt.ArrayLike,
    dQ: npt.ArrayLike,
    dsigma: npt.ArrayLike,
    dslope: npt.ArrayLike = 0.0,
    *,
    checked: bool = True,
) -> StickZone[Array]:
    """Stick zones by the paper's consistency conditions, eqs. (17) and (18), m; arrays of the broadcast shape.

    The conditions go from load point to load point in a single step. Where slip reverses on the way, gradual loads
    have another stick zone: :func:`partialslip.halfplane.stick_zone`.

    Where the loads of an array make the contact slide, |dQ| >= 2 f P, the stick zone is NaN, and
    :attr:`StickZone.slides` is true. Numbers give numbers; a single pair of loads that slides is an error.

    Parameters
    ----------
    contact : Contact
    f : array_like
        Coefficient of friction; :attr:`Contact.f` where it varies along x.
    dQ, dsigma : array_like
        Changes of the shear force (N/m) and of the differential bulk tension (Pa) over half a cycle, of any sign.
    dslope : array_like
        Change of sigma_slope, Pa/m, of any sign: the change of tension at x is dsigma + dslope x. Where it is so large
        that points inside slip before the ends do, the stick zone is NaN with s not 0; an error for numbers.
    checked : bool
        Whether to look for such points, which takes most of the time.

    Raises
    ------
    InputError
        If f is not positive, a number is not finite, or all loads are numbers and the contact slides or has no such
        stick zone.
    """
    given = {"f": f, "dQ": dQ, "dsigma": dsigma, "dslope": dslope}
    arrays = np.broadcast_arrays(*(np.asarray(values, float) for values in given.values()))
    for name, values in zip(given, arrays, strict=True):
        if not np.isfinite(values).all():
            raise InputError(f"{name} = {values[~np.isfinite(values)].flat[0]}: must be finite")
    f_, dQ_, dsigma_, dslope_ = arrays
    if not (f_ > 0).all():
        raise InputError(f"f = {f_[~(f_ > 0)].flat[0]}: must be > 0")
    if contact.bound and not (other := np.abs(f_ - contact.f) <= _SAME * contact.f).all():
        wrong = f_[~other].flat[0]
        raise InputError(f"f = {wrong}: must be contact.f, {contact.f:.17g}, the mean of f where it varies along x")
    at_middle = dsigma_ + dslope_ * contact.centre
    Qf, sf = dQ_ / (2 * f_ * contact.P), np.abs(at_middle) / (f_ * contact.p0)
    gf = dslope_ * contact.a / (f_ * contact.p0)
    slides = np.abs(Qf) >= 1
    if slides.ndim == 0 and slides:
        raise InputError(f"dQ = {dQ_}: must be less than 2 f P in size, or the contact slides")
    turn = np.where(drive(Qf, gf) < 0, -1, 1)
    Qf, gf = (np.where(slides, 0.0, turn * each) for each in (Qf, gf))
    mirror = np.where((turn < 0) == (at_middle < 0), 1, -1)
    bound = contact.friction_bound
    if bound.even:
        centre, half_width, s = stick_zones(Qf, sf, bound, gf, checked)
    else:
        centre, half_width, s = np.empty(Qf.shape), np.empty(Qf.shape), np.empty(Qf.shape, dtype=np.int64)
        for way, shape in ((1, bound), (-1, bound.mirrored)):
            here = mirror == way
            centre[here], half_width[here], s[here] = stick_zones(Qf[here], sf[here], shape, gf[here], checked)
    if np.ndim(half_width) == 0 and np.isnan(half_width):
        raise InputError(f"dslope = {dslope_}: {TOO_STEEP}" if bound.convex else UNEVEN_FRICTION)
    a = np.where(slides, np.nan, contact.a)
    return StickZone((contact.centre + mirror * centre * a)[()], (half_width * a)[()], np.where(slides, 0, s)[()])
