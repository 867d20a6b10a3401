"""Decks for MOOSE and Code_Aster: nobody of this project has run them, so that all in them that can be is checked."""

import re
import zipfile

import meshio
import numpy as np
import pytest
from decks import COARSE
from named_decks import Mail, Table, aster_concepts, moose_blocks
from refusing import line_of

from partialslip import load_scene, score
from partialslip.cli import main
from partialslip.codes.export import export
from partialslip.codes.export import named_boundaries as naming
from partialslip.codes.export.aster import aster_files
from partialslip.codes.export.model import modelled
from partialslip.codes.export.moose import moose_files
from partialslip.run import run

SCENE = "hertz-large-tension"
PULLED = ["bodies.upper={kind='pad', width=0.02, height=0.01, holder={width=0.03, height=0.01}}",
          "bodies.lower={width=0.06, height=0.01, support='roller', pulled=true}"]  # fmt: skip
SCENES = {
    "half-planes": [], "clamped block": ["bodies.lower={width=0.012, height=0.008}"], "pulled": PULLED,
    "rollers": [f"bodies.{name}={{width=0.016, height=0.008, support='roller'}}" for name in ("lower", "upper")],
    "unlike": ["material.upper={E=2e11, nu=0.3}", "load.sigma=[0, 0]"],
    "varying": ["load={P=[4e5, 8e5], Q=[-1e5, 1e5], sigma=[0, 4e7], steps=3, cycles=2}"],
    "pressed": ["load.Q=[0, 0]", "load.sigma=[0, 0]", "friction.f=0"], "N-mm": ["shown_in='N-mm'"],
}  # fmt: skip


@pytest.fixture(scope="module", params=SCENES)
def case(request):
    """Scene, its model in its own units, and the files of both decks by name."""
    scene = load_scene(SCENE, SCENES[request.param])
    made = modelled(scene, 0.3, growth=0.4)
    return scene, made.in_units(scene.units), moose_files(scene, made, "deck") | aster_files(scene, made, "deck")


def moose_mesh(content, tmp_path):
    """Points, and edges of each named line."""
    (tmp_path / "mesh.msh").write_bytes(content)
    read = meshio.gmsh.read(tmp_path / "mesh.msh")
    numbers = read.cell_data_dict["gmsh:physical"]["line"]
    lines = {name: read.cells_dict["line"][numbers == number]
             for name, (number, dimension) in read.field_data.items() if dimension == 1}  # fmt: skip
    bodies = {name for name, (_, dimension) in read.field_data.items() if dimension == 2}
    return read.points[:, :2], lines, bodies


def moose_value(functions, name, time, x=0.0, y=0.0):
    """Value of a function of the input file."""
    told = functions[name]
    if told["type"] == "PiecewiseLinear":
        times, values = (np.array(told[key].split(), dtype=float) for key in "xy")
        return np.interp(time, times, values)
    load = told["symbol_values"]
    return eval(told["expression"], {"x": x, "y": y, told["symbol_names"]: moose_value(functions, load, time)})


def moose_forces(deck, points, lines, time):
    """Sum of the tractions of the input file, by body and direction."""
    total = dict.fromkeys([(body, axis) for body in ("lower", "upper") for axis in "xy"], 0.0)
    for told in deck["BCs"].values():
        if told["type"] == "FunctionNeumannBC":
            edges = lines[told["boundary"]]
            length = np.linalg.norm(np.diff(points[edges], axis=1)[:, 0], axis=1).sum()
            key = told["boundary"].partition("-")[0], told["variable"][-1]
            total[key] += moose_value(deck["Functions"], told["function"], time) * length
    return total


def expected(scene, step):
    """Sum of the forces of a ``step``, by body and direction, in the units of the deck."""
    lower = scene.bodies.lower
    pulled = lower is not None and lower.pulled
    height = scene.units.from_si(lower.height, "m") if pulled else 0.0
    return {("upper", "x"): -step.Q, ("upper", "y"): -step.P, ("lower", "x"): step.sigma * height, ("lower", "y"): 0.0}


def test_moose_names_what_there_is(case, tmp_path):
    """Blocks, boundaries, functions, files and multipliers."""
    _, _, files = case
    text = files["deck.i"].decode()
    assert "# untested" in text
    deck = moose_blocks(text)
    _, lines, bodies = moose_mesh(files["deck.msh"], tmp_path)
    assert deck["Mesh"]["bodies"]["file"] in files
    boundaries = {name for told in deck["BCs"].values() for name in told["boundary"].split()}
    boundaries |= {told["secondary"] for told in deck["Constraints"].values()}
    (contact,) = deck["Contact"].values()
    boundaries |= {contact["primary"], contact["secondary"], deck["VectorPostprocessors"]["tractions"]["boundary"]}
    assert boundaries <= lines.keys()
    assert set(deck["Physics/SolidMechanics/QuasiStatic"]["bodies"]["block"].split()) == bodies
    assert {told["block"] for told in deck["Materials"].values()} == {"lower", "upper", "lower upper"}
    assert {told["function"] for told in deck["BCs"].values() if "function" in told} <= deck["Functions"].keys()
    for period in deck.get("Controls", {}).values():
        assert period["enable_objects"].removeprefix("BCs::") in deck["BCs"]


def test_moose_carries_the_loads(case, tmp_path):
    """Tractions of each step sum up to P, Q and sigma; the tension's displacements are those of the model."""
    scene, made, files = case
    deck = moose_blocks(files["deck.i"].decode())
    points, lines, _ = moose_mesh(files["deck.msh"], tmp_path)
    times = np.cumsum([step.increments for step in made.steps])
    assert int(deck["Executioner"]["end_time"]) == times[-1]
    assert deck["Outputs"]["ends"]["sync_times"].split() == [str(time) for time in times]
    force = max(step.P for step in made.steps)
    lower = made.parts[0]
    outer = lower.mesh.points[lower.outer]
    for time, step in zip(times, made.steps, strict=True):
        found = moose_forces(deck, points, lines, time)
        assert found == pytest.approx(expected(scene, step), rel=1e-9, abs=1e-9 * force)
        for k, axis in enumerate("xy"):
            moved = [moose_value(deck["Functions"], f"bulk_{axis}", time, x, y) for x, y in outer.tolist()]
            assert np.allclose(moved, made.bulk(step)[:, k], rtol=1e-9, atol=1e-15)
    held = [deck["BCs"][f"bulk_{axis}"]["boundary"] for axis in "xy"]
    for boundary, nodes in zip(held, lower.held_nodes, strict=True):
        own = np.unique(np.vstack([lines[name] for name in boundary.split()]))
        assert np.allclose(points[own], lower.mesh.points[nodes])
    guided = [step.guided for step in made.steps]
    if all(guided):
        assert "Controls" not in deck
    else:
        assert deck["Controls"]["guide"]["end_time"] == str(times[guided.index(False) - 1] + 0.5)


@pytest.mark.fault
def test_tractions_for_another_length_of_the_frame_are_seen(tmp_path, monkeypatch):
    """P over the width of the block alone, though it acts on the sides, too."""
    scene = load_scene(SCENE)
    monkeypatch.setattr(naming.Named, "length", lambda made, _: np.ptp(made.meshes["upper"].points[:, 0]))
    made = modelled(scene, **COARSE)
    case = scene, made, moose_files(scene, made, "deck") | aster_files(scene, made, "deck")
    for check in (test_moose_carries_the_loads, test_code_aster_carries_the_loads):
        with pytest.raises(AssertionError):
            check(case, tmp_path, monkeypatch) if "aster" in check.__name__ else check(case, tmp_path)


def aster_deck(files, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return aster_concepts(files["deck.comm"].decode()), Mail(files["deck.mail"].decode())


def each(factor):
    """Occurrences of a factor keyword: one, or several."""
    return [factor] if isinstance(factor, dict) else list(factor)


def groups_of(value, keyword):
    """Groups that a concept names with the keyword, at any depth."""
    if isinstance(value, dict):
        own = value.get(keyword, ())
        yield from (own,) if isinstance(own, str) else own
        for inner in value.values():
            yield from groups_of(inner, keyword)
    elif isinstance(value, (list, tuple)):
        for inner in value:
            yield from groups_of(inner, keyword)


def test_code_aster_names_what_there_is(case, tmp_path, monkeypatch):
    """Groups of elements and nodes, and the files of the export."""
    *_, files = case
    assert b"# untested" in files["deck.comm"]
    names, mail = aster_deck(files, tmp_path, monkeypatch)
    given = [concept.given for concept in names.values() if hasattr(concept, "given")]
    for keyword in ("GROUP_MA", "GROUP_MA_PEAU", "GROUP_MA_MAIT", "GROUP_MA_ESCL"):
        assert set(groups_of(given, keyword)) <= mail.of_cells.keys(), keyword
    assert set(groups_of(given, "GROUP_NO")) <= mail.of_nodes.keys()
    assert all(set(members) <= mail.cells.keys() for members in mail.of_cells.values())
    assert all(set(members) <= mail.nodes.keys() for members in mail.of_nodes.values())
    told = [line.split() for line in files["deck.export"].decode().splitlines()]
    assert {words[2] for words in told if words[0] == "F" and words[3] == "D"} == {"deck.comm", "deck.mail"}
    assert [words[4] for words in told if words[2] == "deck.mail"] == [
        str(names["MESH"].given["MAILLAGE"].given["UNITE"])
    ]
    assert [words[4] for words in told if words[2] == "deck.csv"] == ["38"]
    assert (tmp_path / "fort.38").read_text("utf-8") == "x,p1,p,q1,q2\n"


def test_edges_have_the_body_on_the_left(case, tmp_path, monkeypatch):
    """So that their normals point outwards."""
    _, mail = aster_deck(case[2], tmp_path, monkeypatch)
    sides = {
        (corners[k], corners[(k + 1) % 4])
        for cell, corners in mail.cells.items()
        if mail.kinds[cell] == "QUAD4"
        for k in range(4)
    }
    assert {tuple(ends) for cell, ends in mail.cells.items() if mail.kinds[cell] == "SEG2"} <= sides


def test_code_aster_carries_the_loads(case, tmp_path, monkeypatch):
    scene, made, files = case
    names, mail = aster_deck(files, tmp_path, monkeypatch)
    times = np.cumsum([step.increments for step in made.steps]).tolist()
    intervals = names["TIMES"].given["INTERVALLE"]
    assert [(each["JUSQU_A"], each["NOMBRE"]) for each in intervals] == [
        (time, step.increments) for time, step in zip(times, made.steps, strict=True)
    ]
    force = max(step.P for step in made.steps)
    for time, step in zip(times, made.steps, strict=True):
        total = dict.fromkeys([(body, axis) for body in ("lower", "upper") for axis in "xy"], 0.0)
        for charge in names["LOADS"]:
            factor = 1.0
            if "FONC_MULT" in charge:
                pairs = np.reshape(charge["FONC_MULT"].given["VALE"], (-1, 2))
                factor = np.interp(time, *pairs.T)
            for told in each(charge["CHARGE"].given.get("FORCE_CONTOUR", ())):
                length = np.linalg.norm(mail.edges(told["GROUP_MA"]), axis=1).sum()
                for axis in "xy":
                    key = told["GROUP_MA"].partition("_")[0].lower(), axis
                    total[key] += told.get(f"F{axis.upper()}", 0.0) * length * factor
        assert total == pytest.approx(expected(scene, step), rel=1e-9, abs=1e-9 * force)
    lower = made.parts[0]
    for axis, nodes, strain in zip("XY", lower.held_nodes, lower.strained, strict=True):
        held = np.array([mail.nodes[node] for node in mail.of_nodes[f"HELD_{axis}"]])
        assert np.allclose(held, lower.mesh.points[nodes], rtol=1e-12, atol=1e-15)
        assert eval(names[f"U{axis}"].given["VALE"], {"X": 2.0, "Y": 2.0}) == pytest.approx(2 * strain, rel=1e-9)
    free = [time for time, step in zip(times, made.steps, strict=True) if not step.guided]
    assert ("RES2" in names) == bool(free)
    assert names["RES1"].given["INCREMENT"]["INST_FIN"] in times


def test_the_table_of_code_aster_is_scored(tmp_path, monkeypatch):
    """With the multipliers of the exact solution: pressures are negative, shear is in f p."""
    scene = load_scene(SCENE)
    exact = run(scene, "exact")["exact"]
    x = np.linspace(-1.2, 1.2, 481)[::-1] * exact.a
    at = exact.traction.at(x)
    shear = {3.0: at.q1, 4.0: at.q2}

    def columns(given):
        p = np.maximum(at.p, 1e-300)
        return {"COOR_X": x.tolist(), "LAGS_C": (-at.p).tolist(),
                "LAGS_F1": (shear[given["INST"]] / (scene.friction.f * p)).tolist()}  # fmt: skip

    monkeypatch.setattr(Table, "columns", staticmethod(columns))
    files = aster_files(scene, modelled(scene, **COARSE), "deck")
    aster_deck(files, tmp_path, monkeypatch)
    (tmp_path / "fort.38").rename("deck.csv")
    found = score(scene, "deck.csv")
    assert found.comparisons["deck.csv"].m < 2e-3
    assert found.comparisons["deck.csv"].n < 2e-3
    assert not found.results["deck.csv"].notes


def test_the_table_of_moose_is_scored(tmp_path, monkeypatch):
    """By the names of the multipliers. Where the loads are fully reversed load point 2 is enough. The multiplier of
    friction is -q, as the header says."""
    scene = load_scene(SCENE)
    text = moose_files(scene, modelled(scene, **COARSE), "deck")["deck.i"].decode()
    assert "q is -frictional_tangential_lm" in text
    deck = moose_blocks(text)
    exact = run(scene, "exact")["exact"]
    x = np.linspace(-1.2, 1.2, 481) * exact.a
    at = exact.traction.at(x)
    columns = ["id", *deck["VectorPostprocessors"]["tractions"]["variable"].split(), "x", "y", "z"]
    table = np.column_stack([np.arange(len(x)), at.p, -at.q2, x, 0 * x, 0 * x])
    monkeypatch.chdir(tmp_path)
    np.savetxt("deck.csv", table, delimiter=",", header=",".join(columns), comments="")
    assert "--factors 1,1,-1" in score(scene, "deck.csv").results["deck.csv"].notes[0]
    assert score(scene, "deck.csv", factors=(1.0, 1.0, -1.0)).comparisons["deck.csv"].m < 2e-3


@pytest.mark.parametrize("to", ["moose", "code-aster"])
def test_command(to, tmp_path, monkeypatch, capsys):
    """An archive of the files, which the deck names; its name says that nobody has run it."""
    monkeypatch.chdir(tmp_path)
    assert main(["export", SCENE, "--to", to, "--size", "0.5", "--growth", "1"]) == 0
    (path,) = (tmp_path / "results").iterdir()
    assert path.name.startswith(f"{SCENE}-{to}-untested")
    assert path.name in capsys.readouterr().out
    with zipfile.ZipFile(path) as archive:
        endings = {"moose": [".i", ".msh"], "code-aster": [".comm", ".mail", ".export"]}[to]
        assert archive.namelist() == [f"{SCENE}-untested{ending}" for ending in endings]
    first = path.read_bytes()
    assert main(["export", SCENE, "--to", to, "--size", "0.5", "--growth", "1"]) == 0
    assert path.read_bytes() == first


@pytest.mark.parametrize("to", ["moose", "code-aster"])
@pytest.mark.parametrize(
    ("overrides", "said"),
    [
        (["load.e=[-1e-4, 1e-4]"], "load.e: must be left out to export to {}"),
        (["load.displacement=[-1e-6, 1e-6]", "load.Q=[0, 0]",
          *(f"bodies.{name}={{width=0.016, height=0.008}}" for name in ("lower", "upper"))],
         "load.displacement = [-1e-06, 1e-06] m: must be load.Q here"),
        (["friction={x=[-1e-3, 1e-3], f=[0.4, 0.6]}"], "friction.f = 0.4 to 0.6: must be one number to export"),
        (["load.sigma_slope=[0, 1e9]"], "load.sigma_slope = [0.0, 1000000000.0]: must be 0 or left out to export"),
        (["bodies.lower={kind='pad', width=0.02, height=0.01, holder={width=0.03, height=0.01}}"],
         "bodies.lower: must be a block without a holder to export to {}"),
    ],
)  # fmt: skip
def test_what_cannot_be_carried(to, overrides, said):
    assert re.search(re.escape(said.format(to)), line_of(export, load_scene(SCENE, overrides), to, **COARSE))
