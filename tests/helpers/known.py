"""Artificial results: Hertz under shear alone, after Cattaneo and Mindlin, with optional errors."""

import numpy as np

from partialslip import load_scene
from partialslip.result import Cost, Result, Traction, TractionAt
from partialslip.run import compared
from partialslip.scene.plan import plan

F, P, SHARE = 0.5, 1e5, 0.36  # Q = +-0.36 f P
SCENE = load_scene(
    "hertz-shear", [f"load={{P={P}, Q=[{-SHARE * F * P}, {SHARE * F * P}]}}", f"friction.f={F}", "fem.accuracy=1e-3"]
)
A = float(np.sqrt(2 * SCENE.material.A * SCENE.profile.R * P / np.pi))
P0, C = 2 * P / (np.pi * A), float(np.sqrt(1 - SHARE))  # stick zone [-C a, C a]


def root(x, half_width=1.0):
    return half_width * np.sqrt(np.maximum(1 - (x / half_width) ** 2, 0.0))


def tractions(x):
    """Return p and dq, Pa, at x, m."""
    return P0 * root(x / A), 2 * F * P0 * (root(x / A) - root(x / A, C))


def traction(p=1.0, q=1.0, levels=True, cells=41, add=lambda x: 0 * x, p1=None):
    """Return tractions with scaled pressure and shear. ``add`` is additional shear at load point 2, in f p0, over x/a;
    ``p1`` scales the pressure at load point 1."""

    def at(x):
        pressure, dq = tractions(x)
        change, before = q * dq + F * P0 * add(x / A), None if p1 is None else p1 * pressure
        return TractionAt.between(p * pressure, -q * dq / 2, change - q * dq / 2, levels, before)._replace(dq=change)

    x, breaks = np.linspace(-A, A, 201), A * np.array([-1, -C, C, 1])
    return Traction(x, at(x), at, breaks, None if cells is None else np.linspace(-1.1, 1.1, cells) * A)


def result(method="fem", centre=0.0, half_width=C, a=1.0, regime="small tension", of=None, **more):
    """Return a result with lengths in the exact a; ``centre`` None means no stick zone."""
    return Result(
        method=method, a=a * A, p0=P0 / a, regime=regime, stick_centre=None if centre is None else centre * A,
        stick_half_width=None if centre is None else half_width * A, traction=of or traction(),
        cost=Cost(1.0, 1.0, None),
        **{"certificate": {"kkt": 1e-12}, "last_cycle_change": 1.0, "estimate": {"a": 2e-4, "m": 1e-4, "left": 3e-4},
         **more},
    )  # fmt: skip


EXACT = result("exact", estimate={})


def ran(results, scene=SCENE, accuracy=1e-3):
    """A run that has found ``results``, by name."""
    return compared(scene, plan(scene), results, accuracy)
