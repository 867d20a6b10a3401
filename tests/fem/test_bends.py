"""Elements where the gap's curvature jumps: the end of a flat, where p has a kink of the kind x log|x|."""

import msgspec
import numpy as np
import pytest

import partialslip
from partialslip.result import Clock
from partialslip_fem import estimate, grading
from partialslip_fem.bodies import Grading
from partialslip_fem.mesh_solution import Adapted
from partialslip_fem.problem import scaled
from partialslip_fem.result import to_result
from partialslip_fem.solving import mesh_and_solve

SMALL = 1e-5  # element size at the ends of zones, in a
FINE = {4: 0.2, 6: 0.3}  # growth for which all other errors of p are small ...
USUAL = {4: 0.54, 6: 0.57}  # ... and that of runs, whose elements beside the bends grow as fast


def on_mesh(size, order, b, growth):
    """Error of p on one mesh with elements of the ``size`` at the ends of the flat, and what they are said to leave."""
    scene = partialslip.load_scene("flat-rounded", [f"fem.order={order}", f"profile.b={b}"])
    plan, exact = partialslip.plan(scene), partialslip.run(scene, ["exact"])["exact"]
    a, problem = exact.a / scene.length, scaled(scene, plan)
    sizes = {float(end * a): SMALL * a for end in (-1.0, -exact.m / exact.a, exact.n / exact.a, 1.0)}
    sizes |= dict.fromkeys(problem.kinks, size * a)
    solution = mesh_and_solve(problem, 16 * a, Grading((-1.2 * a, 1.2 * a), sizes, growth), Clock())
    result = to_result(scene, plan, problem, Adapted(solution, {}, 1, 1, 0, 16.0), Clock())
    beside = solution.element_sizes(np.array(problem.kinks)) / solution.half_width
    told = estimate.bend_errors(solution, np.array(problem.bends), beside)
    return partialslip.compare(result, exact, scene, 0.1).p, told["p"]


@pytest.mark.parametrize("b", [1e-3, 2e-4])
@pytest.mark.parametrize("order", [4, pytest.param(6, marks=pytest.mark.slow)])
def test_error_of_p_falls_with_the_size_to_the_power_of_one_and_a_half(order, b):
    """Cells have whole sizes, so that the slope between two meshes is not quite 1.5."""
    (large, told), (small, less) = (on_mesh(size, order, b, FINE[order]) for size in (1.6e-2, 2e-3))
    assert large <= told
    assert small <= less
    assert 1.2 <= np.log(large / small) / np.log(8) <= 1.8


@pytest.mark.parametrize("b", [1e-3, 2e-4])
@pytest.mark.parametrize("order", [4, 6])
def test_error_of_p_is_told(order, b):
    """The constant is that of runs, which have three times as much in the median as the bends of one mesh alone."""
    found, told = on_mesh(1.6e-2, order, b, USUAL[order])
    assert found <= told <= 12 * found


def coarse(monkeypatch):
    """A run with elements so large at the ends of the flat that they alone make p miss its accuracy."""
    monkeypatch.setattr(grading, "_AT_BENDS", 40.0)
    outcome = partialslip.run(partialslip.load_scene("flat-rounded", ["fem.accuracy=1e-7"]))
    return outcome.comparisons["fem"].p, outcome.results["fem"].estimate["p"]


@pytest.mark.slow
def test_coarse_elements_at_bends_are_told(monkeypatch):
    error, told = coarse(monkeypatch)
    assert error > 1e-6 / 2
    assert error <= told


@pytest.mark.slow
@pytest.mark.fault
def test_elements_at_bends_are_counted(monkeypatch):
    """Deliberate fault: two orders are compared alone, which miss what an element leaves of x log|x| nearly alike."""
    monkeypatch.setattr(estimate, "_BENT", dict.fromkeys(estimate._BENT, 1e-12))
    monkeypatch.setattr(estimate, "bend_sizes", lambda _, bends, __: np.full(len(bends), 3e-3))
    error, told = coarse(monkeypatch)
    assert error > 1.2 * told


def test_a_contact_without_bends_computes_nothing_of_them(monkeypatch):
    monkeypatch.setattr(estimate, "_BENT", {})  # would be looked up
    fem = partialslip.run(partialslip.load_scene("hertz-shear", ["fem.accuracy=1e-2"]), ["fem"])["fem"]
    assert fem.estimate


def table():
    """An uneven, tilted table."""
    data = msgspec.to_builtins(partialslip.load_scene("hertz-shear"))
    data = {key: value for key, value in data.items() if value is not None}
    data["load"] = {"P": 2e5, "Q": [-2e4, 2e4]}
    gap = [5e-5, 1.2e-5, 1e-6, 0.0, 4e-6, 1.6e-5, 4e-5]
    data["profile"] = {"kind": "tabulated", "x": [-2e-3, -1e-3, -3e-4, 0.0, 4e-4, 1e-3, 2e-3], "gap": gap}
    return partialslip.parse_scene(data)


def crowned():
    """A flat that is not quite flat."""
    return partialslip.load_scene("flat-rounded", ["profile.crown=0.05"])


@pytest.mark.parametrize("of", [crowned, table])
def test_bends_are_jumps_of_the_second_derivative(of):
    """Between the points at which its curvature jumps the gap is a parabola, so that second differences are exact."""
    scene = of()
    problem = scaled(scene, partialslip.plan(scene))
    kinks, step = np.array(problem.kinks), 1e-2
    assert len(kinks) > 1

    def curvature(x):
        return (problem.gap(x + step) - 2 * problem.gap(x) + problem.gap(x - step)) / step**2

    found = np.abs(curvature(kinks + 2 * step) - curvature(kinks - 2 * step))
    np.testing.assert_allclose(problem.bends, found, rtol=1e-6)
