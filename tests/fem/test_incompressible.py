"""Up to nu = 0.4999 the same accuracy. The exact solution knows nu in the compliance A only; at the same A the scaled
loads, and so the meshes, are the same for all nu, and errors can be compared one to one."""

from dataclasses import replace

import numpy as np
import pytest

import partialslip
from partialslip.judge import cell_errors
from partialslip.result import Clock, Traction, TractionAt
from partialslip_fem.bodies import Grading
from partialslip_fem.problem import scaled
from partialslip_fem.solving import mesh_and_solve

SCENES = ["hertz-small-tension", "hertz-large-tension"]
NU = (0.0, 0.45, 0.49, 0.499, 0.4999)
COARSEST = 0.7  # growth of the elements


def scene_of(name, nu, *overrides):
    E = partialslip.load_scene(name).material.E * (1 - nu**2) / (1 - 0.3**2)
    return partialslip.load_scene(name, [f"material.nu={nu}", f"material.E={E}", *overrides])


def errors(name, order, nu, growth):
    """Errors of the ends, in a, and of q, on a mesh graded to the exact ends."""
    scene = scene_of(name, nu)
    exact = partialslip.run(scene, ["exact"]).results["exact"]
    L, stress = scene.length, scene.P / scene.length
    problem = replace(scaled(scene, partialslip.plan(scene)), order=order)
    a, ends = exact.a / L, np.array([-exact.a, -exact.m, exact.n, exact.a]) / L
    grading = Grading((-1.2 * a, 1.2 * a), dict.fromkeys((ends + 3e-5).tolist(), 1e-4), growth)
    solution = mesh_and_solve(problem, 16 * a, grading, Clock())
    x, p = solution.lower.x, solution.pressure()
    q1, q2 = solution.shear(solution.history.q1), solution.shear(solution.history.q2)

    def at(points):
        return TractionAt(stress * p(points / L), stress * (q2(points / L) - q1(points / L)))

    found = Traction(x * L, at(x * L), at, solution.zone_ends * L, x[::order] * L)
    return np.array([np.abs(solution.zone_ends - ends[[0, 3, 1, 2]]).max() / a, cell_errors(found, exact.traction)[1]])


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize(
    "growth", [COARSEST, *(pytest.param(growth, marks=pytest.mark.slow) for growth in (0.5, 0.35))]
)
def test_errors_of_fourth_order_do_not_depend_on_nu(name, growth):
    reference = errors(name, 4, 0.3, growth)
    for nu in NU if growth < COARSEST else NU[-1:]:
        assert (errors(name, 4, nu, growth) < 3 * reference).all(), nu


@pytest.mark.fault
@pytest.mark.parametrize("name", [pytest.param(SCENES[0], marks=pytest.mark.slow), SCENES[1]])
def test_linear_triangles_lock(name):
    """Deliberate fault: elements of constant strain that keep their volume cannot bend."""
    reference, nearly = (errors(name, 1, nu, 0.2) for nu in (0.3, 0.4999))
    assert (nearly > 10 * reference).all()


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("accuracy", [2e-5, 1e-6])
def test_accuracy_is_kept(name, accuracy):
    for nu in (0.3, *NU):
        assert partialslip.run(scene_of(name, nu, f"fem.accuracy={accuracy}")).passed, nu
