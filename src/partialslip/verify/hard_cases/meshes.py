"""Hard cases: flat triangles of aspect 1e4, meshes off the middle, meshes that do not match."""

from collections.abc import Iterator
from functools import partial

from partialslip.judge import Bar
from partialslip.verify.case import Case
from partialslip.verify.hard_cases.given_meshes import flat_triangles, shifted
from partialslip.verify.hard_cases.scenes import hard_scene

TITLE = "Flat triangles of aspect 1e4, meshes off the middle, meshes that do not match"
HARD = """
Flat triangles make the stiffness ill-conditioned. Iterative solvers and tolerances on absolute forces are affected
first. A mesh with nodes at the ends by construction can give the right result for the wrong reason. If the mesh is
shifted by a part of an element, the ends lie anywhere between nodes. If the nodes of the two bodies do not match,
node-to-segment contact fails the patch test, and gaps sampled at the nodes of one side oscillate.
"""


def cases() -> Iterator[Case]:
    """Make the cases of the family."""
    reason = "even elements of 0.05 a, fourth order, the ends anywhere in them"
    bars = {f"fem.{key}": Bar(1e-3, reason) for key in "amn"} | {
        f"fem.{key}": Bar(bar, reason) for key, bar in (("p", 1e-2), ("q", 2e-2))
    }
    yield Case("aspect-1e4", hard_scene("aspect-1e4"), ("fem",), bars, meshes=partial(flat_triangles, aspect=1e4))
    for share in (0.25, 0.5):
        name = f"shifted-{share:g}h"
        yield Case(name, hard_scene(name), ("fem",), bars, meshes=partial(shifted, share=share))
    for size in (0.7, 1.6):
        name = f"non-matching-{size:g}"
        yield Case(name, hard_scene(name, fem={"lower_size": size, "accuracy": 1e-4}), ("fem",))
