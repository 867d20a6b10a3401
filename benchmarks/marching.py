"""Marching in time against closed forms: errors and orders over meshes, and how fast mean loads settle.

python benchmarks/marching.py orders | example | settling
"""

import argparse
import time

import numpy as np

from partialslip.friction.coulomb_constant_pressure import march
from partialslip.friction.history import History
from partialslip.friction.load_path import Path
from partialslip.friction.zone_ends import read_stick_zone as read_zone
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.loading import one_step
from partialslip.halfplane.punch import Punch
from partialslip.halfplane.shape import Shape
from partialslip.halfplane.steady import steady_stick_zone
from partialslip.halfplane.traction import half_range
from partialslip.march.cells import compliance, forces, graded_cells
from partialslip.result import StickZone
from partialslip.tools.arrays import Array
from partialslip.tools.threads import one_thread

P0 = 2 / np.pi  # a = P = 1


def marched(shape: Shape, vertices: Array, f: float, path: Path) -> History:
    x = (vertices[1:] + vertices[:-1]) / 2
    return march(compliance(vertices / 2), x, f * forces(shape, vertices), path)


def path(f: float, Q: tuple[float, float], sigma: tuple[float, float], cycles: int = 1) -> Path:
    """Q in f P, sigma in f p0."""
    cycle = tuple((q * f, s * f * P0 / 4) for q, s in zip(Q, sigma, strict=True))
    return Path(cycle, (0, 1), True, cycles, 1)


def error_of_q(history: History, vertices: Array, zone: StickZone, shape: Shape, f: float) -> float:
    """Relative L2 of cell averages of dq."""
    nodes, weights = np.polynomial.legendre.leggauss(16)
    angles = np.arcsin(np.clip(vertices, -1, 1))
    half = np.diff(angles)[:, None] / 2
    phi = (angles[1:] + angles[:-1])[:, None] / 2 + half * nodes
    exact = half_range(np.sin(phi).ravel(), zone, shape).reshape(phi.shape) * np.cos(phi) * half @ weights
    widths = np.diff(vertices)
    found = history.change / (2 * f * P0)
    return float(np.sqrt((((found - exact) / widths) ** 2 @ widths) / ((exact / widths) ** 2 @ widths)))


def orders() -> None:
    """Meshes graded to the ends of the contact and of the stick zone that the mesh before found."""
    print(f"{'case':28} {'cells':>6} {'m':>9} {'n':>9} {'q':>9}   orders of m, n, q in 1/cells")
    cases = [
        ("Hertz, small", HertzShape(), 0.4, 1.2),
        ("Hertz, large", HertzShape(), 0.3, 4.0),
        ("flat 0.5, large", Punch(0.5), 0.3, 4.0),
    ]
    for name, shape, Qf, sf in cases:
        zone = steady_stick_zone(Qf, sf, shape)
        before, found = None, None
        for level in range(6):
            size, growth = 1e-2 / 4**level, 0.2 / 1.5**level
            ends = sorted([-1.0, 1.0, *shape.kinks, *([found.left, found.right] if found else [])])
            vertices = graded_cells(np.array(ends), size, growth)
            history = marched(shape, vertices, 0.5, path(0.5, (-Qf, Qf), (-sf / 2, sf / 2)))
            x = (vertices[1:] + vertices[:-1]) / 2
            found = read_zone(x, 0.5 * forces(shape, vertices), history.change, vertices, lambda values: values)
            errors = np.array(
                [
                    abs(found.left + zone.half_width - zone.centre),
                    abs(found.right - zone.half_width - zone.centre),
                    error_of_q(history, vertices, zone, shape, 0.5),
                ]
            )
            text = ""
            if before:
                slopes = np.log(before[1] / errors) / np.log(len(x) / before[0])
                text = " ".join(f"{slope:5.1f}" for slope in slopes)
            print(f"{name:28} {len(x):6} " + " ".join(f"{e:9.1e}" for e in errors) + "   " + text)
            before = len(x), errors


def example(cycles: int = 200) -> None:
    """Q 0.1..0.7 f P, sigma 1..5 f p0: every step certified, change of q from cycle to cycle at the loaded end."""
    f, shape = 0.5, HertzShape()
    zone = steady_stick_zone(0.3, 4.0, shape)
    m, n = zone.half_width - zone.centre, zone.half_width + zone.centre
    vertices = graded_cells(np.array([-1.0, -m, n, 1.0]), 2e-3, 0.1)
    start = time.perf_counter()
    history = marched(shape, vertices, f, path(f, (0.1, 0.7), (1.0, 5.0), cycles))
    widths = np.diff(vertices)
    kkt = max(float((step.residual / widths).max()) for step in history.points) / (f * P0)
    visits = np.array([step.x for step in history.points[::2]]) / widths / (f * P0)
    changes = np.abs(np.diff(visits, axis=0)).max(axis=1)
    print(
        f"{len(widths)} cells, {len(history.points)} load steps, {time.perf_counter() - start:.0f} s, "
        f"worst KKT {kkt:.1e} f p0"
    )
    print("change of q at the loaded end, cycles 1-13:", " ".join(f"{c:.1e}" for c in changes[:13]))
    print(
        "mean Q 0.4 f P, bound",
        f"{one_step(0.3, 4.0, shape).mean_load_bound:.4f} f P; q error of the last cycle",
        f"{error_of_q(history, vertices, zone, shape, f):.1e}",
    )


def settling() -> None:
    """f = 0.5, dQ/(2fP) = 0.2546, dsigma/(f p0) = 1.6: cycles until the range of q changes by less than 1e-6 f p0."""
    f, shape, Qf, sf = 0.5, HertzShape(), 0.2546, 1.6
    zone = steady_stick_zone(Qf, sf, shape)
    bound = one_step(Qf, sf, shape).mean_load_bound
    m, n = zone.half_width - zone.centre, zone.half_width + zone.centre
    vertices = graded_cells(np.array([-1.0, -m, n, 1.0]), 2e-3, 0.1)
    widths = np.diff(vertices)
    print(f"bound {bound:.5f} f P; sliding would begin at {1 - Qf:.5f} f P")
    for share in (0.5, 0.9, 0.98, 0.995, 1.005, 1.02):
        mean, cycles = share * bound, 80
        loads = path(f, (mean - Qf, mean + Qf), (-sf / 2 + 1, sf / 2 + 1), cycles)
        history = marched(shape, vertices, f, loads)
        q = np.array([step.x for step in history.points]) / widths / (f * P0)
        ranges = q[2::2] - q[1::2]
        drift = np.abs(np.diff(ranges, axis=0)).max(axis=1)
        settled = next((k + 1 for k in range(len(drift)) if (drift[k:] < 1e-6).all()), None)
        print(
            f"{share:6.3f} of the bound: {settled or 'more than ' + str(cycles)} cycles; q error of dq "
            f"{error_of_q(history, vertices, zone, shape, f):.1e}; slip added in the last cycle "
            f"{np.abs(history.net_slip).max() / np.abs(history.slip).max():.1e} of the slip of half a cycle"
        )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=["orders", "example", "settling"])
    one_thread({"orders": orders, "example": example, "settling": settling}[parser.parse_args().what])()
