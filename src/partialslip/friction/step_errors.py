"""Errors of ends and tractions due to finite steps of the load path."""

import itertools
import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from partialslip.friction.contact_line import ContactLine, Ends
from partialslip.friction.history import History
from partialslip.friction.load_path import Path
from partialslip.friction.pressing import Pressed
from partialslip.tools.arrays import Array, Indices
from partialslip.tools.bars import BARS, LEAST_SHEAR

Errors = dict[str, float]

_NOTHING = 0.01  # accuracy: of what the accuracy allows: errors of steps that matter to nobody
_MOST_STEPS = 32  # limit: steps from load point to load point that an accuracy of coupled bodies leads to
_AT_ONCE = 8  # cost: most times as many steps at once: errors of few steps mostly fall faster than with the first order
_PROBED = 7  # accuracy: fewest steps from load point to load point with which those of coupled bodies are compared
_SHEARS = ("change", "q1", "q2")


def steps_matter(errors: Mapping[str, float], accuracy: float) -> bool:
    """Whether any error of the load steps is more than a hundredth of what ``accuracy`` (of a) allows."""
    return any(error > _NOTHING * BARS[key] * accuracy for key, error in errors.items())


def of_steps(
    line: ContactLine, history: History, gradual: History, half_width: float, common: Ends | None = None
) -> Errors:
    """Errors of m and n (in contact half-widths), q, q1 and q2 (relative L2) due to the load steps of ``history``: its
    differences from ``gradual``.

    Parameters
    ----------
    line : ContactLine
        Its nodes are those of both histories.
    history, gradual : History
        The history in load steps, and the more gradual one that it is compared with.
    half_width : float
        Half-width of the contact.
    common : (float, float), optional
        Ends of the part of the line in contact at both load points; default: from the nodal forces.
    """
    held, (zone, other) = np.sqrt(line.weights), (line.stick_zone(each, common) for each in (history, gradual))
    found = {"m": abs(zone.left - other.left) / half_width, "n": abs(zone.right - other.right) / half_width}
    for key in _SHEARS:
        forces = getattr(history, key)
        size = max(float(np.linalg.norm(forces / held)), _smallest_norm(history, held) * (2 if key == "change" else 1))
        if size > 0:
            off = float(np.linalg.norm((getattr(gradual, key) - forces) / held))
            found["q" if key == "change" else key] = off / size
    return found


def along_path(line: ContactLine, history: History, finer: History, largest: int) -> Errors:
    """Errors of :func:`of_steps` and, as p varies with q in coupled bodies, of a, left and right (in contact
    half-widths at the load point with the ``largest`` P) and of p (relative L2): twice the change due to ``finer``
    steps (:func:`other_steps`), as errors are of first order in the steps."""
    ends, others = (line.ends_at_points(each) for each in (history, finer))
    half_width = (ends[largest - 1][1] - ends[largest - 1][0]) / 2
    found = {key: 2 * error for key, error in of_steps(line, history, finer, half_width).items()}
    off = 2 * np.abs(np.subtract(ends, others)) / half_width
    found |= {"a": float(off[1].mean()), "left": float(off[:, 0].max()), "right": float(off[:, 1].max())}
    p, other = (each.bounds[1] / np.sqrt(line.weights) for each in (history, finer))
    found["p"] = 2 * float(np.linalg.norm(p - other) / np.linalg.norm(p))
    return found


def of_plates(history: History, finer: History) -> Array:
    """Errors of the rigid shift and of the tangential force at load points 1 and 2 (columns), (2, 2): twice the change
    due to ``finer`` steps, as in :func:`along_path`."""
    one, other = (np.array([each.shifts, [q.sum() for q in each.at_ends]]) for each in (history, finer))
    return 2 * np.abs(one - other)


def other_steps(path: Path) -> Path:
    """``path`` with halved load steps and with ends of steps at odd fractions of each load segment: halved steps alone
    can miss a stick zone that moves past both ends of a step."""
    return path.halved.with_steps(max(2 * path.substeps + 1, _PROBED))


def more_steps(path: Path, errors: Mapping[str, float], others: Mapping[str, float], accuracy: float) -> Path | None:
    """``path`` of coupled bodies with 2^k times as many load steps; None if the present steps suffice, or the limits
    allow no more.

    The ``errors`` e are of first order in the steps. The smallest k within the limits with e/2^k <= max(BARS
    accuracy/2, ``others``) is taken: ``others`` are errors that finer steps do not change.
    """
    allowed = {key: max(BARS[key] * accuracy / 2, others.get(key, 0.0)) for key in errors}
    most = _MOST_STEPS // path.substeps
    excess = max((errors[key] / each for key, each in allowed.items()), default=0.0)
    if most < 2 or excess <= 1:
        return None
    most = min(most, _AT_ONCE)
    power = min(math.ceil(math.log2(min(excess, most))), int(math.log2(most)))
    return replace(path, substeps=path.substeps * 2**power)


def summed(*errors: Mapping[str, float]) -> Errors:
    """Sums of ``errors`` by key; a missing key counts as 0."""
    return {key: sum(each.get(key, 0.0) for each in errors) for key in dict.fromkeys(itertools.chain(*errors))}


def pressed_together(history: History, pressed: Pressed, weights: Array, nodes: Indices) -> Errors:
    """Errors due to the steps in which coupled bodies are ``pressed`` together: a, left, right, m and n in half-widths,
    q1 and q2 in relative L2.

    The error of the shear locked in by pressing may persist: e_q is the L2 norm of this error over that of q1 or q2.
    The error of a after pressing also enters those of m and n (measured: m moves twice as far as a). ``weights`` turn
    tractions at all nodes of the contact line into forces; ``nodes`` are the indices of the nodes of ``history``.
    """
    off = pressed.errors["q"] * np.linalg.norm(pressed.tangential.x / np.sqrt(weights))
    held = np.sqrt(weights[nodes])
    least = _smallest_norm(history, held)
    norms = {key: max(float(np.linalg.norm(getattr(history, key) / held)), least) for key in ("q1", "q2")}
    return dict.fromkeys(("a", "left", "right", "m", "n"), pressed.errors.get("a", 0.0)) | {
        key: float(off / norm) for key, norm in norms.items() if norm > 0
    }


def _smallest_norm(history: History, held: Array) -> float:
    """Smallest L2 norm of shear that relative errors refer to: ``LEAST_SHEAR`` times the norm of f p; ``held`` (n,) are
    the square roots of the nodal weights."""
    return LEAST_SHEAR * float(np.linalg.norm(history.bound / held))
