"""Stick zones under a million random loads at once, against a loop of root searches on the elliptic equations.

python benchmarks/stick_zones.py [--points 1000000] [--loop 1000]
"""

import argparse
import math
import time

import mpmath as mp
import numpy as np
from scipy.optimize import root
from scipy.special import ellipe, ellipk, elliprf, elliprj

import partialslip
from partialslip.halfplane import contact, one_step_zone

F = 0.5
REPEATS = 3
CHECKED = 200


def random_loads(count):
    """Qf and sf, half of them beyond the transition 8 (1 - sqrt(1 - Qf)) from small to large tension."""
    random = np.random.default_rng(1)
    Qf = random.random(count)
    return Qf, random.random(count) * 2 * 8 * (1 - np.sqrt(1 - Qf))


def elliptic(m, n, r, K, E, Pi_phi, Pi_omega, pi):
    """(sf, Qf) of the zone [-m, n] by the paper's (24)-(26), scaled; any kind of number."""
    e, c, B = (n - m) / 2, (n + m) / 2, (3 * n**2 - 2 * m * n + 3 * m**2 - 4) / 3
    I0 = -2 * r * E + (2 * e + 4) * (1 + m) / r * K + 4 * e / r * (Pi_phi - c * Pi_omega)
    bracket = (n / 3 + 2) * m - (m**2 + n**2) / 2 - 2 * (1 + n) / 3
    I1 = 3 * (-2 * e * r * E - (1 + m) / r * bracket * K + B / r * (Pi_phi - c * Pi_omega)) / 2
    return 8 * I0 / pi, 2 * (I1 - e * I0) / pi


def residual(ends, sf, Qf):
    """For large tension, in floating point."""
    m, n = ends.tolist()
    square, c = (1 + m) * (1 + n), (n + m) / 2
    if not (c > 0 and m > -1 and n > -1):
        return np.array([1e3, 1e3])
    rest = 4 * c / square  # 1 - chi^2

    def Pi(t):
        return float(elliprf(0, rest, 1) + t / 3 * elliprj(0, rest, 1, 1 - t))

    K, E = float(ellipk(1 - rest)), float(ellipe(1 - rest))
    loads = elliptic(m, n, math.sqrt(square), K, E, Pi((m - 1) / (m + 1)), Pi((1 - n) / (1 + m)), math.pi)
    return np.array([loads[0] - sf, loads[1] - Qf])


def exact_loads(m, n, s):
    """(sf, Qf) in 40 digits."""
    if s > 0:
        return 4 * (m - n), 1 - (n + m) ** 2 / 4
    square = (1 + m) * (1 + n)
    chi2 = 1 - 2 * (n + m) / square
    Pi_phi, Pi_omega = mp.ellippi((m - 1) / (m + 1), chi2), mp.ellippi((1 - n) / (1 + m), chi2)
    return elliptic(m, n, mp.sqrt(square), mp.ellipk(chi2), mp.ellipe(chi2), Pi_phi, Pi_omega, mp.pi)


def errors(pressed, dQ, dsigma, m, n, s):
    """Errors of m and n, in a: one Newton step from where they are, in 40 digits."""
    mp.mp.dps = 40
    step = mp.mpf(10) ** -20
    a, P = mp.mpf(pressed.a), mp.mpf(pressed.P)
    sf, Qf = mp.mpf(dsigma) * mp.pi * a / (2 * F * P), mp.mpf(dQ) / (2 * F * P)
    m, n = mp.mpf(m) / a, mp.mpf(n) / a
    here = exact_loads(m, n, s)
    by_m, by_n = exact_loads(m - step, n, s), exact_loads(m, n - step, s)
    jacobian = mp.matrix([[(here[i] - by[i]) / step for by in (by_m, by_n)] for i in (0, 1)])
    change = mp.lu_solve(jacobian, mp.matrix([sf - here[0], Qf - here[1]]))
    return [float(abs(value)) for value in change]


def timed(pressed, dQ, dsigma):
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        zones = one_step_zone(pressed, F, dQ, dsigma)
        times.append(time.perf_counter() - start)
    return zones, times


def main(points, loop):
    pressed = contact(partialslip.load_scene("hertz-large-tension"))
    Qf, sf = random_loads(points)
    dQ, dsigma = 2 * F * pressed.P * Qf, F * pressed.p0 * sf
    zones, times = timed(pressed, dQ, dsigma)
    seconds = min(times)
    large = np.flatnonzero(zones.s < 0)
    print(f"at once: {points} points, {len(large) / points:.1%} of them large tension")
    print(f"  {seconds:.3f} s, best of {REPEATS} (median {np.median(times):.3f} s); {points / seconds:.4g} points/s")

    random = np.random.default_rng(2)
    sample = random.choice(points, min(CHECKED, points), replace=False)
    columns = (dQ, dsigma, zones.m, zones.n, zones.s)
    off = np.array([errors(pressed, *(values[i] for values in columns)) for i in sample])
    print(f"  m and n of {len(sample)} of them against 40 digits: largest error {off.max():.1e} a,", end=" ")
    print(f"median {np.median(off):.1e} a")

    chosen = random.choice(large, min(loop, len(large)), replace=False)
    found, converged = np.empty((len(chosen), 2)), np.empty(len(chosen), bool)
    start = time.perf_counter()
    for i, at in enumerate(chosen):
        touching = 2 * math.sqrt(1 - Qf[at]) - 1  # the zone at the transition: m = 1, n = 2 c - 1
        solution = root(residual, (1.0, touching), args=(sf[at], Qf[at]), method="hybr")
        found[i], converged[i] = solution.x, solution.success
    each = (time.perf_counter() - start) / len(chosen)
    expected = np.stack([zones.m[chosen], zones.n[chosen]], axis=1) / pressed.a
    same = converged & (np.abs(found - expected).max(axis=1) < 1e-6)
    print(f"loop of scipy.optimize.root (hybr): {len(chosen)} points of large tension")
    print(f"  {each * 1e6:.0f} us a point; {converged.sum()} converged, {same.sum()} of them to the same zone")

    alike = min(timed(pressed, dQ[large], dsigma[large])[1]) / len(large)
    print(f"ratio per point: {each * points / seconds:.0f}; {each / alike:.0f} with large tension alone at once, too")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--points", type=int, default=1_000_000, metavar="N")
    parser.add_argument("--loop", type=int, default=1000, metavar="N")
    arguments = parser.parse_args()
    main(arguments.points, arguments.loop)
