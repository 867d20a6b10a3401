"""f from a measured loop of Q over displacement: least squares on the exact loop of half-planes.

From a turning point on, a change y of Q slips the surfaces by G(y; f) = f g(y/f), whatever the amplitude, as long as
the adhered shear traction has one sign. With turning points Q1 < Q2, compliance C of all that is in series, and drift,

    displacement = d0 + C Q + drift t + G(Q - Q1)                  where Q rises,
    displacement = d0 + C Q + drift t + G(Q2 - Q1) - G(Q2 - Q)     where Q falls.

d0, C, drift, Q1 and Q2 are nuisance parameters. Both columns have noise: a row weighs 1/(s_d^2 + (C + G')^2 s_Q^2)
(effective variance: Orear, 1982). With S(f) the least sum of squares at f, s^2 = S_min/(n - 6), and t of Student's
distribution, the interval is S(f) <= S_min + (3 t/2)^2 tau s^2, and one-sided if it contains f = infinity, no slip.
tau, the sum of the autocorrelations of the residuals, counts correlated rows as fewer.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq, least_squares, minimize_scalar
from scipy.stats import t as student

from partialslip.halfplane.contact import Contact, contact
from partialslip.halfplane.loop import hysteresis
from partialslip.run.tolerance import COVERAGE
from partialslip.scene import Scene
from partialslip.study.identify.half_planes import half_planes
from partialslip.study.identify.interval import Interval
from partialslip.study.identify.measured_loop import Branches, MeasuredLoop, branches_of
from partialslip.tools.arrays import Array, Indices
from partialslip.tools.errors import InputError

_NEARLY = 1 - 1e-9  # accuracy: Q/(f P) of the largest loop
_POINTS, _TABLE = 401, 20_001  # accuracy: of that loop, and of the table from it
_GRID = np.array([*np.arange(10) / 10, 0.95, 0.98, 1.0, 1.02, 1.06, 1.1])  # of S over Q/(f P)
_WALL = 1e4  # accuracy: residual of Q/(f P) - 1 above sliding, in standard deviations
_PARAMETERS = 6  # fixed: d0, C, drift, Q1, Q2 and f
_LEAST = 1e-7  # accuracy: of the range: least noise
_PULL = 14.0  # accuracy: chi^2 of two turning points above which rows are missing there: 1 in 1000
_CORRELATED = 3.0  # accuracy: standard deviations of the first autocorrelation of white noise
_BACKWARDS = 4.0  # accuracy: standard errors
_FLAT, _SLIDES = 0.02, 0.25  # limit: of the ranges of Q and displacement: a plateau of sliding
_BRANCH = 400  # display: points of a branch of the fitted loop
_AS_GOOD = 1.02  # display: f over that of sliding that says no more
_SEARCH = 1e-4  # accuracy: relative, of f
_WIDER = 1.5  # accuracy: of intervals: noise of Q bends S(f), and tau is an estimate (measured: benchmarks/identify.py)
_OUTLIER, _FAR = 8.0, 0.05  # limit: standard deviations, and range of the displacement, by which no row may be off
_RATIO = 2.0  # display: upper over lower limit above which f is hardly told


@dataclass(frozen=True, eq=False)
class Identified:
    """What a loop tells.

    Parameters
    ----------
    f, stiffness : Interval
        ``stiffness``, dQ/d(displacement) while all sticks, of all that is in series, Pa.
    area : float
        Of the fitted loop: energy dissipated per cycle by Q, J/m.
    opening : float
        Largest width of the fitted loop along the displacement, m.
    scatter : float
        Standard deviation of the residuals of the displacement, m.
    turns : (float, float)
        Fitted Q at the turning points, N/m.
    correlation : float
        Rows that count as one, tau.
    P : float
        Normal force, N/m.
    loop : MeasuredLoop
        The rows that were fitted: means of successive rows if Q is noisy.
    fitted, drift : (n,) arrays
        Fitted displacement at these rows, and the part of it that is drift, m.
    curve : (2, k) array
        Displacement without drift (m) and Q (N/m) along the fitted loop.
    remarks : tuple of str
    """

    f: Interval
    stiffness: Interval
    area: float
    opening: float
    scatter: float
    turns: tuple[float, float]
    correlation: float
    P: float
    loop: MeasuredLoop
    fitted: Array
    drift: Array
    curve: Array
    remarks: tuple[str, ...]


class _Solved(NamedTuple):
    """Parameters (5,) of least squares at a given f, sum of squares S, residuals and their derivatives."""

    at: Array
    S: float
    residuals: Array
    jacobian: Array


class _Fit:
    """Least squares in units of the range of displacement and of Q2 - Q1; ``u`` = (Q2 - Q1)/(2 f P)."""

    def __init__(self, pressed: Contact, A: float, tension: float, branches: Branches, sharp: bool = True) -> None:
        largest = 2 * pressed.P * _NEARLY
        loop = hysteresis(pressed, A, 1.0, largest, tension * largest, _POINTS)
        curve = PchipInterpolator(loop.Q[:_POINTS] / largest, loop.displacement[:_POINTS])
        self._s = np.linspace(0, 1, _TABLE)
        self._G, self._slope, self._bend = (curve(self._s, order) for order in range(3))
        own = branches.loop
        self.low, self.force = branches.turns[0], float(np.ptp(branches.turns))
        self.P, self.length = pressed.P, float(np.ptp(own.displacement))
        blocks = _blocks(branches)
        count = np.bincount(blocks)
        Q, moved, time = (np.bincount(blocks, each) / count for each in (own.Q, own.displacement, own.time))
        self.y, self.d = (Q - self.low) / self.force, (moved - own.displacement[0]) / self.length
        self.time, self.t = time, (time - own.time[0]) / (np.ptp(own.time) or 1.0)
        self.rises = np.bincount(blocks, branches.way) > 0
        self.noise = np.maximum(branches.noise / (self.length, self.force), _LEAST)[:, None] / np.sqrt(count)
        self.turns_error = np.maximum(branches.turns_error / self.force, _LEAST) if sharp else np.full(2, np.inf)
        line = np.linalg.lstsq(np.stack([np.ones_like(self.y), self.y, self.t], 1), self.d, rcond=None)[0]
        self._start = np.append(line, [0.0, 1.0])

    def friction(self, u: float) -> float:
        return float(self.force / (2 * self.P * u)) if u > 0 else np.inf

    def slipped(self, change: Array, u: float) -> tuple[Array, Array, Array]:
        """G and its first and second derivatives at a ``change`` of Q."""
        if u <= 0:
            return 0 * change, 0 * change, 0 * change
        s, scale = u * change, self.friction(u) / self.length
        G, slope, bend = (np.interp(s, self._s, of) for of in (self._G, self._slope, self._bend))
        return scale * (G + slope * np.maximum(s - 1, 0)), scale * u * slope, scale * u**2 * bend * (s < 1)

    def model(self, at: Array, u: float) -> tuple[Array, Array, Array, Array]:
        """Displacement (n,) and its slope along a branch, and the derivatives of both by ``at``, (5, n)."""
        start, compliance, drift, low, high = at
        whole = high - low
        reach = np.append(np.where(self.rises, self.y - low, high - self.y), whole)
        G, slope, bend = self.slipped(reach, u)
        (G, Gs), (slope, slopes), bend = (G[:-1], G[-1]), (slope[:-1], slope[-1]), bend[:-1]
        model = start + compliance * self.y + drift * self.t + np.where(self.rises, G, Gs - G)
        one, no = np.ones_like(self.y), 0 * self.y
        by_turns = -np.where(self.rises, slope, slopes), np.where(self.rises, 0, slopes - slope)
        bent = -bend * self.rises, bend * ~self.rises
        return model, compliance + slope, np.array([one, self.y, self.t, *by_turns]), np.array([no, one, no, *bent])

    def closed(self, at: Array) -> tuple[Array, Array]:
        """Q (N/m) and displacement (m) of the fitted loop without drift, (2 k,): k points up, k down."""
        _, _, _, low, high = at
        share = np.linspace(0, 1, _BRANCH)
        way = (high - low) * np.append(share, share[::-1])
        G = self.slipped((high - low) * np.append(share, share), self.best)[0]
        G[_BRANCH:] = G[_BRANCH - 1] - G[_BRANCH:]
        return self.low + self.force * (low + way), self.length * (at[0] + at[1] * (low + way) + G)

    def residuals(self, at: Array, u: float) -> Array:
        model, slope, _, _ = self.model(at, u)
        rows = (self.d - model) / np.hypot(self.noise[0], slope * self.noise[1])
        return np.concatenate([rows, (at[3:] - (0, 1)) / self.turns_error, [_WALL * max(u * (at[4] - at[3]) - 1, 0)]])

    def jacobian(self, at: Array, u: float) -> Array:
        """Derivatives of the residuals, (n + 3, 5)."""
        model, slope, models, slopes = self.model(at, u)
        variance = self.noise[0] ** 2 + (slope * self.noise[1]) ** 2
        rows = -(models + (self.d - model) * slope * self.noise[1] ** 2 / variance * slopes) / np.sqrt(variance)
        turns = np.zeros((5, 3))
        turns[[3, 4], [0, 1]] = 1 / self.turns_error
        turns[3:, 2] = _WALL * u * np.array([-1, 1]) * (u * (at[4] - at[3]) > 1)
        return np.concatenate([rows, turns], axis=1).T

    def solve(self, u: float) -> _Solved:
        found = least_squares(self.residuals, self._start, self.jacobian, method="lm", args=(u,), xtol=1e-7, ftol=1e-9)
        self._start = found.x  # near that of the next u
        return _Solved(found.x, 2 * float(found.cost), found.fun, found.jac)

    @cached_property
    def grid(self) -> list[float]:
        """S at the u of the grid."""
        return [self.solve(u).S for u in _GRID]

    @cached_property
    def best(self) -> float:
        """u of the least S."""
        k = int(np.argmin(self.grid))
        low, high = _GRID[max(k - 1, 0)], _GRID[min(k + 1, len(_GRID) - 1)]
        found = minimize_scalar(
            lambda u: self.solve(u).S, bounds=(low, high), method="bounded", options={"xatol": 1e-5}
        )
        return float(found.x if found.fun < self.grid[k] else _GRID[k])

    def limits(self, most: float) -> tuple[float, float]:
        """Least and largest u with S <= ``most``: 0 and the largest of the grid where S is that small there."""

        def crossing(outside: Array) -> float:
            ends = outside[0], self.best
            above = [most < self.solve(u).S for u in ends]
            if above != [True, False]:  # another minimum at the same u
                return float(ends[0])
            return float(brentq(lambda u: self.solve(u).S - most, *ends, xtol=1e-5))

        inside = np.array(self.grid) <= most
        below, above = (_GRID[(way * (_GRID - self.best) > 0) & ~inside][::way] for way in (-1, 1))
        return crossing(below) if len(below) else 0.0, crossing(above) if len(above) else float(_GRID[-1])


def from_loop(scene: Scene, loop: MeasuredLoop) -> Identified:
    """f, and the stiffness of all in series, from a measured ``loop`` with their intervals of 95 %; material, profile,
    P and dsigma/dQ are those of ``scene``, its f plays no part. Bodies of a size act as equivalent half-planes.

    Raises
    ------
    InputError
        If the scene has no loop whose slip only grows from turning point to turning point (P varies, dissimilar
        materials, large tension), or the loop is not one of partial slip: it slides, or dissipates no energy.
    """
    scene, remarks = half_planes(scene)
    pressed, tension = contact(scene), _tension(scene)
    if abs(tension) * pressed.a * np.pi >= 4:  # adhered: dq = (dQ/pi + x dsigma/4)/sqrt(a^2 - x^2)
        raise InputError("load.sigma: slip reverses between the load points, and the loop does not tell f: must be "
                         "below 4 dQ/(pi a), or give --stick-width or --slip-scar")  # fmt: skip
    branches = branches_of(loop)
    _require_partial_slip(branches, pressed.P)
    fit = _Fit(pressed, scene.material.A, tension, branches)
    _require_friction(fit, loop.origin)
    found, spare = fit.solve(fit.best), len(fit.y) - _PARAMETERS
    if np.sum(found.residuals[-3:-1] ** 2) > _PULL * max(found.S / spare, 1):
        fit = _Fit(pressed, scene.material.A, tension, branches, sharp=False)
        found = fit.solve(fit.best)
        remarks += ("The rows near the turning points of Q do not fit the loop: are rows missing there? The fit finds "
                    "the turning points.",)  # fmt: skip
    rows = found.residuals[:-3]
    _require_data(fit, found, loop.origin)
    variance, tau = found.S / spare, _correlation(rows)
    correlated = _first_autocorrelation(rows) > _CORRELATED / np.sqrt(len(rows))
    if correlated:  # an error of the model repeats in each cycle
        tau *= max(branches.halves / 2, 1)
        remarks += (f"The residuals are correlated: {tau:.0f} rows count as one.",)
    unit = (
        _WIDER**2 * tau * variance * float(student.ppf((1 + COVERAGE) / 2, max(len(rows) / tau - _PARAMETERS, 1))) ** 2
    )
    low, high = fit.limits(found.S + unit)
    value = fit.friction(fit.best if low else 0.0)
    lowest, highest = min(fit.friction(high), value * (1 - _SEARCH)), max(fit.friction(low), value * (1 + _SEARCH))
    f = Interval(value, lowest, highest)
    remarks += _said(f, float(np.ptp(found.at[3:])) * fit.force / (2 * pressed.P))
    start, (Q, moved) = branches.loop.displacement[0], fit.closed(found.at)
    wide = moved[: _BRANCH - 1 : -1] - moved[:_BRANCH]
    rows_fitted = replace(
        branches.loop, displacement=start + fit.length * fit.d, Q=fit.low + fit.force * fit.y, time=fit.time
    )
    fitted = start + fit.length * fit.model(found.at, fit.best)[0]
    return Identified(
        f,
        _stiffness(fit, found, (low, high), unit),
        float(np.trapezoid(wide, Q[:_BRANCH])),
        float(wide.max()),
        float(np.std(fitted - rows_fitted.displacement)),
        (float(Q[0]), float(Q[_BRANCH])),
        tau,
        pressed.P,
        rows_fitted,
        fitted,
        found.at[2] * fit.t * fit.length,
        np.array([start + moved, Q]),
        (*branches.loop.notes, *remarks),
    )


def _blocks(branches: Branches) -> Indices:
    """Numbers (n,) of the blocks of successive rows of a branch whose means are fitted. Noise of Q, s, moves a curved
    loop by s^2 G''/2, the mean of k rows by (s^2/k + (k step)^2/12) G''/2: least for k^3 = 6 (s/step)^2."""
    way, step = branches.way, float(np.ptp(branches.turns)) * branches.halves / len(branches.way)
    size = max(round((6 * (branches.noise[1] / step) ** 2) ** (1 / 3)), 1)
    starts = np.flatnonzero(np.diff(way, prepend=0))
    since = np.arange(len(way)) - np.repeat(starts, np.diff(np.append(starts, len(way))))
    return np.cumsum(since % size == 0) - 1


def _tension(scene: Scene) -> float:
    """dsigma/dQ between load points 1 and 2, 1/m."""
    load = scene.load
    if load.dsigma and not load.dQ:
        raise InputError("load.Q: the same at load points 1 and 2: must change for a loop under tension")
    return load.dsigma / load.dQ if load.dsigma else 0.0


def _require_partial_slip(branches: Branches, P: float) -> None:
    """Raise InputError if the displacement goes on where Q has come to its end."""
    own, force = branches.loop, float(np.ptp(branches.turns))
    flat = max(_FLAT, 3 * branches.noise[1] / force)
    ends = np.where(branches.way > 0, branches.turns[1] - own.Q, own.Q - branches.turns[0]) < flat * force
    whole = float(np.ptp(own.displacement))
    for way in (1, -1):
        there = own.displacement[ends & (branches.way == way)]
        if len(there) and np.ptp(there) > (_SLIDES + 2 * flat) * whole + 6 * branches.noise[0]:
            raise InputError(
                f"{own.origin}: the displacement grows by {np.ptp(there) / whole:.0%} of its range at the largest Q: "
                f"the contact slides there, and f is about {force / (2 * P):.3g}, half the range of Q over P; must "
                "be a loop in partial slip"
            )


def _require_friction(fit: _Fit, origin: str) -> None:
    """Raise InputError if the displacement falls as Q rises, or Q gains energy."""
    stuck = fit.solve(0.0)
    rows = stuck.residuals[:-3]
    if stuck.at[1] <= 0:
        raise InputError(f"{origin}: the displacement falls as Q rises: change its sign, as by --factors=-1,1")
    opening = np.where(fit.rises, -1, 1) * fit.y * (1 - fit.y)  # of a loop with little slip
    wide = opening @ rows / (opening @ opening)
    rest = rows - wide * opening
    if wide < -_BACKWARDS * np.std(rest) * np.sqrt(_correlation(rest) / (opening @ opening)):
        raise InputError(f"{origin}: the loop runs backwards, Q gains energy: must be in the order of time, and Q and "
                         "displacement of one sign")  # fmt: skip


def _require_data(fit: _Fit, found: _Solved, origin: str) -> None:
    """Raise InputError if a row is far off all others."""
    rows = np.abs(found.residuals[:-3])
    off, worst = np.abs(fit.d - fit.model(found.at, fit.best)[0]), int(rows.argmax())
    if rows[worst] > _OUTLIER * 1.4826 * np.median(rows) and off[worst] > _FAR:
        raise InputError(f"{origin}: the row at time {fit.time[worst]:.6g} is off the loop by {off[worst]:.0%} of the "
                         "displacement's range: take rows out that are no data")  # fmt: skip


def _said(f: Interval, sliding: float) -> tuple[str, ...]:
    """What a reader must know of ``f``; the loop slides at the f ``sliding``."""
    if f.one_sided:
        more = ", Q/P, as the contact does not slide" if f.low < _AS_GOOD * sliding else ""
        return (f"The loop does not tell f: one without slip fits as well. f is at least {f.low:.3g}{more}.",)
    hardly = "The loop hardly tells f: a loop nearer to sliding, less noise or more cycles tell more."
    return (hardly,) if f.high > _RATIO * f.low else ()


def _stiffness(fit: _Fit, found: _Solved, limits: tuple[float, float], unit: float) -> Interval:
    """Stiffness in Pa: its own error at one f, and that of f."""
    own = np.sqrt(unit * np.linalg.pinv(found.jacobian.T @ found.jacobian)[1, 1])
    at = [fit.solve(u).at[1] - found.at[1] for u in limits]
    low, high = (found.at[1] + sign * np.hypot(own, max(sign * np.array([*at, 0.0]))) for sign in (-1, 1))
    scale = fit.force / fit.length
    return Interval(float(scale / found.at[1]), float(scale / high), float(scale / low) if low > 0 else np.inf)


def _first_autocorrelation(rows: Array) -> float:
    rows = rows - rows.mean()
    return float(rows[1:] @ rows[:-1] / (rows @ rows or 1.0))


def _correlation(rows: Array) -> float:
    """Sum of the autocorrelations of ``rows`` (n,), over pairs of lags up to the first negative sum (Geyer, 1992)."""
    count, rows = len(rows), rows - rows.mean()
    spectrum = np.abs(np.fft.rfft(rows, 2 * count)) ** 2
    of = np.fft.irfft(spectrum)[: count // 2 * 2]
    pairs = (of[::2] + of[1::2]) / (of[0] or 1.0)
    first = int(np.argmax(pairs <= 0)) if (pairs <= 0).any() else len(pairs)
    return max(2 * float(pairs[:first].sum()) - 1, 1.0)
