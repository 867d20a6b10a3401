"""Scenes in a line or two: a cylinder on aluminium, unless told otherwise."""

from partialslip import parse_scene

HERTZ = {"kind": "hertz", "R": 0.01}


def plain(load, f=0.3, material=(72.1e9, 0.33), profile=HERTZ, **tables):
    """A scene under ``load``; ``material`` is a table, or (E, nu)."""
    if isinstance(material, tuple):
        material = dict(zip(("E", "nu"), material, strict=True))
    given = {"material": material, "profile": profile, "friction": {"f": f}, "load": load}
    return parse_scene({"name": "plain", **given, **tables})
