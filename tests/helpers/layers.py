"""Two equal layers on frictionless planes by direct collocation at Chebyshev nodes, and their kernels by the equations
of equilibrium; a solver of its own, in SI units."""

import numpy as np
from scipy.optimize import root

COUNT = 60
_W = np.concatenate([5 * k + 2.5 * (1 + np.polynomial.legendre.leggauss(40)[0]) for k in range(8)])
_DW = np.tile(2.5 * np.polynomial.legendre.leggauss(40)[1], 8)
_BELOW = np.sinh(2 * _W) + 2 * _W
_REST = {"M": (np.exp(-2 * _W) - 1 - 2 * _W) / _BELOW, "N": (np.exp(-2 * _W) + 1 - 2 * _W) / _BELOW}
_J = np.pi * np.arange(1, COUNT + 1) / (COUNT + 1)
INNER, OUTER = np.cos(_J), np.cos(np.pi * (np.arange(COUNT + 1) + 0.5) / (COUNT + 1))
_SQUARES = np.pi / (COUNT + 1) * np.sin(_J) ** 2


def moved(w, nu, traction, bonded=False):
    """Displacements (u, v) sin(k x), cos(k x) of the surface of a layer, times k E/(2(1 - nu^2)), under a pressure
    cos(k x), or a shear sin(k x) along x, by Navier's equations at Chebyshev points over the height w/k."""
    count = 40
    y = np.cos(np.pi * np.arange(count + 1) / count)
    c = np.where((np.arange(count + 1) % count) == 0, 2.0, 1.0) * (-1.0) ** np.arange(count + 1)
    D = np.outer(c, 1 / c) / (np.subtract.outer(y, y) + np.eye(count + 1))
    D = -(D - np.diag(D.sum(axis=1))) * 2 / w  # derivative by k times the depth w (1 - y)/2
    mu, one = 1 / (2 * (1 + nu)), np.eye(count + 1)
    lam = 2 * mu * nu / (1 - 2 * nu)
    along = np.hstack([mu * D @ D - (lam + 2 * mu) * one, -(lam + mu) * D])
    across = np.hstack([(lam + mu) * D, (lam + 2 * mu) * D @ D - mu * one])
    shear, normal = np.hstack([mu * D, -mu * one]), np.hstack([lam * one, (lam + 2 * mu) * D])
    held, still = np.hstack([0 * one, one]), np.hstack([one, 0 * one]) if bonded else shear
    A = np.vstack([along[1:-1], across[1:-1], shear[:1], still[-1:], normal[:1], held[-1:]])
    b = np.zeros(2 * count + 2)
    b[-4 if traction == "shear" else -2] = -1.0
    found = np.linalg.solve(A, b) / (2 * (1 - nu**2))
    return found[0], found[count + 1]


def smooth(kernel, h, x, t):
    """(1/h) int (F(w) - 1) sin(w (x - t)/h) dw, (x, t)."""
    at, of = np.exp(1j * np.outer(x / h, _W)), np.exp(-1j * np.outer(t / h, _W))
    return (at * (_DW * _REST[kernel] / h) @ of.T).imag


def pressed(A, R, P, h):
    """a and the smooth part phi of p = sqrt(a^2 - x^2) phi at the nodes, of Hertz's profile."""

    def solved(a):
        x, t = a * OUTER, a * INNER
        K = a**2 * _SQUARES / np.pi * (1 / np.subtract.outer(x, t) + smooth("M", h, x, t))
        phi = np.linalg.lstsq(K, x / (A * R), rcond=None)[0]
        return phi, a**2 * float(_SQUARES @ phi)

    guess = np.sqrt(2 * A * R * P / np.pi)
    a = guess * root(lambda s: solved(guess * float(s[0]))[1] / P - 1, [1 / (1 + guess / h / 4)], tol=1e-15).x[0]
    return float(a), solved(a)[0]


def interpolated(phi, y):
    """The smooth part at y, by its series of Chebyshev polynomials of the second kind."""
    j = np.arange(1, COUNT + 1)
    series = 2 / np.pi * np.sin(np.outer(j, _J)) * np.sin(_J) @ (phi * np.pi / (COUNT + 1))
    angle = np.arccos(np.clip(y, -1 + 1e-15, 1 - 1e-15))
    return np.sin(np.multiply.outer(angle, j)) @ series / np.sin(angle)


def sheared(a, phi, f, Q, sigma, h, large=0, begin=None):
    """(m, n) of the steady cycle between -Q, -sigma and Q, sigma: with one sign of slip, or if ``large`` that sign at
    the left end; ``f`` of x."""
    s, w = np.polynomial.legendre.leggauss(60)
    sine, weights = np.sin(np.pi / 2 * s), w * np.pi / 2 * np.cos(np.pi / 2 * s)

    def bound(x):
        y = np.clip(x / a, -1, 1)
        return f(x) * a * np.sqrt((1 - y) * (1 + y)) * interpolated(phi, y)

    def off(unknown):
        e, c = unknown[0] * a, unknown[1] * a
        ends = np.array([-a, e - c, e + c, a])
        t = ((ends[1:] + ends[:-1])[:, None] / 2 + np.diff(ends)[:, None] / 2 * sine).ravel()
        dt = (np.diff(ends)[:, None] / 2 * weights).ravel()

        def sign(x):  # as smooth as a polynomial between -1 and 1 can be
            y = np.clip((x - e) / c, -1, 1)
            step = y * (315 - 420 * y**2 + 378 * y**4 - 180 * y**6 + 35 * y**8) / 128
            return -large * step if large else 1.0

        x, at = e + c * OUTER, e + c * INNER
        F, Fx = bound(t) * sign(t), bound(x) * sign(x)
        step = np.subtract.outer(x, t)
        given = ((F - Fx[:, None]) / step + F * smooth("N", h, x, t)) @ dt + Fx * np.log(np.abs((x + a) / (a - x)))
        K = c**2 * _SQUARES * (1 / np.subtract.outer(x, at) + smooth("N", h, x, at))
        K = np.hstack([K, np.full((COUNT + 1, 1), np.pi)])
        star = np.linalg.solve(K / np.pi, -sigma / 4 - given / np.pi)
        total = F @ dt + c**2 * _SQUARES @ star[:-1]
        return np.array([star[-1] * a / (bound(0.0) * a), (total - Q) / (bound(0.0) * a)])

    start = begin if begin is not None else (0.0, 0.5)
    found = root(off, start, tol=1e-14)
    e, c = found.x * a
    assert np.abs(off(found.x)).max() < 1e-11
    return c - e, c + e
