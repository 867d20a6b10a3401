"""A body whose mesh is given: by netgen 6.2 (specimen.inp, in mm)."""

from pathlib import Path

import meshio
import pytest

import partialslip
from partialslip import load_scene, plan
from partialslip.cli import main
from partialslip_fem import solve
from partialslip_fem.problem import Part
from partialslip_meshes import block

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
def result():
    """Of the specimen as it is; all formats give the same mesh (tests/meshes/test_read.py)."""
    return fem(SPECIMEN)


@pytest.mark.slow
def test_the_result_is_that_of_the_block(result):
    """Another mesh of the same body, refined to 1e-3 a: off by no more than a quarter of the given elements, whose size
    is 0.1 a: that much ends of zones are off that lie anywhere in an element."""
    lower = f"bodies.lower={{width=40e-3, height=5e-3, {LOWER.partition(', ')[2]}}}"
    chosen = load_scene(SCENE, [lower, PAD, "load.cycles=2", "fem.accuracy=1e-3"])
    block = solve(chosen, plan(chosen))
    assert result.certificate["kkt"] < 1e-8
    assert result.settings["meshes"] == "of the size of the given one"
    assert (result.a, result.m, result.n) == pytest.approx((block.a, block.m, block.n), abs=2.5e-2 * block.a)


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
