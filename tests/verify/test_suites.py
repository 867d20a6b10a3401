"""Cases of the suites by name and number; nothing is solved."""

import itertools
import re

import pytest
from refusing import line_of

from partialslip import InputError, shipped_scenes
from partialslip.verify.hard_cases.catalogue import hard_cases
from partialslip.verify.random_scenes import kind_of
from partialslip.verify.suites import stress_numbers, stress_suite, suite

HARD = [case.name for case in hard_cases()]


def test_quick_has_the_shipped_scenes_and_full_the_hard_cases_too():
    assert list(suite("quick")) == list(shipped_scenes())
    assert list(suite("full")) == [*shipped_scenes(), *HARD]
    assert all(maker().name == name for name, maker in suite("full").items())


def test_only_takes_names_and_patterns():
    assert list(suite("quick", ["yang-laursen"])) == ["yang-laursen"]
    assert list(suite("quick", ["hertz-s*", "flat-rounded"])) == [
        name for name in shipped_scenes() if name.startswith("hertz-s") or name == "flat-rounded"
    ]
    assert list(suite("full", [HARD[0]])) == HARD[:1]


@pytest.mark.parametrize(
    ("name", "only", "hint"),
    [
        ("quick", ["yang-laursen", "hertz-shaer"], "suite quick; did you mean 'hertz-shear'?"),
        ("quick", ["zzzz"], "suite quick; known are flat-rounded, "),
        ("quick", [HARD[0]], "suite quick"),
    ],
)
def test_a_name_of_no_case_is_refused_with_a_hint(name, only, hint):
    told = line_of(suite, name, only)
    assert re.search(rf"^--only '{only[-1]}': no case of the ", told)
    assert hint in told


def test_random_scenes_by_number():
    assert list(stress_suite("fem", 7, 3)) == ["stress-7-0", "stress-7-1", "stress-7-2"]
    assert list(stress_suite("fem", 7, 3, ["12", "4" * 18])) == ["stress-7-12", "stress-7-" + "4" * 18]
    case = stress_suite("march", 7, 3, ["12"])["stress-7-12"]()
    assert (case.name, case.methods, case.reference, case.hard) == ("stress-7-12", ("march",), "", kind_of(12))
    for wrong in ("-1", "x", "", "1.0", "4" * 19):
        with pytest.raises(InputError, match="must be the number of a random scene"):
            stress_suite("fem", 7, 3, ["1", wrong])


def test_the_exact_method_is_not_for_loads_out_of_phase():
    every = list(itertools.islice(stress_numbers("march"), 50))
    assert every == list(range(50))
    exact = list(itertools.takewhile(lambda number: number < 50, stress_numbers("exact")))
    assert exact == [number for number in every if kind_of(number) != "out of phase"]
    assert 0 < len(exact) < 50
