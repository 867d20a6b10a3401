"""The estimate against the true error, on scenes of both regimes; the estimate itself never sees the exact solution."""

from dataclasses import replace

import numpy as np
import pytest
from plain import plain
from spying import spied

import partialslip
from partialslip.run.judge.measures import cell_means
from partialslip_fem import adapt, estimate, goals, solving
from partialslip_fem.solving import solve_on_meshes

SCENES = [
    ("hertz-small-tension", "load.sigma=[-150e6, 150e6]"),
    ("hertz-small-tension", "material.nu=0.45"),
    ("hertz-large-tension", "load.Q=[-9e4, 9e4]"),
    ("hertz-large-tension", "load.sigma=[6e8, -6e8]"),
    ("flat-rounded", "friction.f=0.6"),
]


def ratio(name, *overrides):
    """Estimate over true error, each the largest of a, m and n, and the share of the accuracy that was asked."""
    scene = partialslip.load_scene(name, overrides)
    outcome = partialslip.run(scene)
    fem, found = outcome.results["fem"], outcome.comparisons["fem"]
    true, known = max(found.a, found.m, found.n), max(fem.estimate[key] for key in "amn")
    return known / true, true / scene.fem.accuracy


@pytest.mark.slow
@pytest.mark.parametrize(("accuracy", "least"), [(1e-3, 0.5), (2e-5, 1), (1e-5, 1), (1e-6, 0.5), (1e-7, 0.5)])
def test_estimate_is_right_at_every_accuracy(accuracy, least):
    """No error is far above its estimate. How far it lies below is bounded on average: an error that happens to pass
    through zero says nothing about the estimate."""
    known, share = np.transpose([ratio(*scene, f"fem.accuracy={accuracy}") for scene in SCENES])
    assert known.min() > least
    assert np.exp(np.log(known).mean()) < 6
    assert share.max() < 1


@pytest.mark.fault
def test_difference_of_the_orders_is_not_the_error(monkeypatch):
    """Deliberate fault: what P3 is off by, taken for what P4 is off by."""
    true = estimate._changes
    monkeypatch.setattr(estimate, "_changes", lambda *pair: {k: d**0.75 for k, d in true(*pair).items()})
    known, _ = ratio(*SCENES[2], "fem.accuracy=1e-3")
    assert known > 3


@pytest.mark.fault
def test_elements_at_the_ends_are_counted(monkeypatch):
    """Deliberate fault: without them, a mesh coarse at the ends is taken for a good one."""
    monkeypatch.setattr(goals, "COARSEST", 0.06)
    monkeypatch.setattr(goals, "_END_SHARE", 1e6)
    honest, _ = ratio(*SCENES[2], "fem.accuracy=1e-2")
    monkeypatch.setattr(estimate, "end_errors", lambda *_: dict.fromkeys(estimate.KEYS, 1e-12))
    known, _ = ratio(*SCENES[2], "fem.accuracy=1e-2")
    assert known < 1 / 3 < honest


def test_a_difference_of_tractions_is_relative_to_the_first():
    scene = partialslip.load_scene("hertz-shear", ["load.Q=[0, 0]", "fem.accuracy=1e-2"])
    fem = partialslip.run(scene, ["fem"]).results["fem"]
    assert fem.estimate.keys() == {"a", "left", "right", "p"}  # neither shear nor a stick zone to estimate
    assert 0 < fem.estimate["p"] < 0.1


@pytest.mark.slow
def test_locked_elements_stop_where_meshes_bring_nothing():
    """Instead of refining without end, and it is said that the accuracy is not reached."""
    overrides = ["fem.order=1", "material.nu=0.499", "fem.accuracy=1e-2"]
    fem = partialslip.run(partialslip.load_scene("hertz-small-tension", overrides), ["fem"]).results["fem"]
    assert max(fem.estimate[key] for key in "amn") > 0.05
    assert any("not reached" in note for note in fem.notes)


def test_estimate_knows_of_the_coarser_body():
    """Where nodes do not match, elements of both bodies are as small, and grow as little, as the accuracy needs."""
    scene = partialslip.load_scene("hertz-large-tension", ["fem.lower_size=2", "fem.accuracy=1e-3"])
    outcome = partialslip.run(scene)
    found, known = outcome.comparisons["fem"], outcome.results["fem"].estimate
    assert all(getattr(found, key) <= 3 * known[key] for key in ("a", "m", "n", "p", "q"))
    assert max(known[key] for key in "amn") <= 1e-3


@pytest.mark.parametrize(("name", "steep"), [("hertz-shear", 1.0), ("flat-rounded", None)])
def test_how_steeply_pressure_begins_is_found(monkeypatch, name, steep):
    """As a multiple of Hertz's; corners near the ends of the contact make it steep."""
    solved = spied(monkeypatch, estimate, "end_errors")
    exact = partialslip.run(partialslip.load_scene(name, ["fem.accuracy=1e-3"])).results["exact"]
    a, x = exact.a, exact.a * np.sin(np.linspace(0, np.pi / 2, 2001))
    p, *_ = exact.traction.at(x)
    root, *_ = exact.traction.at(np.array([a * (1 - 1e-7)]))
    known = root[0] / np.sqrt(1e-7) / np.sqrt(np.trapezoid(p**2, x) / a) / np.sqrt(3)
    assert known == pytest.approx(steep or 8.1, rel=0.02)
    assert estimate._steepness(solved[-1][0]) == pytest.approx(known, rel=0.02)


@pytest.mark.slow
@pytest.mark.fault
def test_a_kink_where_an_end_turned_round_within_an_element_is_seen(monkeypatch):
    """At 1e-3 the elements are coarse where the right end turned round, and elements of both orders miss the kink of q
    there by the same. Deliberate fault: q has kinks at the ends of the stick zone alone."""
    x = [0, 4e-4, 8e-4, 1.2e-3, 1.6e-3]
    gap = [0, 4.499035860655817e-06, 2.398457377049308e-05, 7.64219047131212e-05, 1.9175318033788922e-4]
    load = {"P": 1374446.7859455342, "Q": [-530437.5446132885, 530437.5446132885]}
    load |= {"sigma": [3178018449.2957535, -3178018449.2957535]}
    material, table = {"E": 70e9, "nu": 0.3, "plane": "stress"}, {"kind": "tabulated", "x": x, "gap": gap}
    scene = plain(load, 0.7124858377764763, material, table, fem={"accuracy": 1e-3})
    solved = spied(monkeypatch, estimate, "end_errors")
    results = partialslip.run(scene, ["fem", "exact"]).results
    solution, *_, at_kinks = [given for given in solved if given[-1].any()][-1]
    a, exact = solution.half_width, results["exact"]
    (turned,) = solution.turning
    vertices = solution.lower.x[:: solution.lower.order]
    cell = int(np.searchsorted(vertices, turned))
    beside = vertices[cell - 2 : cell + 2]
    places = beside / a * exact.a
    means = [
        np.diff(solution.shear(solution.history.change).antiderivative()(beside)) / np.diff(beside),
        cell_means(exact.traction, places)[1] * scene.length / scene.P,
    ]
    off = np.sqrt((np.subtract(*means) / 2) ** 2 @ np.diff(beside))
    assert off < estimate._kink_errors(solution, at_kinks * a)[0] < 20 * off
    monkeypatch.setattr(estimate, "_turned", lambda solution: np.zeros(len(solution.kinks), dtype=bool))
    assert estimate._kink_errors(solution, at_kinks * a)[0] < off


@pytest.mark.fault
def test_the_place_of_an_end_in_its_element_counts(monkeypatch):
    """The same mesh, stretched so that the end of a Hertz contact moves from a vertex into the element: the error of a
    grows, and elements of the order below do not see it. Deliberate fault: ends are taken to be at vertices."""
    true, solved = adapt.neighbour, spied(monkeypatch, adapt, "neighbour")
    scene = partialslip.load_scene("hertz-shear", ["load.Q=[0, 0]", "fem.accuracy=1e-3"])
    results = partialslip.run(scene, ["fem", "exact"]).results
    solution, problem, width, clock = solved[-1]
    a = results["exact"].a / results["fem"].a * solution.half_width
    vertices = solution.lower.x[:: solution.lower.order]
    cell = int(np.argmin(np.abs(vertices - a)))
    shares, errors = np.array([0.0, 0.2, 0.4]), []
    for share in shares:
        stretch = a / (vertices[cell] + share * (vertices[cell + 1] - vertices[cell]))
        meshes = [replace(each.mesh, points=stretch * each.mesh.points) for each in solution.bodies]
        moved = solve_on_meshes(meshes, problem, width, clock)
        ends = moved.zone_ends
        sizes, inside = moved.element_sizes(ends) / moved.half_width, moved.inside(ends)
        assert inside == pytest.approx(share, abs=0.03)
        known = [
            estimate.end_errors(moved, sizes, each, goals.gaps(moved, problem), np.empty(0))["a"]
            for each in (inside, 0 * inside)
        ]
        other = true(moved, problem, width, clock)
        smooth = estimate.smooth_errors(moved, other)["a"]
        errors.append([abs(moved.half_width / a - 1), *(smooth + np.array(known))])
    off, known, fault = np.transpose(errors)
    assert (off < known).all()
    assert off[1] > 2 * off[0]
    assert (off > fault).any()


def test_an_end_of_the_contact_is_not_known_better_than_two_fits_agree(monkeypatch):
    """See tests/friction/test_stick_zone.py for how far both are off."""
    true, solved = estimate.end_errors, spied(monkeypatch, estimate, "end_errors")
    partialslip.run(partialslip.load_scene("hertz-shear", ["load.Q=[0, 0]", "fem.accuracy=1e-2"]), ["fem"])
    solution, *rest = solved[-1]
    apart = np.array([1e-2, 2e-2])
    known = true(replace(solution, fits=apart * solution.half_width), *rest)
    assert [known["left"], known["right"]] == pytest.approx(1.5 * apart)
    assert known["a"] == pytest.approx(1.5 * apart.mean())
    assert known["p"] == true(*solved[-1])["p"]  # tractions do not depend on how ends are read


@pytest.mark.fault
def test_two_fits_of_an_end_are_apart_by_what_a_flat_bottom_leaves(monkeypatch):
    """Gaps like x^6 and x^2 on one mesh. Deliberate fault: both fits are to as many vertices."""
    x = np.linspace(0, 1.5e-3, 120)

    def apart(power):
        gap = 1e-6 / 0.02 / power * (x / 1e-3) ** power
        load, table = {"P": {2: 1.5e6, 6: 9.4e5}[power]}, {"kind": "tabulated", "x": x, "gap": gap}  # a is about 1 mm
        partialslip.run(plain(load, 0.0, (70e9, 0.3), table, fem={"accuracy": 1e-2}), ["fem"])
        solution, sizes = solved[-1][:2]
        return (solution.fits / solution.half_width / sizes[:2]).max()

    solved = spied(monkeypatch, estimate, "end_errors")
    assert 0 < 10 * apart(2) < apart(6) < 0.1
    monkeypatch.setattr(solving, "NEAREST", solving.VERTICES)
    assert apart(6) == 0
