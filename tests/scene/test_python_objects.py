"""Scenes made and changed in Python are validated like scene files, and refused with the same line."""

import pickle
from pathlib import Path

import msgspec
import numpy as np
import pytest
from refusing import line_of

import partialslip
from partialslip.scene import (
    Bodies,
    Body,
    Effects,
    Elastic,
    Fem,
    FlatRounded,
    Friction,
    Hertz,
    Load,
    Material,
    Scene,
    Tabulated,
)
from partialslip.scene.reading import scene_toml

SHIPPED = partialslip.load_scene("fretting-aluminium")


def made(**tables):
    plain = {
        "name": "mine",
        "material": Material(E=np.float64(72.1e9), nu=np.float32(0.25)),
        "profile": Hertz(R=np.array(0.01)),
        "friction": Friction(f=np.float64(0.3)),
        "load": Load(P=np.int64(135750), Q=np.array([-1e3, 2e3]), sigma=[np.float64(-1e6), 1e6], cycles=np.int32(2)),
    }
    return Scene(**plain | tables)


def from_file(*overrides):
    return partialslip.load_scene("fretting-aluminium", overrides)


def line(make):
    return line_of(make).removeprefix("fretting-aluminium: ")


def test_numbers_of_numpy_become_those_of_a_scene_file():
    scene = made(bodies=Bodies(lower=Body(mesh=Path("lower.msh"), unit=np.float64(1e-3))))
    assert scene == partialslip.parse_scene(msgspec.to_builtins(scene))
    assert hash(scene) == hash(pickle.loads(pickle.dumps(scene)))
    numbers = (scene.material.E, scene.material.nu, scene.profile.R, scene.load.P, *scene.load.Q, *scene.load.sigma)
    assert {type(number) for number in numbers} == {float}
    assert (scene.load.Q, type(scene.load.cycles), scene.bodies.lower.mesh) == ((-1e3, 2e3), int, "lower.msh")


def test_arrays_lists_and_tuples_make_equal_tables():
    x = np.linspace(0, 1e-3, 5)
    assert len({Tabulated(x=kind(x), gap=kind(x**2)) for kind in (np.array, list, tuple)}) == 1
    assert made(load={"P": 1e5}, profile={"kind": "hertz", "R": 1}).load == Load(P=1e5)
    assert Effects(opposing_slip=np.True_) == from_file("effects.opposing-slip=true").effects


@pytest.mark.parametrize(
    ("table", "key", "value", "written"),
    [
        ("load", "P", -1, "-1"),
        ("load", "Q", [1.0], "[1.0]"),
        ("load", "Q", [1.0, np.nan], "[1.0, nan]"),
        ("load", "cycles", 1.5, "1.5"),
        ("load", "R", 1.0, "1.0"),
        ("friction", "f", np.inf, "inf"),
        ("material", "E", 1e300, "1e300"),
        ("material", "plane", "flat", "'flat'"),
        ("effects", "shear", 1, "1"),
    ],
)
def test_bad_values_get_the_line_of_a_scene_file(table, key, value, written):
    """As a table alone, in a scene, and as a change of one."""
    said = line(lambda: from_file(f"{table}.{key}={written}"))
    kinds = {"load": Load, "friction": Friction, "material": Material, "profile": Hertz, "fem": Fem, "effects": Effects}
    rest = {"material": {"E": 1e9, "nu": 0.3}, "profile": {"R": 0.01}, "load": {"P": 1.0}}.get(table, {})
    assert line(lambda: kinds[table](**rest | {key: value})) == said
    assert line(lambda: SHIPPED.replace(**{table: {key: value}})) == said
    assert line(lambda: SHIPPED.replace({f"{table}.{key}": value})) == said
    tables = {"profile": {"kind": "hertz", "R": 0.01}, "load": {"P": 1.0}, "material": rest}.get(table, {})
    assert line(lambda: made(**{table: tables | {key: value}})) == said


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (Hertz, "profile.R: missing"),
        (lambda: FlatRounded(R=1.0), "profile.b: missing"),
        (lambda: Tabulated(x=3, gap=4), "profile.x = 3: must be an array"),
        (lambda: Elastic(E=1e9, nu=1), "elastic.nu = 1: must be < 0.5"),
        (lambda: Effects(oposing_slip=True), "effects.oposing_slip: unknown key; did you mean 'opposing-slip'?"),
        (lambda: made(name="two words"), "name = 'two words': must be letters"),
        (lambda: made(load=Load()), "load: exactly one of P, a, p0"),
        (lambda: made(load=None), "load = None: must be a table"),
        (lambda: Scene(name="mine"), "material: missing"),
        (lambda: Bodies(lower=Body(width=1, height=1e-9)), "bodies.lower.height = 1e-09: must be"),
    ],
)
def test_what_a_table_needs(make, said):
    assert line(make).startswith(said)


def test_replace_changes_what_is_named_and_nothing_else():
    mine = SHIPPED.replace(load={"Q": (-1e4, 2e4)}, friction={"f": np.float64(0.4)}, name="mine")
    assert mine == from_file("load.Q=[-1e4, 2e4]", "friction.f=0.4", "name=mine")
    assert from_file() == SHIPPED
    assert SHIPPED.replace({"load.Q": [-1e4, 2e4], "friction.f": 0.4}, name="mine") == mine
    assert SHIPPED.replace() == SHIPPED


def test_replace_unsets_and_replaces_tables():
    assert SHIPPED.replace(load={"P": None, "a": 1e-4}).load.a == 1e-4
    assert SHIPPED.replace(load=Load(P=1e5)).load == Load(P=1e5)
    flat = SHIPPED.replace(profile={"kind": "flat-rounded", "R": 0.02, "b": 1e-3})
    assert flat.profile == FlatRounded(R=0.02, b=1e-3)
    assert flat.replace(profile={"b": 2e-3}).profile == FlatRounded(R=0.02, b=2e-3)


def test_a_star_stands_for_any_table():
    block = {"width": 0.05, "height": 0.05}
    blocks = SHIPPED.replace({"bodies.lower": block, "bodies.upper.width": 0.04, "bodies.upper.height": 0.05})
    wide = blocks.replace({"bodies.*.width": 0.1})
    assert wide.bodies.lower.width == wide.bodies.upper.width == 0.1
    assert wide.bodies.lower.height == 0.05
    assert line(lambda: SHIPPED.replace({"bodies.*.width": 1})) == (
        "bodies.*.width: the scene has no table in place of *"
    )


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"frction.f": 3}, "frction: unknown key; did you mean 'friction'?"),
        ({"load.p": 3}, "load.p: unknown key; did you mean 'P'?"),
        ({"load": 3}, "load = 3: must be a table, not a whole number"),
        ({"load": {3: 4}}, "load.3: a key must be a string"),
        ({3: 4}, "3: a key must be a string, such as 'load.P'"),
        ({b"load.P": 1e5}, "b'load.P': a key must be a string, such as 'load.P'"),
        ({("load", "P"): 1e5}, "('load', 'P'): a key must be a string, such as 'load.P'"),
        ({"load.a": 1e-4}, "load: exactly one of P, a, p0 must be given, not P and a"),
    ],
)
def test_wrong_keys_of_replace(changes, said):
    assert line(lambda: SHIPPED.replace(changes)).startswith(said)


@pytest.mark.fault
def test_a_constructor_that_does_not_validate_is_noticed():
    """Deliberate fault: a table made past the metaclass, as before tables validated themselves."""
    raw = msgspec.StructMeta.__call__(Load, P=-1.0, Q=[1.0, float("nan")])
    assert raw.P == -1.0
    assert line(lambda: made(load=raw)) == "load.Q[1] = nan: must be finite"


@pytest.mark.parametrize("order", [set, frozenset])
def test_a_set_has_no_order_of_load_points(order):
    said = "load.Q: must be a list: a set has no order"
    assert line(lambda: SHIPPED.replace({"load.Q": order([-1e4, 1e4])})) == said
    assert line(lambda: Load(P=1e5, Q=order([-1e4, 1e4]))) == said


@pytest.mark.parametrize("changes", [3, "load.P", [("load.P", 1e5)], 2.5])
def test_what_is_no_table_of_changes(changes):
    said = line(lambda: SHIPPED.replace(changes))
    assert said.startswith("changes = ")
    assert "must be values by dotted key" in said


ASKED = {
    "run": lambda scene: partialslip.run(scene, "exact"),
    "plan": partialslip.plan,
    "sweep": lambda scene: partialslip.sweep(scene, {"friction.f": [0.3]}, "exact", progress=lambda *_: None),
    "assess": lambda scene: partialslip.assess(scene, criteria=["principal"]),
    "characterise": partialslip.characterise,
    "refitted": lambda scene: partialslip.refitted(scene, 1),
    "export": lambda scene: partialslip.export(scene, "gmsh"),
    "score": lambda scene: partialslip.score(scene, "none.csv"),
    "compare": lambda scene: partialslip.compare(*[partialslip.run(SHIPPED, "exact")["exact"]] * 2, scene, 1e-3),
}
REFUSED = {  # of a scene that does not suit the function, or of a file that is not there: after the scene was read
    "characterise": "bodies",
    "refitted": "profile: must be from a file",
    "score": "none.csv: cannot be read",
}


@pytest.mark.parametrize("name", ASKED)
def test_a_name_or_a_path_stands_for_its_scene(name, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(scene_toml(SHIPPED), "utf-8")
    for scene in ("fretting-aluminium", path, str(path)):
        if name in REFUSED:
            assert REFUSED[name] in line(lambda scene=scene: ASKED[name](scene))
        else:
            assert ASKED[name](scene) is not None
    for wrong in (3, None, {"name": "mine"}, ["hertz-shear"]):
        assert line(lambda wrong=wrong: ASKED[name](wrong)).startswith("scene = ")
    assert "did you mean 'hertz-shear'" in line(lambda: ASKED[name]("hertz-sheer"))


@pytest.mark.parametrize("read", [partialslip.load_scene, partialslip.load_state, partialslip.load_result,
                                  partialslip.load_rig])  # fmt: skip
@pytest.mark.parametrize("path", [0, None, 2.5, ["hertz-shear"]])
def test_what_is_no_path_is_refused(read, path):
    """Not even a number, which stands for an open file, such as standard input."""
    assert "path of a" in line(lambda: read(path))


def test_what_run_is_asked_for():
    assert line(lambda: partialslip.run(SHIPPED, 3)).startswith("methods = 3: must be one or several of exact, march")
    assert line(lambda: partialslip.run(SHIPPED, [["fem"]])).startswith("methods = ['fem']: must be one or several of")
    assert line(lambda: partialslip.run(SHIPPED, [])).startswith("methods = none: must be one or several of")
    assert line(lambda: partialslip.run(SHIPPED, "exact", start=3)).startswith("start = 3: must be a State")
    assert line(lambda: partialslip.load_scene("hertz-shear", [3])).startswith("override 3: must be table.key=value")
    assert partialslip.load_scene("hertz-shear", "friction.f=0.4").friction.f == 0.4
