"""The kernels of a layer on a frictionless plane, or bonded to one, in plane strain or plane stress: Fourier integrals,
by a fixed rule.

Two equal layers of height h are mirror images of each other: pressure and shear do not act on each other, as in
half-planes. A traction cos(k x) moves the surface of one layer by F(w)/k, w = k h, times that of a rigid base
at infinity, with F = M for pressure and N for shear along the traction, and G across it:

    M = (cosh 2w - 1)/(sinh 2w + 2w),   N = (cosh 2w + 1)/(sinh 2w + 2w),   G = 2w/(sinh 2w + 2w),

and of bonded layers, with kappa = 3 - 4 nu in plane strain and D = 2 kappa cosh 2w + 1 + kappa^2 + 4 w^2,

    M = (2 kappa sinh 2w - 4w)/D,   N = (2 kappa sinh 2w + 4w)/D,   G = (kappa^2 - 1 + 4 w^2)/D.

To 1/(x - t) of half-planes the layers add k(x - t) with

    k(s) = (1/h) int_0^oo (F(w) - 1) sin(w s/h) dw,

which is smooth: it sees a traction q by its transform int q exp(i w x/h) dx alone. Derived from Airy's function
(C_1 cosh k y + C_2 k y sinh k y) cos k x; see docs/theory.md, section 13, and Sneddon, Fourier transforms (1951).
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np

from partialslip.result.below import below_surface
from partialslip.scene import Scene
from partialslip.scene.bodies import Strips
from partialslip.tools.arrays import Array, Complex

# accuracy: panels of the rule along w: beyond 40 nothing is left, and up to h = a/3 it sees all waves of sin(2 w a/h)
_PANELS, _COUNT = (0.0, 1.5, 4.0, 8.0, 14.0, 24.0, 40.0), 24
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(_COUNT)
_HALF = np.diff(_PANELS)[:, None] / 2
_W = (np.array(_PANELS[:-1])[:, None] + _HALF * (1 + _NODES)).ravel()
_DW = (_HALF * _WEIGHTS).ravel()
Along = Literal["normal", "shear"]
# accuracy: what the sides of strips send back, in (a/h)(1 + a/h) exp(-decay W/h): 1.7 to 3 times what fem
# finds at widths of 3 and 4 heights, where it shows
_SENT_BACK = {"a": 8.0, "m": 16.0, "n": 16.0, "p": 16.0, "q": 30.0}


@dataclass(frozen=True)
class Layer:
    """What two equal ``strips`` of Kolosov's constant ``kappa`` add to two half-planes."""

    strips: Strips
    kappa: float

    @cached_property
    def _rest(self) -> dict[Along, Array]:
        """M - 1 and N - 1, without cancellation."""
        decay, parts = np.exp(-2 * _W), 4 * _W
        if self.strips.bonded:
            same = -2 * self.kappa * decay - 1 - self.kappa**2 - 4 * _W**2
            return {"normal": (same - parts) / self._below, "shear": (same + parts) / self._below}
        return {"normal": (decay - 1 - 2 * _W) / self._below, "shear": (decay + 1 - 2 * _W) / self._below}

    @cached_property
    def _across(self) -> Array:
        """G."""
        return (self.kappa**2 - 1 + 4 * _W**2 if self.strips.bonded else 2 * _W) / self._below

    @cached_property
    def _below(self) -> Array:
        if self.strips.bonded:
            return 2 * self.kappa * np.cosh(2 * _W) + 1 + self.kappa**2 + 4 * _W**2
        return np.sinh(2 * _W) + 2 * _W

    @cached_property
    def _decay(self) -> float:
        """Balanced states decay along the strips as exp(-x/h) to this power: by the least imaginary part of the roots
        of sinh 2w + 2w, or of D, which lies on the imaginary axis."""
        if not self.strips.bonded:
            return 2.1061
        from scipy.optimize import brentq  # takes long to import

        kappa = self.kappa
        return float(brentq(lambda v: 2 * kappa * math.cos(2 * v) + 1 + kappa**2 - 4 * v**2, 0.5, 1.5))

    @classmethod
    def of(cls, scene: Scene) -> "Layer | None":
        """The layers of a ``scene``; None without strips."""
        return cls(scene.strips, scene.material.bodies[0].kappa) if scene.strips else None

    @property
    def widening(self) -> float:
        """nu/(1 - nu) in plane strain, nu in plane stress."""
        return (3 - self.kappa) / (1 + self.kappa)

    @property
    def drags(self) -> bool:
        """Whether pressing strains the layers along x relative to each other: the sides of one alone are held."""
        return self.strips.held[0] != self.strips.held[1]

    @property
    def _share(self) -> float:
        return sum(self.strips.held) / (4 * self.height)

    @property
    def height(self) -> float:
        """Height of each layer, m."""
        return self.strips.height

    def left_out(self, a: float) -> dict[str, float]:
        """Estimates of what the sides of strips change in a contact of the half-width ``a``, m, beside the strain that
        is known (:meth:`smooth`), as of :attr:`partialslip.Result.estimate`; none if the strips are infinite."""
        if not math.isfinite(self.strips.width):
            return {}
        part = a / self.height * (1 + a / self.height) * math.exp(-self._decay * self.strips.width / self.height)
        return {key: factor * part for key, factor in _SENT_BACK.items()}

    def waves(self, x: Array) -> Complex:
        """exp(i w x/h), (..., w), at ``x`` (...), m."""
        return np.exp(1j * np.asarray(x, float)[..., None] / self.height * _W)

    def transforms(self, t: Array, forces: Array) -> Complex:
        """int q exp(i w t/h) dt, (..., w), of tractions with the ``forces`` (..., n), N/m, at ``t`` (n,), m."""
        return np.asarray(forces @ self.waves(t))

    def smooth(self, along: Along, x: Array, t: Array, forces: Array) -> Array:
        """(1/pi) int q(t) k(x - t) dt, Pa, at ``x`` (k,), m, of tractions with the ``forces`` (..., n), N/m, at ``t``
        (n,): (..., k).

        Bodies of a width W that are held along x on both sides share a shear force q at t unequally, in proportion to
        t: a uniform strain for each of them, here q t/(4 h W).
        """
        transforms = self.transforms(t, forces)
        factors = _DW * self._rest[along] / (np.pi * self.height)
        result = ((transforms.conj() * factors) @ self.waves(x).T).imag
        if along == "shear":
            result = result + (forces @ t)[..., None] * self._share
        return result

    def stretch(self, x: Array, t: Array, forces: Array) -> Array:
        """An integral of :meth:`smooth` along shear at ``x`` (k,), m, N/m."""
        factors = _DW * self._rest["shear"] / (np.pi * _W)
        result = -(self.transforms(t, forces).conj() * factors @ self.waves(x).T).real
        return np.asarray(result + float(forces @ t) * self._share * x)

    def added(self, places: Array, along: Along = "shear") -> Array:
        """Mean displacements of cells with ends at ``places`` (c + 1,), m, under unit forces on cells ``along`` the
        same way, that the layers add to those of half-planes, but for a rigid shift, in A: (c, c)."""
        middle, half = (places[1:] + places[:-1]) / 2, np.diff(places) / 2
        means = self.waves(middle) * np.sinc(half[:, None] / (np.pi * self.height) * _W)
        held = self._share if along == "shear" else 0.0
        return self._moved(means, along) - held * np.outer(middle, middle)

    def moved(self, x: Array, along: Along) -> Array:
        """Displacements at ``x`` (n,), m, under unit forces at these points ``along`` the same way, that layers without
        sides add to those of half-planes, but for a rigid shift, in A: (n, n)."""
        return self._moved(self.waves(x), along)

    def _moved(self, waves: Complex, along: Along) -> Array:
        """-1/pi times the integral of k(x - t), whose ``waves`` (n, w) at x and t are given, (n, n)."""
        factors = _DW * self._rest[along] / (np.pi * _W)
        return np.asarray(((waves * factors) @ waves.conj().T).real - factors.sum())

    def moved_across(self, x: Array) -> Array:
        """Displacements along x of the lower surface at ``x`` (n,), m, under unit forces that press at these points,
        that layers without sides add to those of half-planes, in A: (n, n)."""
        waves = self.waves(x)
        return np.asarray(((waves * (_DW * self._across / (2 * np.pi * _W))) @ waves.conj().T).imag)

    def stresses(self, x: Array, depth: Array, side: Array, acting: "Acting", along: Along) -> Array:
        """Stresses (3, k) xx, yy, xy, Pa, that the layers add to those of half-planes at ``x`` (k,), m, at the
        ``depth`` (k,), m, of the lower (``side`` = 1) or the upper body (-1), under the traction ``acting`` ``along``;
        NaN beyond the layers.

        Sides that are held along x bear a uniform stress: -nu/(1 - nu) P/W (plane strain) by which the layer would
        widen, and +-(1/(h W)) int q t dt.
        """
        within = depth <= self.height
        z = np.where(within, x - 1j * depth, 0.0)
        at, slope = self._potential(z, acting.transform, along)
        mirrored, _ = self._potential(z.conj(), acting.transform, along)
        held = np.where(side > 0, *self.strips.held)
        uniform = -self.widening * acting.force if along == "normal" else acting.moment / self.height
        across = side if along == "shear" else 1.0
        found = below_surface(at + uniform * held, mirrored + uniform * held, slope, z) * np.stack(
            [side**2, side**2, side]
        )
        return np.where(within, across * found, np.nan)

    def _potential(self, z: Complex, transform: Complex, along: Along) -> tuple[Complex, Complex]:
        """S(z) = E' (u' + i v'), Pa, and its derivative at ``z`` (k,), m, of the lower body, whose surface the layer
        moves by u and v more than a half-plane, continued to complex z
        (:func:`partialslip.result.below.below_surface`).
        """
        own, other = self._rest[along], self._across
        if along == "normal":
            cosine, sine = (
                other * transform.real - 1j * own * transform.imag,
                other * transform.imag + 1j * own * transform.real,
            )
        else:
            cosine, sine = (
                -own * transform.imag - 1j * other * transform.real,
                own * transform.real - 1j * other * transform.imag,
            )
        w = _W / self.height
        scale, angle = 2 * _DW / (np.pi * self.height), np.multiply.outer(z, w)
        c, s = (np.asarray(of(angle), complex) for of in (np.cos, np.sin))
        slope = np.asarray(c @ (scale * w * sine) - s @ (scale * w * cosine), complex)
        return np.asarray(c @ (scale * cosine) + s @ (scale * sine), complex), slope


class Acting(NamedTuple):
    """A traction as a layer sees it: its ``transform`` (w,), N/m, its resultant ``force``, N/m, and its ``moment`` int
    q t dt, N."""

    transform: Complex
    force: float
    moment: float

    @classmethod
    def of(cls, layer: Layer, t: Array, forces: Array) -> "Acting":
        """Of ``forces`` (n,), N/m, at ``t`` (n,), m."""
        return cls(layer.transforms(t, forces), float(forces.sum()), float(forces @ t))
