"""One proportional change of the loads of two equal layers: that of half-planes with the same stick zone, and a series.

Scaled as in :mod:`partialslip.halfplane.loading`. Let H_h be the shear traction (over its bound) of half-planes under
loads (Qf', sf') that have this stick zone, of middle e and half-width c, and k the smooth kernel of
:mod:`partialslip.halfplane.layer`. With y = (x - e)/c the traction of the layers is H_h - sqrt(1 - y^2) sum_(j >= 1)
s_j U_(j-1)(y), and in the stick zone

    sum_(j >= 0) s_j T_j(y) = (1/pi) int H(t) k(x - t) dt,    sf' = sf + 8 s_0,    Qf' = Qf + c s_1.

Friction bound and profile come in with H_h alone.
"""

import math
from dataclasses import dataclass, fields
from functools import cache, cached_property

import numpy as np

from partialslip.halfplane.contact import Contact
from partialslip.halfplane.layer import Layer
from partialslip.halfplane.loading import Loading, in_half_planes
from partialslip.halfplane.pressed_layers import COUNT, FORCES, NODES, POINTS, TO_SERIES, second_kind, trimmed
from partialslip.halfplane.shape import rule_over
from partialslip.halfplane.slip import Worn, dissipation
from partialslip.halfplane.steady import UNEVEN_FRICTION
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

_SETTLED = 1e-14  # accuracy: of the loads
_HELD = 1e-9  # limit: residual of the loads above which there is no stick zone
_FULL = 36.0  # limit: -log(1 - Qf) beyond which 1 - Qf is rounding
_STAGES = np.arange(1, 9) / 8  # accuracy: of the way between load points, at which slip is compared
_SHARES = (1 - np.cos(np.pi * np.arange(1, 9) / 8)) / 2  # accuracy: places in a slip zone
_ROUNDING = 1e-9  # accuracy: lengths in a, tractions in f p0, slip in A f p0 a


@dataclass(frozen=True, eq=False)
class InLayers(Loading):
    """A change in the ``contact`` of two layers: the loads of half-planes ``below``, and the ``series`` s (k,)."""

    below: Loading
    series: Array
    contact: Contact

    @property
    def _layer(self) -> Layer:
        assert self.contact.layer
        return self.contact.layer

    @property
    def _middle(self) -> tuple[float, float]:
        """Middle and half-width of the stick zone, for the signs of the loads."""
        return _middle(self.below)

    def traction(self, x: Array) -> Array:
        return self.below.traction(x) - self.bound * _added(self, x)

    @cached_property
    def forces(self) -> tuple[Array, Array]:
        """Places (n,), m, and forces (n,) there, in f p0 m, of the traction over its bound."""
        x, weights = _rule(self.below)
        e, c = self._middle
        a = self.contact.a
        of_series = -a * c * (self.series[1:] @ FORCES[: len(self.series) - 1])
        of_below = a * weights * self.below.traction(x) / self.bound
        return self.contact.places(np.append(x, e + c * POINTS)), np.append(of_below, of_series)

    def slip(self, x: Array) -> Array:
        """Slip at ``x``, in A f p0 a: its slope beyond the stick zone is what the strain of the layers leaves of the
        series' continuation, (1/pi) int H k dt - sum s_j (y -+ sqrt(y^2 - 1))^j, times the bound."""
        e, c = self._middle
        a, layer = self.contact.a, self._layer
        at, forces = self.forces
        result = self.below.slip(x)
        for side in (-1, 1):
            beyond = np.maximum(side * (x - e) - c, 0.0)
            here = beyond > 0
            eta = 2 * np.arcsinh(np.sqrt(beyond[here] / (2 * c)))
            of_series = (
                self.series * np.float64(side) ** np.arange(1, len(self.series) + 1) @ _integrals(eta, len(self.series))
            )
            end = e + side * c
            moved = layer.stretch(self.contact.places(np.append(end, x[here])), at, forces) / a
            result[here] += self.bound * (moved[1:] - moved[0] - c * of_series)
        return result

    @property
    def certificate(self) -> dict[str, float]:
        """Residuals of the loads: ``tension`` in f p0, or relative if sf > 1, and ``shear`` in 2 f P."""
        _, Qf, sf = _solved(self.contact, self.below)
        own_Qf, own_sf = self.loads
        off = abs(Qf - own_Qf), abs(sf - own_sf) / max(self.sf, 1.0)
        own = self.below.certificate
        return {"tension": off[1] + own["tension"], "shear": off[0] + own["shear"]}

    @property
    def _under_shear_alone(self) -> bool:
        """Whether the stick zone only shrinks and the traction in it only grows, by symmetry."""
        return self.sf == 0 and self.shape.even

    @cached_property
    def _stages(self) -> list[Loading]:
        """The change at equal stages of the loads."""
        contact, (Qf, sf), near = self.contact, self.loads, np.array(self.below.loads)
        dQ, dsigma = Qf * self.bound * contact.P, sf * self.bound * contact.p0 / 2
        return [
            *(
                in_layers(contact, 1.0, each * dQ, each * dsigma, bound=self.bound, near=each * near)
                for each in _STAGES[:-1]
            ),
            self,
        ]

    @cached_property
    def turns_round(self) -> bool:
        """Whether slip reverses at stages of gradual loads: a stick zone does not shrink, or points that slip are
        pushed back."""
        if self._under_shear_alone:
            return False
        before = None
        for stage in self._stages:
            places = _beside(stage)
            if before and (
                stage.ends[0] < before.ends[0] - _ROUNDING
                or stage.ends[1] > before.ends[1] + _ROUNDING
                or ((stage.slip(places) - before.slip(places)) * _ways(stage, places) < -_ROUNDING).any()
            ):
                return True
            before = stage
        return False

    @property
    def worn(self) -> Worn:
        def slip_at(x: Array) -> Array:
            return self.turn * 2 / self.bound * self.slip(self.mirror * x)

        return dissipation(self.zone, self.seen, slip_at=slip_at).turned(self.mirror, self.turn)

    @property
    def final(self) -> bool:
        return True

    @property
    def stuck(self) -> None:
        """No zone of points in which the strain is known: layers strain where they stick."""

    @cached_property
    def mean_load_bound(self) -> float:
        """As of :func:`partialslip.halfplane.mean_bound.mean_load_bound`, by the stages and a rule over the zone."""
        e, c = self._middle
        x = e + c * POINTS
        half, p = self.traction(x) / 2, self.shape.pressure(x)
        stages = [self] if self._under_shear_alone else self._stages
        most = np.max([np.abs(stage.traction(x) - half) for stage in stages], axis=0)
        weights = c * np.pi / (2 * COUNT + 1) * np.sqrt(1 - POINTS**2)
        return max(float(weights @ (p - most)) * 2 / math.pi, 0.0)


def _beside(change: Loading) -> Array:
    """Places in the slip zones of a ``change``."""
    left, right = change.ends
    return np.concatenate([left - (left + 1) * _SHARES, right + (1 - right) * _SHARES])


def _ways(change: Loading, x: Array) -> Array:
    """Signs of the ``change`` of traction at places ``x`` in its slip zones."""
    return np.where(x <= change.ends[0], *change.signs)


def in_layers(
    pressed: Contact, f: float, dQ: float, dsigma: float, *, bound: int, near: Array | None = None
) -> Loading:
    r"""Loading of two layers by ``dQ`` (N/m) and ``dsigma`` (Pa) of any sign, with \|dQ\| < ``bound`` f P. ``near``: Qf
    and sf, with their signs, of half-planes with nearly this stick zone.

    Raises
    ------
    InputError
        If more than one zone sticks.
    """
    units = bound * f * pressed.P, bound * f * pressed.p0 / 2
    wanted = in_half_planes(pressed, f, dQ, dsigma, bound=bound)
    if wanted.nothing:
        return wanted
    target = np.array([_stretched(dQ / units[0]), dsigma / units[1]])
    scale = np.array([1.0, max(abs(target[1]), 1.0)])

    @cache  # the solver asks for the first place three times
    def at(z: float, tension: float) -> tuple[Loading, Array, Array]:
        """Half-planes, the series, and how far the loads of the layers are off."""
        Qf = math.copysign(-math.expm1(-min(abs(z), _FULL)), z)
        below = in_half_planes(pressed, f, Qf * units[0], tension * scale[1] * units[1], bound=bound)
        series, *loads = _solved(pressed, below)
        return below, series, (np.array([_stretched(loads[0]), loads[1]]) - target) / scale

    from scipy.optimize import root  # takes long to import

    begin = target if near is None else np.array([_stretched(near[0]), near[1]])
    # loads of half-planes nearly are those of layers: the Jacobian begins as 1
    options = {"xtol": _SETTLED}
    solved = root(lambda x: at(*x.tolist())[2], begin / scale, jac=lambda _: np.eye(2), method="hybr", options=options)
    below, series, off = at(*solved.x.tolist())
    if not np.abs(off).max() < _HELD:
        raise InputError(UNEVEN_FRICTION)
    own = {each.name: getattr(wanted, each.name) for each in fields(Loading)}
    turned = below.zone._replace(centre=below.mirror * wanted.mirror * below.zone.centre)
    found = InLayers(**{**own, "zone": turned}, below=below, series=trimmed(series), contact=pressed)
    _check(found)
    return found


def _stretched(Qf: float) -> float:
    """-log(1 - Qf), odd in Qf: near sliding the half-width of a stick zone follows 1 - Qf."""
    return math.copysign(min(-math.log(max(1 - abs(Qf), 1e-300)), 2 * _FULL), Qf)


def _check(found: InLayers) -> None:
    """Raise InputError if tractions exceed the bound in the stick zone, or points beside it slip the other way."""
    e, c = found._middle
    x, beside = e + c * NODES, _beside(found)
    room = found.bound * found.shape.pressure(x) - np.abs(found.traction(x))
    if (room < -_ROUNDING).any() or (found.slip(beside) * _ways(found, beside) < -_ROUNDING).any():
        raise InputError(UNEVEN_FRICTION)


def _middle(below: Loading) -> tuple[float, float]:
    """Middle and half-width, which keeps its digits where it is small, of the stick zone of ``below``."""
    return sum(below.ends) / 2, below.zone.half_width


def _rule(below: Loading) -> tuple[Array, Array]:
    """Points and weights of quadrature over the contact."""
    return rule_over(np.unique(np.clip([-1.0, *below.shape.kinks, *below.ends, 1.0], -1, 1)))


def _solved(pressed: Contact, below: Loading) -> tuple[Array, float, float]:
    """The series s (k,) with the stick zone of the half-planes ``below``, and the loads Qf and sf, with their signs."""
    layer, a, (e, c) = pressed.layer, pressed.a, _middle(below)
    assert layer
    x, weights = _rule(below)
    at, inner, x_rule = (pressed.places(each) for each in (e + c * NODES, e + c * POINTS, x))
    given = TO_SERIES @ layer.smooth("shear", at, x_rule, a * weights * below.traction(x) / below.bound)
    own = TO_SERIES @ layer.smooth("shear", at, inner, a * c * FORCES).T
    series = np.linalg.solve(np.eye(COUNT) + own[1:], given[1:])
    first = float(given[0] - own[0] @ series)
    Qf, sf = below.loads
    return np.append(first, series), Qf - c * float(series[0]), sf - 8 * first


def _added(found: InLayers, x: Array) -> Array:
    """sqrt(1 - y^2) sum s_j U_(j-1)(y) in the stick zone, zero beside it."""
    e, c = found._middle
    y = np.clip((x - e) / c, -1.0, 1.0)
    return np.sqrt((1 - y) * (1 + y)) * second_kind(found.series[1:], y)


def _integrals(eta: Array, count: int) -> Array:
    """int_0^eta exp(-j y) sinh(y) dy, (count, n), for j from 0 on."""
    j = np.arange(count)[:, None]
    grows = np.where(j == 1, eta, np.expm1((1 - j) * eta) / np.where(j == 1, 1, 1 - j))
    return (grows + np.expm1(-(1 + j) * eta) / (1 + j)) / 2
