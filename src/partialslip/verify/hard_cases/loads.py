"""Hard cases: loads at the borders of the regimes, constant and in phase."""

from collections.abc import Iterator

import numpy as np

from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.steady import transition
from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import MANY_STEPS, PEAKS, family, hard_scene


@family(
    "Near sliding: dQ/(2 f P) = 1 - 1e-3 to 1 - 1e-9",
    """
The stick zone is sqrt(1 - Q_f) of the contact. Inside it the shear is below the friction bound by a part in 1e9 of
the bound, which is as large as the tolerance of many codes. With a penalty or a regularised law the whole contact
creeps. The code may find no stick zone, or a stick zone as wide as its elastic slip. Newton's iteration on stick
and slip flags may switch one last node back and forth. A mesh that does not resolve the zone gives ends that are
off by an element. The error estimate assumes resolved zones and is then a hundred times too small. partialslip
therefore refines a zone of fewer than sixteen elements before it accepts the ends.
""",
)
def near_sliding() -> Iterator[Case]:
    for power in (3, 6, 9):
        name = f"near-sliding-1e-{power}"
        yield Case(name, hard_scene(name, 1 - 10.0**-power, 2.0))


@family(
    "Near stuck: dQ/(2 f P) = 1e-3 to 1e-9",
    """
Slip is confined to strips at the ends that are narrower than any element. The traction beside the strips is the
adhered one, which is infinite at the ends. Codes with an elastic slip tolerance may report that the contact is
stuck, or that it slips a little everywhere. Two meshes that both miss the strips agree with each other, which is no
sign of convergence. The ends of the stick zone are accurate, because they lie next to the ends of the contact. But
q in the last elements is a mean over a peak that the mesh does not resolve. The reference of the relative norm is
as small as the load, so this mean alone causes an error of several percent.
""",
)
def near_stuck() -> Iterator[Case]:
    for power in (3, 6, 9):
        name = f"near-stuck-1e-{power}"
        yield Case(name, hard_scene(name, 10.0**-power, 2 * 10.0**-power), bars=PEAKS)


@family(
    "At the transition from small to large tension, and 1e-9 beside it",
    """
The left slip zone has just disappeared, or is a billionth of the contact wide. Its sign changes from one side of the
transition to the other. The formulas of one regime fail under the loads of the other regime: the root of a negative
number, or a modulus above one. A search with one branch for each regime may jump between the branches. A code that
compares floating-point loads to name the regime may flip between the names. partialslip solves for an unknown that
passes smoothly through zero.
""",
)
def at_transition() -> Iterator[Case]:
    at = float(transition(0.5, HertzShape()))
    for name, sf in (("below", at * (1 - 1e-9)), ("at", at), ("above", at * (1 + 1e-9))):
        yield Case(f"transition-{name}", hard_scene(f"transition-{name}", 0.5, sf))


@family(
    "Huge tension: stick zones of 1e-3 to 1e-8 of a, off the middle",
    """
The stick zone never vanishes. It shrinks exponentially, but not to the middle of the contact. The sum m + n
cancels. Elliptic integrals whose modulus tends to one lose all digits if they take the modulus instead of the
complementary modulus. On a mesh the zone is smaller than the distance of two nodes. Solvers that need one sticking
node to fix the rigid motion may get a singular matrix, cycle, or report m = n = 0 at the middle. Under gradual
loads the tiny zone moves along the contact, and slip reverses behind it. One step, and even four, end with the
tractions of a single step, and m of gradual loads differs by 0.02 to 0.06 a. March and fem follow events. The exact
solution of gradual loads is the reference, except for 1e-8, where m and n are not judged. The accuracy is 1e-2.
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
Without a change of Q any tension is large tension: the transition is at zero. The solution is antisymmetric.
Quantities that are divided by dQ, or scaled with dQ, are lost. An increment with zero resultant must still be a load
step. A code that measures convergence by Q may stop before the first iteration.
""",
)
def no_shear() -> Iterator[Case]:
    yield Case("no-shear", hard_scene("no-shear", 0.0, 4.0))
    yield Case("no-shear-slight", hard_scene("no-shear-slight", 0.0, 1e-6), bars=PEAKS)


@family(
    "No tension: dsigma = 0",
    """
This is the case of Cattaneo and Mindlin. It is symmetric, so both ends of the stick zone move at the same time, and
pairs of nodes change side in the same iteration. Rules that release one node at a time break the symmetry, and the
solution may stay asymmetric.
""",
)
def no_tension() -> Iterator[Case]:
    yield Case("no-tension", hard_scene("no-tension", 0.6, 0.0))


@family(
    "The stick zone beside the centre",
    """
x = 0 slips. Formulas that take the sign of the traction from the sign of x, as printed, are wrong here. A mesh that
is fine only in the middle and at the ends is wrong, too, and so is a search that starts with a centred zone.
""",
)
def beside() -> Iterator[Case]:
    yield Case("beside-small", hard_scene("beside-small", 0.91, 4.8))
    yield Case("beside-large", hard_scene("beside-large", 0.6, 10.0))


@family(
    "A coefficient of friction that varies along the contact",
    """
The bound f(x) p is not the pressure under any profile. It has kinks where f has them, beside or inside the slip
zones. A reading of the end of the stick zone that reaches across a kink is off, and so is an element with a kink
inside. The largest f, or its mean, in place of f(x) moves both ends. Where f steps down, the end of the stick zone
hardly moves under other loads. Where f dips in the middle, points there slip before the ends do if the dip is deep:
more than one zone sticks, and formulas with one zone give tractions beyond the bound.
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
If Q changes sign and sigma does not, the stick zone moves to the other side. These cases test signs under mirrored
loads: one that is right in only one half of the contact, or a tension applied in the wrong direction. Other scenes
detect them, too.
""",
)
def mirrored() -> Iterator[Case]:
    for name, Qf, sf in (("mirrored-small", -0.75, 2.4), ("mirrored-large", -0.4, 4.03)):
        yield Case(name, hard_scene(name, Qf, sf))
