"""Systems of all partitions of nodes from one factor, against their direct solutions."""

from dataclasses import replace

import numpy as np
import pytest

from partialslip.condensed.coupled import Relative, _solve, _Step
from partialslip.condensed.history import resting
from partialslip.condensed.trail import Trail

N = 60


@pytest.fixture
def step():
    """A step of unlike bodies under a parabolic gap: tension moves the nodes, and the gap is open at the ends."""
    x = np.linspace(-1, 1, N)
    alike = 3 - np.log((x[:, None] - x) ** 2 + 1e-3) / 2 + 1e-2 * np.eye(N)
    coupling = 0.05 * np.tanh(20 * (x[:, None] - x))
    C = Relative(alike, alike, coupling)
    return _Step(alike, alike, coupling, C.opening, 0.3, 1.0, 3 * x**2, 0.1, 0.2 * x, C.factors)


def partition(random, opens):
    touch = np.ones(N, dtype=bool)
    touch[:opens] = touch[N - opens :] = False
    return touch, (random.choice([-1, 0, 0, 1], N) * touch).astype(np.int8)


@pytest.mark.parametrize("opens", [0, 5, 14])
def test_any_partition(step, opens):
    """The forces of a partition by the factor are those of the direct solution, and meet its conditions."""
    touch, slip = partition(np.random.default_rng(opens), opens)
    p, q, opening, rest, scale = step._linear_solve(touch, slip, True)
    direct = replace(step, factors=None)._linear_solve(touch, slip, True)
    assert p == pytest.approx(direct[0], abs=1e-12)
    assert q == pytest.approx(direct[1], abs=1e-12)
    assert np.abs(opening[touch]).max() <= 1e-14 * scale.max() * np.diag(step.yy).max()
    assert np.abs(rest[touch & (slip == 0)]).max() <= 1e-14 * scale.max() * np.diag(step.xx).max()
    assert q[slip != 0] == pytest.approx((step.f * slip * p)[slip != 0], rel=1e-14)
    assert p.sum() == pytest.approx(1.0, abs=1e-13)
    assert q.sum() == pytest.approx(0.1, abs=1e-13)


def test_a_step_and_the_same_step_at_other_nodes(step):
    """The answer does not depend on the way to it, and one linear system suffices from the answer at these nodes."""
    zero = resting(np.zeros(N))
    p, q = _solve(step, [(zero, zero)])
    for other in _solve(replace(step, factors=None), [(zero, zero)]), _solve(step, [(p, q)]):
        assert other[0].x == pytest.approx(p.x, abs=1e-12)
        assert other[1].x == pytest.approx(q.x, abs=1e-12)
    assert p.residual.max() <= 1e-13
    assert q.residual.max() <= 1e-13
    x = np.linspace(-1, 1, N)
    trail = Trail(x)
    trail.keep("step", (p, q))
    again = Trail(x, trail)
    assert again.starts("another") == []
    assert _solve(step, again.starts("step"))[0].iterations == 1
    (touching, slipping), coarse = Trail(x[::4], trail).starts("step")[0], p.x[::4] > 0
    assert np.array_equal(touching.x > 0, coarse)
    assert np.array_equal(slipping.sides, q.sides[::4])
