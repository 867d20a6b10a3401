"""Systems of all partitions of nodes from one factor, against their direct solutions."""

from dataclasses import replace

import numpy as np
import pytest

from partialslip.friction.coupled_step import LoadStep, Relative, solve
from partialslip.friction.history import resting
from partialslip.friction.warm_start import Trail

N = 60


@pytest.fixture
def step():
    """A step of unlike bodies under a parabolic gap: tension moves the nodes, and the gap is open at the ends."""
    x = np.linspace(-1, 1, N)
    alike = 3 - np.log((x[:, None] - x) ** 2 + 1e-3) / 2 + 1e-2 * np.eye(N)
    coupling = 0.05 * np.tanh(20 * (x[:, None] - x))
    C = Relative(alike, alike, coupling)
    return LoadStep(alike, alike, coupling, C.opening, np.full(N, 0.3), 1.0, 3 * x**2, 0.1, 0.2 * x, C.factors)


def partition(random, opens, core):
    """Nodes that touch, all but some at the ends, and random ones that slip, all but the ``core`` in the middle."""
    touch = np.ones(N, dtype=bool)
    touch[:opens] = touch[N - opens :] = False
    slip = (random.choice([-1, 0, 0, 1], N) * touch).astype(np.int8)
    slip[core] = 0
    return touch, slip


CORES = [slice(18, 44), slice(24, 50), slice(12, 34)]


@pytest.mark.parametrize("opens", [0, 5, 9])
@pytest.mark.parametrize("core", CORES)
def test_any_partition(step, opens, core):
    """The forces of a partition by the factor are those of the direct solution, and meet its conditions."""
    touch, slip = partition(np.random.default_rng(opens), opens, core)
    system = step.factors.partition(touch, slip, step.f)
    assert system is not None
    p, q, _ = found = step._linear_solve(system.solve, touch, slip, True)
    alone = replace(step, factors=None)
    direct = alone._linear_solve(alone._solver(touch, slip), touch, slip, True)
    for one, other in zip(found, direct, strict=True):
        assert one == pytest.approx(other, abs=1e-12)
    opening, rest = step._gap_and_slip(found)
    scale = step._scale(found).max()
    assert np.abs(opening[touch]).max() <= 1e-14 * scale * np.diag(step.yy).max()
    assert np.abs(rest[touch & (slip == 0)]).max() <= 1e-14 * scale * np.diag(step.xx).max()
    assert q[slip != 0] == pytest.approx((step.f * slip * p)[slip != 0], rel=1e-14)
    assert p.sum() == pytest.approx(1.0, abs=1e-13)
    assert q.sum() == pytest.approx(0.1, abs=1e-13)


def test_a_factor_grows_with_the_contact(step):
    """Nodes that come into contact add rows to the factor, which are those of a new factor of all nodes."""
    touch, no_slip = np.zeros(N, dtype=bool), np.zeros(N, dtype=np.int8)
    touch[20:40] = True
    factors = step.factors
    factors.partition(touch, no_slip, step.f)
    wider = touch | (np.abs(np.arange(N) - 29.5) < 25)
    grown = factors.partition(wider, no_slip, step.f)._by
    assert len(grown.L) >= 100
    order = grown.order[: len(grown.L) // 2]
    product = grown.L @ grown.L.T
    assert product[::2, ::2] == pytest.approx(step.yy[np.ix_(order, order)], abs=1e-12)
    assert product[1::2, 1::2] == pytest.approx(step.xx[np.ix_(order, order)], abs=1e-12)
    assert product[1::2, ::2] == pytest.approx(step.xy[np.ix_(order, order)], abs=1e-12)
    assert factors.made == 2


def test_another_factor_is_made_where_it_pays(step):
    """Where other nodes stick, systems are larger; once that has cost as much as a factor, one is made for them."""
    first, second = (partition(np.random.default_rng(0), 0, core) for core in (slice(0, 25), slice(35, 60)))
    factors = step.factors
    factors.partition(*first, step.f)
    made = [factors.partition(*second, step.f) is not None for _ in range(12)]
    assert not made[0]
    assert made == sorted(made)
    assert made[-1]
    assert factors.partition(*first, step.f) is not None  # the factor before is kept


def test_a_step_and_the_same_step_at_other_nodes(step):
    """The answer does not depend on the way to it, and one linear system suffices from the answer at these nodes."""
    zero = resting(np.zeros(N))
    p, q = solve(step, [(zero, zero)])
    for other in solve(replace(step, factors=None), [(zero, zero)]), solve(step, [(p, q)]):
        assert other[0].x == pytest.approx(p.x, abs=1e-12)
        assert other[1].x == pytest.approx(q.x, abs=1e-12)
    assert p.residual.max() <= 1e-13
    assert q.residual.max() <= 1e-13
    x = np.linspace(-1, 1, N)
    trail = Trail(x)
    trail.keep("step", (p, q))
    again = Trail(x, trail)
    assert again.starts("another") == []
    assert solve(step, again.starts("step"))[0].iterations == 1
    (touching, slipping), coarse = Trail(x[::4], trail).starts("step")[0], p.x[::4] > 0
    assert np.array_equal(touching.x > 0, coarse)
    assert np.array_equal(slipping.sides, q.sides[::4])
