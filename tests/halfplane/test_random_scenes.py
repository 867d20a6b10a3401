"""Random scenes through the exact method: every regime, pressure, sign and unit.

A failure names the number that makes its scene again, by ``draw``.
"""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest

import partialslip
from partialslip.halfplane import contact, method
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.proportional import loading
from partialslip.halfplane.steady import stick_zones
from partialslip.halfplane.turning import Turning
from partialslip.result import StickZone
from partialslip.verify.random_scenes import KINDS, PROFILES, draw, kind_of

SEED = 7
NARROWEST = 1e-99  # of a: narrower stick zones are not told apart
TINY, TIGHT, ROUGH = 1e-14, 1e-9, 5e-3  # the last for sums over the points of a result
STAGES = 5e-8  # rounding of x, 1e-16 a, under the square root at the ends of the stick zone


class Answer:
    """The exact result of a scene in SI units: ``shear`` and ``tension`` are the changes dQ and dsigma, ``mean`` is the
    mean of Q, ``levels`` are q1 and q2, and ``slips`` are points and the slip there."""

    def __init__(self, scene):
        found = partialslip.run(scene, ["exact"]).results["exact"]
        load, traction, slip = scene.load, found.traction, found.slip
        self.scene, self.pressed, self.f = scene, contact(scene), scene.friction.f
        self.shear, self.tension, self.mean = load.dQ, load.dsigma, load.Q_mean
        self.regime, self.limits, self.half_width = found.regime, found.limits, found.stick_half_width
        self.m, self.n = found.m, found.n
        self.x, self.p, self.dq = traction.x, traction.p, traction.dq
        self.at = lambda x: traction.at(x)[:2]
        self.levels = () if traction.q1 is None else (traction.q1, traction.q2)
        self.slips, self.dissipated = ((slip.x, slip.slip), slip.dissipated) if slip else (None, 0.0)

    @functools.cached_property
    def cycle(self):
        """Half a cycle of gradual loads."""
        return method._change(self.scene).cycle  # kept since the scene was solved

    @property
    def turns(self):
        """Whether slip turns round, and gradual loads are followed."""
        return self.regime != "sliding" and isinstance(self.cycle, Turning)

    @functools.cached_property
    def room(self):
        """For the mean force, as a fraction of f P: at stages of the way, at the load points only where slip reverses
        and a single step is all that is known."""
        unit = self.f * self.pressed.p0
        cycle, y, dq = self.cycle, self.x / self.pressed.a, self.dq / unit
        least, (left, right) = self.pressed.shape.pressure(y), cycle.permanent or (1.0, -1.0)
        sticks = (y > left) & (y < right)
        least[sticks] = np.abs(dq)[sticks] / 2
        shares = np.arange(1, 40) / 40 if cycle.holds and not cycle.one_way else ()
        stages = [cycle.part(share) for share in shares] if self.turns else stages_of(cycle, shares)
        for stage in stages:
            least[sticks] = np.maximum(least, np.abs(stage.traction(y) - dq / 2))[sticks]
        return 1 - np.trapezoid(least, y) * 2 / np.pi


def stages_of(whole, shares):
    """Loadings by ``shares`` of the loads of the ``whole`` one, whose stick zones are found together."""
    if not len(shares):
        return []
    loads = [shares * each for each in (whole.Qf, whole.sf)]
    zones = np.transpose(stick_zones(*loads, whole.seen)).tolist()
    found = zip(*(each.tolist() for each in loads), zones, strict=True)
    return [replace(whole, Qf=Qf, sf=sf, zone=StickZone(e, c, int(s))) for Qf, sf, (e, c, s) in found]


def regimes(answer):
    """Names that the loads allow: more than one only where rounding, or the sum for the mean load's room, decides."""
    limit = answer.f * answer.pressed.P
    Qf, mean = abs(answer.shear) / (2 * limit), abs(answer.mean) / limit
    if Qf + mean > 1 + 1e-12 or Qf >= 1:
        return {"sliding"}
    names = {"sliding"} if Qf + mean > 1 - 1e-12 else set()
    if answer.turns:
        room, side = answer.room, "small tension" if answer.cycle.zone.s > 0 else "large tension"
        return names | ({side} if mean < room + ROUGH else set()) | ({"ratchets"} if mean > room - ROUGH else set())
    if answer.shear == answer.tension == 0:
        return names | {"stuck"}
    if "dsigma_transition" not in answer.limits:
        return names
    turns = answer.limits["dsigma_transition"]
    beyond, unsure = abs(answer.tension) - turns, TIGHT * turns + TINY * answer.f * answer.pressed.p0
    tensions = {"small tension"} if beyond < unsure else set()
    tensions |= {"large tension"} if beyond > -unsure else set()
    room = answer.room
    if mean > room - ROUGH and "large tension" in tensions:
        names |= {"ratchets"}
    return names | tensions if mean < room + ROUGH else names


def loads_at(answer):
    """sf and Qf, by the consistency conditions, that belong to the stick zone found."""
    c, centre = answer.half_width / answer.pressed.a, -abs(answer.n - answer.m) / (2 * answer.pressed.a)
    found = answer.pressed.shape.conditions(1 + centre - c, c, 1 if answer.regime == "small tension" else -1)
    return float(found.sf), float(found.Qf)


def complaints(answer):
    """List the errors of a result."""
    pressed, x, p, dq, m, n = answer.pressed, answer.x, answer.p, answer.dq, answer.m, answer.n
    a, f, unit = pressed.a, answer.f, 2 * answer.f * pressed.p0
    limits, slips = answer.limits, answer.slips or ()
    numbers = (a, pressed.p0, x, p, dq, *answer.levels, *slips, answer.dissipated, *limits.values())
    if not all(np.isfinite(values).all() for values in numbers):
        yield "a value that is not finite"
    if answer.regime not in (allowed := regimes(answer)):
        yield f"{answer.regime} in place of {allowed}"
    if answer.regime == "sliding":
        if (m, n, answer.slips) != (None, None, None):
            yield "a stick zone where the contact slides"
        return
    if not (math.isfinite(m) and math.isfinite(n) and -n <= m <= a * (1 + TIGHT) and abs(n) <= a * (1 + TIGHT)):
        yield f"-n <= m <= a, |n| <= a: m = {m / a} a, n = {n / a} a"
    if "Q_mean" in limits and abs(limits["Q_mean"] / (f * pressed.P) - answer.room) > ROUGH:
        yield f"room for {limits['Q_mean'] / (f * pressed.P)} f P in place of {answer.room}"
    if isinstance(pressed.shape, HertzShape) and "dsigma_transition" in limits:
        Qf = abs(answer.shear) / (2 * f * pressed.P)
        turns = 8 * Qf / (1 + math.sqrt(1 - Qf))
        if abs(limits["dsigma_transition"] / (f * pressed.p0) - turns) > TIGHT * turns + TINY:
            yield f"transition at {limits['dsigma_transition'] / (f * pressed.p0)} f p0 in place of {turns}"
    if answer.regime != "stuck" and answer.half_width > NARROWEST * a and not answer.turns:
        sf, Qf = loads_at(answer)
        off = sf - abs(answer.tension) / (f * pressed.p0), Qf - abs(answer.shear) / (2 * f * pressed.P)
        # 1 - Qf, which determines the zone near sliding, has this rounding error
        digits = np.finfo(float).eps / max(1 - abs(answer.shear) / (2 * f * pressed.P), 1e-15)
        if not (abs(off[0]) <= (TIGHT + digits) * max(sf, 1) and abs(off[1]) <= TIGHT):
            yield f"sf off by {off[0]}, Qf by {off[1]} at the zone found"
    side = np.sign(answer.shear) * np.sign(answer.tension)
    if side * (n - m) > 0 or (side == 0 and abs(n - m) > TIGHT * a):
        yield f"the stick zone on the wrong side: m = {m / a} a, n = {n / a} a"
    more = a * np.random.default_rng(0).uniform(-1, 1, 50)
    for where, pressure, change in ((x, p, dq), (more, *answer.at(more))):
        over = (np.abs(change) - 2 * f * pressure) / unit
        if not (pressure >= 0).all():
            yield f"p = {pressure.min() / pressed.p0} p0"
        if not (over <= (STAGES if answer.turns else TIGHT)).all():
            yield f"|dq| > 2 f p by {over.max()} of 2 f p0 at {where[over.argmax()] / a} a"
    if any(np.any(values != 0) for values in answer.at(a * np.array([-1.1, 1.1]))):
        yield "tractions outside the contact"
    for name, values, force, of in (("P", p, pressed.P, pressed.P), ("dQ", dq, answer.shear, 2 * f * pressed.P)):
        if abs(np.trapezoid(values, x) - force) > ROUGH * of:
            yield f"the resultant is not {name}: {np.trapezoid(values, x) / of} in place of {force / of}"
    if answer.levels:
        q1, q2 = answer.levels
        beyond = max(np.abs(q2 - q1 - dq).max(), (np.abs(q1) - f * p).max(), (np.abs(q2) - f * p).max())
        if beyond > (STAGES if answer.turns else TIGHT) * unit:
            yield "q1 and q2"
    if answer.slips and len(answer.slips[0]):
        where, slip = answer.slips
        if not (np.diff(where) >= 0).all() or np.abs(where).max() > a * (1 + TIGHT):
            yield "points of the slip"
        against = slip * answer.at(where)[1] / unit / (np.abs(slip).max() or 1.0)
        # where slip turns round, what is left of it in the end may be against dq
        if not (answer.turns or (against >= -TIGHT).all()) or answer.dissipated < 0:
            yield f"slip against dq: {against.min()} at {where[against.argmin()] / a} a"


def trials(numbers):
    """(number, kind, complaint) for each of them."""
    for number in numbers:
        try:
            kind, scene = draw(SEED, number)
            for complaint in complaints(Answer(scene)):
                if kind != "lost digits" or "finite" in complaint:
                    yield number, kind, complaint
        except Exception as error:
            yield number, kind_of(number), repr(error)


def slow(first, end, step=1):
    return pytest.param(range(first, end, step), marks=pytest.mark.slow)


# Of 7,000 scenes the first 1,600 showed all that was wrong once, but for scenes that nearly stick: of these more.
# Gradual loads whose slip turns round are followed, which takes seconds a scene: of these the first 48, one of each
# kind on each profile; number 70 once went on for ever. More of them are in test_certificate, in test_gradual_table and
# in ``verify --suite stress``, which has a hundred scenes of another seed.
NEARLY_STUCK = slow(KINDS.index("near-stuck"), 3_750, len(KINDS))
ONE_OF_EACH = len(KINDS) * len(PROFILES)
FOLLOWED = {*range(ONE_OF_EACH), 70}


def tried(number):
    """Whether exact solves the random scene of that number, in less than seconds if others like it are tried."""
    kind = kind_of(number)
    if kind == "out of phase" or number in FOLLOWED or kind == "near-stuck":
        return kind != "out of phase"
    scene = draw(SEED, number).scene
    return (
        scene.slides
        or not loading(contact(scene), scene.friction.f, scene.load.dQ, scene.load.dsigma, bound=2).turns_round
    )


@pytest.mark.parametrize(
    "numbers",
    [
        (*range(9), *range(12, 17), 18, 19),
        *(slow(k, k + 24) for k in range(0, ONE_OF_EACH, 24)),
        slow(ONE_OF_EACH, 400),
        NEARLY_STUCK,
    ],
    ids=str,
)
def test_random_scenes(numbers):
    """Nothing raises, everything is finite, and the paper's inequalities hold."""
    found = list(trials(filter(tried, numbers)))
    assert not found, "\n".join(map(str, found))
