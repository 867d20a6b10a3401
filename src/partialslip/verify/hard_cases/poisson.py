"""Hard cases: poisson's ratio from 0 to 0.4999."""

from collections.abc import Iterator

from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import hard_scene

TITLE = "Poisson's ratio from 0 to 0.4999"
HARD = """
Low-order triangles lock as the material becomes incompressible in plane strain. The body is then too stiff, and
contact widths and tractions are wrong although everything converges. An error estimate from the neighbouring lower
order locks as well and gives no warning. At nu = 0 products with nu vanish, which hides mistakes in them.
"""


def cases() -> Iterator[Case]:
    """Make the cases of the family."""
    for nu in (0.0, 0.49, 0.4999):
        yield Case(f"nu-{nu:g}", hard_scene(f"nu-{nu:g}", nu=nu))
    yield Case("nu-0.4999-quadratic", hard_scene("nu-0.4999-quadratic", nu=0.4999, fem={"order": 2, "accuracy": 1e-3}))
