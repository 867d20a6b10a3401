"""What is known of the state in which a path begins, and of the state in which it ends.

What q is off by when a path begins stays where nothing slips, and goes where points slip: under Coulomb friction at
given pressure two solutions under the same loads never move apart, in the norm of the elastic energy. The error at the
beginning is therefore added in full to that of the path.

q2 - q1 of a steady cycle, and with it the stick zone, does not depend on where the path began. While q still changes
from cycle to cycle, about as large a part of the error gets into q2 - q1 as q changes by, in f p0
(measured: restarts against the whole path). The ends follow as their bars follow that of q.
"""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from partialslip.friction.history import History, last_cycle_change
from partialslip.friction.step_errors import Errors
from partialslip.result.state import State
from partialslip.scene import Scene
from partialslip.tools.arrays import Array
from partialslip.tools.bars import BARS, LEAST_SHEAR

if TYPE_CHECKING:
    from scipy.interpolate import PPoly

# limit: relative L2 difference of pressures of two contacts; shear of dissimilar bodies changes p by a tenth
_ANOTHER = 0.25
_UNKNOWN = "the error of the state at the beginning is not known: the estimates leave it out"


def begun(
    errors: Mapping[str, float],
    history: History | None,
    weights: Array,
    start: State | None,
    forces: Callable[[State], Array],
) -> tuple[Errors, tuple[str, ...]]:
    """Errors of q1, q2 and q (relative L2), m and n (in a) due to that of the state ``start``, and notes on what they
    leave out.

    Parameters
    ----------
    errors : mapping of str to float
        Estimated errors of the path itself; without any there are no others.
    history : History or None
    weights : (n,) array
        Factors that turn tractions at the nodes of the history into forces.
    start : State or None
    forces : callable
        ``forces(state) -> (n,)``: normal forces of a state on the nodes of the history.
    """
    if not (start and history):
        return {}, ()
    here, pressed = history.end[1], _mean_pressure_norm(history, weights)
    notes: tuple[str, ...] = ()
    if (other := _norm(forces(start) - here, weights) / _norm(here, weights)) > _ANOTHER:
        notes = (f"p of the state at the beginning is off by {other:.0%}: it seems to be the state of another contact",)
    if start.q_error is None:
        return {}, (*notes, _UNKNOWN) if errors else notes
    if not errors:
        return {}, notes
    norms = _norms(history, weights)
    shares = {key: start.q_error * pressed / norm for key, norm in norms.items() if norm > 0}
    if "q" in shares:
        largest = float((history.bound / weights).max())  # f p0
        shares["q"] *= min((last_cycle_change(history, weights, 1.0, largest) or 0.0), 1.0)
        shares |= dict.fromkeys("mn", shares["q"] / BARS["q"])
    return {key: share for key, share in shares.items() if key in errors}, notes


def end_state(
    scene: Scene, p: "PPoly", q: "PPoly", errors: Mapping[str, float], history: History, weights: Array
) -> State:
    """State at the end of the path of the loads of ``scene``, with the tractions ``p`` and ``q``, Pa over m.

    Its error of q is that of all ``errors`` of q1 and q2; None if these are not known. The other arguments are as for
    :func:`begun`.
    """
    pressed = _mean_pressure_norm(history, weights)
    norms = _norms(history, weights)
    error = max((errors[key] * norms[key] / pressed for key in ("q1", "q2") if key in errors), default=None)
    Q, sigma, slope = scene.load.along[-1]
    return State(scene.pressing[-1].P, scene.material.A, Q, sigma, p, q, slope, error)


def _mean_pressure_norm(history: History, weights: Array) -> float:
    """L2 norm of the mean of p at load points 1 and 2."""
    first, second = history.pressures
    return _norm((first + second) / 2, weights)


def _norms(history: History, weights: Array) -> Errors:
    """L2 norms of q1, q2 and q, as errors are relative to them."""
    least = LEAST_SHEAR * _norm(history.bound, weights)
    forces = {"q1": history.q1, "q2": history.q2, "q": history.change / 2}
    return {key: max(_norm(each, weights), least) for key, each in forces.items()}


def _norm(forces: Array, weights: Array) -> float:
    return float(np.linalg.norm(forces / np.sqrt(weights)))
