"""q1 and q2 of the steady state where the first loading determines them (Mindlin and Deresiewicz, 1953).

A steady cycle fixes only the change q2 - q1. If the first loading to one load point slips wherever the cycle slips, the
shear traction at this load point is that of the first loading, and the state is steady from the first cycle on.
"""

from dataclasses import dataclass

import numpy as np

from partialslip.halfplane.change import Change
from partialslip.halfplane.contact import Contact
from partialslip.halfplane.gradual_path.stage import LostError
from partialslip.halfplane.loading import Loading
from partialslip.halfplane.proportional import loading
from partialslip.halfplane.shape import places_between
from partialslip.halfplane.turning import Turned, Turning
from partialslip.result import PATH_DEPENDENT
from partialslip.scene import Load
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

# why there are no q1 and q2
FRICTIONLESS, SLIDES, RATCHETS = "there is no friction", "the contact slides", "the contact ratchets"
STARTED = "the path goes on from a state, which the closed form cannot follow"
PRESSED = (
    "bodies that are not held alike lock shear in when they are pressed, which is not followed; use width = 'infinite'"
)
_ROUNDING = 1e-9  # accuracy: tolerance: lengths in a, tractions in f p0, slip in A f p0 a
_PLACES = np.cos(np.linspace(np.pi, 0, 81))[1:-1]
_SHARES = np.linspace(0, 1, 9)[1:-1]
_Point = tuple[float, float, float]


@dataclass(frozen=True)
class Levels:
    """Shear tractions at the load points of the contact ``pressed``, scaled as in :class:`Loading`.

    At the load point with the index ``known`` (0 or 1) the traction is that of the ``first`` loading. At the other it
    differs by the change over half a ``cycle``.
    """

    pressed: Contact
    f: float
    first: Loading | Turned
    cycle: Change
    known: int

    @property
    def breaks(self) -> list[float]:
        """Places at which the first loading is not smooth, m."""
        return self.pressed.places(self.first.breaks).tolist()

    def q(self, x: Array) -> tuple[Array, Array]:
        """q1 and q2 at ``x`` (m), Pa."""
        unit = self.f * self.pressed.p0
        q1, q2 = self.at(self.pressed.scaled(x))
        return unit * q1, unit * q2

    def at(self, x: Array) -> tuple[Array, Array]:
        """q1 and q2 at ``x``, in f p0, within the friction bound.

        Where the cycle slips, the bound alone determines them. The first loading leads to other tractions only in slip
        zones of the cycle that are narrower than the tolerance: there it may slip the other way.
        """
        q1, q2 = self.unbounded(x)
        mean, change = (q1 + q2) / 2, (q2 - q1) / 2
        room = np.maximum(self.cycle.shape.pressure(x) - np.abs(change), 0.0)
        mean = np.clip(mean, -room, room)
        return mean - change, mean + change

    def unbounded(self, x: Array) -> tuple[Array, Array]:
        """q1 and q2 at ``x``, in f p0, from the first loading and the change alone."""
        q, dq = self.first.traction(x), self.cycle.traction(x)
        return (q - dq, q) if self.known else (q, q + dq)


def levels(pressed: Contact, f: float, load: Load, cycle: Change) -> Levels | str:
    """q1 and q2 of the steady state, or the reason why no closed form gives them.

    The path goes from zero load to the last load point and then through all load points. Let Z be the stick zone of the
    ``cycle``, the change from load point 1 to 2, and Z_k the stick zone of a first loading straight to load point k.
    Then q_k is the traction of this first loading if

    - Z_k lies in Z, both loadings slip the same way outside Z, and q_k less the change stays within the friction bound
      throughout: the cycle then returns to q_k;
    - load points visited before k caused slip only outside Z_k, and less than the first loading to k: the loading to k
      then makes up the difference;
    - slip does not reverse between load points. Where it does, the loads are followed from zero.

    Fully reversed loads satisfy all conditions if each half cycle is one step.
    """
    if pressed.layer and pressed.layer.drags:
        return PRESSED
    points = [load.along[end] for end in load.ends]
    if isinstance(cycle, Turning):
        return _where_slip_turns(pressed, f, load, cycle)
    assert isinstance(cycle, Loading)
    if load.fully_reversed:
        return Levels(pressed, f, loading(pressed, f, *points[1], bound=1), cycle, 1)
    reason = ""
    for known in sorted((0, 1), key=lambda end: -abs(points[end][0])):
        found = _levels(pressed, f, load, cycle, points, known)
        if isinstance(found, Levels):
            return found
        reason = reason or found
    return reason


def _where_slip_turns(pressed: Contact, f: float, load: Load, cycle: Turning) -> Levels | str:
    """q1 and q2 under slip reversal: known if every point slips in the steady cycle, or if the loads can be followed
    from zero."""
    if not cycle.permanent:
        return Levels(pressed, f, cycle.reached, cycle, 1)
    lost = f"{PATH_DEPENDENT}on the way, and the first loading decides what is locked in; use march"
    if cycle.way.parted or len(load.points) > 2:
        return lost
    Q, sigma = load.points[-1]
    unit = f * pressed.p0
    try:
        first = cycle.from_zero(Q / (unit * pressed.a), sigma / unit, load.cycles)
        return Levels(pressed, f, first, cycle, 1)
    except LostError:
        return lost


def _levels(pressed: Contact, f: float, load: Load, cycle: Loading, points: list[_Point], known: int) -> Levels | str:
    target = points[known]
    try:
        first = loading(pressed, f, *target, bound=1)
    except InputError:
        return "mean loads act, and after the first loading more than one zone sticks; use march"
    left, right = first.ends
    within = cycle.ends[0] - _ROUNDING <= left and right <= cycle.ends[1] + _ROUNDING
    way = tuple((2 * known - 1) * sign for sign in cycle.signs)
    gaps = cycle.ends[0] + 1, 1 - cycle.ends[1]
    if not within or any(
        one != other and gap > _ROUNDING for one, other, gap in zip(first.signs, way, gaps, strict=True)
    ):
        return "mean loads act, and the cycle slips where the first loading sticks; use march"
    before = _before(load, points, known)
    if first.left_end_turns() if not before else cycle.left_end_turns(first.zone.half_width):
        return f"{PATH_DEPENDENT}during the first loading; use march"
    for point in before:
        try:
            earlier = loading(pressed, f, *point, bound=1)
        except InputError:
            return "mean loads act, and at the load point visited first more than one zone sticks; use march"
        if earlier.left_end_turns():
            return f"{PATH_DEPENDENT}during the first loading; use march"
        if not (earlier.ends[0] <= left + _ROUNDING and right - _ROUNDING <= earlier.ends[1]):
            return "mean loads act, and the load point visited first slips where the other sticks; use march"
        x = _PLACES
        more = first.slip(x) - earlier.slip(x)
        signs = np.where(x < right, first.signs[0], first.signs[1])
        if (signs * more < -_ROUNDING).any():
            return "mean loads act, and slip reverses on the path to the second load point; use march"
    found = Levels(pressed, f, first, cycle, known)
    if not _bounded(load, found):
        return "mean loads act, and the first loading less the change exceeds f p; use march"
    return found


def _before(load: Load, points: list[_Point], known: int) -> list[_Point]:
    """Loads at which the path reverses before the first visit of load point ``known``."""
    path = [load.along[-1], *load.along]
    visited = path[: path.index(points[known])]
    turns = {path[0], points[1 - known]} & set(visited)
    return [point for point in turns if any(point)]


def _bounded(load: Load, found: Levels) -> bool:
    r"""Whether \|q\| <= f p throughout the cycle, not at the load points only; if both ends slip the same way, \|q\| is
    largest at a load point."""
    kinks = np.array(found.cycle.shape.strong_kinks)
    x = _PLACES if found.cycle.shape.convex else np.union1d(_PLACES, places_between(kinks, -1.0, 1.0))
    p, (q1, q2) = found.cycle.shape.pressure(x), found.unbounded(x)
    so_far = [np.zeros_like(p)]
    if found.cycle.zone.s < 0 or found.cycle.gf or not found.cycle.shape.convex:
        changes = load.dQ, load.dsigma, load.dslope
        try:
            stages = [
                loading(found.pressed, found.f, *(share * change for change in changes), bound=2)
                for share in _SHARES.tolist()
            ]
        except InputError:  # more than one zone sticks on the way
            return False
        so_far += [stage.traction(x) for stage in stages]
    return all((np.abs(q) <= p + _ROUNDING).all() for dq in so_far for q in (q1 + dq, q2 - dq))
