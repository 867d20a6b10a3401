"""A small boundary-element march that shares nothing with the package but the pressure."""

import numpy as np

P = np.pi / 2  # of a contact with a = p0 = 1


def compliance(x, ends):
    """Displacements at ``x`` due to unit tractions that are constant on the cells between ``ends``; A = 1."""

    def primitive(apart):
        return apart * np.log(np.abs(apart)) - apart

    return -(primitive(x[:, None] - ends[:-1]) - primitive(x[:, None] - ends[1:])) / np.pi


def march(shape, path, count=80, steps=12):
    """q along a path of (Q in f P, sigma in f p0, and its slope in f p0/a if it has one), from nothing, in so many
    ``steps`` to each point: cells of constant
    traction, collocation, active sets. Returns points, widths of cells, p and q at each point, scaled."""
    ends = -np.cos(np.linspace(0, np.pi, count + 1))
    x, widths = (ends[1:] + ends[:-1]) / 2, np.diff(ends)
    C = compliance(x, ends)
    path = [(*point, 0.0)[:3] for point in path]
    p, q, load, found = shape.pressure(x), np.zeros(count), np.zeros(3), []
    for point in np.array(path) * [P, 1, 1]:
        side = np.zeros(count, int)
        for share in np.arange(1, steps + 1) / steps:
            Q = load[0] + share * (point[0] - load[0])
            free = C @ q + (x * (point[1] - load[1]) + x**2 / 2 * (point[2] - load[2])) / steps / 4
            for _ in range(200):
                sticks = side == 0
                known = np.where(sticks, 0.0, side * p)
                system = np.block([[C[np.ix_(sticks, sticks)], -np.ones((sticks.sum(), 1))], [widths[sticks], 0.0]])
                found_q = np.linalg.solve(system, np.append((free - C @ known)[sticks], Q - widths @ known))
                new = known.copy()
                new[sticks] = found_q[:-1]
                slip = free - C @ new + found_q[-1]
                turned = np.where(sticks, np.sign(new) * (np.abs(new) > p * (1 + 1e-11)), side)
                turned = np.where(side * slip < -1e-13, 0, turned).astype(int)
                if (turned == side).all():
                    break
                side = turned
            else:
                raise AssertionError("the active set cycles")
            q = new
        load = point
        found.append(q)
    return x, widths, p, found
