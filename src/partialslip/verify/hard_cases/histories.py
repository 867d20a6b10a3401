"""Hard cases: load histories: means, many cycles, varying pressure, slip that turns round."""

from collections.abc import Iterator, Mapping
from typing import Any

from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.loading import one_step
from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import MANY_CYCLES, family, hard_scene

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
The shear that the first cycles lock in determines q at either load point. The range of q tends to the steady range,
more slowly the nearer the mean load is to the bound. Beyond the bound every cycle adds slip. Codes that stop after
the usual two or three cycles may report a transient as steady. Codes that read the stick zone from the flags of one
instant may find it far too small. If the history is not committed at the end of an increment, the contact ratchets
below the bound, too. The accuracy is 1e-3: the first cycles take many steps.
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
Errors of the steps add up. A loose friction tolerance gives a little slip in every cycle, which looks like
ratcheting. A cycle that repeats to rounding is the steady state, and partialslip skips the remaining cycles. The
accuracy is 1e-3.
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
Where surfaces stick while the contact grows, each part of the surfaces sticks from the moment at which it touches.
A code that lets slip count from the beginning of the step errs by tens of percent in one step, and by a percent in
sixty-four. If P falls to a thousandth, nearly all of the contact is made anew in every cycle. At dQ = f dP the ends
are just about to slip: rounding decides on stick or slip in every step. A moment moves the contact to and fro: it
leaves at one end while it comes at the other, and just below |dQ| = 2 f dM/a both ends slip by a hair. Codes that
keep the traction of nodes that open, or the place at which they stuck, may never reach a steady cycle. The accuracy
is 1e-3: the pressure is solved anew in every step.
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
    "Slip that turns round on the way: zones that drift, and zones inside that slip",
    """
Between the load points the stick zone drifts: it takes points back on one side that have slipped, and then leaves
them again, or a part of it slips the other way for a while and sticks again. The tractions at the load points do
not show it. One load step ends with another m, off by 3e-4 to 0.11 a in these cases. The ends of the stick zone
that have drifted are flat: |dq| meets its bound with the power 3/2, so that m read from the traction is poor. The
cases are beside the borders: where the drift begins, where it ends before the loads do, and where a zone inside
begins to slip. In one case loads with a mean lock in shear of half of the bound before the cycle is steady. In
another points beside those that never slip creep for some cycles before they stick, and the kink of q is where the
creeping ones end. The accuracy of both is 1e-3, as cycles are many. Under tension of a thousand f p0 all points
slip but a strip of 0.0032 a, which sweeps over half of the contact, node by node. The rounding of displacements is
a thousand times as large as elsewhere: a cycle that repeats must not be taken for one that changes.
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
