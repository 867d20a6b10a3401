"""Half cycles of a Hertz contact, cell by cell and event by event: it shares nothing with the package."""

import numpy as np
from boundary_elements import compliance


def hertz(count):
    """Middles, widths, compliance of equal cells of constant traction, and their mean pressures; a = f = A = p0 = 1."""
    ends = np.linspace(-1, 1, count + 1)
    x, widths = (ends[1:] + ends[:-1]) / 2, np.diff(ends)
    force = (ends * np.sqrt(1 - ends**2) + np.arcsin(ends)) / 2
    return x, widths, compliance(x, ends), np.diff(force) / widths


def follow(count, Qf, sf, halves=6):
    """Middles of cells and q at the end of so many half cycles from nothing, for a last one with positive changes, and
    lambda at which the last slip zone between two stick zones has gone in it.

    Between events (a cell comes to its bound, or sticks again) all rates are constant. A cell at its bound slips or
    sticks as Coulomb's conditions of the rates say.
    """
    x, widths, C, p = hertz(count)
    q = np.zeros(count)
    for half in range(halves):
        sign = (-1) ** (halves - 1 - half)
        shear, tension = (sign * (1 if half else 0.5) * load for load in (np.pi * Qf, sf))
        side = np.where(np.abs(q) >= p * (1 - 1e-12), np.sign(q), 0).astype(int)
        done, parted = 0.0, 0.0
        while done < 1:
            side, rate = _rates(side, q, p, widths, C, tension * x / 4, shear)
            sticks = np.flatnonzero(side == 0)
            room = (np.sign(rate[sticks]) * p[sticks] - q[sticks]) / rate[sticks]
            first = int(np.argmin(room))
            step = min(max(float(room[first]), 0.0), 1 - done)
            q, done = q + step * rate, done + step
            if (np.diff(sticks) > 1).any():
                parted = done
            if done < 1:
                cell = sticks[first]
                side[cell] = int(np.sign(rate[cell]))
                q[cell] = side[cell] * p[cell]
    return x, q, parted


def _rates(side, q, p, widths, C, pulled, shear):
    """Sides of slipping cells, 0 of sticking ones, and rates of q."""
    side, all_at_once = side.copy(), True
    for count in range(400):
        sticks = side == 0
        system = np.block([[C[np.ix_(sticks, sticks)], -np.ones((sticks.sum(), 1))], [widths[sticks], 0.0]])
        found = np.linalg.solve(system, np.append(pulled[sticks], shear))
        rate = np.zeros(len(q))
        rate[sticks] = found[:-1]
        slip = pulled - C @ rate + found[-1]
        back = ~sticks & (side * slip < -1e-13)
        over = sticks & (np.abs(q) >= p * (1 - 1e-12)) & (np.sign(q) * rate > 1e-13)
        if not (back | over).any():
            return side, rate
        all_at_once &= count < 60
        wrong = back | over
        if not all_at_once:
            weight = np.where(back, np.abs(slip) / np.abs(slip).max(), 0) + np.where(over, np.abs(rate), 0)
            wrong = np.arange(len(q)) == np.argmax(np.where(wrong, weight, -1))
        side = np.where(wrong, np.where(side == 0, np.sign(q), 0), side).astype(int)
    raise AssertionError("the active set cycles")
