"""Random scenes by one method: each must come to an end, with finite values and a certificate."""

import itertools
from collections.abc import Iterator

from partialslip.verify.case import Case
from partialslip.verify.random_scenes import draw, kind_of


def stress_numbers(method: str) -> Iterator[int]:
    """Numbers of the random scenes that ``method`` is for: the exact one is not for loads out of phase."""
    return (number for number in itertools.count() if method != "exact" or kind_of(number) != "out of phase")


def stress_case(method: str, seed: int, number: int) -> Case:
    """The random scene of that seed and number. A result certifies itself: there is nothing to compare with."""
    kind, scene = draw(seed, number)
    return Case(scene.name, scene, (method,), compared=False, hard=kind)
