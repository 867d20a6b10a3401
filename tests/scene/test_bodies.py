"""Finite bodies in a scene file: contradictory fields are refused in one line."""

import numpy as np
import pytest
from refusing import line_of

from partialslip import load_scene
from partialslip.scene import Bodies

BLOCK = "width=0.04, height=0.02"  # a = 1 mm, R = 50 mm


@pytest.mark.parametrize(
    ("body", "why"),
    [
        ("", "width: missing"),
        ("width=1.0", "height: missing"),
        ("width=0, height=1", "width = 0: must be > 0"),
        ("width=1, height='1'", "height = '1': must be a number, not a string"),
        (
            f"{BLOCK}, colour=1",
            "colour: unknown key; known are kind, width, height, holder, mesh, unit, body, groups, support, "
            "pivot_height, pulled, right_grip",
        ),
        (f"kind='cylinder', {BLOCK}", "kind = 'cylinder': must be one of 'block', 'pad'"),
        (f"support='glued', {BLOCK}", "support = 'glued': must be one of 'clamped', 'roller', 'sides', 'pivot'"),
        (f"pulled=1, {BLOCK}", "pulled = 1: must be true or false, not a whole number"),
        (f"pulled=true, {BLOCK}", "pulled = true: must have support 'roller' or 'sides', not 'clamped'"),
        (f"holder={{width=1}}, {BLOCK}", "holder.height: missing"),
        (f"holder={{width=1, height=1, x=1}}, {BLOCK}", "holder.x: unknown key; known are width, height"),
        (f"holder=1, {BLOCK}", "holder = 1: must be a table, not a whole number"),
        (f"holder={{width=1, height=1e-5}}, {BLOCK}", "holder.height = 1e-05: must be 0.0001 to 10000 times the width"),
        ("width=1, height=1e5", "height = 100000.0: must be 0.0001 to 10000 times the width, 1"),
        (f"unit=1e-3, {BLOCK}", "unit = 0.001: must be given only together with mesh"),
        (f"body='PAD', {BLOCK}", "body = 'PAD': must be given only together with mesh"),
        ("mesh='a.msh', groups={kontakt=1}", "groups.kontakt: unknown key; did you mean 'contact'?"),
        ("mesh=''", "mesh = '': must be a name"),
        ("mesh=3", "mesh = 3: must be a string, not a whole number"),
        ("mesh='a.msh', width=1", "width: must not be given together with mesh"),
        ("mesh='a.msh', holder={width=1, height=1}", "holder: must not be given together with mesh"),
        ("kind='pad', width=0.0901, height=0.1", "width = 0.0901: must be <= 0.09"),
        ("kind='pad', width=0.08, height=0.02", "height = 0.02: must be > 0.0222222 m, as the face recedes by 0.02 m"),
    ],
)
def test_broken_body(body, why):
    assert line_of(load_scene, "hertz-shear", [f"bodies.lower={{{body}}}"]).startswith(
        f"hertz-shear: bodies.lower.{why}"
    )


@pytest.mark.parametrize(
    ("settings", "why"),
    [
        (["bodies=3"], "bodies = 3: must be a table, not a whole number"),
        (["bodies.middle=3"], "bodies.middle: unknown key; known are upper, lower"),
        (["bodies.upper=3"], "bodies.upper = 3: must be a table, not a whole number"),
        ([f"bodies.upper={{pulled=true, support='sides', {BLOCK}}}"], "bodies.upper.pulled = true: must be false"),
        (
            [f"bodies.{name}={{kind='pad', {BLOCK}}}" for name in ("upper", "lower")],
            "bodies.lower.kind = 'pad': must be 'block'; bodies.upper is a pad",
        ),
    ],
)
def test_bodies_that_do_not_go_together(settings, why):
    assert line_of(load_scene, "hertz-shear", settings).startswith(f"hertz-shear: {why}")


def test_names_and_bodies():
    scene = load_scene("hertz-shear", [f"bodies.upper={{kind='pad', {BLOCK}}}"])
    assert [name for name, _ in scene.bodies] == ["bodies.upper"]
    assert scene.bodies.pad == "bodies.upper"
    assert scene.finite
    assert Bodies().pad is None


@pytest.mark.parametrize("name", ["hertz-shear", "flat-rounded"])
def test_the_face_of_a_pad_is_round(name):
    """(x - b)^2 + (R - y)^2 = R^2 beyond the flat, up to the widest pad; the gap equals the parabola up to terms of
    the square of the slope."""
    profile = load_scene(name).profile
    b = getattr(profile, "b", 0.0)
    x = b + profile.R * np.array([1e-9, 1e-3, 0.1, 0.5, 0.9])
    y = profile.face_at(-x)
    assert (x - b) ** 2 + (profile.R - y) ** 2 == pytest.approx(profile.R**2, rel=1e-12)
    assert y[:2] == pytest.approx(profile.gap_at(x[:2]), rel=1e-6)
    assert profile.widest == pytest.approx(x[-1])
