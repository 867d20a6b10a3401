"""Problems of the benchmark as cases of the verification."""

import pytest

from partialslip.run.judge import Outcome
from partialslip.verify.case import run_case
from partialslip.verify.suites import suite


@pytest.mark.slow
def test_problems_of_the_book_meet_the_bars():
    verdicts = run_case(suite("book", ["PS-05"])["PS-05"]())
    assert {verdict.method for verdict in verdicts} == {"exact", "march", "fem"}
    assert all(verdict.outcome is Outcome.PASSED for verdict in verdicts if verdict.outcome is not Outcome.NOT_JUDGED)
    assert {verdict.quantity for verdict in verdicts if verdict.outcome is Outcome.PASSED} >= {"a", "m", "n", "p", "q"}
