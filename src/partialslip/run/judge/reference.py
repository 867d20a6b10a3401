"""The reference of a scene: chosen here and nowhere else, for run, score, verify, fatigue, map and the book."""

from collections.abc import Mapping
from typing import NamedTuple

from partialslip.result import Result
from partialslip.result.record import ResultRecord
from partialslip.run.judge.known import estimated
from partialslip.run.methods import METHODS
from partialslip.scene import Scene
from partialslip.scene.gradual import may_turn_round
from partialslip.scene.plan import reduced

ALL_EFFECTS = "all effects"  # name of the result in which no effect is forced off

_REVERSES = "path-dependent: slip reverses between the load points; no solution is known to hold"


class Reference(NamedTuple):
    """The reference of a scene: the ``method`` with which others are compared, and by quantity why no value of any
    method is known to hold (``unknown``); the errors of these quantities are shown, but not judged."""

    method: str
    unknown: Mapping[str, str] = {}


def reference(scene: Scene) -> Reference:
    """Return the reference of ``scene``: never a solution that is known not to hold.

    Similar half-planes: exact where the steady state is known exactly, march elsewhere. Where slip reverses between the
    load points the closed form, which goes there in one step, does not hold; exact then follows gradual loads. Where it
    cannot, or where the pressure varies, neither exact nor march is a reference for m, n and the shear. Finite bodies
    and unlike materials: fem.
    """
    if scene.finite or not scene.material.alike:
        return Reference("fem")
    own = reduced(scene)
    if not own.load.in_phase:
        return Reference("march")
    if not may_turn_round(own):
        return Reference("exact")
    from partialslip.halfplane.method import has_closed_form, path_dependent

    if not has_closed_form(own):
        return Reference("march")
    if path_dependent(own):
        return Reference("march", dict.fromkeys(("m", "n", "q", "q1", "q2"), _REVERSES))
    return Reference("exact")


def reference_among(scene: Scene, results: Mapping[str, Result] | Mapping[str, ResultRecord]) -> str | None:
    """Return the name of the reference among the ``results`` of ``scene`` by method; None without results.

    The reference is the result with all effects, else that of :func:`reference`, else the first of exact, march, fem
    and equivalent; of these a result that tells its errors goes before one that does not. For finite and for unlike
    bodies, where nothing is judged, it is the first: the errors are what half-planes leave out.
    """
    if ALL_EFFECTS in results:
        return ALL_EFFECTS
    # what is known exactly of the scene, which may take seconds, decides nothing where there is one result
    judged = len(results) > 1 and not scene.finite and scene.material.alike
    first = (reference(scene).method,) if judged else ()
    names = [name for name in (*first, *METHODS) if name in results]
    return next((name for name in names if not judged or estimated(results[name], name)), next(iter(names), None))
