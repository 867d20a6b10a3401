"""Hard cases: one node that sticks, none, and one node in contact."""

from collections.abc import Iterator

import numpy as np

from partialslip.halfplane.hertz import Hertz
from partialslip.judge import Bar
from partialslip.verify.case import Case
from partialslip.verify.hard_cases.given_meshes import one_node
from partialslip.verify.hard_cases.scenes import hard_scene

TITLE = "One node that sticks, none, and one node in contact"
HARD = """
Textbooks show contacts with two hundred nodes, but coarse meshes of large models have one. Without a sticking node
only the force balance fixes the rigid tangential motion, and the matrix of sticking nodes is empty. A single node in
contact gives no area, no slope of the pressure and no end to extrapolate to. The iteration must end, and give a
certified result whose ends are within an element.
"""


def cases() -> Iterator[Case]:
    """Make the cases of the family."""
    size = 0.05
    reason = f"one mesh of elements of {size:g} a: what is smaller cannot be seen"
    coarse = {key: Bar(bar, reason) for key, bar in (("fem.a", size / 2), ("fem.m", size), ("fem.n", size))}
    for name, c in (("one-stick-node", size / 2), ("no-stick-node", size / 500)):
        loads = Hertz().conditions(np.array(0.7 - c), np.array(c), np.array(-1))
        scene = hard_scene(name, float(loads.Qf), float(loads.sf), fem={"size": size, "order": 1})
        yield Case(name, scene, ("fem",), coarse)
    reason = "one node knows no half-width: less than its element is all that can be said"
    one = {"fem.a": Bar(16.0, reason), **{f"fem.{key}": Bar(None, reason) for key in ("m", "n", "p", "q", "regime")}}
    scene = hard_scene("one-contact-node", 0.4, 0.0, fem={"order": 1})
    yield Case("one-contact-node", scene, ("fem",), one, meshes=one_node)
