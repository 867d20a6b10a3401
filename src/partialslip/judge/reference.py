"""Which method the others are compared with: decided here and nowhere else."""

from collections.abc import Mapping

from partialslip.result import Result
from partialslip.scene import Scene

METHODS = ("exact", "march", "fem")  # in the order in which they are the reference
ALL_EFFECTS = "all effects"  # the name of a result with effects that were forced off turned on


def reference_for(scene: Scene) -> str:
    """The method that knows most of ``scene``: the exact one of similar half-planes under loads in phase, march of
    similar half-planes under other loads, and finite elements of finite bodies and of unlike materials."""
    if scene.finite or not scene.material.alike:
        return "fem"
    return "exact" if scene.load.in_phase else "march"


def reference_of(results: Mapping[str, Result]) -> str | None:
    """The method among ``results`` that the others are compared with: the first of exact, march and fem, or the result
    with all effects. Where slip reverses between the load points, march comes before exact. None if there are no
    results."""
    known = [name for name in (ALL_EFFECTS, *METHODS) if name in results]
    if known[:1] == ["exact"] and results["exact"].path_dependent and "march" in known:
        return "march"
    return next(iter(known), None)
