"""The bounded quadratic programme: its conditions, on random and on degenerate problems."""

import numpy as np
import pytest

from partialslip.friction.active_set import Factored, solve_bounded


def compliance(n: int, random: np.random.Generator) -> np.ndarray:
    """-log|x - s| between irregular points, smoothed: positive definite like an elastic half-plane's, no M-matrix."""
    x = np.sort(random.random(n))
    return 3 - np.log((x[:, None] - x) ** 2 + 1e-4) / 2 + 1e-2 * np.eye(n)


def check(C, g, lower, upper, total, tolerance=1e-9):
    solution = solve_bounded(C, g, lower, upper, total)
    x = solution.x
    assert np.all((x >= lower) & (x <= upper))
    assert x.sum() == pytest.approx(total, abs=1e-12 * max(1.0, np.abs(x).sum()))
    gradient = C @ x - g
    free = (x > lower) & (x < upper)
    low = gradient[free | (x == upper)].max(initial=-np.inf)  # these could give, so no other may gain by taking
    high = gradient[free | (x == lower)].min(initial=np.inf)
    assert low - high <= tolerance * max(1.0, np.abs(gradient).max())
    assert solution.residual.max() <= tolerance
    return solution


@pytest.mark.parametrize("seed", range(40))
def test_random_problems(seed):
    random = np.random.default_rng(seed)
    n = int(random.integers(1, 80))
    C = compliance(n, random)
    bound = random.random(n) ** 3
    total = random.uniform(-1, 1) * 0.999 * bound.sum()
    check(C, 10 ** random.uniform(-3, 2) * random.standard_normal(n), -bound, bound, total)
    check(C, random.standard_normal(n), np.zeros(n), np.full(n, np.inf), 10 ** random.uniform(-2, 2))


@pytest.mark.parametrize("total", [-1.0, 1.0])
def test_all_at_the_bound(total):
    C = compliance(20, np.random.default_rng(0))
    bound = np.full(20, 0.05)
    solution = check(C, np.linspace(-1, 1, 20), -bound, bound, total)
    assert np.sign(solution.x) == pytest.approx(total)


def test_on_the_bound_to_the_last_digit():
    """Degenerate solution at bounds with zero multipliers: no active set is unique, and the iteration must end."""
    random = np.random.default_rng(3)
    for n in (5, 30, 60):
        C = compliance(n, random)
        x = random.choice([-1.0, 1.0, 0.3], n)
        solution = check(C, C @ x, -np.ones(n), np.ones(n), x.sum())
        assert solution.x == pytest.approx(x, abs=1e-9)


def test_nothing_free_between_two_blocks_of_bounds():
    """A huge load puts every member at a bound, except one member that balances the sum."""
    C = compliance(31, np.random.default_rng(5))
    solution = check(C, 1e6 * np.linspace(-1, 1, 31), -np.ones(31), np.ones(31), 0.4)
    assert np.sum(np.abs(solution.x) < 1) == 1


def test_unbounded_is_a_linear_solve():
    C = compliance(12, np.random.default_rng(7))
    g = np.linspace(0, 1, 12)
    solution = solve_bounded(C, g, np.full(12, -np.inf), np.full(12, np.inf), 2.0)
    saddle = np.block([[C, -np.ones((12, 1))], [np.ones((1, 12)), np.zeros((1, 1))]])
    assert solution.x == pytest.approx(np.linalg.solve(saddle, np.append(g, 2.0))[:-1], rel=1e-10)
    assert solution.iterations <= 3


@pytest.mark.parametrize("seed", range(20))
def test_sides_and_a_start_from_them(seed):
    """Sides match the active bounds, a start from the solution converges at once, and any start converges to it."""
    random = np.random.default_rng([1, seed])
    n = int(random.integers(1, 80))
    C, g, bound = compliance(n, random), random.standard_normal(n), random.random(n)
    total = random.uniform(-1, 1) * 0.99 * bound.sum()
    cold = check(C, g, -bound, bound, total)
    assert np.array_equal(cold.sides[cold.sides != 0], np.sign(cold.x)[cold.sides != 0])
    assert (np.abs(cold.x) == bound)[cold.sides != 0].all()
    again = solve_bounded(C, g, -bound, bound, total, cold.sides)
    assert again.iterations <= 2 <= cold.iterations
    anywhere = solve_bounded(C, g, -bound, bound, total, random.integers(-1, 2, n).astype(np.int8))
    for other in (again, anywhere):
        assert other.x == pytest.approx(cold.x, abs=1e-11)
        assert np.array_equal(other.sides, cold.sides)


@pytest.mark.parametrize("seed", range(10))
def test_factors_of_earlier_programmes_change_nothing(seed):
    """Programmes with one C, whose inverse or last factor serves all of them: the same answers, to rounding."""
    random = np.random.default_rng([2, seed])
    n = int(random.integers(2, 80))
    C, bound = compliance(n, random), random.random(n)
    inverted, remembered, sides = Factored(C), Factored(C), None
    inverted.expect(1000)
    for level in (0.1, 0.5, 0.9, -0.3):
        g, total = random.standard_normal(n), level * bound.sum()
        alone = check(C, g, -bound, bound, total)
        for factored in (inverted, remembered):
            solution = solve_bounded(C, g, -bound, bound, total, sides, factored)
            assert solution.x == pytest.approx(alone.x, abs=1e-11)
            assert solution.residual.max() <= 1e-13 * np.abs(C).max() * n
            assert solution.imbalance <= 1e-14 * n
            assert np.array_equal(solution.sides, alone.sides)
            assert solve_bounded(C, g, -bound, bound, total, solution.sides, factored).iterations == 1
        sides = alone.sides


@pytest.mark.parametrize("seed", range(4))
def test_members_that_just_touch_a_bound_leave_the_sum(seed):
    """Two members in five are on the bound without a force that keeps them there, to rounding: the inverse takes half
    of them beyond it. All that is cut off at the bound must come back elsewhere: it once left a sum off by 3e-12, and
    a rigid shift of all other members, which looked like slip."""
    random = np.random.default_rng([3, seed])
    n = 300
    C, bound = compliance(n, random), 1 + random.random(n)
    x = bound * np.where(random.random(n) < 0.4, 1, random.uniform(0.2, 0.9, n))
    inverted = Factored(C)
    inverted.expect(1000)
    solution = solve_bounded(C, C @ x, -bound, bound, float(x.sum()), None, inverted)
    rounding = n * np.finfo(float).eps  # of a sum
    assert solution.imbalance <= rounding * x.sum()
    assert np.abs(solution.rest).max() <= 2 * rounding * (C @ x).max()  # of C @ x, and of the product with the inverse
    assert solution.x == pytest.approx(x, abs=1e-10)


@pytest.mark.parametrize("scale", [1e-12, 1e12])
def test_independent_of_units(scale):
    random = np.random.default_rng(11)
    C, g, bound = compliance(40, random), random.standard_normal(40), random.random(40)
    base = solve_bounded(C, g, -bound, bound, 1.0)
    scaled = solve_bounded(C * scale, g, -bound / scale, bound / scale, 1.0 / scale)
    assert scaled.x * scale == pytest.approx(base.x, rel=1e-8, abs=1e-12)
    assert scaled.iterations == base.iterations


def test_residual_of_a_tiny_member_is_not_the_rounding_of_the_shift():
    """Close to sliding, one cell of 1e-9 of the contact sticks. A shift of order one has a rounding error that would be
    1e-7 of this cell's bound."""
    random = np.random.default_rng(5)
    C, bound = compliance(30, random), np.full(30, 0.1)
    bound[0] = 1e-10
    g = C @ bound
    g[0] -= 2.5  # the first member to come off its bound
    total = float(bound.sum()) - 1e-10
    solution = solve_bounded(C, g, -bound, bound, total)
    assert np.flatnonzero(solution.sides == 0).tolist() == [0]
    assert solution.residual[0] <= 1e-9 * bound[0]
    assert solution.imbalance <= 1e-15
