"""Gaps whose curvature jumps within elements, as in tables: interpolation changes their work."""

import math

import numpy as np
import pytest
from plain import plain

import partialslip
from partialslip.halfplane import contact
from partialslip_fem import solving
from partialslip_fem.elasticity import body
from partialslip_fem.mortar import projected
from partialslip_meshes import block

KINK = 0.137


def bent(x):
    """A parabola whose curvature jumps by 1 at ``KINK``."""
    return x**2 / 2 + np.maximum(x - KINK, 0) ** 2 / 2


def work(line, gap, order=12):
    """Work of a unit pressure all along the contact line with a ``gap``."""
    nodes, weights = np.polynomial.legendre.leggauss(order)
    ends = np.union1d(line.x, [KINK])
    half, middle = np.diff(ends)[:, None] / 2, (ends[1:] + ends[:-1])[:, None] / 2
    return float((gap(middle + half * nodes) * (half * weights)).sum())


@pytest.fixture(scope="module", params=[2, 3, 4, 6])
def line(request):
    points = dict.fromkeys(np.linspace(-1, 1, 11).tolist(), 0.15)
    return body(block(5.0, (-1.2, 1.2), points, 0.6), kappa=1.8, order=request.param)


def error_of_work(line, values):
    return abs(float(line.weights @ values) - work(line, bent))


def test_the_projected_gap_does_the_work_of_the_gap(line):
    assert error_of_work(line, projected(line, bent, [KINK])) < 1e-13


@pytest.mark.fault
def test_an_interpolated_gap_does_other_work(line):
    """Deliberate fault: the gap at the nodes, whatever lies between them."""
    assert error_of_work(line, bent(line.x)) > 1e-9


def test_a_gap_without_a_jump_in_a_cell_stays_as_it_is(line):
    vertex = float(line.x[3 * line.order])
    for breaks in ((), (vertex,), (-50.0, 50.0)):
        assert np.array_equal(projected(line, bent, breaks), bent(line.x))


def table():
    """x^6 at 25 points, accuracy 5e-7: a coarse table, whose curvature jumps by much."""
    a = 1e-3
    x = np.linspace(0, 1.7, 25) * a
    profile = {"kind": "tabulated", "x": x.tolist(), "gap": (a**2 / 0.06 * (x / a) ** 6).tolist()}
    A = 4 * (1 - 0.3**2) / 70e9
    P = a**2 / 0.01 / A * math.pi * 15 / 48
    return plain({"P": P, "Q": [-0.25 * P, 0.25 * P]}, 0.5, (70e9, 0.3), profile, fem={"accuracy": 5e-7})


def ratios(scene):
    """Errors of the ends of the contact over their estimates."""
    fem, exact = partialslip.run(scene, ["fem"]).results["fem"], contact(scene)
    left, right = (end / exact.a for end in fem.ends[1])
    return abs(left + 1) / fem.estimate["left"], abs(right - 1) / fem.estimate["right"]


@pytest.mark.slow
def test_ends_of_a_coarse_table_are_within_a_tenth_of_their_estimates():
    """Elements are as small as the tractions call for, and ends converge faster."""
    assert max(ratios(table())) < 0.1


@pytest.mark.slow
@pytest.mark.fault
def test_interpolated_gaps_would_be_seen(monkeypatch):
    """Deliberate fault: the gap at the nodes; estimates that go by the order know nothing of its error."""
    monkeypatch.setattr(solving, "projected", lambda line, gap, _: gap(line.x))
    assert max(ratios(table())) > 0.1
