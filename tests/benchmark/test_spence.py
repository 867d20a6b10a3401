"""The self-similar solution of PS-25, without march, solves its equations and confirms the targets."""

import ast
import importlib
import itertools
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from partialslip.verify.benchmark.problem import read_frozen

SCRIPT = Path(__file__).parents[2] / "benchmarks" / "spence.py"
BETA, F = 0.11369301501135544, 0.08  # of PS-25
C = 0.402936780531


@pytest.fixture(scope="module")
def spence():
    """The script."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(SCRIPT.parent)
        return importlib.import_module("spence")


@pytest.fixture(scope="module")
def punch(spence):
    """The flat punch of PS-25."""
    return spence.punch(BETA, F)


def residuals(punch):
    """Largest errors of H p = beta q and, where it sticks, H q = -beta p; and H q + beta p where it slips."""

    opens, slips = [], []
    for x in (0.15, 0.34, 0.5, 0.8):
        p, q = (float(each(np.array([x]))[0]) for each in (punch.p, punch.q))
        opens.append(hilbert(punch.p, x, False, (punch.c, punch.m)) - BETA * q)
        slips.append(hilbert(punch.q, x, True, (punch.c, punch.m)) + BETA * p)
    return np.abs(opens).max(), np.abs(slips[:2]).max(), slips[2:]


def hilbert(traction, x, odd, breaks, count=501):
    """(1/pi) int t(s)/(x - s) ds over [-1, 1] by tanh-sinh quadrature of a ``traction`` of s and 1 - s, even or ``odd``
    and smooth between the ``breaks``."""
    steps = np.linspace(-4.5, 4.5, count)
    near, far = (1 / (1 + np.exp(side * np.pi * np.sinh(steps))) for side in (-1, 1))
    weights = np.pi * np.cosh(steps) * near * far * (steps[1] - steps[0])
    own = float(traction(np.array([x]), np.array([1 - x]))[0])
    total = own * np.log(x**2 / (1 - x**2) if odd else (1 + x) / (1 - x))
    for left, right in itertools.pairwise(sorted([0.0, x, *breaks, 1.0])):
        s, beside = left + (right - left) * near, 1 - right + (right - left) * far
        apart = np.where(s == x, np.inf, x * x - s * s)
        total += (right - left) * weights @ ((traction(s, beside) - own) * 2 * (s if odd else x) / apart)
    return total / np.pi


def test_it_imports_nothing_of_partialslip():
    nodes = list(ast.walk(ast.parse(SCRIPT.read_text("utf-8"))))
    found = {name.name for node in nodes if isinstance(node, ast.Import) for name in node.names}
    found |= {node.module for node in nodes if isinstance(node, ast.ImportFrom)}
    assert {name for name in found if name.startswith("partialslip")} == set()
    assert "json" in found


def test_another_quadrature_confirms_the_equations(punch):
    """Slip opposes friction: where q > 0 the lower body moves to the right of the upper one."""
    opens, sticks, slips = residuals(punch)
    assert opens < 1e-12
    assert sticks < 1e-12
    assert min(slips) > 0


def test_friction_is_within_its_bound(punch):
    x = np.linspace(0, 0.9999, 2000)
    p, q = punch.p(x), punch.q(x)
    inside = x < punch.c
    assert (p > 0).all()
    assert (np.abs(q[inside]) < F * p[inside]).all()
    assert np.allclose(q[~inside], F * p[~inside], rtol=1e-14, atol=0)


def test_series_and_panels_agree(spence, punch):
    other = spence.punch(BETA, F, 28, 0.3)
    assert punch.c == pytest.approx(C, abs=2e-12)
    assert other.c == pytest.approx(C, abs=2e-12)
    assert other.size() == pytest.approx(punch.size(), rel=1e-11)
    assert other.pressed(0.9) == pytest.approx(punch.pressed(0.9), rel=1e-11)


def test_the_parabola_is_closed_by_its_tractions(punch):
    """H p - beta q = x a^2/(A R P) within the contact, p and q in P/a: that of all punches up to its half-width."""

    def pressure(s, _):
        return np.array([2 / np.pi * punch.pressed(min(each, 1 - 1e-15)) for each in s])

    x = 0.6
    q = 2 * x * punch.integral(lambda _, t, beside: punch.q(t, beside) / t**2, x)
    closing = hilbert(pressure, x, False, (punch.c, punch.m), 31) - BETA * q
    assert closing == pytest.approx(punch.size() * x, rel=1e-10)


def test_weak_coupling_leads_to_goodman(spence):
    """K(c)/K'(c) = f/beta as beta -> 0, with an error like beta^2; a and p become Hertz's."""
    ratio = 0.7
    wide, narrow = (spence.punch(beta, ratio * beta) for beta in (2e-3, 1e-3))
    assert (4 * narrow.c - wide.c) / 3 == pytest.approx(spence.goodman(ratio), abs=1e-9)
    assert (4 * narrow.size() - wide.size()) / 3 == pytest.approx(2 / np.pi, abs=1e-9)
    assert (4 * narrow.pressed(0.6) - wide.pressed(0.6)) / 3 == pytest.approx(0.8, abs=1e-9)


def test_frozen_targets_are_within_their_uncertainty(spence):
    frozen = read_frozen().targets["PS-25"]
    found = spence.values(frozen["a"].value)
    assert found.keys() == frozen.keys()
    for key, target in frozen.items():
        assert abs(target.value - found[key]) <= target.uncertainty * target.scale, key
    assert found["p_max"] > found["p@0.5"]


@pytest.mark.fault
def test_wrong_powers_and_shares_are_seen(punch):
    """Deliberate faults: the power of Goodman's approximation at c and at the end, R in p with the wrong sign, and q
    that is not coupled."""
    wrong = [replace(punch, w=0.5), replace(punch, edge=-0.5), replace(punch, k=-punch.k), replace(punch, f=0.0)]
    found = [max(residuals(each)[:2]) for each in wrong]
    assert min(found) > 4e-5


@pytest.mark.fault
def test_goodmans_stick_zone_is_no_solution(spence):
    """Deliberate fault: with the stick zone of Goodman's approximation tractions are singular there."""
    sizes = [
        abs(float(spence.collocated(BETA, F, c, True, 20, 0.4).R(np.array([c]))[0]))
        for c in (spence.goodman(F / BETA), C)
    ]
    assert sizes[0] > 1e6 * sizes[1]
