"""Refinement ladders: observed order and grid convergence index on series whose limit is known."""

import math

import numpy as np
import pytest
from known import EXACT, SCENE, result, traction

from partialslip.verify import ladder
from partialslip.verify.case import Case
from partialslip.verify.ladder import SIZES, climb, convergence, has_ladder


def changes_of(values):
    return np.abs(np.diff(values)).tolist()


@pytest.mark.fault
def test_a_lucky_last_change_does_not_shrink_the_index():
    """Deliberate fault: errors jump by the element, and the last two meshes agree by chance. The index of the last
    three meshes alone would be zero. The index over the ladder bounds the error in at least 95 % of the series."""
    jumps = np.random.default_rng(1).uniform(0.2, 1, (400, len(SIZES)))
    bounded = 0
    for values in 1 + jumps * SIZES:
        values[-2] = values[-1]
        found = convergence("n", changes_of(values), values[-1] - 1)
        assert found.changes[-1] == 0
        bounded += found.gci >= found.error
    assert bounded >= 380


def test_no_changes_have_no_order():
    found = convergence("q", [0.0] * 4, 0.0)
    assert found.order is None
    assert found.gci == 0


def test_the_ladder_measures_the_errors_of_the_meshes(monkeypatch):
    """Meshes whose half-width and pressure are off by h/10: order 1, true errors known."""
    asked = []

    def solved(_, size):
        asked.append(size)
        return result(a=1 + size / 10, of=traction(p=1 + size / 10))

    monkeypatch.setattr(ladder, "_fem_result", solved)
    found = {each.quantity: each for each in climb(SCENE, EXACT)}
    assert asked == list(SIZES)
    assert set(found) == {"a", "m", "n", "p", "q"}
    for key in ("a", "p"):
        assert found[key].order == pytest.approx(1, abs=0.02)
        assert found[key].error == pytest.approx(SIZES[-1] / 10, rel=1e-6)
        assert found[key].error < found[key].gci < 1.3 * found[key].error
    assert found["q"].gci == 0
    assert not math.isnan(found["m"].gci)


def test_cases_without_a_uniform_mesh_have_no_ladder():
    assert has_ladder(Case("it", SCENE))
    assert not has_ladder(Case("it", SCENE, ("march",)))
    assert not has_ladder(Case("it", SCENE, reference=""))
    assert not has_ladder(Case("it", SCENE, meshes=lambda _: []))
