"""Error measures on known tractions, and perturbations that the measures must detect."""

from dataclasses import replace

import numpy as np
import pytest

from partialslip import compare, load_scene, plan
from partialslip.halfplane import solve
from partialslip.result import Traction, TractionAt
from partialslip.run.judge import Outcome, cell_errors, cell_means

SCENE = load_scene("hertz-large-tension")
CELLS = np.array([-1.1, -0.9, -0.5, 0.1, 0.3, 0.97, 1.2])


def traction_of(p, dq, breaks=(-1.0, 1.0), cells=CELLS):
    x = np.linspace(-1, 1, 50)

    def at(points):
        return TractionAt(p(points), dq(points))

    return Traction(x, at(x), at, np.array(breaks), cells)


def root(x):
    return np.sqrt(np.maximum(1 - x**2, 0))


@pytest.fixture(scope="module")
def exact():
    return solve(SCENE, plan(SCENE))


def with_cells(result, q_added=lambda x: 0 * x):
    """Return the result of a method on a mesh, with perturbations."""
    scaled = np.linspace(-1.05, 1.05, 43) * result.a

    def at(x):
        p, dq, *_ = result.traction.at(x)
        return TractionAt(p, dq + 2 * q_added(x / result.a))

    of = result.traction
    return replace(result, traction=replace(of, values=at(of.x), at=at, cells=scaled))


def test_cell_means_are_exact_for_square_roots():
    p, _ = cell_means(traction_of(root, root), CELLS)
    inner = np.clip(CELLS, -1, 1)
    resultant = (np.arcsin(inner) + inner * np.sqrt(1 - inner**2)) / 2
    assert p * np.diff(CELLS) == pytest.approx(np.diff(resultant), abs=1e-14)


def test_cell_means_see_inner_breaks():
    def kinked(x):
        return root(x) - np.sqrt(np.maximum((0.2 - x) * (x + 0.8), 0))

    means, _ = cell_means(traction_of(kinked, kinked, breaks=(-1, -0.8, 0.2, 1)), CELLS)
    assert means @ np.diff(CELLS) == pytest.approx(np.pi / 2 * (1 - 0.25), abs=1e-13)


@pytest.mark.fault
def test_perturbation_that_keeps_the_resultant_is_seen(exact):
    """Deliberate fault: shear moved from one side to the other, resultant unchanged."""
    moved = with_cells(exact, q_added=lambda x: 2e6 * np.sin(2 * np.pi * x) * (np.abs(x) < 1))
    comparison = compare(moved, exact, SCENE, 2e-5)
    assert not comparison.passed
    assert comparison.q > 1e-3
    assert comparison.q_nodal_max == pytest.approx(2e6 / (0.5 * exact.p0), rel=1e-3)


def test_tiny_stick_zone_is_compared_without_cancellation(exact):
    tiny = replace(exact, stick_centre=-0.3 * exact.a, stick_half_width=1e-20 * exact.a)
    wider = replace(tiny, stick_half_width=3e-20 * exact.a)
    assert compare(wider, tiny, SCENE, 1e-12).m == pytest.approx(2e-20, rel=1e-9)


def test_without_cells_the_spaces_between_points_are_cells(exact):
    assert cell_errors(exact.traction, exact.traction) == (0, 0)
    of = exact.traction
    moved = replace(of, at=lambda x: of.at(x)._replace(p=1.01 * of.at(x).p))
    assert cell_errors(moved, of) == (pytest.approx(0.01, rel=1e-9), 0)


def test_the_largest_pressure_is_found_between_points():
    traction = traction_of(root, root)
    assert traction.p.max() < 1 - 1e-4
    assert traction.p_max == pytest.approx(1, abs=(traction.x[1] - traction.x[0]) ** 4 / 8)  # the neglected term
    corner = traction_of(lambda x: 1 - np.abs(x - traction.x[7]), root)  # a corner is not below its value
    assert 1 <= corner.p_max <= 1.01


@pytest.mark.parametrize("side", [1, -1])
def test_pressure_beyond_the_contact_is_an_error_in_the_cell_of_its_end(side):
    """Traction on 0.15 beyond the reference's end, in a cell of 0.3: the mean there is wrong by 0.5."""
    cells = np.array([-1.2, -0.9, -0.5, 0.1, 0.5, 0.9, 1.2])
    beyond = lambda x: root(x) + ((side * x > 1) & (side * x < 1.15))  # noqa: E731
    ends = sorted([-1.0, 1.0, 1.15 * side])
    error, _ = cell_errors(traction_of(beyond, root, ends, cells), traction_of(root, root, cells=cells))
    means, _ = cell_means(traction_of(root, root), cells)
    norm = np.sqrt(means**2 @ np.diff(cells))
    assert error == pytest.approx(0.15 / 0.3 * np.sqrt(0.3) / norm, rel=1e-9)


@pytest.mark.parametrize(
    ("own", "table", "bar", "outcome"),
    [
        (None, 0.0, 1e-3, Outcome.MISSED),  # m is off by 1.5e-3 a
        (0.0, 0.0, 1e-3, Outcome.MISSED),
        (6e-4, None, 1.6e-3, Outcome.PASSED),
        (6e-4, 0.0, 1.6e-3, Outcome.PASSED),
        (6e-4, 6e-4, 1e-3, Outcome.MISSED),  # every method is given the same table
        (9e-4, 5e-4, 1.4e-3, Outcome.MISSED),
        (1e-3, 0.0, 2e-3, Outcome.PASSED),
        (1.1e-3, 0.0, None, Outcome.NOT_JUDGED),  # the reference's error exceeds the bar
    ],
)
def test_what_the_reference_is_off_by_is_added_to_the_bar(exact, own, table, bar, outcome):
    shares = {} if table is None else {"table": {"m": table}}
    reference = replace(exact, estimate={} if own is None else {"m": own}, shares=shares)
    off = 1.5e-3 * exact.a
    found = replace(with_cells(exact), stick_centre=exact.stick_centre - off / 2)
    found = replace(found, stick_half_width=exact.stick_half_width + off / 2)
    verdict = next(each for each in compare(found, reference, SCENE, 1e-3).verdicts if each.quantity == "m")
    assert verdict.error == pytest.approx(1.5e-3, rel=1e-9)
    assert verdict.bar == (None if bar is None else pytest.approx(bar, rel=1e-6))
    assert verdict.outcome is outcome
    assert (exact.method in verdict.reason) == ((own or 0.0) > (table or 0.0))


def test_nodes_that_all_lie_beyond_the_contact_have_no_relative_error(exact):
    elsewhere = replace(exact.traction, x=exact.traction.x + 3 * exact.a)
    elsewhere = replace(elsewhere, values=elsewhere.values._replace(p=0 * exact.traction.p))
    found = replace(with_cells(exact), traction=replace(elsewhere, cells=exact.traction.x))
    comparison = compare(found, exact, SCENE, 1e-4)
    assert comparison.p_nodal is None
    assert comparison.p_nodal_max == 0


def test_a_reference_that_is_known_by_its_cells_is_compared_on_these():
    """The exact means over cells, constant in each cell, as from marching: finer cells add no information."""
    coarse = np.array([-1.0, -0.9, -0.5, 0.1, 0.3, 0.97, 1.0])
    p, _ = cell_means(traction_of(root, root), coarse)

    def constant(x):
        inside = np.abs(x) < 1
        return np.where(inside, p[np.clip(np.searchsorted(coarse, x) - 1, 0, len(p) - 1)], 0.0)

    for count in (7, 50, 333):
        fine = traction_of(root, root, cells=np.linspace(-1.2, 1.2, count))
        reference = traction_of(constant, constant, breaks=coarse, cells=coarse)
        assert cell_errors(fine, reference) == (pytest.approx(0, abs=1e-12), pytest.approx(0, abs=1e-12))
        assert cell_errors(traction_of(lambda x: 1.02 * root(x), root, cells=fine.cells), reference)[0] > 0.019
