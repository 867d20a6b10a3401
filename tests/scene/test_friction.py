"""The coefficient of friction of a scene: one number, or numbers along the contact."""

import tomllib

import numpy as np
import pytest

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


def test_the_plan_names_it():
    assert plan(changed(f=[0.6, 0.4], x=[0, 1])).called_for["friction"] == "tangential loads act and f = 0.4 to 0.6"


@pytest.mark.parametrize("made", [stick_map, live_page])
def test_maps_and_pages_refuse_it(made):
    with pytest.raises(InputError, match=r"friction\.f = 0\.4 to 0\.6: must be one number for a"):
        made(changed(f=[0.6, 0.4], x=[-1e-3, 1e-3]))
