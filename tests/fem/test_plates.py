"""Plates of finite bodies: their stiffness against another element family, their displacements as loads, energy."""

import dataclasses
from functools import partial
from pathlib import Path

import msgspec
import numpy as np
import pytest
import scipy.sparse as sp
import scipy.sparse.linalg as spla
import skfem
from skfem.models.elasticity import lame_parameters, linear_elasticity

import partialslip
from partialslip import InputError, PartialslipError, parse_scene, plan, run
from partialslip.cli import main
from partialslip.codes.export.model import outlined
from partialslip.friction import coulomb_coupled
from partialslip.march.equivalent import stand_ins
from partialslip.result.record import PlatesRecord
from partialslip.run import default_methods
from partialslip.scene import Bodies
from partialslip.scene.reading import scene_toml
from partialslip.verify.hard_cases import hard_scene
from partialslip_fem import first_mesh, plates
from partialslip_fem.bodies import Kept
from partialslip_fem.method import solve
from partialslip_fem.problem import Part

E, NU = 72.1e9, 0.33
SCENE = {
    "name": "plates", "material": {"E": E, "nu": NU}, "profile": {"kind": "hertz", "R": 0.01}, "friction": {"f": 0.3},
    "load": {"P": 135750.0, "Q": [5e3, 30e3], "cycles": 20, "steps": 4},
    "bodies": {
        "upper": {"width": 6e-3, "height": 3e-3, "support": "sides"},
        "lower": {"width": 8e-3, "height": 2e-3, "support": "roller"},
    },
    "fem": {"size": 0.04},
}  # fmt: skip
CLAMPED = {"bodies.upper.support": "clamped", "bodies.lower.support": "clamped"}
PIVOT = {"bodies.upper.support": "pivot", "bodies.upper.pivot_height": 3e-4}
HIGH_PIVOT = PIVOT | {"bodies.upper.pivot_height": 2e-3, "load.Q": [-5e3, 0.0], "load.cycles": 1}  # ends in the middle
PULLED = {"bodies.lower.pulled": True, "bodies.upper.support": "clamped"}
ALIKE = {f"bodies.{body}.{key}": value for body in ("upper", "lower") for key, value in
         {"width": 8e-3, "height": 3e-3, "support": "clamped"}.items()}  # fmt: skip


def solved(changes=None):
    return run(parse_scene(SCENE).replace(changes or {}), "fem")["fem"]


def graded(low, high, at_low, at_high):
    """Mesh lines between ``low`` and ``high``, half of their distance from the ends apart, down to the sizes given
    there."""
    middle, lines = (low + high) / 2, [low, high]
    for end, size, way in ((low, at_low, 1), (high, at_high, -1)):
        count = int(np.log(abs(middle - end) / size) / np.log(1.5)) + 1
        lines += (end + way * np.geomspace(size, abs(middle - end), count)).tolist()
    return np.unique(np.round(lines, 15))


def bonded(scene, a, fine=1e-4):
    """Compliance (2, 2) of the plates of two blocks that are bonded where \\|x\\| <= ``a``, by elements of eight nodes
    on one mesh of rectangles for each body: another element family, another solver, no condensation. An upper plate on
    a pin turns until the forces on it have no moment."""
    bodies = []
    for body, way in ((scene.bodies.lower, -1), (scene.bodies.upper, 1)):
        side, corner = body.width / 2, 1e-3 * body.height
        x = [graded(-side, -a, corner, fine * a), graded(-a, a, fine * a, fine * a), graded(a, side, fine * a, corner)]
        depth = graded(0.0, body.height, fine * a, corner)
        mesh = skfem.MeshQuad.init_tensor(np.unique(np.concatenate(x)), np.sort(way * depth))
        basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementQuadS2()), intorder=5)
        bodies.append((body, way, basis, linear_elasticity(*lame_parameters(E, NU)).assemble(basis)))
    plates, offset, glued = [], 0, []
    for body, way, basis, _ in bodies:
        at = basis.doflocs
        sides = np.abs(np.abs(at[0]) - body.width / 2) < 1e-12
        back, face = np.abs(at[1] - way * body.height) < 1e-12, (at[1] == 0) & (np.abs(at[0]) <= a * (1 + 1e-12))
        along_x = np.zeros(basis.N, bool)
        along_x[np.concatenate([basis.nodal_dofs[0], basis.facet_dofs[0]])] = True
        if body.pulled:
            sides &= at[0] < 0
        on_x = {"clamped": back, "pivot": back, "roller": sides, "sides": sides}[body.support]
        on_y = {"clamped": back, "pivot": back, "roller": back, "sides": sides}[body.support]
        plates += [offset + np.flatnonzero(on_x & along_x), offset + np.flatnonzero(on_y & ~along_x)]
        nodes = np.flatnonzero(face)
        glued.append(offset + nodes[np.lexsort((at[0, nodes], ~along_x[nodes]))])
        offset += basis.N
    K = skfem.bmat([[bodies[0][3], None], [None, bodies[1][3]]], "csr")
    one = np.arange(offset)
    one[glued[1]] = glued[0]
    kept = np.setdiff1d(np.arange(offset), glued[1])
    numbers = np.empty(offset, int)
    numbers[kept] = np.arange(len(kept))
    J = sp.csr_matrix((np.ones(offset), (np.arange(offset), numbers[one])), (offset, len(kept)))
    K = (J.T @ K @ J).tocsc()
    held = numbers[np.concatenate(plates)]
    free = np.setdiff1d(np.arange(len(kept)), held)
    u = np.zeros((len(kept), 2 if scene.pin is None else 3))
    u[numbers[plates[2]], 0] = u[numbers[plates[3]], 1] = 1.0
    if scene.pin is not None:
        places = np.hstack([basis.doflocs for _, _, basis, _ in bodies])
        u[numbers[plates[2]], 2] = scene.pin - places[1, plates[2]]
        u[numbers[plates[3]], 2] = places[0, plates[3]]
    solve = spla.splu(K[free][:, free])
    for column in u.T:
        column[free] = solve.solve(-(K[free][:, held] @ column[held]))
    return np.linalg.inv(u.T @ (K @ u))[:2, :2]


@pytest.mark.slow
@pytest.mark.parametrize(
    "changes", [{}, CLAMPED, PULLED, HIGH_PIVOT], ids=["sides and roller", "clamped", "pulled", "pivot"]
)
def test_stiffness_against_another_element_family(changes):
    scene = parse_scene(SCENE).replace({**changes, "fem.size": None, "fem.accuracy": 1e-3, "load.steps": 1})
    found = run(scene, "fem")["fem"]
    other = bonded(scene, found.a)
    assert np.diag(found.plates.compliance) == pytest.approx(np.diag(other), rel=1e-4)
    assert found.plates.compliance == pytest.approx(other, abs=2e-4 * other.max())
    assert np.abs(found.plates.compliance - other).max() / other.max() < found.plates.error < 3e-4


@pytest.mark.slow
@pytest.mark.parametrize("spring", [None, 3e9])
@pytest.mark.parametrize("changes", [{}, ALIKE, PIVOT], ids=["coupled", "mirror images", "pivot"])
def test_displacements_of_plates_are_the_inverse_of_forces(changes, spring):
    """On one mesh: moved as far as Q moves them, plates bear Q; all else is the same. An elastic actuator goes Q/k
    farther."""
    found = solved(changes)
    given = found.plates.displacement + (found.plates.at_points / spring if spring else 0.0)
    back = solved({**changes, "load.Q": [0.0, 0.0], "load.displacement": given.tolist(), "load.spring": spring})
    assert np.abs(back.plates.at_points / found.plates.at_points - 1).max() < 1e-9
    assert back.plates.displacement == pytest.approx(found.plates.displacement, rel=1e-9)
    assert (back.m, back.n, back.a) == pytest.approx((found.m, found.n, found.a), rel=1e-9)
    assert back.certificate["kkt"] < 1e-9


@pytest.mark.slow
@pytest.mark.fault
def test_an_actuator_that_is_softer_in_steps_than_between_them(monkeypatch):
    """Deliberate fault: steps take an elastic actuator for softer than the path does that leads to them."""
    step = coulomb_coupled.LoadStep

    def softer(*given):
        return step(*given[:10], *(actuator and 1.1 * actuator for actuator in given[10:]))

    monkeypatch.setattr(coulomb_coupled, "LoadStep", softer)
    found = solved()
    given = found.plates.displacement + found.plates.at_points / 3e9
    back = solved({"load.Q": [0.0, 0.0], "load.displacement": given.tolist(), "load.spring": 3e9})
    assert np.abs(back.plates.at_points / found.plates.at_points - 1).max() > 1e-3


@pytest.mark.slow
def test_work_of_the_actuator_is_what_friction_consumes():
    """Where Q alone changes; load steps of coupled bodies leave out what the loop is rounder than a polygon."""
    off = []
    for steps in (4, 8, 16):
        found = solved({"load.steps": steps, "load.Q": [-30e3, 30e3]})
        off.append(abs(found.plates.work / found.slip.dissipated - 1))
    assert off[2] < off[1] / 1.8 < off[0] / 3.2
    assert off[2] < 1.2e-2


@pytest.mark.parametrize(("order", "rounding"), [(2, 1e-10), (4, 1e-5)])
@pytest.mark.parametrize("drive", ["force", "displacement"])
def test_loop_of_mirror_images_has_the_work_that_friction_consumes(drive, order, rounding):
    """The loop is followed event by event, whatever load.steps are; the dissipated energy is that of one step. With
    elements of high order nodes beside the ends of slip zones slip a little against their traction in one step."""
    one = {**ALIKE, "fem.order": order, "load.steps": 1, "load.Q": [-30e3, 30e3], "load.cycles": None}
    found = solved(one)
    if drive == "displacement":
        moved = found.plates.displacement.tolist()
        found = solved({**one, "load.Q": [0.0, 0.0], "load.displacement": moved})
    assert found.plates.work == pytest.approx(found.slip.dissipated, rel=rounding)
    moved = found.plates.loop[:, 0]
    assert np.ptp(moved) == pytest.approx(np.ptp(found.plates.displacement), rel=1e-9)
    assert moved[-1] == pytest.approx(0.0, abs=1e-9 * np.ptp(moved))


@pytest.mark.fault
def test_a_loop_with_load_points_alone_misses_the_work(monkeypatch):
    """Deliberate fault: the loop of mirror images has corners at the load points only."""

    def lost(*_):
        raise PartialslipError("not followed")

    monkeypatch.setattr(plates, "_followed", lost)
    found = solved({**ALIKE, "load.steps": 1, "load.Q": [-30e3, 30e3], "load.cycles": None})
    assert abs(found.plates.work) < 1e-9 * found.slip.dissipated


@pytest.mark.slow
def test_mirror_images_turn_the_displacement_round():
    one, other = solved(ALIKE), solved({**ALIKE, "load.Q": [-5e3, -30e3]})
    assert other.plates.displacement == pytest.approx(-one.plates.displacement, rel=1e-3)  # no mesh is even
    assert other.plates.approach == pytest.approx(one.plates.approach, rel=1e-5)


@pytest.mark.slow
def test_plates_that_stand_still_bear_what_tension_asks_for():
    """A specimen that is pulled on between plates that do not move takes its pad along: Q against the pull, as much
    less than by the stuck stiffness as slips."""
    free = solved(PULLED | {"load.Q": [0.0, 0.0], "load.sigma": [-1e7, 1e7]})
    held = solved(PULLED | {"load.Q": [0.0, 0.0], "load.displacement": [0.0, 0.0], "load.sigma": [-1e7, 1e7]})
    stuck = -free.plates.displacement * held.plates.stiffness[0]
    assert held.plates.displacement == pytest.approx([0.0, 0.0], abs=1e-18)
    assert np.all(np.sign(held.plates.at_points) == np.sign(stuck))
    assert np.all(np.abs(held.plates.at_points) < np.abs(stuck))
    assert np.all(np.abs(held.plates.at_points) > 0.8 * np.abs(stuck))


def test_units_do_not_matter():
    """Bodies ten times as large under ten times the force per depth move ten times as far and are as stiff."""
    large = {"load.P": 1357500.0, "load.Q": [5e4, 30e4], "profile.R": 0.1}
    large |= {"bodies.upper": {"width": 6e-2, "height": 3e-2}, "bodies.lower": {"width": 8e-2, "height": 2e-2}}
    one, other = solved().plates, solved(large).plates
    assert other.displacement == pytest.approx(10 * one.displacement, rel=1e-9)
    assert other.stiffness == pytest.approx(one.stiffness, rel=1e-9)


def test_a_soft_actuator_is_certified():
    found = solved({"load.Q": [0.0, 0.0], "load.displacement": [-1e-6, 1e-6], "load.spring": 1e-3})
    assert np.abs(found.plates.at_points).max() < 2e-9
    assert found.certificate["equilibrium"] < 1e-12


@pytest.mark.slow
@pytest.mark.fault
def test_a_displacement_that_makes_coarse_meshes_slide_alone(monkeypatch):
    """The first mesh of large blocks is 1.2 % too stiff: on it they slide under 0.997 f P. Force control gives the same
    displacement and stick zone. Deliberate fault: no finer first mesh is tried."""
    block = {"width": 4.0, "height": 2.0}
    rig = partial(hard_scene, "large", bodies={"upper": block, "lower": block}, fem={"accuracy": 1e-3})
    moved = 5.27e-5
    under = rig(load={"displacement": [-moved, moved]})
    fem = run(under, "fem")["fem"]
    share = fem.plates.at_points[1] / (under.friction.f * under.P)
    assert 0.99 < share < 1
    forced = run(rig(share), "fem")["fem"]
    assert forced.plates.displacement[1] == pytest.approx(moved, rel=1e-4)
    assert (fem.m, fem.n) == pytest.approx((forced.m, forced.n), abs=1e-3 * fem.a)
    with pytest.raises(InputError, match="slides on the way"):
        run(rig(load={"displacement": [-1.01 * moved, 1.01 * moved]}), "fem")
    kept = Kept()
    anew, again = (solve(under, plan(under), keep=kept).counts for _ in range(2))
    assert anew["meshes"] == again["meshes"]
    # of the mesh that slides, and of the one that does not
    assert anew["factorizations"] - again["factorizations"] == 2
    monkeypatch.setattr(first_mesh, "_FINEST", 1)
    with pytest.raises(InputError, match="slides on the way"):
        run(under, "fem")


@pytest.mark.slow
@pytest.mark.fault
def test_corners_left_coarse_are_told(monkeypatch):
    """Deliberate fault: elements are not refined at the corners of bodies. Both orders of elements share this mesh, and
    all the same the estimate of the compliance covers its error."""
    corner = {"width": 4e-3, "height": 1e-3}  # at its sides 270 degrees of body, held beside free
    upper = {"bodies.upper": {"width": 6e-3, "height": 3e-3, "support": "sides", "holder": corner}}
    coarse = upper | {"fem.size": None, "fem.accuracy": 1e-2, "load.steps": 1, "load.cycles": 1}
    known = solved(coarse | {"fem.accuracy": 1e-4}).plates.compliance

    def error(plates):
        return np.abs(plates.compliance - known).max() / known.max()

    sound = solved(coarse).plates
    monkeypatch.setattr(Part, "corners", lambda *_: {})
    faulty = solved(coarse).plates
    assert error(sound) < sound.error < 3e-3
    assert 5 * error(sound) < error(faulty) < faulty.error < 4 * error(faulty)


def test_records_of_plates_with_q_at_two_load_points_are_read():
    """Earlier results files have Q at load points 1 and 2 as well."""
    known = {"at_points": [1.0, 2.0, 3.0], "displacement": [0.0, 1e-6], "approach": [1e-6, 1e-6]}
    read = msgspec.convert(known | {"Q": [1.0, 3.0], "compliance": [[1e-9, 0.0], [0.0, 1e-9]]}, PlatesRecord)
    assert read.at_points == (1.0, 2.0, 3.0)


def test_half_planes_have_no_plates():
    assert solved({"bodies.lower": None, "bodies.upper": None}).plates is None


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"load.Q": [0.0, 0.0], "load.displacement": [-1e-4, 1e-4]}, r"load.displacement: must keep \|Q\| below f P"),
        ({"load.displacement": [-1e-6, 1e-6]}, r"load.Q = \[5000.0, 30000.0\]: must be left out or \[0, 0\] with load"),
        ({"load.spring": 1e9}, "load.spring = 1000000000.0: must be given only with load.displacement"),
        ({"load.Q": [0.0, 0.0], "load.displacement": [-1e-6, 1e-6], "bodies.lower": None}, "a half-plane has no plate"),
        ({"load.Q": [0.0, 0.0], "load.displacement": [-1e-6, 1e-6], "friction.f": 0.0}, "friction.f = 0: must be > 0"),
        ({"load.Q": [0.0, 0.0], "load.displacement": [0.0, 1e-6], "load.sigma": [0.0, 1e6, 0.0]}, "as many numbers as"),
        ({"load.Q": [0.0, 0.0], "load.displacement": [0.0, 1e-6], "effects.friction": False}, "effects.friction"),
    ],
)
def test_bad_input_is_one_line(changes, told):
    with pytest.raises(InputError, match=told):
        solved(changes)


@pytest.mark.slow
def test_only_finite_elements_find_q():
    scene = parse_scene(SCENE).replace({"load.Q": [0.0, 0.0], "load.displacement": [-1e-6, 2e-6]})
    with pytest.raises(InputError, match="must have fem among them"):
        run(scene, "exact")
    both = run(scene, ("exact", "fem"))
    assert both.scene.load.points[0][0] == pytest.approx(both["fem"].plates.at_points[0], rel=1e-12)
    forces = scene.replace({"load.displacement": None, "load.Q": both["fem"].plates.at_points.tolist()})
    for method in ("exact", "march", "equivalent"):
        under_forces, beside_fem = run(forces, method)[method], run(scene, (method, "fem"))[method]
        assert (beside_fem.m, beside_fem.n) == (under_forces.m, under_forces.n)
    for of in (partial(stand_ins, rig=None), outlined, lambda each: each.load.points):
        with pytest.raises(InputError, match="only runs with fem find Q"):
            of(scene)


@pytest.mark.slow
def test_a_run_of_moved_plates_is_recorded_and_read_back(tmp_path, monkeypatch, capsys):
    """Page, sketch and results.json; the record has the Q that was found, and runs again from its scene."""
    monkeypatch.chdir(tmp_path)
    scene = parse_scene(SCENE).replace({"load.Q": [0.0, 0.0], "load.displacement": [2e-7, 1.5e-6]})
    Path("scene.toml").write_text(scene_toml(scene), "utf-8")
    assert main(["run", "scene.toml", "--with", "fem", "--out", "there"]) == 0
    printed = capsys.readouterr().out
    assert "stiffness, x and y" in printed
    assert "\n  Q " in printed
    assert "lower \N{MINUS SIGN} upper plate" in Path("there/report.html").read_text("utf-8")
    kept = partialslip.load_result("there/results.json")
    plates = kept.methods["fem"].plates
    assert kept.scene.load.Q_found == plates.at_points
    again = run(kept.scene, "fem")["fem"]
    assert tuple(again.plates.at_points) == pytest.approx(plates.at_points, rel=1e-12)


@pytest.mark.parametrize("spring", [None, 3e9])
def test_given_displacements_are_known_where_cycles_are_skipped(monkeypatch, spring):
    """Which the way there does not tell. Once NaN, though the scene gives them."""
    load = {"load.Q": [0.0, 0.0], "load.displacement": [-1e-6, 1e-6], "load.cycles": None, "load.spring": spring}
    changes = {**load, "load.steps": 1, "fem.size": 0.1}
    followed = solved(changes).plates
    monkeypatch.setattr("partialslip_fem.result.plates_of", lambda *given: _unknown(plates.plates_of(*given)))
    found = solved(changes).plates
    assert found.displacement == pytest.approx(followed.displacement, rel=1e-9)
    assert found.displacement + (found.at_points / spring if spring else 0.0) == pytest.approx([-1e-6, 1e-6], rel=1e-9)


def _unknown(found):
    return dataclasses.replace(found, displacement=np.full(2, np.nan))


def test_slip_of_rounding_does_not_ratchet():
    """Q = +-0.02 N/m on 135,750 N/m: slip and net slip are 1e-16 of the largest possible one."""
    pad, hardly = (
        Path(__file__).parents[2] / "docs/scenes/finite-pad.toml",
        ["load.Q=[-0.02, 0.02]", "load.sigma=[0, 0]"],
    )
    found = run(partialslip.load_scene(pad, [*hardly, "fem.accuracy=1e-3"]), "fem")["fem"]
    assert found.regime != "ratchets"
    assert not any("slip does not" in note for note in found.notes)
    assert (found.m, found.n) == pytest.approx((found.a, found.a), abs=1e-5 * found.a)


def test_half_planes_beside_a_pivot_under_moments_are_those_that_can_be_solved():
    """The default run once refused what fem solves: no exact solution is known where neither end slips."""
    upper = {"width": 20e-3, "height": 10e-3, "support": "pivot", "pivot_height": 0.0}
    turning = {"load.Q": [-2e4, 2e4], "load.M": [10.0, -10.0], "load.cycles": 1, "load.steps": 1}
    turning |= {"bodies.upper": upper, "fem": {"accuracy": 1e-2}}
    scene = parse_scene(SCENE).replace(turning)
    assert default_methods(scene) == ("march", "fem")
    assert default_methods(parse_scene(SCENE)) == ("exact", "fem")
    found = run(scene.replace({"bodies": Bodies(), "fem.accuracy": 0.1}), "march")["march"]
    assert found.regime == "sticking ends"
