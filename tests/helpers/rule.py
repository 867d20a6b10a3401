"""Verdicts of every regime, and the check that no headline quantity may be left out."""

import itertools
from typing import get_args

from partialslip.result import Regime
from partialslip.run.judge import Outcome, Verdict, conclude

WITHOUT = {"sliding", "frictionless"}
REGIMES = get_args(Regime)
STICKS = [regime for regime in REGIMES if regime not in {*WITHOUT, "ratchets"}]


def questions(regime):
    """Return the quantities that a verdict on a contact in ``regime`` must answer."""
    return {
        "sliding": {"regime", "a", "p", "q"},
        "frictionless": {"regime", "a", "p", "q"},
        "ratchets": {"regime", "a", "m", "n", "p", "q", "q1", "q2"},
    }.get(regime, {"a", "m", "n", "p", "q", "q1", "q2"})


def verdicts(regime, unjudged=(), missed=()):
    """Return verdicts on all quantities: passed but for those ``unjudged`` and ``missed``."""
    keys = ["a", "left", "right", "P", "p", "dQ", "q", *([] if regime in WITHOUT else ["m", "n", "q1", "q2"])]
    outcome = dict.fromkeys(missed, Outcome.MISSED) | dict.fromkeys(unjudged, Outcome.NOT_JUDGED)
    found = [Verdict(key, outcome.get(key, Outcome.PASSED), error=0.0, bar=1.0) for key in keys]
    return [*found, Verdict("regime", outcome.get("regime", Outcome.PASSED), regime, regime)]


def asks_every_question():
    """Check, in every regime and for every set of headline quantities not judged or absent, that only all pass."""
    for regime in REGIMES:
        asked = questions(regime)
        for some in itertools.chain.from_iterable(itertools.combinations(sorted(asked), k) for k in range(4)):
            found = conclude(verdicts(regime, unjudged=some))
            assert found.outcome is (Outcome.NOT_JUDGED if some else Outcome.PASSED), (regime, some)
            assert set(found.unjudged) == set(some), (regime, some)
            if not set(some) & {"q1", "q2", "regime"}:
                lost = [each for each in verdicts(regime) if each.quantity not in some]
                assert set(conclude(lost).unjudged) == set(some), (regime, some)
