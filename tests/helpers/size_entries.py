"""Artificial entries of a study of sizes, and a scene of small blocks."""

import made
import msgspec

import partialslip
from partialslip.study.size.case import Sized

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


def entries(name, found, failed=(), left=None, rig=0.0):
    """Return solved cases along the axis ``name``: differences of a by size, and what is left with equivalent
    half-planes, text where there are none; and failed cases."""
    none = {"p_max": 1.0, "m": None, "n": None}
    solved = []
    for at, off in found.items():
        beside = (left or {}).get(at)
        more = {"refused": beside} if isinstance(beside, str) else {"left": beside, "rig": rig}
        fem = {"a": 1 + off, "estimate": {"a": 3e-5}, "counts": {"dofs": 100}, **none}
        solved.append(sized({name: at, "accuracy": 1.0}, fem=fem, exact={"a": 1.0, **none}, **more))
    return solved + [Sized(labels={name: at, "accuracy": 1.0}, error="too narrow") for at in failed]
