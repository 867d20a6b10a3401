"""Hard cases: materials, friction and profiles."""

from collections.abc import Iterator

from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import family, hard_scene


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
