"""Hard cases: load histories: means, many cycles, varying pressure, slip reversal."""

from collections.abc import Iterator, Mapping
from typing import Any

from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.loading import one_step
from partialslip.verify.case import Case
from partialslip.verify.hard_cases import MANY_CYCLES, family, hard_scene

_SHARE = 0.64  # limit: smaller over larger P
_INSIDE = 0.999  # limit: of the eccentricity at which the end stops slipping
# limit:
_LOADS = {  # Q_f, s_f
    "begins": (0.55, 2.3),
    "ends": (0.55, 4.4),
    "drifts": (0.55, 7.0),
    "opens": (0.55, 9.5),
    "parts": (0.75, 6.0),
}
_ACCURACY: Mapping[str, Any] = {"accuracy": 1e-4}  # limit: ends that have drifted are flat


@family(
    "Mean loads at 0.5, 0.9, 0.98 and 1.02 of the largest in a steady state",
    """
The shear that the first cycles lock in determines q at either load point; its range settles more slowly the nearer the
mean load is to the bound, and beyond it every cycle adds slip. Codes that stop after two or three cycles report a
transient as steady, and a history that is not committed at the end of an increment ratchets below the bound.
""",
)
def mean_loads() -> Iterator[Case]:
    bound = one_step(0.3, 4.0, HertzShape()).mean_load_bound
    for share in (0.5, 0.9, 0.98, 1.02):
        name = f"mean-load-{share:g}"
        yield Case(
            name, hard_scene(name, 0.3, 4.0, Q_mean=share * bound, sigma_mean=3.0, load={"cycles": 60}, fem=MANY_CYCLES)
        )


@family(
    "Two hundred cycles at 0.995 of the largest mean load",
    """
Errors of the steps add up, and a loose friction tolerance gives a little slip in every cycle, which looks like
ratcheting. partialslip skips the remaining cycles once a cycle repeats to rounding.
""",
)
def cycles() -> Iterator[Case]:
    bound = one_step(0.3, 4.0, HertzShape()).mean_load_bound
    scene = hard_scene(
        "cycles-200", 0.3, 4.0, Q_mean=0.995 * bound, sigma_mean=3.0, load={"cycles": 200}, fem=MANY_CYCLES
    )
    yield Case("cycles-200", scene)


@family(
    "Varying P and M: P nearly to zero, dQ = f dP, and a moment at which an end stops slipping",
    """
While the contact grows, each part of the surfaces sticks from the moment at which it touches: slip counted from the
beginning of the step is off by tens of percent in one step, and by a percent in sixty-four. At dQ = f dP, and just
below |dQ| = 2 f dM/a, the ends slip by a hair, so that rounding decides on stick or slip in every step. Codes that keep
the traction of nodes that open, or the place at which they stuck, may never reach a steady cycle.
""",
)
def varying_pressure() -> Iterator[Case]:
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


@family(
    "Slip reversal between the load points: zones that drift, and zones inside that slip",
    """
Between the load points the stick zone drifts and takes points back, or a zone inside it slips the other way for a
while: the tractions at the load points do not show it, and one load step has another m, off by 3e-4 to 0.11 a. At
drifted ends |dq| meets its bound with the power 3/2, so that m read from the traction is poor. The cases lie beside the
borders; two have mean loads, and one a strip of 0.0032 a under a thousand f p0, whose rounding of displacements is a
thousand times as large as elsewhere.
""",
)
def turning() -> Iterator[Case]:
    for name, (Qf, sf) in _LOADS.items():
        yield Case(f"turning-{name}", hard_scene(f"turning-{name}", Qf, sf, fem=_ACCURACY))
    name = "turning-mean"
    yield Case(name, hard_scene(name, *_LOADS["drifts"], Q_mean=0.05, sigma_mean=0.5, fem=MANY_CYCLES))
    yield Case("turning-strip", hard_scene("turning-strip", 0.4, 1000.0, fem=_ACCURACY))
    name = "turning-creeps"
    yield Case(name, hard_scene(name, 0.613, 5.475, Q_mean=0.163, sigma_mean=-1.452, fem=MANY_CYCLES))
