"""Orders of convergence, for triangles of order 1 to 4, in the element size of meshes halved as a whole.

On uniform contact meshes the square roots at the ends of the zones leave first order whatever the element: the best
polynomials on a cell of size h miss them by O(h) in L2. Where meshes are graded to the ends, what remains is smooth;
ends of zones and means over cells are functionals of it and converge like the energy, twice as fast as the gradients:
by 2 k for elements of order k. The meshes are not images of each other, so that orders scatter.
"""

from dataclasses import replace

import numpy as np
import pytest

import partialslip
from partialslip.result import Clock, Traction, TractionAt
from partialslip.run.judge import cell_errors
from partialslip_fem import mesh_solution
from partialslip_fem.bodies import Grading
from partialslip_fem.problem import scaled
from partialslip_fem.solving import mesh_and_solve

SCENE = partialslip.load_scene("hertz-small-tension")
EXACT = partialslip.run(SCENE, ["exact"]).results["exact"]
ENDS = np.array([-EXACT.a, -EXACT.m, EXACT.n, EXACT.a]) / EXACT.a


def solved(order, sizes, growth):
    """On one mesh with elements of ``sizes`` at points of the contact line; lengths in the exact a."""
    a = EXACT.a / SCENE.length
    problem = replace(scaled(SCENE, partialslip.plan(SCENE)), order=order)
    sizes = {float(x * a): size * a for x, size in sizes.items()}
    return mesh_and_solve(problem, 16 * a, Grading((-1.2 * a, 1.2 * a), sizes, growth), Clock())


def errors(solution):
    """Of a, m, n (in a), p and q (relative L2 of cell averages)."""
    L, stress, x = SCENE.length, SCENE.P / SCENE.length, solution.lower.x
    p, q1, q2 = solution.pressure(), solution.shear(solution.history.q1), solution.shear(solution.history.q2)

    def at(points):
        return TractionAt(stress * p(points / L), stress * (q2(points / L) - q1(points / L)))

    found = Traction(x * L, at(x * L), at, solution.zone_ends * L, x[:: solution.lower.order] * L)
    ends = np.array([solution.half_width, -solution.stick.left, solution.stick.right]) * L
    return np.array([*np.abs(ends - [EXACT.a, EXACT.m, EXACT.n]) / EXACT.a, *cell_errors(found, EXACT.traction)])


def uniform(order, h):
    """Errors on uniform contact meshes, root mean squares over where the ends lie in their cells."""
    shifts = np.arange(4) / 40
    found = [errors(solved(order, dict.fromkeys(np.linspace(-1.1, 1.0, 11) + s, h), 8 * h)) for s in shifts]
    return np.sqrt(np.mean(np.square(found), axis=0))


def graded(order, growth, ends=ENDS):
    """Errors and unknowns on a mesh graded to the ends."""
    solution = solved(order, dict.fromkeys(ends + 3e-6, 1e-5), growth)  # vertices a little beside them
    return errors(solution), solution.lower.unknowns


@pytest.mark.parametrize(
    "order", [1, 2, pytest.param(3, marks=pytest.mark.slow), pytest.param(4, marks=pytest.mark.slow)]
)
def test_uniform_meshes_are_of_first_order_whatever_the_element(order):
    """Tractions of first order, superconvergent ends of at least that; a quarter of h, and two thirds for scatter."""
    slopes = np.log(uniform(order, 0.1) / uniform(order, 0.025)) / np.log(4)
    assert slopes.min() > 0.7
    assert slopes[3:].max() < 2.2  # even where 2 k is 8


@pytest.mark.parametrize(("order", "coarse", "fine"), [
    (1, 0.4, 0.1), (2, 0.8, 0.2), pytest.param(3, 0.8, 0.4, marks=pytest.mark.slow),
    pytest.param(4, 0.8, 0.6, marks=pytest.mark.slow),
])  # fmt: skip
def test_graded_meshes_are_of_order_2k(order, coarse, fine):
    """In the element size, one over the root of the unknowns; the coarse meshes are not yet in that range, which
    makes slopes too steep rather than too flat."""
    (before, few), (after, many) = graded(order, coarse), graded(order, fine)
    slopes = 2 * np.log(before / after) / np.log(many / few)
    ends = 2 * np.log(before[:3].max() / after[:3].max()) / np.log(many / few)
    assert min(ends, *slopes[3:]) > 2 * order - 0.5


@pytest.mark.fault
def test_grading_beside_the_ends_loses_the_order():
    """Deliberate fault: fine meshes where the stick zone does not end."""
    (before, few), (after, many) = (graded(2, growth, ENDS * [1, 0.9, 0.7, 1]) for growth in (0.8, 0.2))
    slopes = 2 * np.log(before / after) / np.log(many / few)
    assert slopes[4] < 3.5


@pytest.mark.fault
def test_dividing_nodal_forces_by_weights_spoils_odd_orders(monkeypatch):
    """Deliberate fault. Closed Newton-Cotes weights of even order are exact to one degree more than the elements,
    those of odd order are not: the force of a node between unequal cells is then shared wrongly by O(h p'), and on
    graded meshes, whose cells remain unequal, that does not go away."""
    true = mesh_solution.traction

    def divided(body, forces):
        return true(body, body.mass @ (forces / body.weights))

    meshes = {order: solved(order, dict.fromkeys(ENDS + 3e-6, 1e-5), 0.5) for order in (2, 3)}
    right = {order: errors(solution)[3] for order, solution in meshes.items()}
    monkeypatch.setattr(mesh_solution, "traction", divided)
    wrong = {order: errors(solution)[3] for order, solution in meshes.items()}
    assert wrong[3] > 3 * right[3]
    assert wrong[2] < 1.2 * right[2]
