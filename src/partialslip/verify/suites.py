"""Suites of cases, by name; made one at a time, as there may be many."""

import difflib
import fnmatch
import itertools
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Literal, get_args

from partialslip.errors import InputError
from partialslip.verify.case import Case
from partialslip.verify.hard_cases.catalogue import hard_cases, shipped
from partialslip.verify.stress import stress_case, stress_numbers

Suite = Literal["quick", "full", "stress"]
SUITES: tuple[Suite, ...] = get_args(Suite)

Maker = Callable[[], Case]
Makers = Mapping[str, Maker]


def suite(name: Suite, only: Sequence[str] = ()) -> Makers:
    """The shipped scenes (``quick``), or these and the catalogue of hard cases (``full``): of these the ``only`` ones,
    by names in which * and ? stand for anything.

    Raises
    ------
    InputError
        If one of the names in ``only`` is no case's.
    """
    cases = [*shipped(), *(hard_cases() if name == "full" else [])]
    known = {case.name: case for case in cases}
    for pattern in only:
        if not fnmatch.filter(known, pattern):
            near = difflib.get_close_matches(pattern, known, n=1)
            hint = f"; did you mean {near[0]!r}?" if near else "; known are " + ", ".join(known)
            raise InputError(f"--only {pattern!r}: no case of the suite {name}{hint}")
    wanted = [case for case in cases if not only or any(fnmatch.fnmatch(case.name, pattern) for pattern in only)]
    return {case.name: partial(_same, case) for case in wanted}


def stress_suite(method: str, seed: int, count: int, only: Sequence[str] = ()) -> Makers:
    """The first ``count`` random scenes of a ``seed`` that ``method`` is for, or the ``only`` ones of these numbers.

    Raises
    ------
    InputError
        If one of ``only`` is not a number.
    """
    for number in only:
        if not number.isdecimal() or len(number) > 18:
            raise InputError(f"--only {number!r}: must be the number of a random scene")
    numbers = [int(number) for number in only] or itertools.islice(stress_numbers(method), count)
    return {f"stress-{seed}-{number}": partial(stress_case, method, seed, number) for number in numbers}


def _same(case: Case) -> Case:
    return case
