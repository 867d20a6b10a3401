"""Hard cases: materials, friction and profiles."""

from collections.abc import Iterator, Mapping
from typing import Any

from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import MANY_CYCLES, family, hard_scene

# limit: dissimilar bodies with the mean compliance of the other cases, whose Dundurs' constant beta is 0.3
_UNLIKE: Mapping[str, Any] = {"upper": {"E": 210e9, "nu": 0.3}, "lower": {"E": 48e9, "nu": 0.1}}


@family(
    "Poisson's ratio from 0 to 0.4999",
    """
Low-order triangles lock as plane strain becomes incompressible: too stiff, with wrong widths and tractions although
everything converges. An error estimate from the neighbouring lower order locks, too. At nu = 0 products with nu vanish,
which hides mistakes in them.
""",
)
def poisson() -> Iterator[Case]:
    for nu in (0.0, 0.49, 0.4999):
        yield Case(f"nu-{nu:g}", hard_scene(f"nu-{nu:g}", nu=nu))
    yield Case("nu-0.4999-quadratic", hard_scene("nu-0.4999-quadratic", nu=0.4999, fem={"order": 2, "accuracy": 1e-3}))


@family(
    "Coefficients of friction of 1e-3 and 10",
    """
Between similar bodies, results scaled by f do not depend on f: a difference between the cases shows a bound or a
tolerance in the wrong units. At 1e-3, shear is not solved if its tolerance has the scale of the pressure. A large f
makes fixed-point iterations between pressure and shear diverge.
""",
)
def friction() -> Iterator[Case]:
    for f in (1e-3, 10.0):
        yield Case(f"friction-{f:g}", hard_scene(f"friction-{f:g}", f=f))


@family(
    "Flat and rounded punches with b/a up to 0.999",
    """
The pressure has two logarithmic kinks, where quadrature must split, and a peak in a corner a thousandth of the contact
wide, where it falls to zero like a square root. A uniform mesh misses the peak, its force and the slip zone in it. The
width of the corner is a difference of nearly equal numbers.
""",
)
def sharp() -> Iterator[Case]:
    for flat in (0.9, 0.99, 0.999):
        yield Case(f"sharp-{flat:g}", hard_scene(f"sharp-{flat:g}", 0.4, 4.0, flat=flat))


@family(
    "Dissimilar bodies that are pressed together from a flat",
    """
Pressing dissimilar bodies moves their surfaces along x, and points lock in shear as they come into contact. A flat with
round corners begins with the whole flat at once, unlike a cylinder, so that q1 depends on the number of load steps
(eight: off by 0.6) and the gap beside the flat on friction (by 6 % in the second case). March is the reference (fem
shares its growth of the contact, no mesh).
""",
)
def unlike_punches() -> Iterator[Case]:
    for f, flat in ((0.1, 0.9), (0.67, 0.5), (0.3, 0.1)):
        name = f"unlike-flat-{flat:g}"
        scene = hard_scene(name, 0.4, 0.5, f=f, flat=flat, fem=MANY_CYCLES, material=_UNLIKE)
        yield Case(name, scene, ("march", "fem"), reference="march")
