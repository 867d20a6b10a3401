"""Finite bodies in a scene file: contradictory fields are refused in one line."""

import numpy as np
import pytest

from partialslip import load_scene
from partialslip.scene import Bodies

BLOCK = "width=0.04, height=0.02"  # a = 1 mm, R = 50 mm


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
