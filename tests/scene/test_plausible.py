"""Slips of unit are noticed, and nothing else is."""

import pytest

import partialslip
from partialslip.scene.plausible import implausible
from partialslip.scene.reading import parse_scene
from partialslip.verify.hard_cases.catalogue import FAMILIES

SCENE = partialslip.load_scene("hertz-shear")
RIG = {
    "units": "N-mm", "name": "rig", "material": {"E": 116e3, "nu": 0.32}, "profile": {"kind": "hertz", "R": 50},
    "friction": {"f": 0.55}, "load": {"P": 300, "Q": [-90, 90]},
}  # fmt: skip


def with_(table, **values):
    return parse_scene(RIG | {table: RIG[table] | values})


@pytest.mark.parametrize(
    ("scene", "says"),
    [
        (with_("material", E=116e9), "material.E = 1.16e+11 MPa is stiffer than any solid: is units = 'N-mm' right?"),
        (SCENE.replace(material={"E": 70e3}), "material.E = 7e+04 Pa is softer than rubber: are all"),
        (with_("profile", R=0.05), "a/R is about"),
        (with_("profile", R=5e12), "a/R is about"),
        (parse_scene(RIG | {"profile": {"kind": "tabulated", "x": [0, 0.5, 1], "gap": [0, 2.5, 10]}}), "a/R is about"),
        (with_("load", P=300e9), "a = "),
        (with_("load", sigma=[0, 20e6]), "load.sigma = 2e+07 MPa is 1.7e+02 of E, more than any elastic strain: is"),
        (parse_scene(RIG | {"fatigue": {"distance": 1e9}}), "fatigue.distance = 1e+09 mm is "),
        (with_("friction", f=[0.6, 0.4], x=[-500, 500]), "friction.x reaches to"),
        (with_("friction", f=[0.6, 0.4], x=[-5e-4, 5e-4]), "friction.x reaches to"),
    ],
)  # fmt: skip
def test_a_slip_of_unit_is_noticed(scene, says):
    assert any(line.startswith(says) for line in implausible(scene))


def test_both_materials_are_looked_at():
    bodies = {"upper": {"E": 2e11, "nu": 0.3}, "lower": {"E": 2e17, "nu": 0.3}}
    (line,) = implausible(SCENE.replace(material={"E": None, "nu": None} | bodies))
    assert line.startswith("material.lower.E = 2e+17 Pa")


@pytest.mark.parametrize("name", partialslip.shipped_scenes())
def test_shipped_scenes_are_plausible(name):
    assert implausible(partialslip.load_scene(name)) == ()


def test_problems_and_most_hard_cases_are_plausible():
    cases = [case for family in FAMILIES for case in family.cases]
    odd = [case.scene.name for case in cases if implausible(case.scene)]
    assert len(odd) < len(cases) / 10, odd


def test_the_line_is_printed_and_the_run_goes_on(tmp_path, capsys):
    from partialslip.cli import main

    folder = str(tmp_path / "soft")
    assert main(["run", "hertz-shear", "--with", "exact", "--set", "material.E=70e3", "--out", folder]) == 0
    assert "softer than rubber" in capsys.readouterr().out
