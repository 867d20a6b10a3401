"""Materials: one for both bodies, or each body's own."""

import msgspec
import numpy as np
import pytest
from refusing import line_of

import partialslip
from partialslip.scene import Elastic, Material
from partialslip.scene.reading import parse_scene, scene_tables
from partialslip.tools.errors import InputError

STEEL, BRASS = {"E": 210e9, "nu": 0.3}, {"E": 100e9, "nu": 0.35}


def scene(**material):
    return parse_scene({
        "name": "s",
        "material": material,
        "profile": {"kind": "hertz", "R": 0.02},
        "friction": {"f": 0.4},
        "load": {"P": 1e5, "Q": [-1e4, 1e4]},
    })  # fmt: skip


def test_each_body_has_its_own_material():
    """As with a material for both that no body has: E and nu of [material] are then of no body."""
    own = scene(upper=STEEL, lower=BRASS)
    assert own.material.bodies == scene(**STEEL, lower=BRASS).material.bodies
    assert own.material.bodies == scene(E=1.0, nu=0.0, upper=STEEL, lower=BRASS).material.bodies
    assert own.material.A == scene(**BRASS, upper=STEEL).material.A
    assert not own.material.alike
    assert (own.material.E, own.material.nu) == (None, None)
    assert own.material == Material(upper=Elastic(**STEEL), lower=Elastic(**BRASS))
    for same in (parse_scene(scene_tables(own)), parse_scene(msgspec.to_builtins(own))):
        assert same == own
    assert line_of(scene, E=None, nu=0.3, upper=STEEL).startswith("material.E: missing")


def test_two_bodies_of_one_material_are_alike():
    own, both = scene(upper=STEEL, lower=STEEL, plane="stress"), scene(**STEEL, plane="stress")
    assert own.material.alike
    found, known = (partialslip.run(each, ["exact"]).results["exact"] for each in (own, both))
    assert (found.a, found.m) == (known.a, known.m)
    assert np.array_equal(found.traction.p, known.traction.p)


@pytest.mark.parametrize(("material", "name"), [
    ({"E": 1e9, "nu": 0.49999999}, "material"),
    ({**STEEL, "upper": {"E": 1e9, "nu": 0.49999999}}, "material.upper"),
    ({"upper": STEEL, "lower": {"E": 1e9, "nu": 0.49999999}}, "material.lower"),
])  # fmt: skip
def test_finite_elements_name_the_table_of_an_incompressible_material(material, name):
    with pytest.raises(InputError, match=rf"^{name}.nu = 0.49999999: must be <= "):
        partialslip.run(scene(**material), ["fem"])
