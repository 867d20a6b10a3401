"""What is known of the state in which a path begins, and of the state in which it ends.

What q is off by when a path begins stays where nothing slips, and goes where points slip: under Coulomb friction at
given pressure two solutions under the same loads never move apart, in the norm of the elastic energy. The error at the
beginning is therefore added in full to that of the path.
"""

from collections.abc import Callable, Mapping

import numpy as np

from partialslip.arrays import Array
from partialslip.bars import LEAST_SHEAR
from partialslip.condensed.history import History
from partialslip.condensed.step_errors import Errors
from partialslip.result.state import State

_ANOTHER = 0.05  # relative L2 difference of pressures of two contacts; coupling and the transfer make less of one
_UNKNOWN = "the error of the state at the beginning is not known: the estimates of q1 and q2 leave it out"


def begun(
    errors: Mapping[str, float],
    history: History | None,
    weights: Array,
    f: float,
    start: State | None,
    forces: Callable[[State], Array],
) -> tuple[Errors, tuple[str, ...]]:
    """Errors of q1 and q2 (relative L2) due to that of the state ``start``, and notes on what they leave out.

    Parameters
    ----------
    errors : mapping of str to float
        Estimated errors of the path itself; without any there are no others.
    history : History or None
    weights : (n,) array
        Factors that turn tractions at the nodes of the history into forces.
    f : float
        Coefficient of friction.
    start : State or None
    forces : callable
        ``forces(state) -> (n,)``: normal forces of a state on the nodes of the history.
    """
    if not (start and history):
        return {}, ()
    here, pressed = history.end[1] / f, _norm(history.bound, weights) / f
    notes: tuple[str, ...] = ()
    if (other := _norm(forces(start) - here, weights) / _norm(here, weights)) > _ANOTHER:
        notes = (f"p of the state at the beginning is off by {other:.0%}: it seems to be the state of another contact",)
    if start.q_error is None:
        return {}, (*notes, _UNKNOWN) if errors else notes
    if not errors:
        return {}, notes
    shares = {key: start.q_error * pressed / norm for key, norm in _norms(history, weights).items() if norm > 0}
    return shares, notes


def known_to(errors: Mapping[str, float], history: History, weights: Array, f: float) -> float | None:
    """Error of q at the end of the path, its L2 norm relative to that of p, from all ``errors`` of q1 and q2; None if
    these are not known. Arguments as for :func:`begun`."""
    pressed = _norm(history.bound, weights) / f
    found = [errors[key] * norm / pressed for key, norm in _norms(history, weights).items() if key in errors]
    return max(found, default=None)


def _norms(history: History, weights: Array) -> Errors:
    """L2 norms of q1 and q2, as errors are relative to them."""
    least = LEAST_SHEAR * _norm(history.bound, weights)
    return {key: max(_norm(getattr(history, key), weights), least) for key in ("q1", "q2")}


def _norm(forces: Array, weights: Array) -> float:
    return float(np.linalg.norm(forces / np.sqrt(weights)))
