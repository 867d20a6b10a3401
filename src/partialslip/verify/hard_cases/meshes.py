"""Hard cases: coarse, flat, shifted and non-matching meshes."""

from collections.abc import Iterator
from functools import partial

import numpy as np

from partialslip.halfplane.contact import contact
from partialslip.halfplane.hertz import HertzShape
from partialslip.run.judge import Bar
from partialslip.scene import Scene
from partialslip.tools.arrays import Array
from partialslip.verify.case import Case
from partialslip.verify.hard_cases import family, hard_scene
from partialslip_meshes.blocks import block
from partialslip_meshes.mesh import Mesh

_WIDTH = 16.0  # limit: width of the blocks, in contact half-widths
_ALONG = 0.05  # limit: element size along the contact, in contact half-widths


@family(
    "One node that sticks, none, and one node in contact",
    """
Without a sticking node only the force balance fixes the rigid tangential motion, and the matrix of sticking nodes is
empty. A single node in contact gives no area, no slope of the pressure and no end to extrapolate to. The iteration must
end with a certified result whose ends are within an element.
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
Flat triangles make the stiffness ill-conditioned, and iterative solvers and tolerances on absolute forces fail first. A
mesh with nodes at the ends of the zones can be right for the wrong reason; on a shifted mesh the ends lie anywhere
between nodes. If the nodes of the bodies do not match, node-to-segment contact fails the patch test, and gaps sampled
at the nodes of one side oscillate.
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


def one_node(scene: Scene) -> list[Mesh]:
    """Return a mesh for ``scene`` with elements so large that one vertex is in contact."""
    a = contact(scene).a
    return [block(16 * _WIDTH * a, (-32 * a, 32 * a), {0.0: 16 * a}, 0.7)]


def shifted(scene: Scene, share: float) -> list[Mesh]:
    """Return a mesh for ``scene`` of equal elements along the contact, shifted by ``share`` of their size."""
    a = contact(scene).a
    mesh = block(_WIDTH * a, (-1.5 * a, 1.5 * a), {}, 0.3, along=_ALONG * a)
    return [Mesh(mesh.points + np.array([share * _ALONG * a, 0.0]), mesh.triangles, mesh.lines)]


def flat_triangles(scene: Scene, aspect: float) -> list[Mesh]:
    """Return a grid for ``scene`` with equal columns along the contact; cells of the first row are ``aspect`` times
    wider than high."""
    a = contact(scene).a
    middle = np.linspace(-1.5, 1.5, round(3 / _ALONG) + 1)
    beyond = 1.5 + _growing(_ALONG, _WIDTH - 1.5)
    x, y = np.concatenate([-beyond[::-1], middle, beyond]), np.append(0.0, -_growing(_ALONG / aspect, _WIDTH))
    columns, rows = len(x), len(y)
    node = np.arange(rows * columns).reshape(rows, columns)  # from the contact line down
    upper_left, upper_right = node[:-1, :-1].ravel(), node[:-1, 1:].ravel()
    lower_left, lower_right = node[1:, :-1].ravel(), node[1:, 1:].ravel()
    triangles = np.vstack(
        [
            np.column_stack([lower_left, lower_right, upper_right]),
            np.column_stack([lower_left, upper_right, upper_left]),
        ]
    )
    top, outer = np.column_stack([node[0, :-1], node[0, 1:]]), len(beyond)
    lines = {
        "contact": top[outer:-outer],
        "face": np.vstack([top[:outer], top[-outer:]]),
        "back": np.column_stack([node[-1, :-1], node[-1, 1:]]),
        "left": np.column_stack([node[:-1, 0], node[1:, 0]]),
        "right": np.column_stack([node[:-1, -1], node[1:, -1]]),
    }
    return [Mesh(a * np.column_stack([np.tile(x, rows), np.repeat(y, columns)]), triangles, lines)]


def _growing(first: float, end: float) -> Array:
    """Return distances up to ``end``; the first step is about ``first``, each next step 1.5 times the previous."""
    count = int(np.ceil(np.log1p(end / first / 2) / np.log(1.5)))
    return (1.5 ** np.arange(1.0, count + 1) - 1) * end / (1.5**count - 1)
