"""Work of friction over a cycle: what load steps miss of it, and its error.

Where the pressure varies, it does so together with the slip. Steps that end with the right shear still miss a part of
int f p |ds|, and this part hardly depends on the mesh: it is found on one mesh and counts on all later ones
(:attr:`partialslip.friction.load_path.Path.missed`).
"""

from collections.abc import Mapping
from dataclasses import replace

from partialslip.friction.history import History
from partialslip.friction.load_path import Missed, Path

_ROUNDING = 1e-14  # accuracy: work in f P times a displacement of A P: of rounding, where nothing slips


def last_cycle(history: History) -> Path:
    """The last cycle of ``history``, followed event by event from the state in which it began."""
    path = history.path
    began = history.points[-1 - len(path.cycle)].x
    return replace(path, begin=path.cycle[-1], before=began, cycles=1, ways=(), half=False, followed=True)


def told_missed(history: History, steps: History, gradual: History) -> History:
    """The ``history`` with the work that its steps miss, known from loads that change gradually: the difference of
    ``gradual`` from ``steps``, both on any one mesh."""
    missed = Missed(gradual.dissipated - steps.dissipated, 0.0)
    return replace(history, path=replace(history.path, missed=missed))


def told_by_finer(history: History, finer: History) -> History:
    """The ``history`` with the work that its steps miss, known from ``finer`` ones, at least twice as many: what these
    miss is less than the difference, as errors are of first order in the steps or of a higher one."""
    missed = finer.dissipated - history.dissipated
    return replace(history, path=replace(history.path, missed=Missed(missed, abs(missed))))


def work(history: History) -> float:
    """Work of friction over the last cycle, scaled, with what the steps are known to miss."""
    return history.dissipated + (history.path.missed.work if history.path.missed else 0.0)


def work_error(history: History, other: History | None, errors: Mapping[str, float]) -> float | None:
    """Estimated error of :func:`work`, scaled; None where nothing tells what the steps miss, or how good the mesh is:
    where no node slips under a shear that changes, the slip zones are narrower than the mesh.

    The work is not known better than q, nor than two meshes agree on it.

    Parameters
    ----------
    other : History or None
        On another mesh, or on the same one with elements of another order.
    errors : mapping of str to float
        Estimated errors of the ``history`` by key; that of q is relative L2.
    """
    missed = history.path.missed if history.path.moves else Missed(0.0, 0.0)
    unseen = not history.dissipated and bool(history.change.any())
    if missed is None or other is None or unseen or "q" not in errors:
        return None
    alike = work if other.path.missed else lambda each: each.dissipated  # a mesh before may know less of its steps
    by_mesh = abs(alike(history) - alike(other))
    known = max(by_mesh, errors["q"] * (history.dissipated + abs(missed.work))) + missed.error
    return known + _ROUNDING * float(history.bound.sum())
