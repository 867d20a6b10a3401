"""Bad scenes, settings and arguments, one by one, and the message of each."""

import re
from pathlib import Path

import pytest

from partialslip.cli import main

GOOD = (Path(__file__).parent / "bench.toml").read_text("utf-8")
EXACT = ("run", "bench.toml", "--with", "exact")
SHIPPED = ("run", "hertz-shear", "--with", "exact")
SIZE = "must be zero or of a size from 1e-100 to 1e+100"
TABLES = ("material", "profile", "friction", "load")


def edited(line, new):
    """The good scene with the one line that begins with ``line`` replaced."""
    lines = GOOD.splitlines()
    (place,) = (number for number, text in enumerate(lines) if text.startswith(line))
    return "\n".join([*lines[:place], new, *lines[place + 1 :], ""])


def without(table):
    """The good scene without a table."""
    return re.sub(rf"\[{table}\]\n([^\[].*\n)+", "", GOOD)


def test_the_good_scene_is_good(tmp_path, capsys):
    (tmp_path / "bench.toml").write_text(GOOD, "utf-8")
    assert main(["run", str(tmp_path / "bench.toml"), "--with", "exact", "--json"]) == 0
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(
    ("line", "new", "expected"),
    [
        # numbers
        ("E =", "E = -1", "material.E = -1: must be > 0"),
        ("E =", "E = nan", "material.E = nan: must be finite"),
        ("E =", "E = 1e400", "material.E = inf: must be finite"),
        ("E =", 'E = "72e9"', "material.E = '72e9': must be a number, not a string"),
        ("E =", "E = true", "material.E = true: must be a number, not true or false"),
        ("E =", "E = 1979-05-27", "material.E = 1979-05-27: must be a number, not "),
        ("E =", "E = " + "9" * 400, f"material.E = {'9' * 57}...: {SIZE}"),
        ("E =", "E = " + "9" * 5000, "not valid TOML: "),
        ("E =", "E = " + "[" * 3000 + "]" * 3000, "not valid TOML: "),
        ("nu =", "nu = 0.5", "material.nu = 0.5: must be < 0.5"),
        ("nu =", "nu = -1", "material.nu = -1: must be >= -0."),
        ("nu =", "nu = 2", "material.nu = 2: must be < 0.5"),
        ("f =", "f = -0.1", "friction.f = -0.1: must be >= 0"),
        ("f =", "f = 1001", "friction.f = 1001: must be <= 1000"),
        ("R =", "R = 0", "profile.R = 0: must be > 0"),
        ("E =", "E = 1e-320", f"material.E = 1e-320: {SIZE}"),
        ("E =", "E = 1e-99", "load.p0 = 400000000.0: must give P and sqrt(A R P) from 1e-100 to 1e+100"),
        # words
        ("plane =", 'plane = "plain"', "material.plane = 'plain': must be one of 'strain', 'stress'"),
        ("plane =", "plane = 1", "material.plane = 1: must be 'strain' or 'stress', not a whole number"),
        ("kind =", 'kind = "wedge"', "profile.kind = 'wedge': must be one of 'hertz'"),
        ("name =", "name = 3", "name = 3: must be a string"),
        ("name =", 'name = ""', "name = '': must be letters"),
        ("name =", 'name = "a/b"', "name = 'a/b': must be letters"),
        ("name =", r'name = "bench\n"', r"name = 'bench\n': must be letters"),
        ("name =", f'name = "{"x" * 101}"', f"name = '{'x' * 56}...: must be at most 100 characters"),
        # the load
        ("p0 =", "", "load: exactly one of P, a, p0 must be given, not none"),
        ("p0 =", "P = 1e5\na = 1e-3", "load: exactly one of P, a, p0 must be given, not P and a"),
        ("p0 =", "a = 1e99", "load.a = 1e+99: must give P and sqrt(A R P) from 1e-100 to 1e+100"),
        ("Q =", "Q = 1e5", "load.Q = 100000.0: must be an array, not a number"),
        ("Q =", "Q = [1.0]", "load.Q = [1.0]: must be an array of at least 2 numbers"),
        ("Q =", "Q = [1, 2, 3]", "load.sigma: must have as many numbers as load.Q, 3, not 2"),
        ("Q =", 'Q = ["1", 2]', "load.Q[0] = '1': must be a number, not a string"),
        ("Q =", "Q = [-1e308, 1e308]", f"load.Q[0] = -1e+308: {SIZE}"),
        ("sigma =", "sigma = [0, [1]]", "load.sigma[1] = [1]: must be a number, not an array"),
        ("cycles =", "cycles = 0", "load.cycles = 0: must be >= 1"),
        ("cycles =", "cycles = 1.5", "load.cycles = 1.5: must be a whole number"),
        ("cycles =", "cycles = 1000000000", "load.cycles = 1000000000: must be <= 1000"),
        # finite elements
        ("accuracy =", "accuracy = 0", "fem.accuracy = 0: must be >= 1e-09"),
        ("order =", "order = 5", "fem.order = 5: must be one of 1, 2, 3, 4, 6"),
        ("far_field =", 'far_field = "bx"', "fem.far_field = 'bx': must be one of 'half-plane', 'box'"),
        ("width =", "width = 1", "fem.width = 1: must be >= 4"),
        # keys and tables
        ("name =", "", "name: missing"),
        ("R =", "", "profile.R: missing"),
        ("name =", 'nmae = "bench"', "nmae: unknown key; did you mean 'name'?"),
        ("f =", "mu = 0.5", "friction.mu: unknown key; known are f"),
        ("[material]", "[materiel]", "materiel: unknown key; did you mean 'material'?"),
        ("[fem]", "[mesh]", "mesh: unknown key; known are name, material, "),
        ("[load]", "[[load]]", "load = [{'p0': 400000000.0, "),
        ("[friction]", "[friction.f]", "friction.f = {'f': 0.5}: must be a number or an array, not a table"),
        ("E =", r'"E\nE" = 1', r"material.E\nE: unknown key; known are E, nu, plane"),
        # TOML
        ("E =", "E =", "not valid TOML: Invalid value (at line 4"),
        ("E =", "E = 1\nE = 2", "not valid TOML: Cannot overwrite a value (at line 5"),
        ("plane =", "plane", "not valid TOML: "),
    ],
)
def test_broken_scene(rejected, line, new, expected):
    assert rejected(edited(line, new), EXACT).startswith(f"partialslip: bench.toml: {expected}")


@pytest.mark.parametrize("table", TABLES)
@pytest.mark.parametrize("value", [None, "3", '"x"', "[]"])
def test_table_missing_or_not_a_table(rejected, table, value):
    text = without(table) if value is None else f"{table} = {value}\n" + without(table)
    expected = f"{table}: missing" if value is None else f"{table} = {value.replace(chr(34), chr(39))}: must be a table"
    assert rejected(text, EXACT).startswith(f"partialslip: bench.toml: {expected}")


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (b"", "name: missing"),
        (b"# nothing\n", "name: missing"),
        (b"\x00" * 8, "not valid TOML"),
        (GOOD.encode() + b"\x00", "not valid TOML"),
        (GOOD.replace("bench", "Bänk").encode("latin-1"), "not UTF-8 text"),
        (GOOD.encode("utf-16"), "not UTF-8 text"),
    ],
)
def test_broken_file(rejected, content, expected):
    assert f"bench.toml: {expected}" in rejected(content, EXACT)


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        ("nosuch.toml", ["nosuch.toml: cannot be read: No such file"]),
        ("folder.toml", ["folder.toml: cannot be read"]),
        ("folder", ["'folder'", "neither a file nor a shipped scene"]),
        ("", ["''", "known are", "hertz-shear"]),
        ("hertz-sheer", ["'hertz-sheer'", "did you mean 'hertz-shear'?"]),
        ("Hertz-Shear", ["'Hertz-Shear'", "did you mean 'hertz-shear'?"]),
        ("../scenes/yang-laursen", ["'../scenes/yang-laursen'"]),
        ("nul\0.toml", ["cannot be read"]),
        ("two\nlines", [r"'two\nlines'"]),
        ("two\nlines.toml", [r"two\nlines.toml: cannot be read: No such file"]),
        ("my-scen.toml", ["my-scen.toml: cannot be read: No such file", "did you mean 'my-scene.toml'?"]),
        ("my_scene", ["scene 'my_scene': neither a file nor a shipped scene; did you mean 'my-scene.toml'?"]),
        ("hertz-sheer.toml", ["hertz-sheer.toml: cannot be read: No such file", "did you mean 'hertz-shear'?"]),
    ],
)
def test_no_such_scene(rejected, tmp_path, path, expected):
    for folder in ("folder", "folder.toml"):
        (tmp_path / folder).mkdir()
    (tmp_path / "my-scene.toml").touch()
    message = rejected(None, ["run", path, "--with", "exact"])
    assert not [part for part in expected if part not in message]


def test_what_the_run_refuses_names_the_scene(rejected):
    two = "material={upper={E=72e9, nu=0.3}, lower={E=210e9, nu=0.3}}"
    for scene in ("bench.toml", "hertz-shear"):
        said = rejected(GOOD, ["run", scene, "--set", two, "--with", "exact"])
        assert f"{scene}: material.upper, material.lower: the bodies differ" in said


def test_all_but_incompressible_is_for_the_exact_method_alone(rejected, capsys):
    text = edited("nu =", "nu = 0.49999991")
    message = rejected(text, ["run", "bench.toml"])
    assert "material.nu = 0.49999991: must be <= 0.4999999 in plane strain" in message
    assert main([*EXACT, "--json"]) == 0
    assert capsys.readouterr().err == ""


def test_tension_beyond_what_cells_resolve_is_for_the_exact_method_or_without_q(rejected, capsys):
    strong = ["bench.toml", "--set", "load.sigma=[-1e15,1e15]"]
    for method in ("march", "fem"):
        message = rejected(GOOD, ["run", *strong, "--with", method])
        assert re.search(r"load.sigma = 1e\+15 Pa: must be <= [\d.e+]+ Pa beside Q, by march and fem", message)
    assert main([*EXACT, *strong[1:], "--json"]) == 0
    assert main(["run", *strong, "--set", "load.Q=[0,0]", "--with", "march", "--json"]) == 0
    capsys.readouterr()


@pytest.mark.parametrize("key", ["width", "height"])
@pytest.mark.parametrize("size", ["1e-100", "1e-9", "1e5", "1e100"])
def test_bodies_out_of_all_proportion(rejected, key, size):
    block = {"width": "0.02", "height": "0.02"} | {key: size}
    text = GOOD + "[bodies.upper]\n" + "".join(f"{k} = {v}\n" for k, v in block.items())
    message = rejected(text, ["run", "bench.toml", "--with", "fem"])
    assert re.search(r"bodies\.upper\.(width|height) = \S+: must be ", message)


@pytest.mark.parametrize("method", ["exact", "march", "fem"])
def test_a_flat_that_is_hardly_pressed(rejected, method):
    text = GOOD.replace('"hertz"', '"flat-rounded"\nb = 1e20').replace("p0 =", "P =")
    assert "must press the contact beyond its flat" in rejected(text, ["run", "bench.toml", "--with", method])
    if method != "fem":  # the corners carry all of P, on 1e-10 of the contact, where rounding is a part of p
        text = text.replace("1e20", "5e4").replace("p0 =", "P =")
        assert "by more than 1e-07 of the flat's" in rejected(text, ["run", "bench.toml", "--with", method])


def test_more_than_the_memory_holds(rejected, monkeypatch):
    def solve(*_):
        raise MemoryError

    monkeypatch.setattr("partialslip.halfplane.method.solve", solve)
    assert "not enough memory" in rejected(GOOD, EXACT)


@pytest.mark.parametrize("name", ["results.json", "tractions.csv", "report.html"])
def test_a_folder_where_a_file_must_go(rejected, tmp_path, name):
    place = Path("mine", name)
    (tmp_path / place).mkdir(parents=True)
    assert rejected(None, [*SHIPPED, "--out", "mine"]) == f"partialslip: {place}: cannot be written: is a folder\n"
