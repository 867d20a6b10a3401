"""Reading of scenes, and the plan that follows from them."""

import contextlib
import itertools
import math

import msgspec
import pytest

import partialslip
from partialslip.scene import Material, Scene
from partialslip.scene.plan import Effect, plan
from partialslip.scene.reading import load_scene, parse_scene, shipped_scenes
from partialslip.tools.errors import InputError, PartialslipError

SHIPPED = sorted(shipped_scenes())
EFFECTS = set(Effect.__args__)


def scene(load=None, **tables):
    """A scene with the given load; other tables by name replace the plain ones."""
    data = {
        "name": "plain",
        "material": {"E": 72e9, "nu": 0.3},
        "profile": {"kind": "hertz", "R": 0.02},
        "friction": {"f": 0.4},
        "load": {"P": 1e5} | (load or {}),
    }
    return parse_scene(data | tables)


# --- reading


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_scene_bears_its_file_name(name):
    shipped = load_scene(name)
    assert isinstance(shipped, Scene)
    assert shipped.name == name
    assert shipped.title == shipped_scenes()[name] != ""


def test_a_file_is_read_whatever_its_suffix(tmp_path):
    text = 'name = "mine"\nmaterial = {E = 1e9, nu = 0}\nprofile = {kind = "hertz", R = 1}\n'
    text += "friction = {f = 0.5}\nload = {P = 1e3}\n"
    for name in ("mine.toml", "mine.txt", "mine"):
        path = tmp_path / name
        path.write_text(text, "utf-8")
        plain = load_scene(path)
        path.write_text(text, "utf-8-sig")  # with a byte order mark
        assert load_scene(path) == load_scene(str(path)) == plain
        assert load_scene(path).name == "mine"


def test_a_folder_of_the_same_name_does_not_hide_a_shipped_scene(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "hertz-shear").mkdir()
    assert load_scene("hertz-shear").name == "hertz-shear"


def test_a_local_file_comes_before_a_shipped_scene_of_that_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "hertz-shear").write_text("name = 3\n", "utf-8")
    with pytest.raises(InputError, match="name = 3"):
        load_scene("hertz-shear")


@pytest.mark.parametrize(
    ("table", "key", "value"),
    [(None, "name", "b"), (None, "P", 1.0), ("material", "E", 1.0), ("load", "cycles", 2), ("fem", "order", 2)],
)
def test_a_scene_cannot_be_changed(table, key, value):
    shipped = load_scene("hertz-shear")
    owner = getattr(shipped, table) if table else shipped
    with pytest.raises(AttributeError):
        setattr(owner, key, value)


def test_equal_scenes_hash_alike():
    assert len({load_scene("hertz-shear"), load_scene("hertz-shear"), load_scene("yang-laursen")}) == 2


def test_whole_numbers_are_taken_as_floats():
    whole = scene({"P": 100000, "Q": [-1, 1]}, material={"E": 72_000_000_000, "nu": 0}, friction={"f": 0})
    assert whole == scene({"P": 1e5, "Q": [-1.0, 1.0]}, material={"E": 72e9, "nu": 0.0}, friction={"f": 0.0})
    for number in (whole.material.E, whole.material.nu, whole.load.P, whole.load.Q[0], whole.friction.f):
        assert isinstance(number, float)


# --- settings changed from outside


@pytest.mark.parametrize(
    ("override", "table", "key", "value"),
    [
        ("load.P=2e5", "load", "P", 2e5),
        (" load.P = 200000 ", "load", "P", 2e5),
        ("load.Q=[-1e4, 2e4]", "load", "Q", (-1e4, 2e4)),
        ("load.cycles=3", "load", "cycles", 3),
        ("material.plane=stress", "material", "plane", "stress"),
        ('material.plane="stress"', "material", "plane", "stress"),
        ("fem.far_field=box", "fem", "far_field", "box"),
        ("fem.width=32", "fem", "width", 32.0),
    ],
)
def test_override(override, table, key, value):
    changed = load_scene("fretting-aluminium", [override])
    assert getattr(getattr(changed, table), key) == value
    data = msgspec.to_builtins(changed)
    data[table][key] = getattr(getattr(load_scene("fretting-aluminium"), table), key)
    assert parse_scene(data) == load_scene("fretting-aluminium")


def test_overrides_at_the_top_and_the_last_one_wins():
    changed = load_scene("fretting-aluminium", ["name=other", "title=Two words", "load.P=1e5", "load.P=3e5"])
    assert (changed.name, changed.title, changed.P) == ("other", "Two words", 3e5)


@pytest.mark.parametrize(
    ("value", "title"),
    [("nanometre", "nanometre"), ("true story", "true story"), ("élan 1=2", "élan 1=2"), ('"[x] <y>"', "[x] <y>")],
)
def test_words_are_a_string(value, title):
    assert load_scene("hertz-shear", [f"title={value}"]).title == title


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_a_second_line_in_a_setting_is_refused_or_does_nothing(newline):
    with contextlib.suppress(InputError):
        assert load_scene("hertz-shear", [f"load.p0=3e8{newline}other=2"]).load.p0 == 3e8


def test_bad_input_is_a_value_error_of_this_package():
    with pytest.raises(PartialslipError) as caught:
        load_scene("hertz-sheer")
    assert isinstance(caught.value, ValueError)
    assert "did you mean 'hertz-shear'?" in str(caught.value)


# --- quantities that follow from the settings


@pytest.mark.parametrize("nu", [-0.5, 0.0, 0.3, 0.4999])
def test_elastic_constants(nu):
    E = 72e9
    strain, stress = (Material(E=E, nu=nu, plane=plane) for plane in ("strain", "stress"))
    mu = pytest.approx(E / (2 * (1 + nu)), rel=1e-15)
    assert strain.bodies == (constants := (mu, pytest.approx(3 - 4 * nu, rel=1e-15)), constants)
    assert stress.bodies == (constants := (mu, pytest.approx((3 - nu) / (1 + nu), rel=1e-15)), constants)
    assert pytest.approx(4 * (1 - nu**2) / E, rel=1e-14) == strain.A
    assert pytest.approx(4 / E, rel=1e-14) == stress.A


@pytest.mark.parametrize("plane", ["strain", "stress"])
@pytest.mark.parametrize(("E", "R", "a"), [(72e9, 0.05, 1e-3), (1.0, 1.0, 1.0), (200e9, 1e6, 2.0), (1e5, 1e-6, 1e-8)])
def test_half_width_peak_pressure_and_force_are_one_load(plane, E, R, a):
    tables = {"material": {"E": E, "nu": 0.3, "plane": plane}, "profile": {"kind": "hertz", "R": R}}
    A = Material(**tables["material"]).A
    P, p0 = math.pi * a**2 / (2 * A * R), a / (A * R)
    assert pytest.approx(2 * P / (math.pi * a), rel=1e-14) == p0
    for key, value in {"P": P, "a": a, "p0": p0}.items():
        one = scene({"P": None, key: value}, **tables)
        assert pytest.approx(P, rel=1e-14) == one.P
        assert one.length == pytest.approx(a * math.sqrt(math.pi / 2), rel=1e-14)
        exact = partialslip.run(one, ["exact"]).results["exact"]
        assert exact.a == pytest.approx(a, rel=1e-14)
        assert exact.p0 == pytest.approx(p0, rel=1e-14)


@pytest.mark.parametrize("Q", ["[-1e-10, 1e-10]", "[0, 1e-100]"])
def test_next_to_no_shear_is_no_shear(Q):
    tiny, none = (partialslip.run(load_scene("hertz-small-tension", [f"load.Q={q}"]), ["exact"]) for q in (Q, "[0, 0]"))
    assert tiny.results["exact"].m == pytest.approx(none.results["exact"].m, rel=1e-9)


def test_changes_of_load_and_full_reversal():
    load = scene({"Q": [-2.0, 5.0], "sigma": [3.0, 1.0]}).load
    assert (load.dQ, load.dsigma, load.fully_reversed) == (7.0, -2.0, False)
    assert scene({"Q": [-2.0, 2.0], "sigma": [3.0, -3.0]}).load.fully_reversed
    assert scene().load.fully_reversed


# --- the plan

SHEARED, TENSION = {"Q": [-1e4, 1e4]}, {"Q": [-1e4, 1e4], "sigma": [-1e7, 1e7]}


@pytest.mark.parametrize(
    ("what", "subsurface", "called_for"),
    [
        (scene(), False, "normal far-field"),
        (scene(SHEARED), False, "normal friction shear far-field"),
        (scene(TENSION), False, "normal friction shear tension far-field"),
        (scene(TENSION | {"steps": 4}), False, "normal friction shear tension history far-field"),
        (scene(SHEARED | {"P": 1e4}), False, "normal shear far-field"),
        (scene({"sigma": [-1e7, 1e7]}), False, "normal friction tension opposing-slip far-field"),
        (scene(TENSION, friction={"f": 0.0}), False, "normal shear tension far-field"),
        (scene({"Q": [0.0, 1e4]}), False, "normal friction shear history far-field"),
        (scene({"Q": [1e4, 1e4]}), False, "normal friction shear history far-field"),
        (scene(SHEARED | {"sigma": [1e7, 1e7]}), False, "normal friction shear tension history far-field"),
        (scene(SHEARED | {"cycles": 3}), False, "normal friction shear far-field"),
        (scene(SHEARED | {"steps": 2}), False, "normal friction shear history far-field"),
        (scene({"cycles": 3}), False, "normal far-field"),
        (scene(SHEARED, fem={"far_field": "box"}), False, "normal friction shear"),
        (scene(SHEARED), True, "normal friction shear far-field subsurface"),
    ],
)
def test_plan(what, subsurface, called_for):
    effects = plan(what, subsurface=subsurface)
    assert set(effects.called_for) == set(called_for.split())
    assert set(effects.left_out) == EFFECTS - set(called_for.split())
    for effect in EFFECTS:
        assert effects.needs(effect) == (effect in effects.called_for)
    for why in [*effects.called_for.values(), *effects.left_out.values()]:
        assert why.strip()
        assert "\n" not in why


# Conditions under which a reason, given by its beginning, is true.
TRUE_IF = {
    "two bodies are pressed together": lambda s: s.P > 0,
    "P is constant": lambda s: not s.presses_anew,
    "slip may reverse between": lambda s: s.friction.f > 0 and s.load.dsigma != 0 and not s.slides,
    "no tangential load acts": lambda s: not any(s.load.Q + s.load.sigma),
    "f = 0: ": lambda s: s.friction.f == 0 and (any(s.load.Q + s.load.sigma) or not s.mirrored),
    "tangential loads act and f = 0.4": lambda s: s.friction.f == 0.4 and any(s.load.Q + s.load.sigma),
    "Q goes between 0 and 10000 N/m": lambda s: s.load.Q == (0, 1e4),
    "Q goes between -10000 and 10000 N/m": lambda s: s.load.Q == (-1e4, 1e4),
    "Q goes between 10000 and 10000 N/m": lambda s: s.load.Q == (1e4, 1e4),
    "Q = 0 at every load point": lambda s: s.load.Q == (0, 0),
    "sigma goes between -1e+07 and 0 Pa": lambda s: s.load.sigma == (0, -1e7),
    "sigma goes between -1e+07 and 1e+07 Pa": lambda s: s.load.sigma == (-1e7, 1e7),
    "sigma goes between 1e+07 and 1e+07 Pa": lambda s: s.load.sigma == (1e7, 1e7),
    "sigma = 0 at every load point": lambda s: s.load.sigma == (0, 0),
    "tension may turn the slip": lambda s: s.load.dsigma != 0 and s.friction.f > 0,
    "tension is small": lambda s: s.load.dsigma != 0 and s.friction.f > 0 and not s.finite,
    "pressure drags the ends": lambda s: s.friction.f > 0 and not s.mirrored,
    "without a change of tension": lambda s: s.load.dsigma == 0 and s.friction.f > 0,
    "mean loads act": lambda s: not s.load.fully_reversed,
    "pressure and shear move the surfaces together": lambda s: not s.mirrored,
    "Q1 = -Q2 and sigma1 = -sigma2": lambda s: s.load.fully_reversed and s.mirrored,
    "pressure moves the surfaces along x and f = 0.4": lambda s: s.friction.f == 0.4 and not s.mirrored,
    "the bodies are not mirror images": lambda s: not s.mirrored,
    "the bodies are mirror images": lambda s: s.mirrored,
    "a body has a size of its own": lambda s: s.bodies.upper or s.bodies.lower,
    "the bodies stand for half-planes": lambda s: not (s.bodies.upper or s.bodies.lower),
    "a block is held by": lambda s: s.fem.far_field == "half-plane" and not (s.bodies.upper and s.bodies.lower),
    "blocks are held as they are": lambda s: s.fem.far_field == "box" or (s.bodies.upper and s.bodies.lower),
    "no moment acts, and the gap is even": lambda s: s.even,
    "fields inside the bodies were not asked": lambda _: True,
}


@pytest.mark.parametrize("sigma", [(0, 0), (0, -1e7), (-1e7, 1e7), (1e7, 1e7)])
@pytest.mark.parametrize("Q", [(0, 0), (0, 1e4), (-1e4, 1e4), (1e4, 1e4)])
def test_reasons_are_true_of_the_scene(Q, sigma):
    block = {"width": 0.1, "height": 0.05}
    all_bodies = ({}, {"upper": block}, {"upper": block, "lower": block})
    for f, cycles, far_field, bodies in itertools.product((0, 0.4), (1, 3), ("half-plane", "box"), all_bodies):
        load = {"Q": Q, "sigma": sigma, "cycles": cycles}
        what = scene(load, friction={"f": f}, fem={"far_field": far_field}, bodies=bodies)
        effects = plan(what)
        for why in (effects.called_for | effects.left_out).values():
            (holds,) = (holds for words, holds in TRUE_IF.items() if why.startswith(words))
            assert holds(what), why
