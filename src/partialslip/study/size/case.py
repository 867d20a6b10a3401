"""One case of a study of sizes: finite elements, half-planes, and half-planes that act like the bodies."""

from typing import TYPE_CHECKING

from partialslip.report.record import Record, record
from partialslip.result import Result
from partialslip.run import compared, run
from partialslip.scene import Scene
from partialslip.study.batch.job import Job, Solved
from partialslip.study.fatigue import hot_spots
from partialslip.tools.errors import InputError

if TYPE_CHECKING:
    from partialslip_fem import Kept

FEM, HALF_PLANE, EQUIVALENT = "fem", "half-plane", "equivalent"


def half_plane_method(scene: Scene) -> str:
    """Return the method that solves the half-planes of ``scene``: exact, or march where exact has no solution: for
    dissimilar materials, and loads out of phase."""
    return "exact" if scene.material.alike and scene.load.in_phase else "march"


def compared_methods(scene: Scene) -> tuple[str, str, str]:
    """Return the methods that a case of ``scene`` compares."""
    return half_plane_method(scene), "equivalent", "fem"


class Sized(Solved, frozen=True, kw_only=True):
    """Outcome of a case: ``run`` compares the finite elements with half-planes; ``stresses`` are hot spots by
    :data:`FEM`, :data:`HALF_PLANE` and :data:`EQUIVALENT`.

    Parameters
    ----------
    equivalent : Record or None
        Comparison of equivalent half-planes with the finite elements, without curves; None if there are none.
    refused : str
        Why there are no equivalent half-planes, in one line; empty for a scene without finite bodies.
    """

    equivalent: Record | None = None
    refused: str = ""


def solve_sized(job: Job, keep: "Kept | None" = None) -> Sized:
    """Solve ``job`` as half-planes (:func:`half_plane_method`) and by finite elements, and by equivalent half-planes
    where these exist; ``keep`` as in :func:`partialslip.run`."""
    scene, method = job.scene, half_plane_method(job.scene)
    try:
        whole = run(scene, (method, "fem"), subsurface=job.stresses, keep=keep)
        found = {FEM: whole["fem"], HALF_PLANE: _with_stresses(scene, whole[method])} if job.stresses else {}
        spots = {name: hot_spots(scene, result) for name, result in found.items()}
    except InputError as error:
        return Sized(labels=job.labels, error=str(error))
    plain = record(whole, curves=False)
    if not scene.finite:
        return Sized(labels=job.labels, run=plain, stresses=spots)
    try:
        alike = run(scene, "equivalent", subsurface=job.stresses)
        spots |= {EQUIVALENT: hot_spots(scene, alike["equivalent"])} if job.stresses else {}
    except InputError as error:
        return Sized(labels=job.labels, run=plain, stresses=spots, refused=str(error))
    against = compared(scene, whole.plan, {"fem": whole["fem"], **alike.results}, None)
    return Sized(labels=job.labels, run=plain, stresses=spots, equivalent=record(against, curves=False))


def _with_stresses(scene: Scene, found: Result) -> Result:
    """Return the half-planes of ``scene`` with stresses: by march where the exact method has ``found`` none. Of
    dissimilar materials no method knows them."""
    if found.method == "march" or scene.slides or (found.stress_at and not found.path_dependent):
        return found
    return run(scene, "march", subsurface=True)["march"]
