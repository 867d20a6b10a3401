"""Nothing that must not matter does: every pair of every method."""

import pytest
from pairs import Trial, trials

TRIALS = [
    pytest.param(
        trial,
        id=f"{trial.method}-{trial.kind}-{trial.invariance}",
        marks=[pytest.mark.slow] if trial.slow else [],
    )
    for trial in trials()
]


@pytest.mark.parametrize("trial", TRIALS)
def test_nothing_changes(trial: Trial):
    apart = trial.run()
    assert apart.traction <= trial.bars.traction
    assert apart.ends <= trial.bars.ends
