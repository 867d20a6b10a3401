"""The outcome of a comparison, a run or a suite: the one rule by which verdicts on quantities become one verdict.

A comparison passes only if every headline quantity was judged and nothing is missed. The regime of the reference tells
which quantities are the headline.
"""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

from partialslip.run.judge.verdict import NO_BAR, Outcome, Verdict

_STICK = ("a", "m", "n", "p", "q")  # with a stick zone
#: Quantities that must be judged, by the regime of the reference where there is no stick zone to ask for. The regime
#: itself must be judged there: nothing else says that nothing sticks.
_OTHERS: Mapping[str, tuple[str, ...]] = {
    "sliding": ("regime", "a", "p", "q"),  # q = f p
    "frictionless": ("regime", "a", "p", "q"),  # q = 0
    "ratchets": ("regime", *_STICK),  # asked for, and never judged: there is no steady state
}
#: Quantities that must be judged where both results have them and they have a bar: what comes beside a, p and q where
#: the contact is not even, the pressure varies, or the shear at the load points is known.
_WHERE_KNOWN = ("left", "right", "left_1", "right_1", "left_2", "right_2", "p_1", "q1", "q2")

PASSED, MISSED, UNJUDGED = 0, 1, 4  # fixed: exit codes


@dataclass(frozen=True)
class Conclusion:
    """What verdicts amount to.

    Parameters
    ----------
    outcome : Outcome
    missed : tuple of str
        Missed verdicts as text.
    unjudged : tuple of str
        Headline quantities that were not judged.
    asked : bool
        Whether there were bars. Without bars the outcome is NOT_JUDGED, or MISSED if a condition is missed.
    """

    outcome: Outcome
    missed: tuple[str, ...] = ()
    unjudged: tuple[str, ...] = ()
    asked: bool = True

    @property
    def text(self) -> str:
        """The outcome in words, with what was missed or not judged."""
        if self.outcome is Outcome.MISSED:
            return "missed: " + "; ".join(self.missed)
        if self.outcome is Outcome.PASSED:
            return "all bars met"
        if not self.asked:
            return "no bars"
        return f"not judged: {', '.join(self.unjudged) or 'no result beside the reference claims to hold'}"

    @property
    def code(self) -> int:
        """Exit code: 1 if missed, 4 if bars were asked for and headline quantities were not judged, 0 otherwise."""
        if self.outcome is Outcome.MISSED:
            return MISSED
        return UNJUDGED if self.outcome is Outcome.NOT_JUDGED and self.asked else PASSED


def headline(verdicts: Iterable[Verdict]) -> tuple[str, ...]:
    """Return the quantities that must be judged, by the regime of the reference in ``verdicts``.

    Without a verdict on the regime these are the regime and the quantities of a stick zone.
    """
    known = {verdict.quantity: verdict for verdict in verdicts}
    regime = known["regime"].reference if "regime" in known else None
    required = _OTHERS.get(str(regime), _STICK if regime else ("regime", *_STICK))
    further = (key for key in _WHERE_KNOWN if key in known and known[key].known and known[key].reason != NO_BAR)
    return (*required, *further)


def conclude(
    verdicts: Iterable[Verdict], conditions: Iterable[Verdict] = (), waived: Collection[str] = ()
) -> Conclusion:
    """Return what ``verdicts`` on one comparison and the ``conditions`` of its result amount to.

    MISSED if any of them is missed; PASSED if every headline quantity was judged; NOT_JUDGED otherwise. Passed
    ``conditions`` alone do not pass a result.

    Parameters
    ----------
    verdicts : iterable of Verdict
        One per quantity, with that on the regime.
    conditions : iterable of Verdict
        Checks of the result alone.
    waived : collection of str
        Headline quantities that need not be judged.
    """
    verdicts = tuple(verdicts)
    judged = {verdict.quantity for verdict in verdicts if verdict.outcome is not Outcome.NOT_JUDGED}
    asked = bool(judged) or any(verdict.bar is not None for verdict in verdicts)
    unjudged = tuple(key for key in headline(verdicts) if key not in judged and key not in waived) if asked else ()
    missed = tuple(verdict.text for verdict in (*verdicts, *conditions) if verdict.outcome is Outcome.MISSED)
    passed = asked and bool(judged) and not unjudged
    return Conclusion(_outcome(bool(missed), passed), missed, unjudged, asked)


def together(conclusions: Iterable[Conclusion]) -> Conclusion:
    """Return what several ``conclusions`` amount to: PASSED only if all that had bars passed, and one had."""
    conclusions = tuple(conclusions)
    missed = tuple(text for each in conclusions for text in each.missed)
    unjudged = tuple(dict.fromkeys(key for each in conclusions for key in each.unjudged))
    asked = [each for each in conclusions if each.asked]
    passed = bool(asked) and all(each.outcome is Outcome.PASSED for each in asked)
    return Conclusion(_outcome(bool(missed), passed), missed, unjudged, bool(asked))


def of_run(compared: Mapping[str, Conclusion], missed: Iterable[str], hold: Mapping[str, bool]) -> Conclusion:
    """Return what a run of several methods amounts to.

    Parameters
    ----------
    compared : mapping of str to Conclusion
        Conclusions by method; none for the reference.
    missed : iterable of str
        What any method, the reference included, missed, as text.
    hold : mapping of str to bool
        By method, whether the result claims to hold. A closed form that says that it does not hold for the scene needs
        not pass; nor does it make a run pass.
    """
    asking = [each for name, each in compared.items() if hold[name]]
    whole, missed = together(asking or compared.values()), tuple(missed)
    passed = bool(asking) and whole.outcome is Outcome.PASSED
    return Conclusion(_outcome(bool(missed), passed), missed, whole.unjudged, whole.asked)


def missed_by(verdicts: Mapping[str, Iterable[Verdict]]) -> tuple[str, ...]:
    """Return missed ``verdicts``, by method, as text."""
    return tuple(
        f"{name}: {verdict.text}"
        for name, some in verdicts.items()
        for verdict in some
        if verdict.outcome is Outcome.MISSED
    )


def _outcome(missed: bool, passed: bool) -> Outcome:
    return Outcome.MISSED if missed else Outcome.PASSED if passed else Outcome.NOT_JUDGED
