"""Figures of the problems: errors of codes along the contact, at their places."""

import itertools

import numpy as np
import pytest
from outline import texts

from partialslip.verify.benchmark import Answer, Meta, Submission, read_problems
from partialslip.verify.benchmark.book import _APART, _columns, errors_along, problem_svg

PROBLEM = read_problems()["PS-02"]
EXACT = {key: target.value for key, target in PROBLEM.targets.items()}


def submission(code, **values):
    """Answers of a ``code`` that has ``values`` in place of the targets; None leaves one out."""
    changed = {**EXACT, **values}
    return Submission(Meta(code, "1"), {"PS-02": Answer({k: v for k, v in changed.items() if v is not None})})


def test_the_worst_traction_of_a_place_decides():
    """An error of dq alone, and one of p alone, stand at their places, in 2 f p0 and p0; others are zero."""
    of_q, of_p = PROBLEM.targets["dq@0.5"], PROBLEM.targets["p@-0.9"]
    off = {"dq@0.5": of_q.value + 3e-2 * of_q.scale, "p@-0.9": of_p.value - 2e-3 * of_p.scale}
    (along,) = errors_along(PROBLEM, [submission("a code", **off)]).values()
    assert list(along) == list(PROBLEM.places)
    assert np.allclose([along[place] for place in (-0.9, -0.5, 0.0, 0.5, 0.9)], [2e-3, 0, 0, 3e-2, 0], atol=1e-12)


def test_the_figure_has_numbers_in_greys():
    """A row of an exact answer has zeros; the number of a wrong place is white on dark."""
    wrong = EXACT["p@0"] * 1.2
    found = problem_svg(PROBLEM, [submission("right"), submission("wrong", **{"p@0": wrong})])
    assert {"right 1", "wrong 1", "2e-1"} <= set(texts(found))
    assert texts(found).count("0") == 2 * len(PROBLEM.places) - 1
    assert "stick zone [-m, n]" in texts(found)
    alone = texts(problem_svg(PROBLEM, []))
    assert "p/p0, targets" in alone
    assert "right 1" not in alone


@pytest.mark.parametrize("number", read_problems())
def test_columns_do_not_overlap(number):
    """Columns keep their order and their least distance, and stay within the contact; lonely ones stay in place."""
    places = read_problems()[number].places
    columns = _columns(places)
    assert all(right - left > _APART * (1 - 1e-9) for left, right in itertools.pairwise(columns.values()))
    assert max(map(abs, columns.values())) <= 1
    assert columns[0.5] == pytest.approx(0.5, abs=1e-12)
