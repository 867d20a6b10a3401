"""Ways of the ends of two stick intervals, (l, a) and (b, r), between which q is on the lower friction bound. Scaled as
in :mod:`partialslip.halfplane.shape`.

The rate of q is -+ dsigma/4 (z - z0)(z - z1)/sqrt(\\|(z - l)(z - a)(z - b)(z - r)\\|), - in the left interval: its
strain is that of the tension in both intervals. Its sum gives z0 + z1 = (l + a + b + r)/2 - c*; that both intervals
move alike gives the product. l, a and r retreat: the rates that a point has seen take it to the bound. b takes points
back, z0 = b, or retreats, too. The ways are polynomials, panel by panel in lambda, found by collocation of
q_start + int (rate) d(lambda) = bound, with Newton's method.
"""

import itertools

import numpy as np

from partialslip.halfplane.gradual_path.inner_rates import (
    DECAY,
    LAST,
    PANEL_NODES,
    RATE,
    SINE,
    A,
    B,
    Event,
    L,
    Map,
    Panel,
    R,
    Z,
    root,
    taken,
    ways,
)
from partialslip.halfplane.gradual_path.inner_seen import Seen
from partialslip.halfplane.gradual_path.stage import LostError
from partialslip.halfplane.gradual_path.tractions import Tractions
from partialslip.tools.arrays import Array

ENDS = (L, A, B, R)
_STEPS = 24  # limit: of Newton's method on a panel
PATIENCE = 3  # cost: steps without one that is half as large as those before, after which a panel is too long
_CLOSE = 1e-12  # accuracy: Newton step that is rounding
_SLOW = 3e-11  # accuracy: where rounding stops Newton's method: ends that hardly move
# accuracy: of the way of an end in the panel: an inner zone that closes slows a down by orders of magnitude
_RELATIVE = 1e-7
_TAIL = 1e-9  # accuracy: of the ways, relative to their lengths
_AT = 1e-11  # accuracy: distance from a break within which an end is at it
_GONE = 1e-6  # accuracy: width of an interval that has vanished
_FASTEST = 0.05  # cost: of the contact, that an end may pass in the first panel
_GROWTH = 1.7  # cost: of a panel over the one before
_PANELS = 200  # limit: of a way
_SLOWS = 2.5  # fixed: power of what is left, with which a comes to rest while an inner zone closes
_PART = 0.1  # accuracy: of an inner zone, to which it closes in a panel
SHUT = 1e-5  # accuracy: width of an inner zone that has closed: points are pushed beyond the bound by its square
_WEAK = 1e-3  # accuracy: width of an inner zone below which a hardly moves: a break that it passes leaves no kink at b
_NARROW = 1e-4  # accuracy: width of an inner zone that may be closed where its ends are lost
_HALVINGS = 12  # limit: of a panel where an event is sought
_SHORTEST = 1e-15  # limit: panel
_REFUSED = 24  # limit: halvings of a panel after the first, after which the way is lost
_FARTHER = 1.05  # cost: by which a panel is longer than the one that it is like, for b to reverse in it
# accuracy: z0 - b where b reverses; ways from there that rounding hides in the changes of q
_TURNED, _NEAR_TURN = 1e-9, 1e-7


_EVENTS = {"width": {A: 1.0, L: -1.0}, "gap": {L: 0.5, R: 0.5, A: -1.0}}  # fixed: of what their size is the sum
RETREATING, _AHEAD = [L, A, R], np.array([[1.0], [-1.0], [-1.0]])  # ends that only retreat, and where to
_KEPT = 0.2  # cost: least share of its way that a Newton step leaves an end
_REST, _MISSES = 0.5, 3  # cost: of a panel, that is left of it; panels unlike those from a similar state
_SMOOTH = 1e-12  # accuracy: last coefficients of ways, of which two panels may be one
_AT_END = np.array([0.97, 1.0])


class Way(Seen):
    """Ways of the ends from a state at lambda = 0 on.

    Parameters
    ----------
    tension, least : float
        dsigma of the half cycle, and c*.
    start : Tractions
        The state: from ``low`` to 1 it is on the lower friction bound.
    left, low : float
        l and a at the beginning.
    near : Way, optional
        Ways from a similar state.
    patience : int
        Steps of Newton's method without progress after which a panel is too long.

    Attributes
    ----------
    closed, vanished : bool
        Whether the inner zone has closed at the end, or the left interval has vanished.
    """

    def __init__(
        self, tension: float, least: float, start: Tractions, left: float, low: float, near: "Way | None" = None,
        patience: int = PATIENCE
    ) -> None:  # fmt: skip
        super().__init__(tension, least)
        self.start, self._patience = start, patience
        self._breaks = np.array([-1.0, *sorted({*start.breaks, *start.shape.strong_kinks}), 1.0])
        ends = np.array([left, low, low + 4 / 3 * ((left + 1) / 2 - least - low), 1.0])
        ends[B] = taken(ends[:, None], least)[0]
        self.first = np.append(ends, ends[B])
        self.closed = self.vanished = False
        self._near = near.panels if near else []
        self._missed, self._misses = -1, 0  # number of the last panel that is unlike these, and how many are
        self._refused = -1  # number of the panel that was not found up to an event
        self._kink = True
        with np.errstate(divide="ignore", invalid="ignore"):  # by steps that go too far, which are taken back
            self._follow()

    @property
    def progress(self) -> float:
        """lambda at the end."""
        return self.panels[-1].progress + self.panels[-1].length if self.panels else 0.0

    @property
    def ends(self) -> Array:
        """Positions of the four zone ends and z0 at the last lambda reached, (5,)."""
        return self.panels[-1].end if self.panels else self.first

    def _follow(self) -> None:
        takes, length, speeds = self._first_speeds()
        refused = 0  # panels in a row
        while self.progress < 1 - 1e-14:
            if len(self.panels) == _PANELS:
                raise LostError("too many panels")
            begin = self.ends
            gap = begin[B] - begin[A]
            length = min(length, 1 - self.progress)
            panel = self._again(takes, speeds)
            if not panel:
                panel = self._tried(takes, length, speeds)
            if not panel or panel.tail > _TAIL:
                length, refused = min(length, panel.length if panel else length) / 2, refused + 1
                shortest = _SHORTEST * max(1.0, 1e8 * (gap < _NARROW))
                if not length >= shortest or (
                    self.panels and refused > _REFUSED and gap >= _NARROW
                ):  # NaN where speeds are infinite
                    if gap < _NARROW:
                        self.closed = True
                        return
                    raise LostError(f"no panel is short enough at {self.progress}")
                continue
            turn, halved = self._turn(panel), refused > 0
            if turn is not None:
                if turn > 1e-3:
                    part = panel.length * float(panel.by.share(np.array(turn)))
                    panel = self._converged_panel(begin, takes, part, speeds, SINE, None, panel.cut(part, SINE))
                    if not panel or panel.tail > _TAIL:
                        length, refused, self._refused = part / 2, refused + 1, len(self.panels)
                        if not length >= _SHORTEST or refused > _REFUSED:
                            raise LostError(f"b turns at {self.progress}")
                        continue
                    self.panels.append(panel._replace(turns=True))
                takes = not takes
            else:
                self.panels.append(panel)
            refused = 0
            at_break = panel.event is not None and not isinstance(panel.event[0], str)
            grown = panel.length if halved and takes else _GROWTH * panel.length
            length = max(grown, length if at_break else 0.0)
            places = _AT_END
            if turn is not None and turn <= 1e-3:
                length, places = panel.length / 8, np.array([0.0, 0.2])
            speeds = panel.speeds(places)
            if turn is not None:
                speeds[B] = speeds[Z] = 0.0
            left, low, high, right = self.ends[:4]
            at_break = min(np.abs(each - self._breaks).min() for each in (left, low, right)) < _AT
            self._kink = bool(at_break and high - low > _WEAK)
            self.vanished, self.closed = bool(low - left < _GONE), bool(high - low < SHUT)
            if self.vanished or self.closed:
                return

    def _again(self, takes: bool, speeds: Array) -> Panel | None:
        """The next panel, if one like that of the ways from a similar state fits, or two of these in one."""
        ahead = [each for each in self._near if each.progress + (1 - _REST) * each.length > self.progress][:2]
        if not ahead or any(each.takes != takes for each in ahead) or self._missed == len(self.panels):
            return None
        wide = bool(self.first[B] - self.first[A] > _WEAK)  # of narrower ones the panels are few
        both = wide and len(ahead) == 2 and not ahead[0].event and max(each.tail for each in ahead) < _SMOOTH
        for old in ahead[both::-1]:
            begin, event = self.ends, old.event
            length = old.progress + old.length * (_FARTHER if old.turns else 1) - self.progress
            if event and event[0] == "width":
                event = "width", (begin[A] - begin[L]) * np.exp(-RATE)
            elif event and not isinstance(event[0], str):
                breaks = self._breaks_of(event[0], takes)
                event = (event[0], float(breaks[np.argmin(np.abs(breaks - event[1]))])) if len(breaks) else None
            panel = self._converged_panel(begin, takes, length, speeds, old.by, event, self._alike(length, old.by))
            if panel and self.progress + panel.length <= 1 and not self._crossing(panel) and panel.tail <= _TAIL:
                return panel
        self._missed = len(self.panels)
        self._misses += 1
        if self._misses > _MISSES:
            self._near = []
        return None

    def _alike(self, length: float, by: Map) -> Array | None:
        """Ways of the ends over the next ``length`` of lambda in a similar state, (5, nodes); None beyond its end."""
        progress = self.progress + length * np.append(0.0, by.shares)
        if not self._near or progress[-1] > self._near[-1].progress + self._near[-1].length:
            return None
        ends = ways(self._near, progress)
        return ends[:, 1:] - ends[:, :1]

    def _tried(self, takes: bool, length: float, speeds: Array) -> Panel | None:
        """The next panel: up to a break, to where an interval has become narrower, or of a ``length``."""
        begin, rest = self.ends, 1 - self.progress
        width, gap = begin[A] - begin[L], begin[B] - begin[A]
        fall, shut = speeds[L] - speeds[A], speeds[A] - speeds[B]
        passing = self._next_break(begin, takes, speeds)
        panel = None
        if self._refused == len(self.panels):
            pass
        elif passing and passing[0] < 1.2 * length:
            panel = self._converged_panel(begin, takes, passing[0], speeds, SINE, passing[1:])
        elif self.panels and fall * length > 0.3 * width and not shut * width > fall * gap:
            panel = self._converged_panel(
                begin, takes, 0.4 * width / fall, speeds, DECAY, ("width", width * np.exp(-RATE))
            )
        elif self.panels and takes and shut * length > 0.5 * gap:
            size = self._least + max(SHUT / 2, _PART * gap)
            panel = self._converged_panel(begin, takes, gap / shut, speeds, SINE, ("gap", size))
        if not panel or panel.length > rest or panel.tail > _TAIL:
            self._refused = len(self.panels)
            panel = self._converged_panel(begin, takes, length, speeds, SINE)
        for _ in range(_HALVINGS):
            crossing = self._crossing(panel) if panel else None
            if not panel or not crossing:
                return panel
            end, place, s = crossing
            part = panel.length * float(panel.by.share(np.array(s)))
            panel = self._converged_panel(begin, takes, part, speeds, SINE, (end, place), panel.cut(part, SINE))
        return None

    def _first_speeds(self) -> tuple[bool, float, Array]:
        """Whether b takes points back, length of the first panel, and speeds of the ends."""
        ends, speeds, near = self.first, np.zeros(5), 1e-8
        for end in (L, A, R):
            way, factor = (1 if end == L else -1), (1.0 if end == R else -1.0)
            stiff = abs(float(self.start.less(factor, np.array([ends[end] + way * near]))[0])) / np.sqrt(near)
            apart = ends - ends[end]
            apart[end] = 1.0
            rate = float(self._rates_near(ends, end))
            speeds[end] = way * 2 * rate / max(stiff, 1e-2)
        step = 1e-4 / np.abs(speeds).max()
        moved = ends + step * speeds
        free = (taken(moved[:4, None], self._least)[0] - ends[B]) / step
        takes = bool(free <= 0)
        speeds[B] = free if takes else 2 / 3 * free
        speeds[Z] = free
        return takes, min(_FASTEST / np.abs(speeds).max(), 0.2, (ends[B] - ends[A]) / (2 * abs(speeds[B]))), speeds

    def _rates_near(self, ends: Array, end: int) -> float:
        """Size of the rate near an ``end``, times the square root of the distance."""
        apart = ends - ends[end]
        other = (apart[L] + apart[A] + apart[B] + apart[R]) / 2 - self._least - apart[Z]
        product = np.prod([abs(apart[each]) for each in ENDS if each != end])
        return float(self._tension / 4 * abs(apart[Z] * other) / np.sqrt(product))

    def _breaks_of(self, end: int, takes: bool) -> Array:
        """Places at which the way of an ``end`` has a kink: where q at the beginning is not smooth, or, of b on its way
        back, where it began to take points."""
        if end != B:
            return self._breaks
        began = [
            float(panel.begin[B])
            for before, panel in itertools.pairwise([None, *self.panels])
            if panel and panel.takes and not (before and before.takes)
        ]
        return np.array([] if takes else began)

    def _next_break(self, begin: Array, takes: bool, speeds: Array) -> tuple[float, int, float] | None:
        """lambda up to the next break that an end passes, about, the end, and the break."""
        found = []
        for end in ENDS:
            breaks = self._breaks_of(end, takes)
            ahead = (breaks - begin[end]) * np.sign(speeds[end])
            if (ahead > _AT).any():
                ahead[ahead <= _AT] = np.inf
                span = float(ahead.min() / abs(speeds[end]))
                shut = (begin[B] - begin[A]) / (speeds[A] - speeds[B])  # lambda until the inner zone closes, about
                if end == A and takes and shut > 0:  # a slows down as in the first guess of a panel
                    if not _SLOWS * span < shut:
                        continue
                    span = float(shut * (1 - (1 - _SLOWS * span / shut) ** (1 / _SLOWS)))
                found.append((span, end, float(breaks[np.argmin(ahead)])))
        return min(found) if found else None

    def _crossing(self, panel: Panel) -> tuple[int, float, float] | None:
        """The end that passes a break first, the break, and s."""
        s = np.linspace(0, 1, 201)[1:]
        at, found = panel.at(s), []
        for end in ENDS:
            way, breaks = (1 if end in (L, B) else -1), self._breaks_of(end, panel.takes)
            ahead = way * (breaks - panel.begin[end])
            for distance, place in zip(ahead, breaks, strict=True):
                passed = way * at[end] > distance + _AT
                if distance > _AT and passed.any():
                    found.append((float(s[np.argmax(passed)]), end, float(place)))
        return min(found)[1:] + min(found)[:1] if found else None

    def _turn(self, panel: Panel) -> float | None:
        """s at which the end b reverses: while it takes up points it would move to the right, or while it retreats,
        beyond z0."""
        s = np.linspace(0, 1, 401)
        at = panel.at(s)
        if panel.takes:
            values = np.diff(at[B])
            wrong = values > 1e-13
        else:
            wrong = (at[Z] - at[B] + (panel.begin[Z] - panel.begin[B]))[1:] < -1e-12
        if not wrong.any():
            return None
        number = int(np.argmax(wrong))
        low, high = s[number], s[min(number + 1, 400)]
        if panel.takes:
            low = s[max(number - 1, 0)]
            fine = np.linspace(low, high, 2001)
            way = panel.at(fine)[B]
            k = int(np.argmin(way))
            if 0 < k < 2000:
                y0, y1, y2 = way[k - 1 : k + 2]
                return float(fine[k] + (fine[1] - fine[0]) * 0.5 * (y0 - y2) / (y0 - 2 * y1 + y2))
            return float(fine[k])
        return float(low)

    def at(self, progress: float) -> Array:
        """Positions of the four zone ends and z0 at lambda = ``progress``, (5,)."""
        return ways(self.panels, np.array([progress]))[:, 0] if self.panels else self.first

    @property
    def kinks(self) -> list[float]:
        """x of kinks of q that the end b of the inner slip zone causes: its position when it began to take up points,
        if q or the path of an end had a kink then."""
        return [float(panel.begin[B]) for panel in self.panels if panel.takes and panel.kink]

    def _completed(self, begin: Array, offsets: Array, takes: bool) -> Array | None:
        """``offsets`` with those of z0, and of b where it takes points; None if the ends are not in order."""
        offsets = offsets.copy()
        ends = begin[:4, None] + offsets[:4]
        if takes:
            gap = 4 / 3 * ((ends[L] + ends[R]) / 2 - self._least - ends[A])  # in narrow inner zones
            if not (gap > 0).all():
                return None
            ends[B] = np.where(ends[B] > ends[A] + gap / 4, ends[B], ends[A] + gap)
        if not (np.diff(ends, axis=0) > 0).all():
            return None
        with np.errstate(all="ignore"):
            if takes:
                offsets[B] = taken(ends, self._least) - begin[B]
                offsets[Z] = offsets[B] + (begin[B] - begin[Z])
            else:
                offsets[Z] = root(ends, self._least) - begin[Z]
        ends = begin[:4, None] + offsets[:4]
        return offsets if np.isfinite(offsets).all() and (np.diff(ends, axis=0) > 0).all() else None

    def _slopes(self, ends: Array, free: tuple[int, ...]) -> Array:
        """Derivatives (5, free, n) of the ends and z0 by the ``free`` ends; the others are such that b takes points."""
        count, steps = ends.shape[1], 1e-6 * np.diff(ends, axis=0).min(axis=0)
        moved = np.repeat(ends[:, None], 1 + len(ENDS), axis=1)  # first as they are, then each moved in turn
        moved[ENDS, [1 + end for end in ENDS]] += steps
        at, *after = root(moved.reshape(len(ENDS), -1), self._least).reshape(-1, count)
        found, by = np.zeros((5, len(free), count)), [(each - at) / steps for each in after]
        for column, end in enumerate(free):
            found[end, column] = 1.0
            if B in free:
                found[Z, column] = by[end]
            else:  # where z0 = b
                found[B, column] = found[Z, column] = by[end] / (1 - by[B])
        return found

    def _converged_panel(
        self,
        begin: Array,
        takes: bool,
        length: float,
        speeds: Array,
        by: Map,
        event: Event | None = None,
        like: Array | None = None,
    ) -> Panel | None:
        """A panel by Newton's method, perhaps from ways that are ``like`` these (5, nodes); None if it does not
        converge. The length is unknown if there is an ``event``.

        Where b has just reversed, it moves by a quarter of what the place does at which it would take points: both
        go with the square of the time, and by this quarter what a point has seen adds up to nothing. At the beginning
        it moves by half of that: both go with the time, and no point has seen anything before.
        """
        turned = not takes and begin[Z] - begin[B] < _TURNED
        follows = 1 / 4 if self.panels else 1 / 2
        if like is not None:
            offsets = like
        else:
            offsets = speeds[:, None] * by.shares * length
            if event and event[0] == "gap":  # a slows down with the inner zone's width
                offsets[A] = speeds[A] * length * (1 - (1 - by.shares) ** _SLOWS) / _SLOWS
            if turned:
                ends = begin[:4, None] + offsets[:4]
                offsets[B] = follows * np.abs(taken(ends, self._least) - begin[B]) + 1e-9 * by.shares * length
        free = (L, A, R) if takes else ENDS
        count = len(free)
        step: tuple[float, Array] | None = None  # of the length and of the offsets
        best, since = np.inf, 0
        for count_of_steps in range(_STEPS):
            found = self._completed(begin, offsets, takes)
            for _ in range(_HALVINGS):
                if found is not None:
                    break
                if step is None:
                    length *= 0.9
                    offsets = offsets * 0.9
                else:  # the last step went too far
                    length, offsets, step = length - step[0] / 2, offsets - step[1] / 2, (step[0] / 2, step[1] / 2)
                found = self._completed(begin, offsets, takes)
            if found is None:
                return None
            offsets = found
            ends = begin[:4, None] + offsets[:4]
            slopes = self._slopes(ends, free)
            residual, matrix, by_length = (
                np.zeros((count, PANEL_NODES, *more)) for more in ((), (count, PANEL_NODES), ())
            )
            own = np.tensordot(offsets, by.own_cardinal, (1, 2))  # (5, nodes, points)
            for row, end in enumerate(free):
                right, factor = end in (B, R), (1.0 if end == R else -1.0)
                apart = (begin - begin[end])[:, None, None] + own - offsets[end][:, None]
                other = (apart[L] + apart[A] + apart[B] + apart[R]) / 2 - self._least - apart[Z]
                rates = length * by.own_weights * self.rates(apart) * (1 if right else -1)
                total = rates.sum(axis=1)
                by_length[row] = total / length
                past, past_slope = self.seen(begin, end, offsets[end])
                factors = np.array([*(0.5 / other - 0.5 / apart[each] for each in ENDS), 1 / apart[Z] - 1 / other])
                factors *= rates
                at_x = -(1 / apart[Z] + 1 / other - sum(0.5 / apart[each] for each in ENDS if each != end))
                diagonal = past_slope + (rates * at_x).sum(axis=1)
                factors[end] = rates * (0.5 / other)
                blocks = factors.swapaxes(0, 1) @ by.own_cardinal  # (nodes, 5, nodes)
                blocks[:, end] += ((rates * -0.5 / apart[end])[:, None] @ by.own_change)[:, 0]
                matrix[row] = np.einsum("jek,eck->jck", blocks, slopes)
                less = np.zeros(PANEL_NODES)
                if end != B:
                    x, origin = offsets[end], float(begin[end])
                    near = 1e-4 * np.abs(x[:, None] - (self._breaks - origin)).min(axis=1)
                    places = np.concatenate([x, x + near, x - near])
                    less, *beside = self.start.less(factor, places, origin).reshape(3, -1)
                    diagonal -= np.subtract(*beside) / (2 * near)
                residual[row] = past + total - less
                matrix[row, :, row] += np.diag(diagonal)
                if end == B and turned:
                    due = taken(ends, self._least) - begin[B]
                    near = np.flatnonzero(np.abs(due) < _NEAR_TURN)
                    residual[row, near] = offsets[B, near] - follows * due[near]
                    matrix[row, near] = by_length[row, near] = 0.0
                    matrix[row, near, row, near] = 1.0
            size = count * PANEL_NODES
            system, target = matrix.reshape(size, size), -residual.ravel()
            if event:
                kind, value = event
                extra = np.zeros((count, PANEL_NODES))
                signs = _EVENTS[kind] if isinstance(kind, str) else {kind: 1.0}
                for end, sign in signs.items():
                    extra += sign * slopes[end] * LAST
                    value -= sign * (begin[end] + LAST @ offsets[end])
                system = np.block([[system, by_length.reshape(-1, 1)], [extra.reshape(1, -1), np.zeros((1, 1))]])
                target = np.append(target, value)
            if not np.isfinite(system).all():
                return None
            solution = np.linalg.solve(system, target)
            change, damp, longer = solution[:size].reshape(count, PANEL_NODES), 1.0, 0.0
            if event:
                damp = min(1.0, 0.5 * length / abs(float(solution[-1])))
                longer = damp * float(solution[-1])
            moves = damp * np.einsum("ecj,cj->ej", slopes, change)
            ahead = _AHEAD * (offsets[RETREATING] + moves[RETREATING])
            back = ahead < _KEPT * _AHEAD * offsets[RETREATING]
            if back.any():  # behind its beginning an end would see rates that there are none
                moves[RETREATING] = np.where(back, (_KEPT - 1) * offsets[RETREATING], moves[RETREATING])
                damp = min(damp, 0.5)
            step = longer, moves
            length, offsets = length + step[0], offsets + step[1]
            largest, moved = np.abs(change).max(axis=1), np.abs(offsets[list(free)]).max(axis=1)
            relative = free.index(A), free.index(L), free.index(R)  # b need not be known as well where it reverses
            close = (largest < 1e-15 + _RELATIVE * moved)[list(relative)].all()
            if damp == 1 and close and largest.max() < (_CLOSE if count_of_steps < 2 else _SLOW):
                return Panel(self.progress, length, begin, offsets, by, takes, self._kink, event)
            if damp == 1 and largest.max() < best / 2:
                best, since = float(largest.max()), count_of_steps
            if count_of_steps - since > self._patience:
                return None
        return None
