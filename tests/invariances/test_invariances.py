"""Nothing that must not matter does: every pair of every method."""

import functools

import pairs
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

ANSWERED = functools.cache(pairs.answered)


@pytest.fixture(autouse=True)
def _each_scene_is_solved_once(monkeypatch):
    monkeypatch.setattr(pairs, "answered", ANSWERED)


@pytest.mark.parametrize("trial", TRIALS)
def test_nothing_changes(trial: Trial):
    apart = trial.run()
    assert apart.traction <= trial.bars.traction
    assert apart.ends <= trial.bars.ends
