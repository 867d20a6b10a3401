"""Tolerances of a scene: what they mean, in which units, and what is refused."""

import msgspec
import pytest
from refusing import line_of

import partialslip
from partialslip import load_scene, parse_scene
from partialslip.scene.reading import scene_tables, scene_toml
from partialslip.scene.tolerance import inputs, moved

NAME = "fretting-aluminium"
GIVEN = [
    'tolerance.friction.f="5 %"',
    "tolerance.load.P={std=1e3}",
    "tolerance.load.Q=500",
    "tolerance.material.nu=0.01",
]

HOSTILE = {
    'friction.f="5"': "'5': must be a half-width such as 0.015 or '5 %'",
    'friction.f="five %"': "must be a half-width",
    'friction.f="nan %"': "must be a half-width",
    'friction.f="0 %"': "must be a half-width",
    'friction.f="1e999 %"': "must be a half-width",
    'friction.f=""': "must be a half-width",
    "friction.f=0": "must be > 0",
    "friction.f=-0.01": "must be > 0",
    "friction.f=nan": "must be finite",
    "friction.f=true": "must be a number or a string or a table",
    "friction.f=[0.1,0.2]": "must be a number or a string or a table, not an array",
    "friction.f={}": "tolerance.friction.f.std: missing",
    "friction.f={sdt=0.1}": "did you mean 'std'?",
    'friction.f={std="40 %"}': "too wide: friction.f = -0.06: must be >= 0",
    'friction.f="150 %"': "too wide: friction.f = -0.15",
    'material.nu="60 %"': "too wide: material.nu = 0.528: must be < 0.5",
    "friction.g=1": "tolerance.friction.g: unknown key; known are f",
    'friction="5 %"': "tolerance.friction = '5 %': must be a table",
    "fem.accuracy=1e-6": "tolerance.fem: unknown key",
    "load.e=1e-6": "the scene gives no number load.e: give load.e, or remove its tolerance",
    "load.cycles=1": "tolerance.load.cycles: unknown key",
    "load.sigma_slope=1": "all numbers of load.sigma_slope are 0",
    "profile.b=1e-4": "the scene gives no number profile.b",
    "load.P=1e200": "must be zero or of a size from",
}


@pytest.mark.parametrize("setting", HOSTILE)
def test_one_line_names_field_and_value(setting):
    line = line_of(load_scene, NAME, [f"tolerance.{setting}"])
    assert line.startswith(f"{NAME}: tolerance.{setting.split('=')[0].split('.')[0]}")
    assert HOSTILE[setting] in line


@pytest.mark.parametrize("text", ["friction.f", "=5%", "friction.f=", "friction.f=5 5", "friction.f=5%%", "nothing=1"])
def test_option_is_refused(refused, text):
    line = refused("run", NAME, "--tolerance", text)
    assert text.split("=")[0] in line or "KEY=HALF-WIDTH" in line


def test_a_share_of_zero_and_too_many_inputs():
    eccentric = load_scene(NAME, ["load.e=0.0"])
    assert "load.e is 0" in line_of(eccentric.replace, {"tolerance.load.e": "1 %"})
    (e,) = inputs(eccentric.replace({"tolerance.load.e": 1e-6}))
    assert (e.at(1.0), e.at(-1.0)) == (1e-6, -1e-6)


def test_displacements_are_refused():
    """Each body would have to be solved by elements again."""
    body = {"width": 2e-3, "height": 2e-3}
    driven = {"bodies.upper": body, "bodies.lower": body, "load.Q": [0, 0], "load.displacement": [-1e-6, 1e-6]}
    scene = load_scene(NAME).replace(driven)
    assert "must be left out with load.displacement" in line_of(scene.replace, {"tolerance.friction.f": "5 %"})


def test_a_start_is_refused(refused):
    assert "must be left out with tolerances" in refused(
        "run", NAME, "--tolerance", "friction.f=5%", "--start", "a.npz"
    )


def test_reach_and_lists():
    """A list changes in proportion; the reach of a normal distribution is two standard deviations."""
    scene = load_scene(NAME, GIVEN)
    by_key = {each.key: each for each in inputs(scene)}
    assert by_key["friction.f"].reach == pytest.approx(0.015)
    assert (by_key["load.P"].reach, by_key["load.P"].normal) == (2000.0, True)
    there = moved(scene, [by_key["load.Q"], by_key["friction.f"]], [1.0, -1.0])
    assert pytest.approx((-39250.0, 39250.0)) == there.load.Q
    assert there.friction.f == pytest.approx(0.285)
    assert there.tolerance is None


def test_scene_is_read_back_in_any_units():
    scene = load_scene(NAME, GIVEN)
    assert parse_scene(scene_tables(scene)) == scene
    shown = scene.replace({"shown_in": "N-mm"})
    text = scene_toml(shown)
    assert "Q = 0.5\n" in text  # N/mm
    assert inputs(parse_scene(scene_tables(shown))) == inputs(scene)
    assert hash(scene) != hash(load_scene(NAME))
    assert partialslip.load_scene(NAME).tolerance is None
    assert msgspec.to_builtins(scene)["tolerance"]["load"]["P"] == {"std": 1000.0}
