"""Hard cases: coarse, flat, shifted and non-matching meshes."""

from collections.abc import Iterator
from functools import partial

import numpy as np

from partialslip.halfplane.hertz import HertzShape
from partialslip.judge import Bar
from partialslip.verify.case import Case
from partialslip.verify.hard_cases.given_meshes import flat_triangles, one_node, shifted
from partialslip.verify.hard_cases.scenes import family, hard_scene


@family(
    "One node that sticks, none, and one node in contact",
    """
Textbooks show contacts with two hundred nodes, but coarse meshes of large models have one. Without a sticking node
only the force balance fixes the rigid tangential motion, and the matrix of sticking nodes is empty. A single node in
contact gives no area, no slope of the pressure and no end to extrapolate to. The iteration must end, and give a
certified result whose ends are within an element.
""",
)
def few_nodes() -> Iterator[Case]:
    size = 0.05
    reason = f"one mesh of elements of {size:g} a: what is smaller cannot be seen"
    coarse = {key: Bar(bar, reason) for key, bar in (("fem.a", size / 2), ("fem.m", size), ("fem.n", size))}
    for name, c in (("one-stick-node", size / 2), ("no-stick-node", size / 500)):
        loads = HertzShape().conditions(np.array(0.7 - c), np.array(c), np.array(-1))
        scene = hard_scene(name, float(loads.Qf), float(loads.sf), fem={"size": size, "order": 1})
        yield Case(name, scene, ("fem",), coarse)
    reason = "one node knows no half-width: less than its element is all that can be said"
    one = {"fem.a": Bar(16.0, reason), **{f"fem.{key}": Bar(None, reason) for key in ("m", "n", "p", "q", "regime")}}
    scene = hard_scene("one-contact-node", 0.4, 0.0, fem={"order": 1})
    yield Case("one-contact-node", scene, ("fem",), one, meshes=one_node)


@family(
    "Flat triangles of aspect 1e4, meshes off the middle, meshes that do not match",
    """
Flat triangles make the stiffness ill-conditioned. Iterative solvers and tolerances on absolute forces are affected
first. A mesh with nodes at the ends by construction can give the right result for the wrong reason. If the mesh is
shifted by a part of an element, the ends lie anywhere between nodes. If the nodes of the two bodies do not match,
node-to-segment contact fails the patch test, and gaps sampled at the nodes of one side oscillate.
""",
)
def poor_meshes() -> Iterator[Case]:
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
