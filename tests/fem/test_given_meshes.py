"""A body whose mesh is given: by netgen 6.2 (specimen.inp, in mm), written through meshio to three more formats."""

from pathlib import Path

import meshio
import numpy as np
import pytest

import partialslip
from partialslip import load_scene, plan
from partialslip.cli import main
from partialslip.result import Clock
from partialslip.tools.threads import one_thread
from partialslip_fem import solve
from partialslip_fem.problem import Part, scaled
from partialslip_fem.solving import solve_on_meshes
from partialslip_fem.uniform import uniform
from partialslip_meshes import Mesh, block

SPECIMEN = Path(__file__).parents[1] / "meshes" / "specimen.inp"  # 40 mm x 5 mm
SCENE = "fretting-aluminium"  # a = 0.2 mm
LOWER = "unit=1e-3, support='roller', pulled=true"
PAD = "bodies.upper={kind='pad', width=10e-3, height=5e-3, support='sides'}"


def scene(path, lower=LOWER, *overrides):
    return load_scene(SCENE, [f"bodies.lower={{mesh='{path}', {lower}}}", PAD, "load.cycles=2", *overrides])


def fem(*args):
    chosen = scene(*args)
    return solve(chosen, plan(chosen))


@pytest.fixture(scope="module")
def found():
    return meshio.read(SPECIMEN)


@pytest.fixture(scope="module")
def formats(found, tmp_path_factory):
    """The same mesh in all formats, by suffix."""
    folder = tmp_path_factory.mktemp("meshes")
    triangles, lines = (block.data for block in found.cells)
    groups = {name: members[1] for name, members in found.cell_sets.items()}
    tag = np.zeros(len(lines), dtype=int)
    for number, members in enumerate(groups.values(), start=1):
        tag[members] = number
    none, cells = np.zeros(len(triangles), dtype=int), found.cells
    physical = {f"gmsh:{kind}": [none + 9, tag] for kind in ("physical", "geometrical")}
    names = {name: np.array([number, 1]) for number, name in enumerate(groups, start=1)}
    msh = meshio.Mesh(found.points, cells, cell_data=physical, field_data=names)
    med = meshio.Mesh(found.points[:, :2], cells, cell_data={"cell_tags": [none, -tag]})
    med.cell_tags = {-number: [name] for number, name in enumerate(groups, start=1)}
    member = {name: [none, tag == number] for number, name in enumerate(groups, start=1)}
    vtu = meshio.Mesh(found.points, cells, cell_data={k: [a, b.astype(int)] for k, (a, b) in member.items()})
    meshio.write(folder / "s.msh", msh, file_format="gmsh22", binary=True)
    meshio.write(folder / "s.med", med)
    meshio.write(folder / "s.vtu", vtu)
    return {".inp": SPECIMEN} | {suffix: folder / f"s{suffix}" for suffix in (".msh", ".med", ".vtu")}


@pytest.fixture(scope="module")
def results(formats):
    return {suffix: fem(path) for suffix, path in formats.items()}


@pytest.mark.slow
def test_all_formats_give_the_same_result(results):
    """To the last bit."""
    first, *others = results.values()
    for other in others:
        assert (other.a, other.m, other.n, other.p0) == (first.a, first.m, first.n, first.p0)
        assert np.array_equal(other.traction.q2, first.traction.q2)
    assert first.certificate["kkt"] < 1e-8
    assert first.settings["meshes"] == "of the size of the given one"


@pytest.mark.slow
def test_the_result_is_that_of_the_arrays(found, results):
    """The same without any file: the mesh's arrays, laid where they belong by hand."""
    chosen = scene(SPECIMEN)
    problem = scaled(chosen, plan(chosen))
    triangles, lines = (block.data for block in found.cells)
    names = {name: lines[members[1]] for name, members in found.cell_sets.items()}
    mesh = Mesh(found.points[:, :2] * 1e-3 / chosen.length, triangles, names)
    mesh = Mesh(mesh.points, counter_clockwise(mesh), names)
    # on one thread, as methods are: which nodes bear next to nothing is up to rounding, and moves the fitted ends
    found = one_thread(uniform)(problem, None, 16.0, Clock()).solution
    direct = one_thread(solve_on_meshes)([mesh, found.bodies[1].mesh], problem, 16.0, Clock())
    assert direct.half_width * chosen.length == pytest.approx(results[".inp"].a, rel=1e-10)
    assert direct.zone_ends == pytest.approx(found.zone_ends, abs=1e-10)


def counter_clockwise(mesh):
    a, b, c = (mesh.points[mesh.triangles[:, corner]] for corner in range(3))
    turned = np.linalg.det(np.stack([b - a, c - a], axis=1)) < 0
    return np.where(turned[:, None], mesh.triangles[:, ::-1], mesh.triangles)


@pytest.mark.slow
def test_the_result_is_that_of_the_block(results):
    """Another mesh of the same body, refined to 1e-3 a: off by no more than a quarter of the given elements, whose size
    is 0.1 a: that much ends of zones are off that lie anywhere in an element."""
    lower = f"bodies.lower={{width=40e-3, height=5e-3, {LOWER.partition(', ')[2]}}}"
    chosen = load_scene(SCENE, [lower, PAD, "load.cycles=2", "fem.accuracy=1e-3"])
    block, given = solve(chosen, plan(chosen)), results[".inp"]
    assert (given.a, given.m, given.n) == pytest.approx((block.a, block.m, block.n), abs=2.5e-2 * block.a)


def test_both_bodies_given(found, tmp_path):
    """One file for both bodies, the upper one its mirror image: one factorisation, and as sizes go a half-plane."""
    support = f"{{mesh='{SPECIMEN}', unit=1e-3, support='sides'}}"
    chosen = load_scene(SCENE, [f"bodies.lower={support}", f"bodies.upper={support}"])
    outcome = partialslip.run(chosen)
    assert outcome.results["fem"].counts["factorizations"] == 1
    assert outcome.results["fem"].settings["meshes"] == "as given"
    assert outcome.comparisons["fem"].a < 2e-2
    assert not outcome.missed
    mirrored = tmp_path / "upper.inp"
    meshio.write(mirrored, meshio.Mesh(found.points * [1, -1, 1] + [0, 7, 0], found.cells, cell_sets=found.cell_sets))
    other = load_scene(
        SCENE, [f"bodies.lower={support}", f"bodies.upper={support.replace(str(SPECIMEN), str(mirrored))}"]
    )
    two, one = solve(other, plan(other)), outcome.results["fem"]
    assert two.counts["factorizations"] == 2
    assert (two.a, two.m, two.n) == pytest.approx((one.a, one.m, one.n), rel=1e-9)


def test_left_and_right_exchanged(found, tmp_path):
    """The specimen turned round, and Q with it: m and n change places, to rounding."""
    turned = tmp_path / "turned.inp"
    sets = dict(found.cell_sets)
    sets["left"], sets["right"] = sets["right"], sets["left"]
    meshio.write(turned, meshio.Mesh(found.points * [-1, 1, 1], found.cells, cell_sets=sets))
    lower, loads = "unit=1e-3, support='sides'", ["load.sigma=[0, 0]", "load.Q=[0, 3e4]"]
    both = [
        load_scene(SCENE, [f"bodies.{name}={{mesh='{path}', {lower}}}" for name in ("lower", "upper")] + way)
        for path, way in ((SPECIMEN, loads), (turned, [loads[0], "load.Q=[0, -3e4]"]))
    ]
    one, other = (solve(each, plan(each)) for each in both)
    assert (one.a, one.m, one.n) == pytest.approx((other.a, other.n, other.m), rel=1e-9)


def test_a_mesh_beside_a_half_plane():
    chosen = load_scene(SCENE, [f"bodies.lower={{mesh='{SPECIMEN}', unit=1e-3}}", "load.cycles=2"])
    outcome = partialslip.run(chosen)
    assert outcome.comparisons["fem"].a < 1e-2
    assert outcome.results["fem"].settings["far_field"] == "half-plane"


@pytest.mark.parametrize(
    ("lower", "why"),
    [
        ("support='roller', pulled=true", r"the contact lines must lie opposite each other; is their unit right\?"),
        ("unit=8e-3", r"bodies.lower.mesh: must have more than 4 elements in the contact, not \d; is .*unit right\?"),
        ("unit=1e-6", r"bodies.lower.mesh.*: must be wider than the contact"),
        ("unit=1e-3, kind='pad'", ": contact line must be of the profile's shape"),
    ],
)
def test_meshes_that_do_not_fit_are_refused(lower, why):
    chosen = load_scene(SCENE, [f"bodies.lower={{mesh='{SPECIMEN}', {lower}}}"])
    with pytest.raises(partialslip.InputError, match=why):
        solve(chosen, plan(chosen))


def test_paths_are_relative_to_the_scene(tmp_path, monkeypatch, capsys):
    text = "[bodies.lower]\nmesh = 'specimen.inp'\nunit = 1e-3\n"
    scenes = tmp_path / "scenes"
    scenes.mkdir()
    (scenes / "specimen.inp").write_bytes(SPECIMEN.read_bytes())
    shipped = Path(partialslip.__file__).parent / "scene" / "shipped" / f"{SCENE}.toml"
    (scenes / "mine.toml").write_text(shipped.read_text("utf-8") + "\n" + text, "utf-8")
    monkeypatch.chdir(tmp_path)
    assert main(["run", "scenes/mine.toml", "--with", "fem", "--json"]) == 0
    assert '"meshes": "of the size of the given one"' in capsys.readouterr().out
    (scenes / "specimen.inp").write_text("*NODE\n", "utf-8")
    assert main(["run", "scenes/mine.toml", "--with", "fem", "--json"]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_parts_that_are_given_are_told_apart():
    """Bodies are kept for other loads by what they are: a mesh by its identity."""
    one, other = (block(1.0, (-0.5, 0.5), {0.0: 0.2}, 0.5) for _ in range(2))
    assert Part("lower", 1.8, 1.0, mesh=one) == Part("lower", 1.8, 1.0, mesh=one)
    assert Part("lower", 1.8, 1.0, mesh=one) != Part("lower", 1.8, 1.0, mesh=other)
