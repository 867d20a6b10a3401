"""Choice of the reference method, with which the other methods are compared."""

from collections.abc import Mapping

from partialslip.result import Result
from partialslip.scene import Scene

REFERENCES = ("exact", "march", "fem")  # by preference
METHODS = (*REFERENCES, "equivalent")
ALL_EFFECTS = "all effects"  # name of the result in which no effect is forced off


def reference_for(scene: Scene) -> str:
    """Return the most accurate method for ``scene``.

    Similar half-planes: exact under loads in phase, march under other loads. Finite bodies and unlike materials: fem.
    """
    if scene.finite or not scene.material.alike:
        return "fem"
    return "exact" if scene.load.in_phase else "march"


def reference_of(results: Mapping[str, Result]) -> str | None:
    """Return the name of the reference among ``results``; None without results.

    The reference is the result with all effects, else the first of exact, march, fem and equivalent. March precedes
    exact if slip reverses between the load points.
    """
    known = [name for name in (ALL_EFFECTS, *METHODS) if name in results]
    if known[:1] == ["exact"] and results["exact"].path_dependent and "march" in known:
        return "march"
    return next(iter(known), None)
