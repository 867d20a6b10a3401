"""Hard cases: P nearly to zero, dQ = f dP, and a moment at which an end stops slipping."""

from collections.abc import Iterator

from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import MANY_CYCLES, hard_scene

TITLE = "Varying P and M: P nearly to zero, dQ = f dP, and a moment at which an end stops slipping"
HARD = """
Where surfaces stick while the contact grows, each part of the surfaces sticks from the moment at which it touches. A
code that lets slip count from the beginning of the step errs by tens of percent in one step, and by a percent in
sixty-four. If P falls to a thousandth, nearly all of the contact is made anew in every cycle. At dQ = f dP the ends are
just about to slip: rounding decides on stick or slip in every step. A moment moves the contact to and fro: it leaves at
one end while it comes at the other, and just below |dQ| = 2 f dM/a both ends slip by a hair. Codes that keep the
traction of nodes that open, or the place at which they stuck, never reach a steady cycle. The accuracy is 1e-3: the
pressure is solved anew in every step.
"""
_SHARE = 0.64  # smaller over larger P
_INSIDE = 0.999  # of the eccentricity at which the end stops slipping


def cases() -> Iterator[Case]:
    """Make the cases of the family."""
    constant = hard_scene("constant")
    P, limit, a = constant.P, constant.friction.f * constant.P, 1e-3

    def case(name: str, **load: object) -> Case:
        return Case(name, hard_scene(name, load={"a": None, "cycles": 3, **load}, fem=MANY_CYCLES))

    still = [0.0, 0.0]
    yield case("varying-near-zero", P=[1e-3 * P, P], Q=[0.0, 0.4 * limit], sigma=still)
    yield case("varying-limit", P=[_SHARE * P, P], Q=[0.0, (1 - _SHARE) * limit], sigma=still)
    # at |dQ| = 2 f dM/a, dM = 2 e P, the increments of q at both ends are f times those of p
    Qf = 0.2
    e = _INSIDE * a * Qf / 2
    yield case("varying-moment", P=P, e=[-e, e], Q=[-Qf * limit, Qf * limit], sigma=still)
