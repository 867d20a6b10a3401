"""One case of a study of sizes: finite elements, half-planes, and half-planes that act like the bodies."""

from typing import TYPE_CHECKING

from partialslip.batch.job import Job, Solved
from partialslip.errors import InputError
from partialslip.record import Record, record
from partialslip.run import compared, run

if TYPE_CHECKING:
    from partialslip_fem import Kept

COMPARED_METHODS = ("exact", "equivalent", "fem")


class Sized(Solved, frozen=True, kw_only=True):
    """Outcome of a case: ``run`` compares the finite elements with half-planes.

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
    """Solve ``job`` by the exact method and finite elements, and by equivalent half-planes where these exist; ``keep``
    as in :func:`partialslip.run`."""
    try:
        whole = run(job.scene, ("exact", "fem"), keep=keep)
    except InputError as error:
        return Sized(labels=job.labels, error=str(error))
    plain = record(whole, curves=False)
    if not job.scene.finite:
        return Sized(labels=job.labels, run=plain)
    try:
        alike = run(job.scene, "equivalent")
    except InputError as error:
        return Sized(labels=job.labels, run=plain, refused=str(error))
    against = compared(job.scene, whole.plan, {"fem": whole["fem"], **alike.results}, None)
    return Sized(labels=job.labels, run=plain, equivalent=record(against, curves=False))
