"""Artificial entries of a study of sizes, made-up sizes, and a scene of small blocks."""

import made
import msgspec
import numpy as np

import partialslip
from partialslip.study.size.case import Sized
from partialslip.study.size.law import Sizes
from partialslip.study.size.sizes import DIFFERENCES

BLOCKS = {"upper": {"width": 1.0, "height": 1.0}, "lower": {"width": 1.0, "height": 1.0}}


def scene(**fem):
    data = {
        "name": "blocks", "material": {"E": 72e9, "nu": 0.3}, "profile": {"kind": "hertz", "R": 0.02},
        "friction": {"f": 0.4}, "load": {"a": 1e-3, "Q": [-3e4, 3e4], "sigma": [-3e7, 3e7]}, "bodies": BLOCKS,
        "fem": {"accuracy": 1e-3, **fem},
    }  # fmt: skip
    return partialslip.parse_scene(data)


def sized(labels, left=None, rig=0.0, refused="", **methods):
    """Return a solved case; ``left`` is the difference of equivalent half-planes in a, and ``rig`` the rig's error."""
    solved = made.solved(scene(), labels, {"p": None, "q": None}, **methods)
    more = {}
    if left is not None:
        errors = msgspec.structs.replace(solved.run.comparison["fem"], errors={"a": left, "p": None})
        method = made.method(shares={"rig": {"a": rig}})
        more["equivalent"] = msgspec.structs.replace(
            solved.run, comparison={"equivalent": errors}, methods={"equivalent": method}
        )
    return Sized(labels=labels, run=solved.run, refused=refused, **more)


NONE = {"p_max": 1.0, "m": None, "n": None}


def on_mesh(labels, a, dofs=100, accuracy=1.0):
    """Return a solved case whose half-width is ``a`` on a mesh of so many unknowns, without an estimate; exactly 1."""
    fem = {"a": a, "estimate": {}, "counts": {"dofs": dofs}, **NONE}
    return sized(labels | {"accuracy": accuracy}, fem=fem, exact={"a": 1.0, **NONE})


def entries(name, found, failed=(), left=None, rig=0.0, remains=0.0):
    """Return solved cases along the axis ``name``: differences of a by size, and what is left with equivalent
    half-planes, text where there are none; the case that stands for an infinite size, with what ``remains`` of the
    difference, unless None; and failed cases."""
    if found and remains is not None:
        far = 100 * max(found)
        found, left = found | {far: remains}, left and left | {far: 0.0}
    solved = []
    for at, off in found.items():
        beside = (left or {}).get(at)
        more = {"refused": beside} if isinstance(beside, str) else {"left": beside, "rig": rig}
        fem = {"a": 1 + off, "estimate": {"a": 3e-5}, "counts": {"dofs": 100}, **NONE}
        solved.append(sized({name: at, "accuracy": 1.0}, fem=fem, exact={"a": 1.0, **NONE}, **more))
    return solved + [Sized(labels={name: at, "accuracy": 1.0}, error="too narrow") for at in failed]


X = 4.0 * 2.0 ** np.arange(6)  # up to 128


def made_sizes(off, mesh=0.0, x=X, remains=0.0, error=0.0):
    """Return sizes with one change and one error of the mesh for all quantities; and what remains at an infinite size,
    with its error, unless None."""
    off, mesh = (np.broadcast_to(each, x.shape).astype(float) for each in (off, mesh))
    limit = np.inf
    if remains is not None:
        limit = 100 * x[-1]
        x, off, mesh = np.append(x, limit), np.append(off, remains), np.append(mesh, error)
    return Sizes("W", x, dict.fromkeys(DIFFERENCES, off), dict.fromkeys(DIFFERENCES, mesh), limit=limit)
