"""The limit of cycles that come to the steady state in geometric progression."""

from dataclasses import replace

import numpy as np
import pytest
from cell_contact import cells, loads

from partialslip.friction import history
from partialslip.friction.coulomb_constant_pressure import march
from partialslip.friction.limit import limit

BOUND = np.array([1.0, 2.0, 0.5, 0.0])
END, MODE = np.array([0.3, -1.2, 0.1, 0.0]), np.array([0.2, 0.1, -0.05, 0.0])


@pytest.mark.parametrize("ratio", [0.1, 0.7, 0.99])
def test_geometric_progression(ratio):
    """The limit of a progression is exact, from four states on; errors beside it count as much as the ratio tells."""
    states = [END + MODE * ratio**k for k in range(4)]
    assert limit(states, BOUND) == pytest.approx(END, abs=1e-12)
    assert limit(states[:3], BOUND) is None
    beside = [state + 1e-4 * (1 - ratio) ** 2 * MODE[::-1] * 0.05**k for k, state in enumerate(states)]
    assert limit(beside, BOUND) == pytest.approx(END, abs=1e-4)


def test_bounds_are_kept():
    states = [np.array([0.9 - 0.5 * 0.9**k, 0.0, 0.0, 0.0]) + np.array([0.3, 0, 0, 0]) for k in range(4)]
    assert (np.abs(limit(states, BOUND)) <= BOUND).all()


def test_no_progression():
    """Power laws, growth, oscillations and cycles that repeat have no limit that four cycles tell."""
    for shares in ([1, 1 / 2, 1 / 3, 1 / 4], [1, 2, 4, 8], [1, -0.5, 0.25, -0.125], [1, 1, 1, 1]):
        assert limit([END + share * MODE for share in shares], BOUND) is None


@pytest.mark.parametrize(("Qf", "sf"), [(0.6, 10.0), (0.7, 9.0)])
def test_skipped_cycles_change_nothing(Qf, sf, monkeypatch):
    """Under a small mean load nodes come slowly to their bounds: cycles that are skipped change neither the change of q
    from load point to load point nor what is locked in."""
    _, *problem = cells(growth=0.2)
    path = loads(Qf, sf)
    path = replace(path, cycle=tuple((Q + 0.03, strain, slope) for Q, strain, slope in path.cycle))
    hastened = march(*problem, 1.0, path)
    monkeypatch.setattr(history, "limit", lambda *_: None)
    plain = march(*problem, 1.0, path)
    for key in ("q1", "q2"):
        assert getattr(hastened, key) == pytest.approx(getattr(plain, key), abs=1e-6 * problem[-1].max())
    assert hastened.load_steps < plain.load_steps
