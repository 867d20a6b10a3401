"""Refinement does not end while the contact reaches the last node of the fine contact line, which cuts it off."""

from dataclasses import replace

import numpy as np
import pytest

import partialslip
from partialslip import load_scene, parse_scene
from partialslip_fem import adapt
from partialslip_fem.load_steps import LoadSteps
from partialslip_fem.mesh_solution import MeshSolution

# the first mesh of quadratic triangles is too coarse for this material: by its solution the contact is too narrow
CUT = ["material.nu=-0.84", "material.plane='stress'", "fem.order=2", "fem.far_field='box'", "fem.accuracy=2e-3"]


def solved():
    """Half-width of a Hertz contact, relative to the exact one, less 1; its estimate; the number of meshes."""
    run = partialslip.run(load_scene("hertz-shear", CUT))
    fem = run["fem"]
    return abs(fem.a / run["exact"].a - 1), fem.estimate["a"], fem.counts["meshes"]


@pytest.fixture
def large(monkeypatch):
    """Every mesh is too large for a finer one."""
    monkeypatch.setattr(adapt, "_MOST_UNKNOWNS", 0)


@pytest.mark.usefixtures("large")
def test_a_large_mesh_that_cuts_the_contact_is_not_the_last():
    error, estimate, meshes = solved()
    assert error < estimate < 2e-2
    assert meshes > 2


@pytest.mark.fault
@pytest.mark.usefixtures("large")
def test_a_contact_that_is_cut_off_is_seen(monkeypatch):
    """Deliberate fault: every contact line is said to enclose the contact."""
    monkeypatch.setattr(MeshSolution, "enclosed", property(lambda _: True))
    error, estimate, meshes = solved()
    assert meshes == 2
    assert error > 10 * estimate


def test_a_contact_that_every_line_cuts_is_refused(monkeypatch):
    monkeypatch.setattr(adapt, "_MOST_CUTS", 0)  # this scene has one such mesh
    with pytest.raises(partialslip.InputError, match=r"fem.accuracy = 0.002: must be .* ends of 1 contact lines"):
        solved()


@pytest.mark.slow
def test_a_contact_that_finer_steps_widen_gets_a_wider_line(monkeypatch):
    """Steps are halved on the last mesh; here the contact then reaches the ends of its line."""
    *_, meshes = solved()
    lines = []

    def wider(_, solution):
        x = solution.lower.x
        lines.append(x[-1] - x[0])
        return replace(solution, most=np.ones_like(x), moving=True) if len(lines) == 1 else solution

    monkeypatch.setattr(LoadSteps, "checked", wider)
    error, estimate, more = solved()
    assert error < estimate
    assert more > meshes
    assert lines[1] > lines[0]


def off_at_load_point_1():
    """Distance of the contact's left end at load point 1 from that of the march, in half-widths; the larger estimate
    of both. Shear presses unlike materials together on one side: the contact moves with Q."""
    unlike = {"upper": {"E": 3e11, "nu": 0.25}, "lower": {"E": 7e10, "nu": 0.1}}
    load = {"P": 1.8e6, "Q": [-0.72e6, 1e6]}
    data = {"name": "unlike", "material": unlike, "friction": {"f": 0.8}, "profile": {"kind": "hertz", "R": 0.02}}
    scene = parse_scene(data | {"load": load, "fem": {"accuracy": 7e-4}})
    fem, march = (partialslip.run(scene, [method])[method] for method in ("fem", "march"))
    ends = [result.contact_ends[0][0] / result.a for result in (fem, march)]
    return abs(ends[0] - ends[1]), max(fem.estimate["left"], march.estimate["left"])


@pytest.mark.slow
def test_the_line_encloses_the_contact_at_both_load_points():
    error, estimate = off_at_load_point_1()
    assert error < estimate < 1e-4


@pytest.mark.slow
@pytest.mark.fault
def test_a_line_for_load_point_2_alone_is_seen(monkeypatch):
    """Deliberate fault: contact lines enclose the contact at load point 2 only, and are said to enclose it."""
    monkeypatch.setattr(MeshSolution, "reach", property(lambda found: (found.left, found.right)))
    monkeypatch.setattr(MeshSolution, "enclosed", property(lambda found: not found.pressing.x[[0, -1]].any()))
    error, estimate = off_at_load_point_1()
    assert error > 2 * estimate
