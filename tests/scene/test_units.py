"""Scenes in N, mm and MPa: the same bodies and loads, the same results, and what is written of them."""

import csv
import io
import tomllib
from dataclasses import replace
from itertools import chain

import msgspec
import numpy as np
import pytest
from refusing import line_of

import partialslip
from partialslip.cli import main
from partialslip.report import answer, rows
from partialslip.report.files import surface_csv, tractions_csv
from partialslip.result.fields import SurfaceStress
from partialslip.scene import Scene
from partialslip.scene.dimensions import DIMENSIONS, dimension
from partialslip.scene.profiles import FlatRounded, Hertz, Tabulated
from partialslip.scene.reading import load_scene, parse_scene, scene_tables, scene_toml, shipped_scenes
from partialslip.scene.table import Table
from partialslip.scene.units import N_MM, N_NM, N_UM, SI
from partialslip.study.batch.ledger import scene_content
from partialslip.tools.errors import InputError

# Scene files with the numbers in SI units | in N, mm and MPa; together they have every key with a dimension.
TWINS = {
    "hertz": """
        material.nu = 0.33
        material.E = 72.1e9                            | 72.1e3
        profile.kind = "hertz"
        profile.R = 0.3e-3                             | 0.3
        load.P = 135750.0                              | 135.75
        load.Q = [-13.1e3, 38.75e3]                    | [-13.1, 38.75]
        load.sigma = [-101e6, 100e6]                   | [-101, 100]""",
    "slope of tension, crown": """
        material.nu = 0.33
        material.E = 72.1e9                            | 72.1e3
        profile.kind = "flat-rounded"
        profile.R = 0.3e-3                             | 0.3
        profile.b = 0.1e-3                             | 0.1
        profile.crown = 3.3                            | 3300
        load.P = 135750.0                              | 135.75
        load.Q = [-13.1e3, 38.75e3]                    | [-13.1, 38.75]
        load.sigma_slope = [-2.3e9, 1.7e9]             | [-2.3, 1.7]
        fatigue.sigma_y = 330e6                        | 330
        fatigue.distance = 50e-6                       | 0.05
        fatigue.sigma_upper = [-1e6, 1e6]              | [-1, 1]""",
    "half-width, own materials": """
        material.upper = {E = 210e9, nu = 0.3}         | {E = 210e3, nu = 0.3}
        material.lower = {E = 7.3e9, nu = 0.3}         | {E = 7300, nu = 0.3}
        profile.kind = "hertz"
        profile.R = 0.017                              | 17
        load.a = 2.07e-4                               | 0.207""",
    "largest pressure, finite bodies": """
        material.nu = 0.33
        material.E = 72.1e9                            | 72.1e3
        profile.kind = "hertz"
        profile.R = 0.017                              | 17
        load.p0 = 418.1e6                              | 418.1
        load.displacement = [-3.3e-6, 4e-6]            | [-3.3e-3, 4e-3]
        load.spring = 2.1e9                            | 2100
        load.Q_found = [-13.1e3, 38.75e3]              | [-13.1, 38.75]
        bodies.upper.width = 0.011                     | 11
        bodies.upper.height = 0.0123                   | 12.3
        bodies.upper.holder.width = 61e-3              | 61
        bodies.upper.holder.height = 21e-3             | 21
        bodies.upper.support = "pivot"
        bodies.upper.pivot_height = 37e-3              | 37
        bodies.lower.width = 0.04                      | 40
        bodies.lower.height = 5e-3                     | 5
        bodies.lower.holder.width = 6e-2               | 60
        bodies.lower.holder.height = 2e-2              | 20""",
    "meshes": """
        material.nu = 0.33
        material.E = 72.1e9                            | 72.1e3
        profile.kind = "flat-rounded"
        profile.R = 0.017                              | 17
        profile.b = 1.7e-4                             | 0.17
        load.P = 135750.0                              | 135.75
        bodies.upper.mesh = "a.msh"
        bodies.upper.unit = 25.4e-3                    | 25.4
        bodies.lower.mesh = "a.msh"
        bodies.lower.unit = 1e-6                       | 1e-3
        bodies.lower.support = "pivot"
        bodies.lower.pivot_height = 1.9e-3             | 1.9""",
    "tabulated": """
        material.nu = 0.33
        material.E = 72.1e9                            | 72.1e3
        profile.kind = "tabulated"
        profile.x = [0, 1e-3, 2e-3, 3e-3]              | [0, 1, 2, 3]
        profile.gap = [0, 1.1e-5, 4.4e-5, 9.9e-5]      | [0, 0.011, 0.044, 0.099]
        load.P = 135750.0                              | 135.75""",
    "made from a file": """
        material.nu = 0.33
        material.E = 72.1e9                            | 72.1e3
        profile.kind = "tabulated"
        profile.x = [-1e-3, 0, 1e-3, 2e-3]             | [-1, 0, 1, 2]
        profile.gap = [1.1e-5, 0, 1.1e-5, 4.4e-5]      | [0.011, 0, 0.011, 0.044]
        profile.measured.file = "pad.csv"
        profile.measured.points = 100
        profile.measured.unit = [1e-3, 1e-6]           | [1, 1e-3]
        profile.measured.smooth = 1e-3                 | 1
        profile.measured.noise = 2e-7                  | 2e-4
        profile.measured.offset = 3e-6                 | 3e-3
        profile.measured.centre = 5e-5                 | 5e-2
        profile.measured.misfit = 1e-7                 | 1e-4
        load.P = 135750.0                              | 135.75""",
    "moment": """
        material.nu = 0.33
        material.E = 72.1e9                            | 72.1e3
        profile.kind = "hertz"
        profile.R = 0.017                              | 17
        load.P = 135750.0                              | 135.75
        load.e = 3e-6                                  | 3e-3
        friction.f = [0.3, 0.2]
        friction.x = [-1e-4, 2e-4]                     | [-0.1, 0.2]""",
}
ALWAYS = 'units = "{}"\nname = "twin"\nfem.size = 0.05\nfem.width = 16\n'
WITH_DIMENSION = sorted(key for key, of in DIMENSIONS.items() if N_MM.size(of) != 1)


def twins(kind):
    """The tables of a scene in SI units and in N, mm and MPa."""
    lines = [line.partition("|") for line in TWINS[kind].splitlines() if line.strip()]
    second = "\n".join(f"{first.partition('=')[0]} = {other}" if other else first for first, _, other in lines)
    texts = "\n".join(first for first, _, _ in lines), second
    always = ALWAYS if "friction.f" in TWINS[kind] else ALWAYS + "friction.f = 0.3\n"
    return [tomllib.loads(always.format(name) + text) for name, text in zip(("SI", "N-mm"), texts, strict=True)]


def in_si(scene):
    """The scene without the units in which it is shown."""
    return msgspec.structs.replace(scene, shown_in="SI")


def keys(data, path=""):
    """Keys of all numbers of nested tables."""
    if isinstance(data, dict):
        return set(chain.from_iterable(keys(child, f"{path}.{key}".lstrip(".")) for key, child in data.items()))
    numbers = data if isinstance(data, list) else [data]
    return {path} if all(isinstance(number, (int, float)) for number in numbers) else set()


def differ():
    """Kinds of twins that are not the same scene, bit for bit."""
    found = []
    for kind in TWINS:
        one, other = twins(kind)
        try:
            same = parse_scene(one) == in_si(parse_scene(other))
        except InputError:  # sizes that no scene has
            same = False
        found += [] if same else [kind]
    return found


# --- dimensions


def types(kind, path=""):
    """Types of all values of a table type by key."""
    for field in msgspec.structs.fields(kind):
        inner = [each for each in (field.type, *getattr(field.type, "__args__", ())) if isinstance(each, type)]
        tables = [each for each in inner if issubclass(each, Table)]
        if not tables:
            yield f"{path}{field.encode_name}", str(field.type)
        for table in tables:
            yield from types(table, f"{path}{field.encode_name}.")


def test_every_number_of_a_scene_has_a_dimension():
    """And only those: whole numbers are counts."""
    assert {Hertz, FlatRounded, Tabulated} <= set(Scene.__annotations__["profile"].__args__)
    keys = {key for key, kind in types(Scene) if "float" in kind}
    widths = {key for key in keys if key.startswith("tolerance.")}
    assert keys - widths == set(DIMENSIONS)
    assert {dimension(key) for key in widths} <= {dimension(key) for key in DIMENSIONS}
    assert {key.removeprefix("tolerance.").removesuffix(".std") for key in widths} < set(DIMENSIONS)


def test_the_twins_have_every_key_with_a_dimension():
    assert set.union(*(keys(twins(kind)[1]) for kind in TWINS)) >= set(WITH_DIMENSION)


def test_twins_are_the_same_scene_bit_for_bit():
    assert differ() == []


@pytest.mark.fault
@pytest.mark.parametrize("key", WITH_DIMENSION)
def test_dimension_of_a_key_wrong(monkeypatch, key):
    """A deliberate fault: a key left out of the table, or in it with another dimension."""
    others = {"m": "Pa", "Pa": "N/m", "N/m": "Pa", "Pa/m": "Pa"}
    for wrong in ("1", others[DIMENSIONS[key]]):
        with monkeypatch.context() as patched:
            patched.setitem(DIMENSIONS, key, wrong)
            assert differ() != []


def test_a_mesh_without_a_unit_is_in_the_units_of_the_scene():
    for data, size in zip(twins("meshes"), (None, 1e-3), strict=True):
        del data["bodies"]["lower"]["unit"]
        scene = parse_scene(data)
        assert scene.bodies.lower.unit == size
        assert parse_scene(scene_tables(scene)) == scene
    shown = parse_scene(twins("meshes")[0] | {"shown_in": "N-mm"})  # written in mm, the mesh stays in m
    shown = msgspec.structs.replace(shown, bodies=parse_scene(data | {"units": "SI"}).bodies)
    assert in_si(parse_scene(scene_tables(shown))).bodies.lower.unit == 1.0


@pytest.mark.parametrize("system", [SI, N_MM, N_UM, N_NM])
def test_systems_are_consistent(system):
    """Equations hold without factors: stress times length is force per depth, times length energy per depth / m."""
    m, Pa, force, energy = (system.size(of) for of in ("m", "Pa", "N/m", "J/m"))
    assert m * Pa == pytest.approx(force)
    assert Pa * m**2 == pytest.approx(energy)
    values = np.array([0.3, -1.7e-5, 0.0])
    for of in ("m", "Pa", "N/m", "J/m", "1"):
        assert system.from_si(system.to_si(values, of), of) == pytest.approx(values, rel=1e-15)
        assert [system.to_si(value, of) for value in values.tolist()] == pytest.approx(
            system.to_si(values, of).tolist()
        )


# --- reading and writing


@pytest.mark.parametrize("name", sorted(shipped_scenes()))
def test_a_scene_written_in_either_unit_reads_back_the_same(name):
    scene = load_scene(name)
    shown = msgspec.structs.replace(scene, shown_in="N-mm")
    for each in (scene, shown):
        assert parse_scene(scene_tables(each)) == each
        assert parse_scene(tomllib.loads(scene_toml(each))) == each
        assert parse_scene(msgspec.to_builtins(each)) == each  # plain data are in SI units
        assert msgspec.json.decode(msgspec.json.encode(each), type=Scene) == each
    assert tomllib.loads(scene_toml(shown))["material"]["E"] == scene.material.E / 1e6


def test_cases_that_differ_only_in_units_are_one_case_of_a_ledger():
    SI_scene, scene = map(parse_scene, twins("hertz"))
    assert SI_scene != scene
    assert scene_content(SI_scene) == scene_content(scene)


def test_settings_are_in_the_units_of_the_file(tmp_path):
    (tmp_path / "twin.toml").write_text(scene_toml(parse_scene(twins("hertz")[1])), "utf-8")
    scene = load_scene(tmp_path / "twin.toml", ["load.P=200", "load.Q=[-10, 10]"])
    assert scene.P == 2e5
    assert scene.load.Q == (-1e4, 1e4)
    shown = load_scene("fretting-aluminium", ["shown_in=N-mm", "load.P=2e5"])  # of a file in SI units
    assert (shown.shown_in, shown.P) == ("N-mm", 2e5)
    with pytest.raises(InputError, match=r"--set units=N-mm: must stand in the scene file"):
        load_scene("fretting-aluminium", ["units=N-mm"])


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("units = 'mm'", "units = 'mm': must be one of 'SI', 'N-mm'"),
        ("units = 1", "units = 1: must be one of 'SI', 'N-mm'"),
        ("unit = 'N-mm'", "unit: unknown key; did you mean 'units'?"),
        ("shown_in = 'mm'", "shown_in = 'mm': must be one of 'SI', 'N-mm'"),
        ("material.E = -72.1e3", "material.E = -72100.0: must be > 0"),
        ("load.P = -1", "load.P = -1: must be > 0"),
        ("load.P = 2e98", "load.P = 2e+98: must be zero or of a size from 1e-100 to 1e+100 in SI units"),
        ("bodies.upper = {kind = 'pad', width = 1, height = 3}",
         "bodies.upper.width = 1.0: must be <= 0.54 mm, the profile's width"),
        ("bodies.upper = {kind = 'pad', width = 0.5, height = 0.1}",
         "bodies.upper.height = 0.1: must be > 0.149076 mm, as the face recedes by 0.134169 mm"),
        ("bodies.upper = {width = 10, height = 1e-4}",
         "bodies.upper.height = 0.0001: must be 0.0001 to 10000 times the width, 10.0 mm"),
        ("profile = {kind = 'tabulated', x = [0, 1, 2, 3], gap = [0, 1, 3, 4]}",
         "profile.gap: must be convex; its slope decreases at x = 2.0 mm"),
        ("profile = {kind = 'tabulated', x = [0, 1, 2, 2], gap = [0, 1, 3, 4]}",
         "profile.x[3] = 2.0: must be > profile.x[2] = 2.0"),
    ],
)  # fmt: skip
def test_messages_name_values_and_units_as_written(setting, message):
    data, changed = twins("hertz")[1], tomllib.loads(setting)
    for key, value in changed.items():
        data[key] = data[key] | value if isinstance(value, dict) and key in data and "kind" not in value else value
    assert line_of(parse_scene, data).startswith(message)


def test_messages_of_methods_are_in_the_scene_units():
    narrow = twins("tabulated")[1]
    narrow["load"]["P"] = 1e5
    with pytest.raises(InputError, match=r"load.P = 100000: must keep .* which ends at 3 mm"):
        partialslip.run(parse_scene(narrow), ["exact"])


# --- results


@pytest.fixture(scope="module")
def pair():
    """The same scene in both units, solved exactly; with made-up stresses along the surfaces."""
    runs = [partialslip.run(parse_scene(data), ["exact"]) for data in twins("hertz")]
    for run in runs:
        x = np.array([-1e-4, 1e-4])
        surface = SurfaceStress(x, 1e6 * np.arange(8.0).reshape(2, 2, 2), lambda x: x)
        run.results["exact"] = replace(run.results["exact"], surface=surface)
    return runs


def test_results_are_the_same_bit_for_bit(pair):
    one, other = (run.results["exact"] for run in pair)
    assert (one.a, one.p0, one.m, one.n, one.regime) == (other.a, other.p0, other.m, other.n, other.regime)
    for key, column in one.columns.items():
        assert np.array_equal(column, other.columns[key])
    assert one.limits == other.limits
    assert one.slip.dissipated == other.slip.dissipated


@pytest.mark.parametrize("kind", ["hertz", "tabulated"])
def test_the_same_numbers_in_another_system_give_the_same_numbers(kind):
    """No factor between units is missing: equations of mechanics hold in any consistent system."""
    data = twins(kind)[1]
    exact = [partialslip.run(parse_scene(data | {"units": units}), ["exact"]) for units in ("SI", "N-mm")]
    plain, scene = (run.results["exact"] for run in exact)
    for of, values in {"m": ("a", "m", "n"), "Pa": ("p0",)}.items():
        for key in values:
            assert N_MM.from_si(getattr(scene, key), of) == pytest.approx(getattr(plain, key), rel=1e-12)
    if kind == "hertz":  # J/m and N mm/mm; without shear there is no slip
        assert scene.slip.dissipated == pytest.approx(plain.slip.dissipated, rel=1e-12)


def test_tables_name_the_units(pair):
    run = pair[1]
    result, units = run.results["exact"], run.scene.units
    assert rows.units(run) == f"exact: f p0 = {0.3 * result.p0 / 1e6:.6g} MPa, P = 135.75 N/mm"
    found = dict(answer.answers(run))
    assert found["a"] == f"{result.a * 1e3:.7g} mm"
    assert found["p0"] == f"{result.p0 / 1e6:.7g} MPa"
    facts = rows.facts(result, units=units)
    assert "slides at |Q| = 40.73 N/mm" in facts["limits"]
    assert facts["slip"].endswith(f"{result.slip.dissipated:.7g} N mm/mm dissipated a cycle")
    assert ("material", "E", "72100 MPa") in [(table or "material", *rest) for table, *rest in rows.settings(run.scene)]
    assert "Q goes between -13.1 and 38.75 N/mm" in run.plan.called_for.values()


def test_csv_files_are_in_the_units_of_the_scene(pair):
    for text in (tractions_csv, surface_csv):
        plain, shown = (list(csv.reader(io.StringIO(text(run)))) for run in pair)
        sizes = [{"": 1, "[mm]": 1e-3, "[MPa]": 1e6}[head.partition(" ")[2]] for head in shown[0]]
        assert [head.split()[0] for head in shown[0]] == plain[0]
        assert sum(size != 1 for size in sizes) == len(plain[0]) - 2  # all but method and x/a
        for one, other in zip(plain[1:], shown[1:], strict=True):
            for value, same, size in zip(one[1:], other[1:], sizes[1:], strict=True):
                assert value == same == "" or float(same) * size == pytest.approx(float(value), rel=1e-15, abs=1e-300)


def test_results_json_holds_si_units(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "twin.toml").write_text(scene_toml(parse_scene(twins("hertz")[1])), "utf-8")
    assert main(["run", "twin.toml", "--with", "exact", "--json"]) == 0
    found = msgspec.json.decode(capsys.readouterr().out)["scene"]
    assert (found["shown_in"], found["load"]["P"]) == ("N-mm", 135750.0)
    assert "units" not in found
    assert parse_scene(found) == load_scene("twin.toml")
