"""Verification of the methods on the shipped scenes, the catalogue of hard cases, and random scenes."""

from typing import TYPE_CHECKING

from partialslip.tools.lazy import homes_of, make_lazy

if TYPE_CHECKING:
    from partialslip.run.judge import Bar as Bar
    from partialslip.verify.case import REQUIREMENTS as REQUIREMENTS
    from partialslip.verify.case import Case as Case
    from partialslip.verify.case import CaseVerdict as CaseVerdict
    from partialslip.verify.case import Found as Found
    from partialslip.verify.case import judge_case as judge_case
    from partialslip.verify.case import number_of as number_of
    from partialslip.verify.case import requirement_of as requirement_of
    from partialslip.verify.case import run_case as run_case
    from partialslip.verify.case import solve_case as solve_case
    from partialslip.verify.driver import Verification as Verification
    from partialslip.verify.driver import verify_suite as verify_suite
    from partialslip.verify.hard_cases.catalogue import FAMILIES as FAMILIES
    from partialslip.verify.hard_cases.catalogue import hard_cases as hard_cases
    from partialslip.verify.hard_cases.catalogue import shipped as shipped
    from partialslip.verify.suites import stress_case as stress_case
    from partialslip.verify.suites import stress_suite as stress_suite
    from partialslip.verify.suites import suite as suite

_HOMES = homes_of(
    {
        "case": "Case CaseVerdict Found REQUIREMENTS judge_case number_of requirement_of run_case solve_case",
        "driver": "Verification verify_suite",
        "hard_cases.catalogue": "FAMILIES hard_cases shipped",
        "suites": "stress_case stress_suite suite",
    }
)
__all__ = [*_HOMES]
make_lazy(__name__, _HOMES)
