"""Hard cases: materials, friction and profiles."""

from collections.abc import Iterator, Mapping
from typing import Any

from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import MANY_CYCLES, family, hard_scene

# limit: unlike bodies with the mean compliance of the other cases, whose Dundurs' constant beta is 0.3
_UNLIKE: Mapping[str, Any] = {"upper": {"E": 210e9, "nu": 0.3}, "lower": {"E": 48e9, "nu": 0.1}}


@family(
    "Poisson's ratio from 0 to 0.4999",
    """
Low-order triangles lock as the material becomes incompressible in plane strain. The body is then too stiff, and
contact widths and tractions are wrong although everything converges. An error estimate from the neighbouring lower
order locks as well and gives no warning. At nu = 0 products with nu vanish, which hides mistakes in them.
""",
)
def poisson() -> Iterator[Case]:
    for nu in (0.0, 0.49, 0.4999):
        yield Case(f"nu-{nu:g}", hard_scene(f"nu-{nu:g}", nu=nu))
    yield Case("nu-0.4999-quadratic", hard_scene("nu-0.4999-quadratic", nu=0.4999, fem={"order": 2, "accuracy": 1e-3}))


@family(
    "Coefficients of friction of 1e-3 and 10",
    """
Between similar bodies, results scaled by f do not depend on f. A difference between the two cases therefore shows a
bound or a tolerance in the wrong units. At 1e-3, shear tractions are not solved at all if their tolerance has the
scale of the pressure. A large f makes fixed-point iterations between pressure and shear diverge, although similar
bodies need no such iteration.
""",
)
def friction() -> Iterator[Case]:
    for f in (1e-3, 10.0):
        yield Case(f"friction-{f:g}", hard_scene(f"friction-{f:g}", f=f))


@family(
    "Flat and rounded punches with b/a up to 0.999",
    """
The pressure has two logarithmic kinks, and a peak in a corner a thousandth of the contact wide. In the corner it
falls to zero like a square root. A uniform mesh along the contact misses the peak, the force in it and the slip zone
in it. Quadrature that does not split at the kinks stalls. The width of the corner is a difference of nearly equal
numbers.
""",
)
def sharp() -> Iterator[Case]:
    for flat in (0.9, 0.99, 0.999):
        yield Case(f"sharp-{flat:g}", hard_scene(f"sharp-{flat:g}", 0.4, 4.0, flat=flat))


@family(
    "Unlike bodies that are pressed together from a flat",
    """
Between unlike bodies pressing alone moves the surfaces along x, friction resists, and points lock in shear as they
come into contact. The contact of a cylinder grows at one and the same ratio of stick zone to contact, which some codes
use. That of a flat with round corners does not: it begins with the whole flat at once. Load steps then lock in shear
that depends on their number: eight left q1 off by 0.6. What the locked in shear opens beside the flat differs from
what it is without friction, by 6 % in the second case. In the first one friction is weak and the flat long, in the
last one the flat is short. There is no exact solution: the march is the reference, which shares with finite elements
how the contact grows, but no mesh. The accuracy is 1e-3.
""",
)
def unlike_punches() -> Iterator[Case]:
    for f, flat in ((0.1, 0.9), (0.67, 0.5), (0.3, 0.1)):
        name = f"unlike-flat-{flat:g}"
        scene = hard_scene(name, 0.4, 0.5, f=f, flat=flat, fem=MANY_CYCLES, material=_UNLIKE)
        yield Case(name, scene, ("march", "fem"), reference="march")
