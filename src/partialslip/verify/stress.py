"""Random scenes by one method: each must finish with finite values and small residuals."""

import itertools
from collections.abc import Iterator

from partialslip.verify.case import Case
from partialslip.verify.random_scenes import draw, kind_of


def stress_numbers(method: str) -> Iterator[int]:
    """Yield the numbers of random scenes that ``method`` solves; exact does not solve loads out of phase."""
    return (number for number in itertools.count() if method != "exact" or kind_of(number) != "out of phase")


def stress_case(method: str, seed: int, number: int) -> Case:
    """Return the case of random scene ``seed``, ``number`` by ``method``; judged by certificates only."""
    kind, scene = draw(seed, number)
    return Case(scene.name, scene, (method,), compared=False, hard=kind)
