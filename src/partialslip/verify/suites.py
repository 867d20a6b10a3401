"""Suites of cases by name. Cases are made one at a time, because there may be many."""

import fnmatch
import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import Literal, get_args

from partialslip.run.judge import Bar
from partialslip.run.judge.reference import reference
from partialslip.scene.reading import meant
from partialslip.tools.errors import InputError
from partialslip.tools.methods import REFERENCES
from partialslip.verify.case import Case
from partialslip.verify.hard_cases.catalogue import hard_cases, shipped
from partialslip.verify.random_scenes import draw, draw_varying, kind_of, varies

Suite = Literal["quick", "full", "book", "stress"]
SUITES: tuple[Suite, ...] = get_args(Suite)

# Levels of dissimilar half-planes by finite elements, which press them from a flat punch on the nodes of the contact
_PRESSED = {
    key: Bar(0.05, "elements do not resolve the singular ends of the flat punch from which pressing is made")
    for key in ("fem.q1", "fem.q2")
}

# Problems in which a method knows levels less well than asked for, and says so in its estimate
_LEVELS = {
    "PS-19": {
        key: Bar(5e-3, "cells that come into contact within a load step lock in shear from its end on: first order")
        for key in ("march.q1", "march.q2")
    }
}

Maker = Callable[[], Case]
Makers = Mapping[str, Maker]


def suite(name: Suite, only: Sequence[str] = ()) -> Makers:
    """Return functions that make the cases of a suite, by name of the case.

    Parameters
    ----------
    name : str
        "quick": shipped scenes; "full": shipped scenes and hard cases; "book": problems of the benchmark.
    only : sequence of str
        Names of cases, with wildcards * and ?; default: all cases.

    Raises
    ------
    InputError
        If a name in ``only`` matches no case.
    """
    cases = book() if name == "book" else [*shipped(), *(hard_cases() if name == "full" else [])]
    known = {case.name: case for case in cases}
    for pattern in only:
        if not fnmatch.filter(known, pattern):
            hint = meant(pattern, known) or "; known are " + ", ".join(known)
            raise InputError(f"--only {pattern!r}: no case of the suite {name}{hint}")
    wanted = [case for case in cases if not only or any(fnmatch.fnmatch(case.name, pattern) for pattern in only)]
    return {case.name: partial(_same, case) for case in wanted}


def book() -> list[Case]:
    """Return the problems of the benchmark as cases, by every method that solves them; the reference is the method
    that their targets come from."""
    from partialslip.verify.benchmark import read_problems
    from partialslip.verify.benchmark.freeze import derivations

    cases = []
    for number, problem in read_problems().items():
        methods = tuple(dict.fromkeys(way.method for way in derivations(problem)))
        scene, unlike = problem.scene, not problem.scene.material.alike
        reference = "" if scene.sized else next(known for known in REFERENCES if known in methods)
        if unlike:  # the load steps of coupled bodies are as many as a loose accuracy needs
            scene = scene.replace(fem={"accuracy": 1e-3})
        cases.append(
            Case(number, scene, methods, _PRESSED if unlike else _LEVELS.get(number, {}), reference, hard=problem.why)
        )
    return cases


def stress_suite(method: str, seed: int, count: int, only: Sequence[str] = ()) -> Makers:
    """Return functions that make random cases, by name of the case.

    Parameters
    ----------
    method : str
        Method of all cases.
    seed, count : int
        Seed, and number of scenes: the first ``count`` that ``method`` solves.
    only : sequence of str
        Numbers of scenes in place of ``count``.

    Raises
    ------
    InputError
        If an item of ``only`` is not a number.
    """
    for number in only:
        if not number.isdecimal() or len(number) > 18:
            raise InputError(f"--only {number!r}: must be the number of a random scene, at most 18 digits")
    numbers = [int(number) for number in only] or itertools.islice(stress_numbers(method), count)
    return {f"stress-{seed}-{number}": partial(stress_case, method, seed, number) for number in numbers}


def _same(case: Case) -> Case:
    return case


def stress_numbers(method: str) -> Iterator[int]:
    """Yield the numbers of random scenes that ``method`` solves; exact does not solve loads out of phase."""
    return (number for number in itertools.count() if method != "exact" or kind_of(number) != "out of phase")


def stress_case(method: str, seed: int, number: int) -> Case:
    """Return the case of random scene ``seed``, ``number`` by ``method``.

    Under constant pressure certificates are judged. Under varying pressure march takes the place of exact where there
    is no closed form; march and fem are compared with the reference.
    """
    if not varies(seed, number):
        kind, scene = draw(seed, number)
        return Case(scene.name, scene, (method,), reference="", hard=kind)
    kind, scene = draw_varying(seed, number)
    best = reference(scene)
    if method == "exact" and best.method != "exact" and not best.unknown:
        method = "march"
    elif kind_of(number) != "lost digits" and method != "exact":  # whose stick zone may be narrower than any cell
        return Case(scene.name, scene, (method,), reference="" if best.method == method else best.method, hard=kind)
    return Case(scene.name, scene, (method,), reference="", hard=kind)
