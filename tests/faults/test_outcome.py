"""Deliberate faults of the rule by which verdicts become one: its checks must catch each."""

import pytest
from rule import asks_every_question

from partialslip.judge import outcome

pytestmark = pytest.mark.fault


def any_passes(_):
    """Ask for nothing: a pass in anything passes all."""
    return ()


def never_a_regime(_):
    """Ask for a stick zone's ends only, whatever the regime."""
    return ("a", "m", "n", "p", "q")


def without_levels(verdicts, true=outcome.headline):
    """Forget the shear at the load points."""
    return tuple(key for key in true(verdicts) if key not in ("q1", "q2"))


@pytest.mark.parametrize("fault", [any_passes, never_a_regime, without_levels])
def test_a_rule_that_forgets_a_question_is_caught(fault, monkeypatch):

    asks_every_question()
    monkeypatch.setattr(outcome, "headline", fault)
    with pytest.raises(AssertionError):
        asks_every_question()
