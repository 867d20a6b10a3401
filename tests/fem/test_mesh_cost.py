"""Predicted sizes and work of meshes, against those of the meshes that are made."""

import pytest

from partialslip import Allowance, load_scene, plan
from partialslip_fem import mesh_cost, solve

# on its third mesh a node comes to its bound in 45 cycles, on the fourth all nodes do in one
SLOW_NODE = load_scene(
    "fretting-aluminium",
    [
        "material={E=70e9, nu=0.0}",
        "profile.R=0.02",
        "friction.f=0.2067376282132438",
        "load.P=[1374446.7859455342, 1018591.4542271302]",
        "load.Q=[-47169.44502966223, 47169.44502966223]",
        "load.sigma=[-42664030.6705252, 42664030.6705252]",
        "fem.accuracy=0.00034422277279996436",
    ],
)


def marches(scene, monkeypatch, work):
    """``work`` on each mesh of ``scene``, and that expected on the next one."""
    found, expected, ahead = [], [], mesh_cost.march_ahead

    def noted(solution, anew):
        found.append(work(solution))
        expected.append(found[-1] * ahead(solution, anew))
        return ahead(solution, anew)

    monkeypatch.setattr(mesh_cost, "march_ahead", noted)
    solve(scene, plan(scene), allowance=Allowance(1e9))
    return found, expected


@pytest.mark.slow
def test_cycles_of_a_single_node_are_not_expected_again(monkeypatch):
    legs, expected = marches(SLOW_NODE, monkeypatch, lambda solution: solution.history.load_steps)
    assert legs[-2] > 10 * legs[-1]
    assert legs[-1] < expected[-2] < 4 * legs[-1]


@pytest.mark.slow
def test_steps_that_begin_where_those_before_ended_take_few_linear_solves(monkeypatch):
    """Expected from the mesh before, within 1.3 times; the marches of both meshes differ by 1.4 times."""
    scene = load_scene("fretting-aluminium", ["material.upper={E=150e9, nu=0.3}", "fem.accuracy=1e-3"])
    works, expected = marches(
        scene,
        monkeypatch,
        lambda solution: solution.iterations + solution.history.load_steps + solution.pressed.steps,
    )
    assert len(works) == 3
    assert works[1] > 1.4 * works[2]
    for found, before in zip(works[1:], expected[:-1], strict=True):
        assert 1 / 1.3 < found / before < 1.3


@pytest.mark.parametrize(
    ("name", "accuracy"),
    [("hertz-shear", 1e-3), ("hertz-small-tension", 1e-6), pytest.param("flat-rounded", 1e-5, marks=pytest.mark.slow)],
)
def test_sizes_of_meshes_are_known_before(monkeypatch, name, accuracy):
    """From the element sizes alone, without those of earlier meshes."""
    scene, ratios, measure = load_scene(name, [f"fem.accuracy={accuracy}"]), [], mesh_cost.Expense.measure

    def compared(self, solution, march_s=0.0, expected=None, anew=False):
        if expected:
            ratio = self._ratio.copy()
            ratios.append((solution.dofs / expected.unknowns, len(solution.lower.x) / expected.nodes) * ratio)
        measure(self, solution, march_s, expected, anew)

    monkeypatch.setattr(mesh_cost.Expense, "measure", compared)
    solve(scene, plan(scene), allowance=Allowance(1e9))
    assert len(ratios) > 1
    for unknowns, nodes in ratios:
        assert 0.85 < unknowns < 1.2
        assert 0.85 < nodes < 1.1
