"""Exported decks and meshes: what is in them is the scene."""

import re
from dataclasses import replace
from itertools import pairwise

import meshio
import msgspec
import numpy as np
import pytest
from decks import COARSE, UNIT, Deck, deck_equations, places

from partialslip import load_scene
from partialslip.cli import main
from partialslip.codes.export import FORMATS, export
from partialslip.codes.export import model as models
from partialslip.codes.export.inp import deck_units
from partialslip.codes.export.model import modelled
from partialslip.scene.units import N_MM, N_UM, SI
from partialslip.tools.errors import InputError

SCENE, SIZE, GROWTH, STIFFER = "hertz-large-tension", 0.1, 0.4, 100.0
# corners of the sides of a brick, in the numbering of Abaqus and CalculiX
BRICK = {"S3": (0, 4, 5, 1), "S4": (1, 5, 6, 2), "S5": (2, 6, 7, 3), "S6": (3, 7, 4, 0)}
SQUARE = {"S1": (0, 1), "S2": (1, 2), "S3": (2, 3), "S4": (3, 0)}


@pytest.fixture(scope="module")
def scene():
    return load_scene(SCENE)


@pytest.fixture(scope="module")
def made(scene):
    return modelled(scene, SIZE, growth=GROWTH, stiffer=STIFFER)


@pytest.fixture(scope="module")
def files(scene, tmp_path_factory):
    folder = tmp_path_factory.mktemp("export")
    paths = {to: folder / f"{to}{ending}" for to, ending in FORMATS.items()}
    for to, path in paths.items():
        export(scene, to, size=SIZE, growth=GROWTH, stiffer=STIFFER)(path)
    return paths


@pytest.fixture(scope="module", params=["calculix", "abaqus"])
def deck(request, files):
    """A deck, its unit of length in m, its thickness in that unit, and the sides of its elements."""
    if request.param == "calculix":
        return Deck(files["calculix"]), UNIT, SIZE * 1e-3 / UNIT, BRICK
    return Deck(files["abaqus"]), 1.0, 1.0, SQUARE


def test_elements_are_sound(deck):
    """Counter-clockwise, every node used, the bodies' area that of the blocks; bricks lie upon themselves."""
    deck, unit, thickness, sides = deck
    points, area = places(deck), 0.0
    for body in ("LOWER", "UPPER"):
        elements = deck.table(next(k for k, _ in deck.blocks if k.startswith("*ELEMENT") and k.endswith(body)), int)
        bottom = points[elements[:, 1:5], :2]
        if sides is BRICK:
            top = points[elements[:, 5:]]
            assert np.array_equal(top[..., :2], bottom)
            assert np.allclose(top[..., 2] - points[elements[:, 1:5], 2], thickness)
        x, y = np.moveaxis(bottom, -1, 0)
        corners = [np.roll(x, -i - 1, 1) - np.roll(x, -i, 1) for i in (0, 1)]
        rises = [np.roll(y, -i - 1, 1) - np.roll(y, -i, 1) for i in (0, 1)]
        assert (corners[0] * rises[1] - rises[0] * corners[1] > 0).all()
        area += ((x * np.roll(y, -1, 1) - y * np.roll(x, -1, 1)).sum() / 2) * unit**2
        numbers = deck.table(f"*NODE, NSET={body}")[:, 0].astype(int)
        assert set(elements[:, 1:].ravel()) == set(numbers)
    wide = 50 / np.sqrt(SIZE) * 1e-3
    assert area == pytest.approx(2 * 2 * wide**2, rel=1e-6)


def gap_error(x, y, scene):
    """How much the surface differs from the flattened profile, but for a shift, relative to the gap."""
    gap = scene.profile.gap_at(x) / STIFFER
    return np.ptp(y - gap) / np.ptp(gap)


def test_gap_is_the_profile(deck, scene):
    """Between the surfaces, but for the approach of the bodies and the flattening; the lower one is flat."""
    deck, unit, _, _ = deck
    points = places(deck) * unit
    lower, upper = (points[deck.members(f"{body}_CONTACT")] for body in ("LOWER", "UPPER"))
    assert not lower[:, 1].any()
    assert gap_error(*upper[:, :2].T, scene) < 1e-9
    assert np.ptp(upper[:, 1]) == pytest.approx(1.2e-3**2 / (2 * 0.05) / STIFFER, rel=1e-9)
    assert np.allclose(np.unique(lower[:, 0].round(12)), np.unique(upper[:, 0].round(12)), atol=1e-11)


def test_fault_gap_not_flattened_with_the_bodies(scene, monkeypatch):
    """Bodies stiffer but not the gap flatter, which would be another contact: the check sees it."""
    true = models._upper
    monkeypatch.setattr(models, "_upper", lambda *given: true(*given[:-1], 1.0))
    upper = modelled(scene, SIZE, growth=GROWTH, stiffer=STIFFER).parts[1]
    assert gap_error(*upper.mesh.points[upper.contact].T, scene) > 1


def test_surfaces_are_the_contact_lines(deck):
    deck, unit, _, sides = deck
    points = places(deck)
    elements = {row[0]: row[1:] for row in deck.table("*ELEMENT", int).tolist()}
    for body in ("LOWER", "UPPER"):
        faces = deck.rows(f"*SURFACE, NAME={body}_FACE")
        nodes = np.array([[elements[int(element)][corner] for corner in sides[side]] for element, side in faces])
        assert set(nodes.ravel()) == set(deck.members(f"{body}_CONTACT"))
        assert np.ptp(points[nodes][..., 0], axis=1).sum() * unit == pytest.approx(2.4e-3, rel=1e-9)


def test_loads_are_those_of_the_path(deck, scene):
    """Pressed by P alone; then P stays, and Q and the bulk strain are those of the last load point, of 1 and of 2."""
    deck, unit, thickness, _ = deck
    points, steps = places(deck), deck.steps()
    last, first, second = scene.load.points[-1], *scene.load.points
    assert len(steps) == 4
    frame, outer = int(deck.members("UPPER_OUTER")[0]), deck.members("LOWER_OUTER")
    assert steps[0][0][frame, 1] == 0  # held along x, until there is contact
    E, nu = scene.material.E * STIFFER, scene.material.nu
    for number, ((moved, forces), (Q, sigma)) in enumerate(zip(steps, ((0, 0), last, first, second), strict=True)):
        assert {node for node, _ in forces} == {frame}
        assert forces[frame, 2] / (thickness * unit) == pytest.approx(-scene.P, rel=1e-9)
        if number:
            assert (frame, 1) not in moved
            assert forces[frame, 1] / (thickness * unit) == pytest.approx(-Q, rel=1e-9)
        u = np.array([[moved[node, component] for component in (1, 2)] for node in outer.tolist()])
        strain = np.array([(u[:, i] @ points[outer, i]) / (points[outer, i] @ points[outer, i]) for i in (0, 1)])
        assert np.allclose(u, points[outer, :2] * strain, rtol=1e-9, atol=1e-9 * np.abs(u).max())
        stretched, across = E / ((1 + nu) * (1 - 2 * nu)) * np.array([[1 - nu, nu], [nu, 1 - nu]]) @ strain
        assert stretched == pytest.approx(sigma, rel=1e-9)
        assert abs(across) < 1e-9 * abs(sigma) + 1e-9


def test_steps_of_cycles_and_of_plane_stress():
    """Every cycle goes through all load points; plane stress is plane strain of a material of the same A and mu."""
    scene = load_scene(SCENE, ["load.cycles=2", "load.steps=3", "material.plane='stress'"])
    made = modelled(scene, 0.5, growth=1.0)
    points = scene.load.points
    assert [(step.Q, step.sigma) for step in made.steps] == [(0, 0), points[1], *points, *points]
    assert [step.increments for step in made.steps] == [1, *[3] * 5]
    for part in made.parts:
        assert 2 * (1 - part.nu**2) / part.E == pytest.approx(scene.material.A / 2, rel=1e-12)
        assert part.E / (1 + part.nu) == pytest.approx(scene.material.E / (1 + scene.material.nu), rel=1e-12)


def test_without_shear_it_is_pressed_only():
    scene = load_scene("hertz-shear", ["load.Q=[0, 0]"])
    assert [step.name for step in modelled(scene, 0.5, growth=1.0).steps] == ["press"]


@pytest.fixture(scope="module")
def varying(scene):
    """Loads out of phase at three load points, in two cycles; P is largest at the second point."""
    loads = {"P": (4e5, 8e5, 6e5), "Q": (-1e5, 0.0, 1e5), "sigma": (0.0, 4e7, 8e7), "cycles": 2, "p0": None}
    return scene.replace(load=loads)


def pressed_with(scene, to, path):
    """P of each step of the deck, N/m."""
    export(scene, to, **COARSE)(path)
    deck = Deck(path)
    thickness = np.nanmax(places(deck)[:, 2]) * UNIT if to == "calculix" else 1.0
    frame = int(deck.members("UPPER_OUTER")[0])
    return [-forces[frame, 2] / thickness for _, forces in deck.steps()]


@pytest.mark.parametrize("to", ["calculix", "abaqus"])
def test_each_step_presses_with_p_of_its_load_point(varying, to, tmp_path):
    """And the first one with that of the last load point, where the path begins."""
    P = varying.load.P
    assert pressed_with(varying, to, tmp_path / "deck") == pytest.approx([P[-1], P[-1], *P, *P], rel=1e-9)
    head = (tmp_path / "deck").read_text("ascii").split("*NODE")[0]
    assert "cycle 2, load point 2: P = 800000 N/m, Q = 0 N/m, sigma = 40000000 Pa\n" in head
    assert "P = 600000 N/m at load point 3\n" in head  # of load points 1 and 2, the extremes of Q


@pytest.mark.fault
def test_p_that_stays_is_seen(varying, monkeypatch, tmp_path):
    """P of one load point in all steps."""
    true = models.steps_of
    monkeypatch.setattr(models, "steps_of", lambda scene: tuple(s._replace(P=scene.P) for s in true(scene)))
    assert pressed_with(varying, "abaqus", tmp_path / "deck")[2] == pytest.approx(1.5 * varying.load.P[0])


def test_the_mesh_resolves_the_smallest_contact_and_reaches_beyond_the_largest(scene, varying):
    made = modelled(varying, SIZE, growth=GROWTH)
    least, most, a = (1e-3 * np.sqrt(P / scene.P) for P in varying.load.P)
    assert made.a == pytest.approx(a, rel=1e-9)
    for part in made.parts:
        x = np.unique(part.mesh.points[part.contact, 0])
        assert np.diff(x).max() < 1.05 * SIZE * least
        assert x[-1] == -x[0] == pytest.approx(1.2 * most, rel=1e-9)


def test_without_friction_the_upper_body_is_held_in_every_step(varying, tmp_path):
    scene = varying.replace(friction={"f": 0.0}, load={"Q": (0.0, 0.0, 0.0), "sigma": (0.0, 0.0, 0.0)})
    export(scene, "abaqus", **COARSE)(tmp_path / "deck")
    deck = Deck(tmp_path / "deck")
    frame = int(deck.members("UPPER_OUTER")[0])
    assert [moved.get((frame, 1)) for moved, _ in deck.steps()] == [0.0] * 8


def test_frame_is_rigid(deck):
    """Every other node of the upper body's outer boundary is tied to its first, along x and y."""
    deck, *_ = deck
    first, *others = deck.members("UPPER_OUTER").tolist()
    tied = {
        (row[0], row[1]) for keyword, (_, row) in deck_equations(deck) if row[2:] == ["1.", str(first), row[1], "-1."]
    }
    assert tied == {(str(node), component) for node in others for component in "12"}


def test_units_change_nothing(scene, made):
    """Stress over stiffness, and lengths over a, are what they were."""
    other = made.in_units(N_UM)
    for before, after in zip(made.parts, other.parts, strict=True):
        assert np.allclose(after.mesh.points * UNIT, before.mesh.points, rtol=1e-14)
    assert deck_units(scene, made) == N_UM
    strains = [step.P / (each.a * each.parts[0].E) for each in (made, other) for step in each.steps]
    assert strains == pytest.approx(strains[:1] * len(strains), rel=1e-12)
    for step, same in zip(made.steps, other.steps, strict=True):
        assert np.allclose(other.bulk(same) * UNIT, made.bulk(step), rtol=1e-12)
        assert abs(same.Q * step.P - step.Q * same.P) <= 1e-12 * step.P * same.P


def test_a_deck_is_in_the_units_of_its_scene(scene, files, tmp_path):
    """Abaqus: lengths 1e3 times, stiffness 1e-6 times as large as in SI; comments in N/mm and MPa."""
    shown = msgspec.structs.replace(scene, shown_in="N-mm")
    for to in ("abaqus", "gmsh"):
        export(shown, to, size=SIZE, growth=GROWTH, stiffer=STIFFER)(tmp_path / to)
    decks = [Deck(files["abaqus"]), Deck(tmp_path / "abaqus")]
    assert np.allclose(places(decks[1]), places(decks[0]) * 1e3, rtol=1e-11, atol=0, equal_nan=True)
    E = [float(next(lines for key, lines in deck.blocks if key == "*ELASTIC")[0][0]) for deck in decks]
    assert E[1] == pytest.approx(E[0] / 1e6, rel=1e-11)
    head = (tmp_path / "abaqus").read_text("ascii").split("*NODE")[0]
    assert "Abaqus deck in N, mm and MPa" in head
    assert f"P = {scene.P / 1e3:.10g} N/mm" in head
    assert " N/m\n" not in head
    meshes = [meshio.gmsh.read(path).points for path in (files["gmsh"], tmp_path / "gmsh")]
    assert np.allclose(meshes[1], meshes[0] * 1e3, rtol=1e-11)


@pytest.mark.parametrize(("a", "shown_in", "units"), [(1.0, "SI", N_MM), (200.0, "SI", SI), (1.0, "N-mm", N_MM),
                                                      (200.0, "N-mm", N_MM), (1e-3, "N-mm", N_UM)])  # fmt: skip
def test_calculix_gets_a_unit_of_length_that_is_small_enough(scene, made, a, shown_in, units):
    shown = msgspec.structs.replace(scene, shown_in=shown_in)
    assert deck_units(shown, replace(made, a=a)) == units


def test_finer_towards_given_points(scene):
    """Element sizes there, and no coarser than asked for anywhere else on the line."""
    ends = (-1.0, -0.8, 0.3, 1.0)
    lower, upper = modelled(scene, SIZE, growth=0.3, ends=ends, fine=0.005).parts
    for part in (lower, upper):
        x = np.unique(part.mesh.points[part.contact, 0]) / 1e-3
        width = np.array([after - before for before, after in pairwise(x)])
        for end in ends:
            assert 0.0025 < width[np.searchsorted(x, end - 1e-9)] < 0.01
        assert width.max() < 1.5 * SIZE


def test_abaqus_deck_is_read_by_others(files, made, tmp_path):
    """By meshio, which knows CPE4 under its plane-stress name only."""
    path = tmp_path / "deck.inp"
    path.write_text(files["abaqus"].read_text("ascii").replace("CPE4", "CPS4"), "ascii")
    read = meshio.read(path)
    for part, block in zip(made.parts, read.cells_dict["quad"].reshape(2, -1, 4), strict=True):
        assert len(block) == len(part.mesh.quads)
    assert {"LOWER_OUTER", "LOWER_CONTACT", "UPPER_OUTER", "UPPER_CONTACT"} <= set(read.point_sets)


def test_gmsh_file(files, made):
    """Both bodies, with their lines as physical groups."""
    read = meshio.read(files["gmsh"])
    for part in made.parts:
        for name, kind, wanted in [(part.name, "quad", part.mesh.quads), *(
            (f"{part.name}-{line}", "line", edges) for line, edges in part.mesh.lines.items()
        )]:  # fmt: skip
            number = read.field_data[name][0]
            found = read.cells_dict[kind][read.cell_data_dict["gmsh:physical"][kind] == number]
            ends, start = read.points[found][..., :2], part.mesh.points[wanted]
            assert np.allclose(ends, start, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize(("override", "said"), [
    ("bodies.upper={width=0.0018, height=0.01}", "bodies.upper.width: must be wider than the contact"),
    ("bodies.lower={mesh='body.msh'}", "bodies.lower.mesh: must be left out to export"),
    ("load.sigma_slope=[0, 1e9]", "load.sigma_slope"), ("load.Q=[-400e3, 400e3]", "load.Q"),
    ("load={P=[2e5, 6e5], Q=[-11e4, 20e4]}", "load.Q: must be within f P = 100000 N/m at load point 1;"),
])  # fmt: skip
def test_what_cannot_be_exported(override, said):
    with pytest.raises(InputError, match=said):
        export(load_scene(SCENE, [override]), "abaqus")


def test_command(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    coarse = ("--size", "0.5", "--growth", "1")
    for to, options in (("calculix", []), ("abaqus", []), ("calculix", []), ("calculix", ["--stiffer", "2"])):
        assert main(["export", SCENE, "--to", to, *coarse, *options]) == 0
    written = capsys.readouterr().out.splitlines()
    assert written[0] == written[2]
    assert written[3].endswith(".inp (settings: size, growth, stiffer)")
    decks = sorted(re.sub("-[0-9a-f]{8}[.]", "-HASH.", path.name) for path in (tmp_path / "results").iterdir())
    assert decks == [f"{SCENE}-{to}-HASH.inp" for to in ("abaqus", "calculix", "calculix")]
