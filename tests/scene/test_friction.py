"""The coefficient of friction of a scene: one number, or numbers along the contact."""

import tomllib

import numpy as np
import pytest
from refusing import line_of

import partialslip
from partialslip.scene import Friction
from partialslip.scene.plan import plan
from partialslip.scene.reading import scene_toml
from partialslip.study.live import live_page
from partialslip.study.map import stick_map
from partialslip.tools.errors import InputError

SCENE = partialslip.load_scene("hertz-shear")


def changed(**friction):
    return SCENE.replace(friction=friction)


def test_it_is_linear_between_points_and_stays_beyond():
    friction = Friction(f=[0.6, 0.4, 0.5], x=[-1e-3, 0.0, 1e-3])
    assert friction.f == 0.6
    assert friction.at([-2e-3, -1e-3, -5e-4, 0.0, 1e-3, 3e-3]) == pytest.approx([0.6, 0.6, 0.5, 0.4, 0.5, 0.5])
    assert friction.jumps == pytest.approx(np.array([200, 300, 100]) / 0.6)
    assert repr(friction) == "Friction(f=(0.6, 0.4, 0.5), x=(-0.001, 0, 0.001))"


def test_one_number_is_a_number():
    for friction in (Friction(f=0.4), Friction(f=[0.4, 0.4], x=[0, 1])):
        assert (friction.varies, friction.kinks) == (False, ())
        assert np.array_equal(friction.at(np.zeros(3)), [0.4, 0.4, 0.4])


def read(scene):
    """The scene that is read from what is written of ``scene``."""
    return partialslip.parse_scene(tomllib.loads(scene_toml(scene)))


def test_it_is_written_and_read_again():
    scene = changed(f=[0.6, 0.4], x=[-1e-3, 1e-3])
    assert read(scene) == scene
    shown = scene.replace(shown_in="N-mm")
    assert "-1.0" in scene_toml(shown)
    assert read(shown).friction == scene.friction


@pytest.mark.parametrize(
    ("friction", "said"),
    [
        ({"f": [0.6, 0.4]}, "friction.x: missing; must give the places of the numbers of friction.f"),
        ({"f": 0.5, "x": [0, 1]}, "friction.x: must be left out where friction.f is one number"),
        ({"f": [0.6, 0.4], "x": [1, 1]}, "friction.x[1] = 1.0: must be > friction.x[0] = 1.0"),
        ({"f": [0.6, 0.4], "x": [0, 1, 2]}, "friction.x: must have as many numbers as friction.f, 2, not 3"),
        ({"f": [0.6, 0], "x": [0, 1]}, "friction.f[1] = 0: must be > 0.0"),
        ({"f": [0.6], "x": [0, 1]}, "friction.f = [0.6]: must be an array of at least 2 numbers"),
        ({"f": "x"}, "friction.f = 'x': must be a number or an array, not a string"),
        ({"f": -1}, "friction.f = -1: must be >= 0.0"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(friction, said):
    assert line_of(changed, **friction) == said


def test_the_plan_names_it():
    assert plan(changed(f=[0.6, 0.4], x=[0, 1])).called_for["friction"] == "tangential loads act and f = 0.4 to 0.6"


@pytest.mark.parametrize("made", [stick_map, live_page])
def test_maps_and_pages_refuse_it(made):
    with pytest.raises(InputError, match=r"friction\.f = 0\.4 to 0\.6: must be one number for a"):
        made(changed(f=[0.6, 0.4], x=[-1e-3, 1e-3]))
