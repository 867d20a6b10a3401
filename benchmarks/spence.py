"""Dissimilar half-planes pressed together, by the self-similar solution: no march, and no code of partialslip.

python benchmarks/spence.py prints the targets of PS-25 and how far the frozen ones are from them.

All stages of pressing under a parabola are similar, and the contact grows as under a flat punch of its half-width, with
the same stick zone |x| < c at all stages (Spence 1968, 1975). Lengths in the punch's half-width, H t(x) = (1/pi) int
t(s)/(x - s) ds, beta of Dundurs (its sign only mirrors q), e = arctan(f beta)/pi:

    H p = beta q in |x| < 1,    H q = -beta p in |x| < c,    q = f sgn(x) p in c < |x| < 1,    int p dx = 1.

Let r = q - f p in 0 < x < c. Plemelj's formulas give the powers at c and at the end, and that p and r share R:

    r = (c - x)^w R(x),    p = A(x),              0 < x < c,
    p = A(x) + k (x - c)^w R(x),                  c < x < m,    k = -beta/((1 + f^2 beta^2) sin(pi (w + 1))),
    p = (1 - x)^(e - 1/2) D(x),                   m < x < 1.

A, which is even, R and D are analytic: their Chebyshev series converge geometrically. w is 1/2 - e or -1/2 - e. With
the latter every c has a solution; R(c) = 0 gives the stick zone, where tractions are continuous. The parabola's contact
follows from all punches up to its half-width a (x in a, p0 = 2 P/(pi a), A R P as in Hertz's a^2 = 2 A R P/pi):

    p(x)/p0 = pi x int_x^1 p_punch(t) dt/t^2,    a^2 = -(2/pi) A R P int_0^1 p_punch(t) ln(1 - t^2) dt/t^2.

Sources: D. A. Spence, Self similar solutions to adhesive contact problems with incremental loading, Proc. R. Soc. Lond.
A 305, 1968, 55-80; The Hertz contact problem with finite friction, J. Elasticity 5, 1975, 297-319.
"""

import itertools
import json
import tomllib
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.polynomial.legendre import leggauss
from scipy.optimize import brentq
from scipy.special import digamma, ellipk, ellipkm1, roots_jacobi

Array = np.ndarray[Any, np.dtype[Any]]
Basis = Callable[[Array], Array]

DATA = Path(__file__).parents[1] / "src" / "partialslip" / "verify" / "benchmark"
TERMS = 20  # accuracy: of each series; c of PS-25 is the same to 1e-12 from 16 on
SHARE = 0.4  # accuracy: (m - c)/(1 - c)
POINTS = 160  # accuracy: of each quadrature
NEAR = 1.2  # accuracy: sum of the half-axes of Bernstein's ellipse within which the kernel's pole is subtracted
GRADED = 6  # accuracy: power by which quadrature points of p are graded towards c and the end


def goodman(ratio: float) -> float:
    """Stick zone in Goodman's approximation, H p = 0: K(c)/K'(c) = ``ratio`` = f/beta (Spence 1975)."""
    return float(brentq(lambda c: ellipk(c * c) / ellipkm1(c * c) - ratio, 1e-9, 1 - 1e-12))


@dataclass(frozen=True)
class Punch:
    """Flat punch with the stick zone |x| < ``c``: ``m``, ``w``, ``k`` as above, ``edge`` = e - 1/2, and the ``bases``
    of A, R and D with their coefficients, ``series``."""

    f: float
    c: float
    m: float
    w: float
    k: float
    edge: float
    bases: tuple[Basis, ...]
    series: tuple[Array, ...]

    def R(self, x: Array) -> Array:
        """R at ``x`` (n,)."""
        return self.bases[1](x) @ self.series[1]

    def p(self, x: Array, beside: Array | None = None) -> Array:
        """Pressure at 0 <= ``x`` < 1 (n,); ``beside`` = 1 - x, if it is known better than x."""
        A, D = (self.bases[i](x) @ self.series[i] for i in (0, 2))
        inner = A + np.where(x > self.c, self.k * np.abs(x - self.c) ** self.w * self.R(x), 0.0)
        return np.where(x < self.m, inner, (1 - x if beside is None else beside) ** self.edge * D)

    def q(self, x: Array, beside: Array | None = None) -> Array:
        """Shear traction, likewise."""
        r = np.where(x < self.c, np.abs(self.c - x) ** self.w * self.R(x), 0.0)
        return self.f * self.p(x, beside) + r

    def integral(self, weigh: Callable[[Array, Array, Array], Array], begins: float = 0.0) -> float:
        """Integral of ``weigh`` (p, t, 1 - t) from ``begins`` to 1."""
        v, by = (leggauss(POINTS) + np.array([[1.0], [0.0]])) / 2
        found = 0.0
        for left, right in itertools.pairwise((0.0, self.c, self.m, 1.0)):
            if (length := right - max(left, begins)) > 0:
                far = length * v**GRADED
                t = 1 - far if right == 1 else right - length + far
                beside = far if right == 1 else 1 - t
                found += float(by * GRADED * v ** (GRADED - 1) * length @ weigh(self.p(t, beside), t, beside))
        return found

    def pressed(self, x: float) -> float:
        """p/p0 under the parabola at ``x``; lengths in a."""
        p0 = float(self.p(np.zeros(1))[0])
        rest = self.integral(lambda p, t, _: (p - p0) / t**2, x) if x else 0.0
        return np.pi * (p0 * (1 - x) + x * rest)

    def size(self) -> float:
        """a^2/(A R P) under the parabola."""

        def weighed(p: Array, t: Array, beside: Array) -> Array:
            inner = np.log1p(-(np.minimum(t, 0.5) ** 2))
            return p * np.where(t < 0.5, inner, np.log(beside * (1 + t))) / t**2

        return -2 / np.pi * self.integral(weighed)


def punch(beta: float, f: float, terms: int = TERMS, share: float = SHARE) -> Punch:
    """The flat punch for Dundurs' ``beta`` > 0 and the coefficient of friction ``f``."""

    def singular(c: float) -> float:
        return float(collocated(beta, f, c, True, terms, share).R(np.array([c]))[0])

    near = goodman(f / beta)
    found = collocated(beta, f, brentq(singular, 0.4 * near, (1 + near) / 2, xtol=1e-15), False, terms, share)
    force = 2 * found.integral(lambda p, *_: p)
    return replace(found, series=tuple(each / force for each in found.series))


def collocated(beta: float, f: float, c: float, singular: bool, terms: int, share: float) -> Punch:
    """The punch with the stick zone ``c`` and p(0) = 1 that meets all equations best, at twice as many points as there
    are terms; ``singular``: with w = -1/2 - e."""
    e, m = np.arctan(f * beta) / np.pi, c + share * (1 - c)
    w, edge = (-0.5 if singular else 0.5) - e, e - 0.5
    k = -beta / (1 + (f * beta) ** 2) / np.sin(np.pi * (w + 1))
    bases: tuple[Basis, Basis, Basis] = (
        lambda x: chebvander(x / m, 2 * terms - 2)[:, ::2],
        lambda x: chebvander(2 * x / m - 1, terms - 1),
        lambda x: chebvander((2 * x - m - 1) / (1 - m), terms - 1),
    )
    A, R, D = bases
    at = (1 - np.cos((np.arange(2 * terms) + 0.5) * np.pi / (2 * terms))) / 2
    x = np.concatenate([c * at, c + (m - c) * at, m + (1 - m) * at])
    stick, end, beside = (x < c)[:, None], (x > m)[:, None], (1 - x)[:, None]
    own = np.abs(x - c)[:, None] ** w * R(x)
    p = np.hstack([np.where(end, 0, A(x)), np.where(stick | end, 0, k * own), np.where(end, beside**edge * D(x), 0)])
    r = np.hstack([0 * own, np.where(stick, own, 0), 0 * own])
    panels = (0.0, m, 0.0, A), (c, m, w, R), (1.0, m, edge, D), (c, 0.0, w, R)
    right, left = ([cauchy(i, j, power, basis, side * x) for i, j, power, basis in panels] for side in (1, -1))
    even, odd = ([one + sign * other for one, other in zip(right, left, strict=True)] for sign in (-1, 1))
    opens = np.hstack([even[0], k * even[1], even[2]]) - beta * (f * p + r)
    slips = np.hstack([f * odd[0], f * k * odd[1] + odd[3], f * odd[2]]) + beta * p
    scale = np.where(end, beside, np.abs(x - c)[:, None] if singular else 1.0) ** 0.5
    both = np.array([m])
    meets = np.hstack([A(both), k * (m - c) ** w * R(both), -((1 - m) ** edge) * D(both)])
    middle = np.hstack([A(np.zeros(1)), np.zeros((1, 2 * terms))])
    rows = np.vstack([scale * opens, (scale * slips)[: len(at)], meets, middle])
    found = np.linalg.lstsq(rows, np.append(np.zeros(len(rows) - 1), 1.0), rcond=1e-15)[0]
    return Punch(f, c, m, w, k, edge, bases, tuple(np.split(found, 3)))


def cauchy(start: float, end: float, power: float, basis: Basis, x: Array) -> Array:
    """(1/pi) int |t - ``start``|^``power`` basis(t)/(x - t) dt between ``start`` and ``end``, at ``x`` (n,), principal
    value: (n, terms)."""
    t, by = roots_jacobi(POINTS, 0.0, power)
    t, by, length, y = (t + 1) / 2, by / 2 ** (power + 1), end - start, (x - start) / (end - start)
    far = np.abs(2 * y - 1)
    near = (far + np.sqrt(np.maximum(far**2 - 1, 0)) < NEAR)[:, None]
    kernel = by / (y[:, None] - t)
    apart = np.where(near, basis(x), 0.0) * (kernel.sum(1) + pole(power, y))[:, None]
    return np.sign(length) * abs(length) ** power * (kernel @ basis(start + length * t) - apart) / np.pi


def pole(power: float, y: Array) -> Array:
    """Principal value of int_0^1 t^``power``/(t - y) dt at ``y`` (n,)."""
    if not power:
        return np.log(np.abs(1 / y - 1))
    inner = np.abs(y) < 1
    at, z = np.where(inner, y, 0.5), 1 / np.where(inner, 2.0, y)
    whole = np.where(y > 0, 1 / np.tan(np.pi * power), 1 / np.sin(np.pi * power))  # of t from 0 to infinity
    return np.where(inner, -np.pi * whole * np.abs(at) ** power - lerch(-power, at), -z * lerch(power + 1, z))


def lerch(b: float, z: Array) -> Array:
    """Sum of z^n/(n + b) over n = 0, 1, ..., for -1 <= ``z`` < 1 (n,): in powers of z/(z - 1) or of 1 - z. SciPy's
    hyp2f1(1, b, b + 1, z) is wrong at some z near 1 for b = 1.499999."""
    n, low, rest = np.arange(120), np.minimum(z, 0.3), 1 - np.maximum(z, 0.3)[:, None]
    falling, rising = (np.cumprod(np.append(1.0, each)) for each in (n[1:] / (n[1:] + b), (n[:-1] + b) / n[1:]))
    below = (falling * (low / (low - 1))[:, None] ** n).sum(1) / (b * (1 - low))
    return np.where(z < 0.3, below, (rising * (digamma(n + 1) - digamma(n + b) - np.log(rest)) * rest**n).sum(1))


def values(places: float | None = None) -> dict[str, float]:
    """Targets of PS-25, in SI units; p@0.5 is at half of ``places``, m, or of a. p falls from x = 0 on."""
    scene = tomllib.loads((DATA / "problems" / "PS-25.toml").read_text("utf-8"))["scene"]
    E, nu = (np.array([scene["material"][body][key] for body in ("upper", "lower")]) for key in ("E", "nu"))
    A, P = float((2 * (1 - nu**2) / E).sum()), scene["load"]["P"]
    found = punch(abs(float(np.diff((1 - 2 * nu) * (1 + nu) / E)[0])) / A, scene["friction"]["f"])
    a = float(np.sqrt(found.size() * A * scene["profile"]["R"] * P))
    p = {f"p@{x}": found.pressed(abs(x) * (places or a) / a) * 2 * P / (np.pi * a) for x in (-0.9, -0.5, 0, 0.5, 0.9)}
    return {"a": a, "m": found.c * a, "n": found.c * a, "p_max": p["p@0"]} | p


def main() -> None:
    """Print the targets of PS-25 and how far the frozen ones are from them, in their scales."""
    frozen = json.loads((DATA / "targets.json").read_text("utf-8"))["targets"]["PS-25"]
    for key, value in values(frozen["a"]["value"]).items():
        off = (frozen[key]["value"] - value) / frozen[key]["scale"]
        print(f"{key:7} {value:.12g}, frozen off by {off:8.1e}, uncertainty {frozen[key]['uncertainty']:.0e}")


if __name__ == "__main__":
    main()
