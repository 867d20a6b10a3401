"""Data of the map over dP and dQ, for scenes in which P varies (docs/theory.md, section 11).

The larger P is the scene's; the smaller P varies. Q and sigma are those of the scene, times one factor. Lengths are
fractions of a, the half-width of the contact under the larger P. The map shows positive dQ and dsigma; other signs
follow by symmetry.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from partialslip.halfplane.contact import Contact, contact
from partialslip.halfplane.mean_pressure import Mean
from partialslip.halfplane.steady import stick_zones
from partialslip.halfplane.varying import closed_form
from partialslip.run import run
from partialslip.run.judge.reference import reference
from partialslip.scene import Pressing, Scene
from partialslip.study.map.grid import Point, require_stick_zones
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

_COUNT = 50  # display: steps along either axis
_COUNT_KINKED = 15  # display: the same for a pressure with corners, which is slower
_PURPOSE = "for a map over dP and dQ"
_ROUNDING = 1e-9  # accuracy: lengths in a


@dataclass(frozen=True)
class VaryingMap:
    """The map over dP and dQ.

    Parameters
    ----------
    scene, pressed : Scene and Contact
        The scene and its contact under the larger P.
    P_change, Q_change : (rows, columns) arrays
        \\|dP\\|/P and \\|dQ\\|/(f P), P being the larger one. Each row has one dQ/(f (P1 + P2)), each column one dP.
    smaller : (rows, columns) array
        Half-width of the contact under the smaller P.
    m, n : (rows, columns) arrays
        Ends of the stick zone if both ends of the contact slip; elsewhere, see ``regime``, they have no meaning.
    regime : (rows, columns) array of str
        "small tension" or "large tension": both ends slip. "no slip": no end slips. "part of the cycle": an end slips
        at most during part of the cycle, and there is no closed form. "sliding".
    point : Point or None
        Place of the scene; None if the contact slides.
    """

    scene: Scene
    pressed: Contact
    P_change: Array
    Q_change: Array
    smaller: Array
    m: Array
    n: Array
    regime: npt.NDArray[np.str_]
    point: Point | None

    @property
    def ratio(self) -> float:
        """\\|dsigma\\| a/\\|dQ\\|, the same all over the map."""
        return _ratio(self.scene, self.pressed)

    @property
    def both(self) -> npt.NDArray[np.bool_]:
        """Where both ends slip, (rows, columns)."""
        return np.char.endswith(self.regime, "tension")

    @property
    def beyond(self) -> Array:
        """By how much the stick zone of the closed form extends beyond the smaller contact, (rows, columns): both ends
        slip where this is not positive."""
        return np.maximum(self.m, self.n) - self.smaller

    def sticks(self, dP: Array | float) -> Array:
        """Largest dQ/(f P) at which no end slips, at ``dP``, \\|dP\\|/P, of any shape."""
        return _sticks(self.ratio, np.asarray(dP, float))

    def slides(self, dP: Array | float) -> Array:
        """Least dQ/(f P) at which the contact slides at a load point, at ``dP``, \\|dP\\|/P, of any shape."""
        return _slides(self.scene, np.asarray(dP, float))


def varying_map(scene: Scene, progress: Callable[[str], None] = lambda _: None) -> VaryingMap:
    """Compute the map over dP and dQ: how the ends of the contact slip, and the stick zone where both do.

    Parameters
    ----------
    scene : Scene
        Scene in which P varies, under loads in phase. The map keeps its larger P and its ratios of Q and sigma at both
        load points to dQ.
    progress : callable
        ``progress(line)``: called from time to time with a line of text.

    Raises
    ------
    InputError
        If the bodies differ, there is no friction, the pressure is not even, P or Q is constant, or the loads are not
        in phase; and as :func:`partialslip.halfplane.contact`.
    """
    require_stick_zones(scene)
    scene.require_even(_PURPOSE)
    load = scene.load
    if not scene.presses_anew:
        raise InputError(f"load.P: must vary {_PURPOSE}")
    if not load.in_phase:
        raise InputError(f"load.Q, load.sigma, load.P: must be in phase {_PURPOSE}")
    if load.dQ == 0:
        raise InputError(f"load.Q = {load.shown('Q', scene.units)}: must vary {_PURPOSE}")
    pressed = contact(scene.half_planes)
    count = _COUNT_KINKED if pressed.shape.kinks else _COUNT
    shares = np.linspace(0, 1, count, endpoint=False)  # of dQ = f (P1 + P2), and of dP = P
    ratio, columns = _ratio(scene, pressed), []
    for dP in shares.tolist():
        progress(f"map {dP:.0%}")
        less = contact(scene.half_planes, Pressing((1 - dP) * scene.P, scene.M))
        zone = stick_zones(shares, math.pi * ratio * shares, Mean(pressed, less))
        columns.append((zone.m, zone.n, zone.s, np.full(count, less.a / pressed.a)))
    m, n, s, smaller = np.stack(columns, axis=-1)
    dP, share = np.meshgrid(shares, shares)
    dQ = (2 - dP) * share
    regime = np.where(s > 0, "small tension", "large tension").astype("<U17")
    regime[np.maximum(m, n) > smaller + _ROUNDING] = "part of the cycle"
    regime[dQ <= _sticks(ratio, dP)] = "no slip"
    regime[dQ >= _slides(scene, dP)] = "sliding"
    return VaryingMap(scene, pressed, dP, dQ, smaller, m, n, regime, _varying_map_point(scene))


def _ratio(scene: Scene, pressed: Contact) -> float:
    return abs(scene.load.dsigma / scene.load.dQ) * pressed.a


def _sticks(ratio: float, dP: Array) -> Array:
    """|dQ +- (pi/4) a dsigma| <= f |dP|, for the sign and the contact that make the left side largest."""
    return dP / (1 + math.pi / 4 * ratio)


def _slides(scene: Scene, dP: Array) -> Array:
    """|Q| >= f P at a load point."""
    ends = scene.load.ends[:: 1 if scene.largest == 1 else -1]
    larger, smaller = (abs(scene.load.points[end][0] / scene.load.dQ) for end in ends)
    with np.errstate(divide="ignore"):
        result: Array = np.minimum(np.divide(1.0, larger), np.divide(1 - dP, smaller))
    return result


def _varying_map_point(scene: Scene) -> Point | None:
    if scene.slides:
        return None
    load, (one, other) = scene.load, (P for P, _ in scene.end_pressing)
    missing = (
        f"{why}; must be solved by march" if (why := closed_form(scene)) else reference(scene).unknown.get("m", "")
    )
    exact = None if missing else run(scene, ["exact"]).results["exact"]
    dP, dQ = abs(other - one) / scene.P, abs(load.dQ) / (scene.friction.f * scene.P)
    return Point((dP, dQ), load.dQ * load.dsigma < 0, exact, missing)
