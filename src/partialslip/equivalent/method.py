"""Method ``equivalent``: bodies of a size as half-planes with other data, in closed form."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from partialslip.equivalent.data import Data, Moments, data_of, moments_of
from partialslip.errors import InputError
from partialslip.halfplane.method import solve as solve_exactly
from partialslip.plan import Plan
from partialslip.plan import plan as plan_of
from partialslip.result import Clock, Result
from partialslip.rig import Rig
from partialslip.scene import Bodies, Hertz, Scene

_SETTLED, _MOST = 1e-13, 40  # change of the data in an iteration; iterations


def solve(scene: Scene, plan: Plan, rig: Rig, progress: Callable[[str], None] = lambda _: None) -> Result:
    clock = Clock()
    found = _solved(half_planes(scene, None))
    data = None
    for _ in range(_MOST):
        before, data = data, data_of(rig, scene, moments_of(rig, scene, found), found)
        if before and data.apart(before, scene) <= _SETTLED:
            break
        found = _solved(half_planes(scene, data))
    return replace(found, method="equivalent", cost=clock.cost())


def half_planes(scene: Scene, data: Data | None) -> Scene:
    """The scene of half-planes with the ``data`` that act like the bodies of ``scene``; without data, like no size."""
    plain = scene.replace(bodies=Bodies(), load={"P": scene.P, "a": None, "p0": None})
    if data is None:
        return plain
    first, second = scene.load.ends
    Q = [scene.load.points[end][0] for end in (first, second)]
    R = 1 / (1 / scene.profile.R + data.curvature.mean())
    M = scene.P * -R * data.tilt
    load = {"Q": Q, "sigma": data.sigma.tolist(), "M": M.tolist()}
    if np.any(data.sigma_slope):
        load["sigma_slope"] = data.sigma_slope.tolist()
    return plain.replace(profile={"R": R}, load=load)


def _solved(scene: Scene) -> Result:
    return solve_exactly(scene, plan_of(scene))
