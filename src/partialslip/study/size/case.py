"""One case of a study of sizes: finite elements, half-planes, and half-planes that act like the bodies; of two equal
strips their exact solution, too."""

from dataclasses import replace
from typing import TYPE_CHECKING

from msgspec import structs

from partialslip.report.record import Record, record
from partialslip.result import Result
from partialslip.run import Run, run
from partialslip.run.judge import compare
from partialslip.run.judge.reference import reference
from partialslip.scene import Scene
from partialslip.study.batch.job import Job, Solved
from partialslip.study.fatigue import hot_spots
from partialslip.tools.errors import InputError

if TYPE_CHECKING:
    from partialslip_fem import Kept

FEM, HALF_PLANE, EQUIVALENT, STRIPS = "fem", "half-plane", "equivalent", "strips"


def half_plane_method(scene: Scene) -> str:
    """Return the method that solves the half-planes of ``scene``: exact, or march where exact has no solution: for
    dissimilar materials, and loads out of phase."""
    return "exact" if scene.material.alike and scene.load.in_phase else "march"


def compared_methods(scene: Scene) -> tuple[str, str, str]:
    """Return the methods that a case of ``scene`` compares."""
    return half_plane_method(scene), "equivalent", "fem"


class Sized(Solved, frozen=True, kw_only=True):
    """Outcome of a case: ``run`` compares the finite elements with half-planes; ``stresses`` are hot spots by
    :data:`FEM`, :data:`HALF_PLANE`, :data:`EQUIVALENT` and :data:`STRIPS`.

    Parameters
    ----------
    equivalent : Record or None
        Comparison of equivalent half-planes with the finite elements, without curves; None if there are none.
    refused : str
        Why there are no equivalent half-planes, in one line; empty for a scene without finite bodies.
    strips : Record or None
        Comparison of the finite elements with the exact solution of two equal strips, by march where exact has none;
        without curves; None for other bodies.
    """

    equivalent: Record | None = None
    refused: str = ""
    strips: Record | None = None


def solve_sized(job: Job, keep: "Kept | None" = None) -> Sized:
    """Solve ``job`` as half-planes (:func:`half_plane_method`) and by finite elements, and by equivalent half-planes
    where these exist; two equal strips exactly. ``keep`` as in :func:`partialslip.run`."""
    scene, stresses = job.scene, job.stresses
    exact = {HALF_PLANE: (scene.half_planes if scene.strips else scene, half_plane_method(scene))}
    exact |= {STRIPS: (scene, reference(scene).method)} if scene.strips else {}
    try:
        solved = run(scene, "fem", subsurface=stresses, keep=keep)
        found = {name: run(of, method, subsurface=stresses)[method] for name, (of, method) in exact.items()}
        spots = {}
        if stresses:
            stressed = {name: _with_stresses(exact[name][0], each) for name, each in found.items()}
            spots = {name: hot_spots(scene, each) for name, each in ({FEM: solved["fem"]} | stressed).items()}
    except InputError as error:
        return Sized(labels=job.labels, error=str(error))
    plain, strips = (
        _against(solved, each.method, each, "fem", solved["fem"]) if each else None
        for each in (found[HALF_PLANE], found.get(STRIPS))
    )
    own = Sized(labels=job.labels, run=plain, stresses=spots, strips=strips)
    if not scene.finite:
        return own
    try:
        alike = run(scene, "equivalent", subsurface=stresses)["equivalent"]
        spots |= {EQUIVALENT: hot_spots(scene, alike)} if stresses else {}
    except InputError as error:
        return structs.replace(own, refused=str(error))
    return structs.replace(own, equivalent=_against(solved, "fem", solved["fem"], "equivalent", alike))


def _against(solved: Run, name: str, true: Result, other: str, result: Result) -> Record:
    """The ``result`` of the method ``other`` compared with the ``true`` one of the method ``name``, both of the scene
    that was ``solved``; without curves."""
    comparisons = {other: compare(result, true, solved.scene, None)}
    return record(replace(solved, results={name: true, other: result}, comparisons=comparisons), curves=False)


def _with_stresses(scene: Scene, found: Result) -> Result:
    """Return the half-planes of ``scene`` with stresses: by march where the exact method has ``found`` none. Of
    dissimilar materials no method knows them."""
    if found.method == "march" or scene.slides or (found.stress_at and not found.path_dependent):
        return found
    return run(scene, "march", subsurface=True)["march"]
