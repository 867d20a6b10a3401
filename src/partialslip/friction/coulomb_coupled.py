"""Two bodies that are not mirror images, pressed together with friction and loaded: their way through load steps
(:mod:`partialslip.friction.coupled_step`), scaled as these."""

import itertools
from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np

from partialslip.friction.active_set import Solution
from partialslip.friction.contact_line import ContactLine
from partialslip.friction.coupled_step import LoadStep, Pivot, Relative, solve_near
from partialslip.friction.even_gap import PARABOLA, EvenGap
from partialslip.friction.history import History, certified, follow, resting, still
from partialslip.friction.load_path import Path
from partialslip.friction.pressing import FlatPunch, Pressed, Punches, Stages, disproportion
from partialslip.friction.warm_start import Pair, Trail
from partialslip.friction.zone_ends import CORNER
from partialslip.tools.arrays import Array, Mask
from partialslip.tools.errors import InputError

_STICKS = 1e-9  # accuracy: relative tolerance of the friction bound and of lengths
_TIMES = 8  # limit: iterations of the half-width in self-similar pressing
# cost: least and largest change of what is found less what was assumed, by what was assumed (measured: -1.1); change
# that is no progress: nodes that are covered or not move the ends
_SLOPES, _SLOWEST = (-2.0, -0.5), 0.5
_PUNCHES = np.array([1.0, 0.5, 0.25])  # half-widths of flat punches on bodies of a size, in that of the contact
HALF = 0.5  # accuracy: half-width of a second punch that tells how similar like bodies of a size are, in the first's
_ROUGH = 0.1  # accuracy: largest error of q for which punches are used
_SETTLED = 0.03  # accuracy: error of the half-width that is left, in the tolerance of the ends
# accuracy: error of the half-width over what punches leave of the gap (measured: 2e-3 to 1e-2); q is off by less than
# that part (0.1)
_OF_LAW = 0.01
_FAR = 10.0  # accuracy: gap, in half-widths, that stays open
_ENDS = 15.0  # accuracy: tolerance of q over tolerance of the ends
_MOST, _WORK = 64, 16_000  # limit: steps of pressing, and of steps times nodes
_ANEW = "anew"  # key of steps that do not begin where others did


class SlidesError(InputError):
    """Bodies that a displacement moves slide, on this mesh: a finer one is less stiff, and bears less Q. ``factored``:
    factorisations that were made for this mesh."""

    factored = 0


@dataclass(frozen=True)
class Growth:
    """Growth of the contact while coupled bodies are pressed together.

    ``similar``: half-planes with Dundurs' beta under the even gap ``under``, self-similar growth; ``sized``: nearly so,
    bodies of one material and size; ``nearly_similar``: any bodies of finite size under a parabola. ``stages`` gives
    the stages of pressing (default: from a flat punch on the nodes); ``near`` is an estimate of the half-width.
    """

    similar: bool = False
    sized: bool = False
    nearly_similar: bool = False
    near: float | None = None
    stages: Stages | None = None
    under: EvenGap = PARABOLA


def press_coupled(
    C: Relative,
    gap: Array,
    f: Array,
    line: ContactLine,
    growth: Growth,
    least: int,
    accuracy: float,
    trail: Trail | None = None,
    P: float = 1.0,
    pivot: Pivot | None = None,
) -> Pressed:
    """Press the bodies together under a force from 0 to ``P``, with friction and without Q. The moment of a ``pivot``
    grows with the force.

    Nodes that stick keep their displacement. Under an even gap bodies are pressed in one small step from an earlier
    stage, known from flat punches about its vertex (:mod:`partialslip.friction.pressing`). Others are pressed
    in at least ``least`` steps, doubled until q changes by less than ``accuracy`` (relative L2), or up to the limit.
    Nodes touch one by one, in one step or the next, and lock in more or less than their neighbours: the change is that
    of means over cells.

    ``C`` are the compliances, ``gap`` (n,) the gap before loading, ``f`` (n,) the coefficients of friction.
    """
    bodies, settled = _Bodies(C, gap, f, line, growth, P, pivot, trail), _SETTLED * accuracy / _ENDS
    if (growth.similar or growth.sized) and (alike := _similar(bodies, settled)):
        return alike
    if growth.nearly_similar and (found := _nearly_similar(bodies, settled)):
        return found
    last, count = bodies.in_steps(least), least
    while True:
        before, last, count = last, bodies.in_steps(2 * count), 2 * count
        (p, q), others = last[-1], before[-1]
        errors = {"q": 2 * line.change(q.x, others[1].x), "a": 2 * bodies.moved(last[-1], others)}
        grown = p.x - last[-2][0].x, q.x - last[-2][1].x
        reached = errors["q"] <= accuracy and errors["a"] <= accuracy / _ENDS
        if reached or 2 * count > max(_MOST, 2 * least) or 2 * count * len(gap) > _WORK:
            return Pressed(*_certified(last[1:]), count, errors, grown, f)


@dataclass(frozen=True)
class _Bodies:
    """Bodies to be pressed together, as for :func:`press_coupled`."""

    C: Relative
    gap: Array
    f: Array
    line: ContactLine
    growth: Growth
    P: float
    pivot: Pivot | None
    trail: Trail | None
    number: Iterator[int] = field(default_factory=itertools.count)

    @cached_property
    def vertex(self) -> float:
        """Where a parabolic gap is smallest: there the bodies touch first."""
        fit = np.polynomial.Polynomial.fit(self.line.x, self.gap, 2)
        return float(fit.deriv().roots()[0].real) if self.growth.under.parabolic else 0.0

    @cached_property
    def x(self) -> Array:
        """Nodes (n,), from there on."""
        return self.line.x - self.vertex

    @property
    def apart(self) -> Pair:
        """Forces of bodies that are apart."""
        return resting(0 * self.gap), resting(0 * self.gap)

    def step(self, P: float, gap: Array, kept: Array, before: Pair, key: Hashable = None) -> Pair:
        """Forces under ``P`` over the ``gap`` (n,), of nodes that stick at ``kept`` (n,); a guess is ``before``."""
        C, pivot = self.C, self.pivot and self.pivot._replace(moment=self.pivot.moment * P / self.P)
        assert C.xx is not None
        assert C.xy is not None
        this = LoadStep(C.xx, C.yy, C.xy, C.opening, self.f, P, gap, 0.0, kept, C.factors, None, pivot)
        trail, key = (None if key == _ANEW else self.trail), ("pressing", key or next(self.number))
        return solve_near(this, [before], trail, key)

    def in_steps(self, count: int) -> list[Pair]:
        """Forces after each of ``count`` equal steps."""
        found = [self.apart]
        for force in np.linspace(0, self.P, count + 1)[1:].tolist():
            found.append(self.step(force, self.gap, self.kept(found[-1]), found[-1]))
        return found

    def kept(self, forces: Pair) -> Array:
        """Displacements (n,) along x under the ``forces``."""
        return self.C.moved(forces[0].x, forces[1].x)[0]

    def covered(self, half_width: float) -> Mask:
        """Nodes (n,) that a flat punch of the ``half_width`` covers."""
        return np.abs(self.x) <= half_width * (1 + _STICKS)

    def punch(self, half_width: float, guess: Pair) -> Pair:
        """Forces under the flat punch of the ``half_width`` and the force 1, from a ``guess`` of them."""
        open_ = np.where(self.covered(half_width), 0.0, _FAR * half_width)
        return self.step(1.0, open_, np.zeros(len(open_)), guess, _ANEW)

    def half_width(self, forces: Pair) -> float:
        """Half-width of the contact under the ``forces``."""
        left, right = self.line.ends(forces[0].x, forces[1].x)
        return (right - left) / 2

    def moved(self, forces: Pair, others: Pair) -> float:
        """Largest distance between the ends of two contacts, in half-widths."""
        (left, right), (l_other, r_other) = (self.line.ends(p.x, q.x) for p, q in (forces, others))
        return max(abs(left - l_other), abs(right - r_other)) * 2 / (right - left)

    def off(self, forces: Pair, others: Pair) -> float:
        """Relative L2 difference of the tangential forces."""
        q, other, norm = forces[1].x, others[1].x, 1 / self.line.weights
        size = float(norm @ q**2)
        return float(np.sqrt(norm @ (q - other) ** 2 / size)) if size > 0 else 0.0

    def from_a_punch(self, half_width: float) -> FlatPunch:
        """Stages of pressing, from the flat punch of the ``half_width``."""
        line, growth = self.line, self.growth
        p, q = (each.x for each in self.punch(half_width, self.apart))
        left, right = line.ends(p, q, rise=CORNER)  # between the last node and the next one
        points, left_of = line.resultants(p, q)
        between = left - self.vertex, right - self.vertex
        punch = FlatPunch(
            between, self.x, line.weights, (p, q), points - self.vertex, left_of, growth.sized, growth.under
        )
        if growth.sized or growth.under.parabolic:
            return punch
        pushes = float(self.f.max()) * abs(line.beta)
        return replace(punch, gap=growth.under.under(*punch.beyond(pushes), pushes))


def _settled(
    bodies: _Bodies, reach: float, tolerance: float, press: Callable[[float], Pair]
) -> tuple[Pair, float, float, int]:
    """Press from stages of contacts of half-width ``reach``, by secants until that is also the one that is found.

    Returns what is found, its ``reach``, by how much of it the half-widths still differ, and how often it was pressed.
    """
    count, before, least = 0, (0.0, 0.0), np.inf
    while True:
        found, count = press(reach), count + 1
        off = bodies.half_width(found) - reach
        if abs(off) <= tolerance * reach or abs(off) > _SLOWEST * least or count == _TIMES:
            return found, reach, abs(off) / reach, count
        slope = (off - before[1]) / (reach - before[0]) if count > 1 else -1.0
        before, least = (reach, off), abs(off)
        reach -= off / min(max(slope, _SLOPES[0]), _SLOPES[1])


def _similar(bodies: _Bodies, accuracy: float) -> Pressed | None:
    """Press self-similarly about the vertex, with last steps of two sizes; the difference is the error estimate. Steps
    begin where one that bears all of P ended. None if like bodies of a size are not as similar as that, or touch
    elsewhere."""
    line, grows, first = bodies.line, bodies.growth, bodies.in_steps(1)[-1]

    def press(stages: Stages, size: float, reach: float) -> Pair:
        p, q = stages.stage(reach, 1 - size)
        start = replace(first[0], x=p), replace(first[1], x=q)
        return bodies.step(1.0, bodies.gap, bodies.kept(start), start)

    reach, count, unlike, tried = grows.near or bodies.half_width(first), 1, 0.0, list[Mask]()
    while True:
        tried.append(covered := bodies.covered(reach))
        if not covered.any():  # the contact is elsewhere than where the gap is smallest
            return None
        stages = grows.stages or bodies.from_a_punch(reach)
        last, reach, left, pressed = _settled(bodies, reach, accuracy, partial(press, stages, stages.last / 2))
        count += pressed + (grows.stages is None)
        covered = bodies.covered(reach)  # two punches may each lead to the other
        if grows.stages or count >= _MOST or any(np.array_equal(covered, each) for each in tried):
            break
    growth = stages.growth(reach)
    if grows.sized:
        if not bodies.covered(HALF * reach).any():
            return None
        half = bodies.punch(HALF * reach, bodies.apart)
        if (unlike := disproportion(bodies.x, growth, (half[0].x, half[1].x))) > _ROUGH:
            return None
    rough = press(stages, stages.last, reach)
    law = stages.gap.off
    errors = {"q": bodies.off(last, rough) + unlike + law, "a": bodies.moved(last, rough) + left + _OF_LAW * law}
    corners = None if grows.stages else line.ends(*growth, rise=CORNER)
    return Pressed(*_certified([last]), count + 1 + grows.sized, errors, growth, bodies.f, corners)


def _nearly_similar(bodies: _Bodies, accuracy: float) -> Pressed | None:
    """Press bodies of a size with all punches and half of the last step, and with all but one and the whole last step.
    The difference is the error estimate; None if it is large."""
    x, none, gap = bodies.x, bodies.apart, bodies.gap
    near = bodies.growth.near or bodies.half_width(bodies.in_steps(1)[-1])
    half_widths = float(f"{near:.2g}") * _PUNCHES  # the error of another mesh, from which it may be, does not matter

    def punch(half_width: float, like: Pair, wider: float) -> Pair:
        """The punch, from one that is so many times ``wider``."""
        covered, nearest = bodies.covered(half_width), np.searchsorted(middles, x * wider)
        guess = replace(none[0], x=covered.astype(float)), replace(none[1], rest=like[1].rest[nearest] * covered)
        return bodies.punch(half_width, guess)

    middles, under = (x[1:] + x[:-1]) / 2, [none]
    for half_width, wider in zip(half_widths.tolist(), (1.0, *_PUNCHES[:-1] / _PUNCHES[1:]), strict=True):
        under.append(punch(half_width, under[-1], wider))
    under = under[1:]
    known = [(p.x > 0, (p.x > 0) & (q.sides == 0), *bodies.C.moved(p.x, q.x)) for p, q in under]
    if not all(sticks.any() for _, sticks, _, _ in known):
        return None
    punches, found = Punches.of(half_widths, x, known), under[:1]

    def press(count: int, last: float, reach: float) -> Pair:
        found.append(bodies.step(1.0, gap, punches.kept(gap, reach, 1 - last, count), found[-1], ("last", count)))
        return found[-1]

    last, reach, left, count = _settled(bodies, near, accuracy, partial(press, len(under), punches.last / 2))
    rough = press(len(under) - 1, punches.last, reach)
    errors = {"q": bodies.off(last, rough), "a": bodies.moved(last, rough) + left}
    if errors["q"] > _ROUGH:
        return None
    p, q = (each.x for each in punch(reach, under[0], half_widths[0] / reach))
    corners = bodies.line.ends(p, q, rise=CORNER)
    return Pressed(*_certified([last]), len(under) + count + 2, errors, (p, q), bodies.f, corners)


def _certified(done: Sequence[Pair]) -> Pair:
    """Last solution, with the residuals of all steps."""
    return certified([p for p, _ in done]), certified([q for _, q in done])


def march(
    C: Relative,
    gap: Array,
    stretch: Array,
    bent: Array,
    f: Array,
    path: Path,
    line: ContactLine,
    growth: Growth,
    pressed: Array | None = None,
    accuracy: float = 1e-3,
    trail: Trail | None = None,
    pivot: Pivot | None = None,
) -> tuple[History, Solution, Pressed | None]:
    """Press the bodies together with friction and follow the path of the loads.

    Returns the history, the normal forces at load point 2 with the residuals of all steps, and the pressing (None if
    the path begins with pressed bodies).

    Parameters
    ----------
    C : Relative
    gap : (n,) array
        Gap before loading.
    stretch : (2, n) array
        Displacements of the lower surface, along x and y, under the tension that strains a long body by 1.
    bent : (n,) array
        Displacements along x under the tension that strains the surface by x; there are none along y.
    f : (n,) array
        Coefficient of friction.
    path : Path
    line : ContactLine
    growth : Growth
    pressed : (n,) array, optional
        Normal forces at the beginning of the path; default: the bodies are apart.
    accuracy : float
        Tolerance of q for the steps of pressing, relative L2.
    trail : Trail, optional
        Where steps begin.
    pivot : Pivot, optional
        Pin on which a body turns; its moment is that of the path.

    Raises
    ------
    SlidesError
        If a displacement moves the bodies so far that they slide.
    """
    assert C.xx is not None
    xx, xy = C.xx, C.xy if C.xy is not None else 0 * C.xx
    full = replace(C, xy=xy)
    gap = gap - path.begin[1] * stretch[1]
    first: Pressed | None = None

    def turning(load: Sequence[float] | Array) -> Pivot | None:
        return pivot and pivot._replace(moment=float(load[4]))

    if pressed is None:
        P = path.begin[3] if path.presses_anew else 1.0
        first = press_coupled(full, gap, f, line, growth, path.substeps, accuracy, trail, P, turning(path.begin))
        done = [(first.normal, first.tangential)]
    else:
        done = [(resting(pressed), resting(0 * gap if path.before is None else path.before))]
    cycle = sum(len(way) for way in path.fractions[1:])

    def advance(before: Solution, load: Array, change: Array) -> tuple[Solution, Array]:
        nonlocal gap
        Q, strain = float(load[0]), float(change[1])
        if not change.any():
            normal = done[-1][0]
            done.append((replace(still(normal), rest=normal.rest), replace(still(before), turn=normal.turn)))
            return done[-1][1], normal.x
        gap = gap - strain * stretch[1]
        kept = xx @ before.x + xy @ done[-1][0].x + strain * stretch[0] + change[2] * bent
        if pivot:
            kept = kept - pivot.height * done[-1][0].turn
        starts = [done[-1], *done[-cycle : 1 - cycle]]  # the previous step, and this step of the previous cycle
        P = float(load[3]) if path.presses_anew else 1.0
        if path.actuator is not None:  # which was bent by the forces before the step
            Q = float(change[0]) + path.actuator * float(before.x.sum())
        this = LoadStep(xx, C.yy, xy, full.opening, f, P, gap, Q, kept, full.factors, path.actuator, turning(load))
        normal, sheared = solve_near(this, starts, trail, ("path", len(done)))
        if path.actuator is not None and not ((normal.x > 0) & (sheared.sides == 0)).any():
            raise SlidesError("load.displacement: must keep |Q| below f P; the contact slides on the way")
        done.append((replace(normal, residual=np.maximum(normal.residual, sheared.residual / f)), sheared))
        return sheared, normal.x

    def skip(times: float) -> None:
        (normal, sheared), (before, _) = done[-1], done[-1 - cycle]
        forces = np.maximum(normal.x + times * (normal.x - before.x), 0.0)
        done[-1] = replace(normal, x=forces, turn=normal.turn + times * (normal.turn - before.turn)), sheared

    history = follow(path, advance, done[0][1], f, skip=skip if path.settled > 0 else None)
    last, _ = done[-cycle:][sum(len(way) for way in path.fractions[1 : path.ends[1] + 2]) - 1]
    together = replace(
        last,
        residual=np.maximum.reduce([normal.residual for normal, _ in done]),
        imbalance=max(normal.imbalance for normal, _ in done),
        iterations=sum(normal.iterations for normal, _ in done),
        changes=sum(normal.changes + sheared.changes for normal, sheared in done),
    )
    return history, together, first
