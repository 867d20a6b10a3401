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
    """Errors of m and n (in contact half-widths), q, q1 and q2 (relative L2) of a history in steps.

    Parameters
    ----------
    line : ContactLine
        With the nodes of both histories.
    history, gradual : History
        With the steps taken, and without any.
    half_width : float
        Half-width of the contact.
    common : (float, float), optional
        Ends of what is in contact at both load points; by default as the forces tell.
    """
    held, (zone, other) = np.sqrt(line.weights), (line.stick_zone(each, common) for each in (history, gradual))
    found = {"m": abs(zone.left - other.left) / half_width, "n": abs(zone.right - other.right) / half_width}
    for key in _SHEARS:
        forces = getattr(history, key)
        size = max(float(np.linalg.norm(forces / held)), _least(history, held) * (2 if key == "change" else 1))
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
    """The ``path`` in half as large steps, and others that end at odd fractions of each way: where a stick zone moves
    past both ends of a step, halves alone may see nothing of it."""
    return path.halved.with_steps(max(2 * path.substeps + 1, _PROBED))


def more_steps(path: Path, errors: Mapping[str, float], others: Mapping[str, float], accuracy: float) -> Path | None:
    """The ``path`` of coupled bodies in as many steps as make their ``errors``, of first order in the steps, no more
    than half of what the ``accuracy`` (of a) allows, or than the ``others``; a power of 2 times as many, as far as
    the limits let them. None if there are enough, or would be too many."""
    allowed = {key: max(BARS[key] * accuracy / 2, others.get(key, 0.0)) for key in errors}
    most = _MOST_STEPS // path.substeps
    excess = max((errors[key] / each for key, each in allowed.items()), default=0.0)
    if most < 2 or excess <= 1:
        return None
    most = min(most, _AT_ONCE)
    power = min(math.ceil(math.log2(min(excess, most))), int(math.log2(most)))
    return replace(path, substeps=path.substeps * 2**power)


def summed(*errors: Mapping[str, float]) -> Errors:
    """Sums of ``errors`` by key."""
    return {key: sum(each.get(key, 0.0) for each in errors) for key in dict.fromkeys(itertools.chain(*errors))}


def pressed_together(history: History, pressed: Pressed, weights: Array, nodes: Indices) -> Errors:
    """Errors of a, left, right, m and n (in half-widths), q1 and q2 (relative L2) of coupled bodies ``pressed``
    together in steps: an error of q at the end of pressing may persist. The stick zone ends where friction lets it,
    and so as badly known as the contact (measured: m moves twice as far as a). ``weights`` turn tractions at all nodes
    of the contact line into forces; ``nodes`` are the indices of the nodes of ``history``."""
    off = pressed.errors["q"] * np.linalg.norm(pressed.tangential.x / np.sqrt(weights))
    held = np.sqrt(weights[nodes])
    least = _least(history, held)
    norms = {key: max(float(np.linalg.norm(getattr(history, key) / held)), least) for key in ("q1", "q2")}
    return dict.fromkeys(("a", "left", "right", "m", "n"), pressed.errors.get("a", 0.0)) | {
        key: float(off / norm) for key, norm in norms.items() if norm > 0
    }


def _least(history: History, held: Array) -> float:
    return LEAST_SHEAR * float(np.linalg.norm(history.bound / held))
