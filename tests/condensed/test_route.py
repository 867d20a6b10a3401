"""Where the steps of a march begin: fewer iterations, and the same forces."""

from dataclasses import replace

import numpy as np
import pytest

from partialslip.arrays import runs, submatrix
from partialslip.condensed import bounded, history
from partialslip.condensed.bounded import Factored
from partialslip.condensed.history import march
from partialslip.condensed.path import Path
from partialslip.condensed.route import Route

N = 120
X = np.cos(np.pi * (np.arange(N)[::-1] + 0.5) / N)
C = -np.log(np.abs(X[:, None] - X) + 0.3 / N)
BOUND = np.sqrt(1 - X**2) / np.sqrt(1 - X**2).sum()
STRETCH = np.array([X, X**2 / 2])


def along(Q, strain, steps, back=-0.9):
    """Path to a shear and a tension, ``back`` times as far and to them once more, in equal steps."""
    return Path(((back * Q, back * strain, 0.0), (Q, strain, 0.0)), (0, 1), True, 1, steps)


def close(one, other):
    for key in ("q1", "q2", "slip", "net_slip"):
        assert getattr(one, key) == pytest.approx(getattr(other, key), abs=1e-12), key


def solved(path, factored=None, route=None):
    return march(C, STRETCH, BOUND, path, factored, route)


def test_finer_steps_begin_at_those_of_the_coarser():
    factored, route = Factored(C), Route()
    solved(along(0.7, 0.3, 8), factored, route)
    finer = solved(along(0.7, 0.3, 16), factored, route)
    alone = solved(along(0.7, 0.3, 16))
    close(finer, alone)
    assert finer.iterations < 0.8 * alone.iterations


def test_the_same_path_once_more_takes_one_solve_a_step():
    """But for the step in which slip no longer goes as far as on the way before."""
    factored, route, path = Factored(C), Route(), along(0.7, 0.3, 8)
    first, again = (solved(path, factored, route) for _ in range(2))
    close(first, again)
    assert again.iterations <= again.load_steps + 1 == 25


@pytest.mark.parametrize("others", [(0.72, 0.31), (-0.7, 0.3), (0.05, 0.0)])
def test_other_loads_before_change_nothing(others):
    """Also where they are far from the loads, or opposed to them."""
    factored, route = Factored(C), Route()
    solved(along(*others, 4), factored, route)
    close(solved(along(0.7, 0.3, 4), factored, route), solved(along(0.7, 0.3, 4)))


def test_the_way_back_is_the_mirror_image_of_the_way(monkeypatch):
    """Where the loads are fully reversed and the first loading leads to the cycle: it is not solved."""
    path = along(0.7, 0.3, 8, back=-1.0)
    mirrored = solved(path)
    monkeypatch.setattr(history._Step, "mirrors", lambda *_: False)
    plain = solved(path)
    close(mirrored, plain)
    assert mirrored.points[2].iterations == 0 < mirrored.points[1].iterations == plain.points[1].iterations
    assert mirrored.load_steps == plain.load_steps


def test_half_a_cycle_begins_with_the_zone_known_from_elsewhere():
    path = replace(along(0.6, 0.1, 1, back=-1.0), half=True)
    cold = solved(path)
    warm = solved(path, None, Route(cold.points[0].sides))
    close(cold, warm)
    assert warm.iterations == 1 < cold.iterations


def test_steps_on_an_inverse_multiply_by_the_compliance_once_or_twice(monkeypatch):
    """Once for the certificate, and once more where a step of refinement was needed: not in each iteration."""

    class Counted(np.ndarray):
        products = 0

        def __matmul__(self, other):
            Counted.products += 1
            return np.asarray(self) @ other

    factored = Factored(C)
    factored.expect(100)
    factored.C = C.view(Counted)
    monkeypatch.setattr(history, "solve_bounded", lambda _, *rest: bounded.solve_bounded(factored.C, *rest))
    found = solved(along(0.7, 0.3, 16), factored)
    assert found.iterations > found.load_steps
    assert found.load_steps < Counted.products <= 2 * found.load_steps + 1


def test_parts_of_matrices_by_runs():
    matrix = np.arange(400.0).reshape(20, 20)
    for members in ([], [3], [0, 1, 2, 7, 8, 19], range(20), range(0, 20, 2), [5, 6, 2, 3]):
        rows = np.array(members, dtype=np.int64)
        assert np.array_equal(np.concatenate([np.arange(20)[run] for run in runs(rows)] or [rows]), rows)
        for columns in (rows, np.array([4, 5, 11])):
            assert np.array_equal(submatrix(matrix, rows, columns), matrix[np.ix_(rows, columns)])


def test_steps_from_the_displacements_of_another_step_are_noticed(monkeypatch):
    """Deliberate fault: the remembered product is that of the step before the last one. Every step has its certificate
    all the same; only another solution shows it."""
    path, late = along(0.7, 0.3, 4), [np.zeros(N)]
    true = solved(path)
    monkeypatch.setattr(Factored, "times", lambda self, x: (late.append(self.C @ x), late[-2])[1])
    wrong = solved(path)
    assert max(step.residual.max() for step in wrong.points) < 1e-12
    assert np.abs(wrong.change - true.change).max() > 1e-3 * BOUND.max()
