"""Hard cases: loads at the borders of the regimes, constant and in phase."""

from collections.abc import Iterator

import numpy as np

from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.steady import transition
from partialslip.verify.case import Case
from partialslip.verify.hard_cases import MANY_STEPS, PEAKS, family, hard_scene


@family(
    "Near sliding: dQ/(2 f P) = 1 - 1e-3 to 1 - 1e-9",
    """
The stick zone is sqrt(1 - Q_f) of the contact, with shear as little as 1e-9 below the friction bound: with penalties
and regularised laws all of it creeps, and Newton's iteration may switch one last node back and forth. A mesh that does
not resolve the zone is off by an element, and its error estimate is a hundred times too small. partialslip refines
zones of fewer than sixteen elements.
""",
)
def near_sliding() -> Iterator[Case]:
    for power in (3, 6, 9):
        name = f"near-sliding-1e-{power}"
        yield Case(name, hard_scene(name, 1 - 10.0**-power, 2.0))


@family(
    "Near stuck: dQ/(2 f P) = 1e-3 to 1e-9",
    """
Slip is confined to strips at the ends that are narrower than any element: an elastic slip tolerance may give a stuck
contact, or slip everywhere, and two meshes that both miss the strips agree. The last cells average q over a singular
peak, which alone is an error of several percent.
""",
)
def near_stuck() -> Iterator[Case]:
    for power in (3, 6, 9):
        name = f"near-stuck-1e-{power}"
        yield Case(name, hard_scene(name, 10.0**-power, 2 * 10.0**-power), bars=PEAKS)


@family(
    "At the transition from small to large tension, and 1e-9 beside it",
    """
The left slip zone has just disappeared, or is a billionth of the contact wide. The formulas of one regime fail under
loads of the other (root of a negative number, modulus above one), and a search with one branch for each regime jumps
between them. partialslip solves for an unknown that passes smoothly through zero.
""",
)
def at_transition() -> Iterator[Case]:
    at = float(transition(0.5, HertzShape()))
    for name, sf in (("below", at * (1 - 1e-9)), ("at", at), ("above", at * (1 + 1e-9))):
        yield Case(f"transition-{name}", hard_scene(f"transition-{name}", 0.5, sf))


@family(
    "Huge tension: stick zones of 1e-3 to 1e-8 of a, off the middle",
    """
The stick zone shrinks exponentially, off the middle: m + n cancels, elliptic integrals need the complementary modulus,
and a solver that needs a sticking node may fail or report m = n = 0. Under gradual loads the zone moves, with slip
reversal behind it: m of one step, and even of four, is off by 0.02 to 0.06 a. The reference is the exact solution of
gradual loads (m and n of 1e-8 are not judged).
""",
)
def huge_tension() -> Iterator[Case]:
    for power in (3, 5, 8):
        name, c = f"huge-tension-1e-{power}", 10.0**-power
        loads = HertzShape().conditions(np.array(0.7 - c), np.array(c), np.array(-1))  # centre -0.3 a
        yield Case(name, hard_scene(name, float(loads.Qf), float(loads.sf), fem=MANY_STEPS))


@family(
    "No shear: dQ = 0",
    """
Any tension is large tension, and the solution is antisymmetric: quantities divided by dQ, or scaled with it, are lost.
An increment with zero resultant must still be a load step; convergence measured by Q may stop before the first
iteration.
""",
)
def no_shear() -> Iterator[Case]:
    yield Case("no-shear", hard_scene("no-shear", 0.0, 4.0))
    yield Case("no-shear-slight", hard_scene("no-shear-slight", 0.0, 1e-6), bars=PEAKS)


@family(
    "No tension: dsigma = 0",
    """
The symmetric case of Cattaneo and Mindlin: both ends of the stick zone move at once, and pairs of nodes change side in
the same iteration. Rules that release one node at a time break the symmetry for good.
""",
)
def no_tension() -> Iterator[Case]:
    yield Case("no-tension", hard_scene("no-tension", 0.6, 0.0))


@family(
    "The stick zone beside the centre",
    """
x = 0 slips. Formulas that take the sign of the traction from the sign of x fail, and so do meshes that are fine only in
the middle and at the ends, and searches that start with a centred zone.
""",
)
def beside() -> Iterator[Case]:
    yield Case("beside-small", hard_scene("beside-small", 0.91, 4.8))
    yield Case("beside-large", hard_scene("beside-large", 0.6, 10.0))


@family(
    "A coefficient of friction that varies along the contact",
    """
The bound f(x) p has kinks: readings of the end of the stick zone, and elements, that reach across a kink are off. The
largest or the mean f in place of f(x) moves both ends. A deep dip of f lets points inside slip first: more than one
zone sticks, and formulas with one zone give tractions beyond the bound.
""",
)
def uneven_friction() -> Iterator[Case]:
    for name, f, x, Qf, sf in (
        ("slope", (0.6, 0.4), (-1.0, 1.0), 0.6, 1.5),
        ("step", (0.6, 0.6, 0.4, 0.4), (-1.0, 0.57, 0.58, 1.0), 0.6, 0.0),
        ("dip", (0.6, 0.3, 0.6), (-1.0, 0.0, 1.0), 0.5, 1.0),
        ("slip-turns-round", (0.55, 0.45), (-1.0, 1.0), 0.55, 7.0),
    ):
        scene = hard_scene(f"uneven-friction-{name}", Qf, sf)
        half_width = scene.load.a or 0.0
        friction = {"f": f, "x": [half_width * place for place in x]}
        yield Case(scene.name, scene.replace(friction=friction))


@family(
    "Mirrored loads",
    """
If Q changes sign and sigma does not, the stick zone moves to the other side: this shows a sign that is right in one
half of the contact only, or a tension in the wrong direction.
""",
)
def mirrored() -> Iterator[Case]:
    for name, Qf, sf in (("mirrored-small", -0.75, 2.4), ("mirrored-large", -0.4, 4.03)):
        yield Case(name, hard_scene(name, Qf, sf))
