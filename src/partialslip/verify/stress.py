"""Random scenes by one method: each must finish with finite values and small residuals. Under varying pressure march
and fem are also compared with exact, and fem with march where exact is not the reference."""

import itertools
from collections.abc import Iterator

from partialslip.judge.reference import reference
from partialslip.verify.case import Case
from partialslip.verify.random_scenes import draw, kind_of
from partialslip.verify.random_varying import draw_varying, varies


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
