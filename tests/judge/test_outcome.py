"""The rule by which verdicts on quantities become one: passed, missed or not judged. Nothing is solved."""

import itertools
from dataclasses import replace
from typing import get_args

import pytest

from partialslip.result import Regime
from partialslip.run.judge import NO_BAR, Conclusion, Outcome, Verdict, conclude, of_run, together
from partialslip.run.judge import verdicts as module
from partialslip.run.judge.verdicts import headline
from partialslip.tools.bars import BARS

PASSED, MISSED, NOT_JUDGED = Outcome.PASSED, Outcome.MISSED, Outcome.NOT_JUDGED
SOUND = Verdict("finite", PASSED)
SLIDES, STICKS = {"regime", "a", "p", "q"}, {"a", "m", "n", "p", "q", "q1", "q2"}
QUESTIONS = {  # what a verdict on a contact in a regime must answer
    regime: {"sliding": SLIDES, "frictionless": SLIDES, "ratchets": {"regime", *STICKS}}.get(regime, STICKS)
    for regime in get_args(Regime)
}


def verdicts(regime, unjudged=(), missed=()):
    """Return verdicts on all quantities: passed but for those ``unjudged`` and ``missed``."""
    keys = ["a", "left", "right", "P", "p", "dQ", "q", *sorted({"m", "n", "q1", "q2"} & QUESTIONS[regime])]
    outcome = dict.fromkeys(missed, MISSED) | dict.fromkeys(unjudged, NOT_JUDGED)
    found = [Verdict(key, outcome.get(key, PASSED), error=0.0, bar=1.0) for key in keys]
    return [*found, Verdict("regime", outcome.get("regime", PASSED), regime, regime)]


def asks_every_question():
    """Check, in every regime and for every set of headline quantities not judged or absent, that only all pass."""
    for regime, asked in QUESTIONS.items():
        for some in itertools.chain.from_iterable(itertools.combinations(sorted(asked), k) for k in range(4)):
            found = conclude(verdicts(regime, unjudged=some))
            assert found.outcome is (NOT_JUDGED if some else PASSED), (regime, some)
            assert set(found.unjudged) == set(some), (regime, some)
            if not set(some) & {"q1", "q2", "regime"}:
                lost = [each for each in verdicts(regime) if each.quantity not in some]
                assert set(conclude(lost).unjudged) == set(some), (regime, some)


@pytest.mark.parametrize("key", ["left", "right", "left_1", "right_1", "left_2", "right_2", "p_1", "q1", "q2"])
def test_what_only_some_scenes_have_is_asked_where_it_is_known_and_has_a_bar(key):
    def asked(**changes):
        return key in headline([*verdicts("small tension"), replace(Verdict(key, NOT_JUDGED, error=0.0), **changes)])

    assert asked()
    assert asked(error=None, reference=1.0)
    assert not asked(reason=NO_BAR)
    assert not asked(error=None)  # neither has it
    assert key in BARS


@pytest.mark.parametrize("key", ["P", "M", "dQ", "p_max", "q_max", "surface"])
def test_sums_and_largest_values_are_no_headline(key):
    found = [*verdicts("small tension"), Verdict(key, NOT_JUDGED, error=0.0, reason="why")]
    assert conclude(found, [SOUND]).outcome is PASSED


def test_anything_missed_is_missed_and_said():
    over = Verdict("dQ", MISSED, error=0.2, bar=0.1)
    found = conclude([*verdicts("small tension"), over], [replace(SOUND, outcome=MISSED, reason="NaN")])
    assert (found.outcome, found.code, found.text) == (MISSED, 1, "missed: dQ: error 0.2 > 0.1; finite: NaN")
    assert found.missed == ("dQ: error 0.2 > 0.1", "finite: NaN")
    assert conclude(verdicts("small tension"), [replace(SOUND, outcome=MISSED)]).outcome is MISSED
    assert conclude([], [replace(SOUND, outcome=MISSED)]).outcome is MISSED


def test_in_words_and_as_an_exit_code():
    found = conclude(verdicts("large tension", unjudged=("m", "n", "q", "q1", "q2")), [SOUND])
    assert (found.outcome, found.code, found.text) == (NOT_JUDGED, 4, "not judged: m, n, q, q1, q2")
    found = conclude(verdicts("large tension"), [SOUND])
    assert (found.outcome, found.code, found.text) == (PASSED, 0, "all bars met")
    found = conclude([replace(each, outcome=NOT_JUDGED, bar=None, reason=NO_BAR) for each in verdicts("sliding")])
    assert (found.outcome, found.code, found.text, found.asked) == (NOT_JUDGED, 0, "no bars", False)
    assert (conclude([], [SOUND]).text, conclude([]).code) == ("no bars", 0)


def test_a_bar_that_judges_nothing_is_a_bar():
    found = conclude([Verdict("P", NOT_JUDGED, bar=0.1), Verdict("regime", NOT_JUDGED, "sliding")])
    assert (found.asked, found.unjudged, found.code) == (True, ("regime", "a", "p", "q"), 4)


def test_quantities_may_be_waived():
    some = verdicts("small tension", unjudged=("m", "q"))
    assert conclude(some, waived={"m"}).unjudged == ("q",)
    assert conclude(some, waived={"m", "q"}).outcome is PASSED
    assert conclude(verdicts("small tension", missed=("m",)), waived={"m"}).outcome is MISSED


ALL, SOME, BAD, NONE = (
    Conclusion(PASSED), Conclusion(NOT_JUDGED, unjudged=("m", "n")),
    Conclusion(MISSED, missed=("q: error 2 > 1",), unjudged=("n",)), Conclusion(NOT_JUDGED, asked=False),
)  # fmt: skip


@pytest.mark.parametrize(("each", "outcome", "unjudged", "asked"), [
    ([ALL, ALL], PASSED, (), True), ([ALL, NONE], PASSED, (), True), ([ALL, SOME], NOT_JUDGED, ("m", "n"), True),
    ([SOME, SOME], NOT_JUDGED, ("m", "n"), True), ([ALL, SOME, BAD], MISSED, ("m", "n"), True),
    ([NONE], NOT_JUDGED, (), False), ([replace(NONE, outcome=MISSED, missed=("x",)), ALL], MISSED, (), True),
    ([], NOT_JUDGED, (), False),
])  # fmt: skip
def test_several_pass_if_all_that_had_bars_pass(each, outcome, unjudged, asked):
    found = together(each)
    assert (found.outcome, found.unjudged, found.asked) == (outcome, unjudged, asked)
    assert found.missed == tuple(text for one in each for text in one.missed)


@pytest.mark.parametrize(("compared", "hold", "outcome"), [
    ({"fem": ALL}, {"exact": True, "fem": True}, PASSED),
    ({"fem": ALL, "exact": SOME}, {"march": True, "fem": True, "exact": False}, PASSED),
    ({"fem": SOME, "exact": SOME}, {"march": True, "fem": True, "exact": False}, NOT_JUDGED),
    ({"fem": ALL, "march": SOME}, {"exact": True, "fem": True, "march": True}, NOT_JUDGED),
    ({"fem": ALL, "exact": BAD}, {"march": True, "fem": True, "exact": False}, MISSED),
    ({"exact": ALL}, {"march": True, "exact": False}, NOT_JUDGED),
    ({"exact": SOME}, {"march": True, "exact": False}, NOT_JUDGED),
    ({"fem": NONE}, {"fem": True, "exact": True}, NOT_JUDGED), ({}, {"exact": True}, NOT_JUDGED),
])  # fmt: skip
def test_a_run_passes_if_every_result_that_claims_to_hold_passes(compared, hold, outcome):
    missed = [f"{name}: {text}" for name, each in compared.items() for text in each.missed]
    found = of_run(compared, missed, hold)
    assert (found.outcome, found.missed) == (outcome, tuple(missed))
    assert of_run(compared, [*missed, "exact: finite: NaN"], hold).outcome is MISSED
    if compared == {"exact": ALL}:
        assert found.text == "not judged: no result beside the reference claims to hold"
    assert found.asked is bool(compared and NONE not in compared.values())
    assert found.unjudged == (("m", "n") if outcome is NOT_JUDGED and SOME in compared.values() else ())


FORGETFUL = {
    "a pass in anything passes all": lambda _: (),
    "never the regime": lambda _: ("a", "m", "n", "p", "q"),
    "no shear at load points": lambda given, true=headline: tuple(
        key for key in true(given) if key not in ("q1", "q2")
    ),
}


@pytest.mark.fault
@pytest.mark.parametrize("fault", FORGETFUL.values(), ids=FORGETFUL)
def test_a_rule_that_forgets_a_question_is_caught(fault, monkeypatch):
    asks_every_question()
    monkeypatch.setattr(module, "headline", fault)
    with pytest.raises(AssertionError):
        asks_every_question()
