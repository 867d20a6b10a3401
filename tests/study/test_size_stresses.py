"""Stresses in sweeps over sizes: differences, laws, sizes needed, and what bodies of a size do to them."""

import csv

import msgspec
import numpy as np
import pytest
from size_entries import entries, on_mesh, scene

from partialslip.study.batch.ledger import Ledger
from partialslip.study.batch.sweep import workers
from partialslip.study.fatigue import HotSpot
from partialslip.study.size import sizes as size
from partialslip.study.size import stresses, tables
from partialslip.study.size.axes import axis as read
from partialslip.study.size.axes import cases as make
from partialslip.study.size.case import Sized, solve_sized
from partialslip.study.size.figure import size_svg
from partialslip.study.size.stresses import criteria_of, quantities_of
from partialslip.tools.errors import InputError


def with_stresses(entry, fem, half_plane, error=1e-6):
    """Return ``entry`` with largest stresses by quantity."""

    def spots(values, error):
        return {key: HotSpot(value, "Pa", 1e-3, error) for key, value in values.items()}

    return msgspec.structs.replace(entry, stresses={"fem": spots(fem, error), "half-plane": spots(half_plane, 0.0)})


def stressed_study():
    """A study in which sigma_xx comes near the half-plane with 1/size, and averages of swt with its square."""
    axis = read("bodies.*.width=4a,8a,16a,32a,64a,128a")
    plain = entries(axis.name, {at: 0.3 * at**-2.0 for at in axis.values})
    found, fem = [], {"sigma_xx": 1e8, "swt": 1e6, "swt.line": 5e5}
    for at, entry in zip((*axis.values, axis.limit), plain, strict=True):
        half_plane = {"sigma_xx": 1e8 * (1 - 0.5 / at), "swt": 1e6, "swt.line": 5e5 * (1 + 2 / at**2)}
        found.append(with_stresses(entry, fem, half_plane))
    return tables.size_study(scene(), axis, found), axis, found


def test_stresses_have_laws_and_needed_sizes_like_all_quantities():
    study, axis, found = stressed_study()
    laws = {trend.quantity: trend.law.k for trend in study.trends if trend.law}
    assert laws == pytest.approx({"a": 2, "sigma_xx": 1, "swt.line": 2}, abs=0.01)
    needed = {row[0]: row[2] for row in tables.needed_table(study)[1]}
    assert needed["sigma_xx"].startswith("49.8, interpolated") or needed["sigma_xx"].startswith("50.0, interpolated")
    assert stresses.in_short(study)[0] == "size 4: the half-plane is off by 12 % in sigma_xx, 0 % in swt"
    assert stresses.stresses_of(study).quantities == ("sigma_xx", "swt", "swt.line")
    head, rows = stresses.stress_differences_table(study, study.models[0])
    assert head == ("size", "stresses", "sigma_xx", "swt", "mesh")
    assert [row[:4] for row in rows[:2]] == [("4", "surface", "1.2e-01", "0.0e+00"), ("4", "line", "", "1.2e-01")]
    head, rows = stresses.largest_table(study)
    assert head == ("largest", "unit", "size", "fem", "x, mm", "half-plane", "x, mm")
    assert rows[0] == ("sigma_xx", "MPa", "4", "100.0000 +- 0.0001", "1", "87.5", "1")
    data = list(csv.DictReader(stresses.stresses_csv(study).splitlines()))
    told = [data[0][key] for key in ("size [a of the half-plane]", "by", "quantity", "unit")]
    assert told == ["4.0", "fem", "sigma_xx", "Pa"]
    assert "sigma_xx within 1 %" in size_svg(stresses.stresses_of(study))
    assert size.stress_quantities(found) == ("sigma_xx", "swt", "swt.line")
    assert size.along(axis, found).mesh["sigma_xx"] == pytest.approx(1e-6)


def test_the_change_by_the_last_mesh_is_an_error_of_stresses():
    """In full: stresses at the ends of the contact converge like square roots, so an eighth would be too little."""
    axis = read("load.P=1,2")
    meshes = []
    for accuracy, value, dofs in ((8.0, 1.01e8, 10), (1.0, 1e8, 20)):
        entry = on_mesh({"load.P": 1.0}, 1.0, dofs, accuracy)
        meshes.append(with_stresses(entry, {"sigma_xx": value}, {"sigma_xx": 1.1e8}, error=None))
    assert size.along(axis, meshes).mesh["sigma_xx"] == pytest.approx(0.01)
    assert np.isnan(size.along(axis, meshes[1:]).mesh["sigma_xx"]).all()


@pytest.mark.slow
def test_a_case_has_stresses_if_the_scene_asks_for_them():
    """Under a mean load march tells those of the half-plane; without asking nothing is solved for inside the bodies."""
    plain = scene(accuracy=1e-2)
    (case,) = make(plain, [read("bodies.*.width+bodies.*.height=8a")])
    assert solve_sized(case).stresses == {}
    assert solve_sized(case).run.methods["fem"].counts["back_solves"] == 0
    asking = plain.replace({"fatigue.distance": 1e-4, "load.sigma": [0.0, 6e7]})
    (case,) = make(asking, [read("bodies.*.width+bodies.*.height=8a")])
    found = solve_sized(case)
    assert found.run.methods["fem"].counts["back_solves"] > 0
    for spots in found.stresses.values():
        assert spots.keys() >= {"sigma_xx", "swt", "principal", "principal.line"}
    assert found.stresses.keys() == {"fem", "half-plane", "equivalent"}
    axis = read("bodies.*.width+bodies.*.height=8a")
    off, left = (size.along(axis, [found], name).off["sigma_xx"] for name in ("half-plane", "equivalent"))
    assert 10 * left < off < 0.5
    assert msgspec.json.decode(msgspec.json.encode(found), type=Sized).stresses == found.stresses


@pytest.mark.slow
def test_the_range_of_stress_comes_near_that_of_the_half_plane_like_m_but_the_mean_slowly(tmp_path):
    """What blocks add to the range falls with the square of their size, like what they add to m. P stretches their
    surface by a tension like P over the width, which does not change in a cycle and does not move m."""
    axis, ledger = read("bodies.*.width+bodies.*.height=8a,16a,32a"), Ledger(tmp_path / "ledger.jsonl")
    asking = scene(accuracy=1e-5).replace({"fatigue.distance": 1e-4})
    with workers(processes=1) as executor:
        found = size.measure(asking, [axis], ledger, executor, control=False)
    sizes = size.along(axis, found)

    def order(key):
        off = sizes.off[key][sizes.size < sizes.limit]
        return np.log2(off[:-1] / off[1:])

    assert order("m") == pytest.approx([2, 2], abs=0.1)
    assert order("principal.line") == pytest.approx([2, 2], abs=0.2)
    assert 0.5 < order("sigma_xx")[0] < order("sigma_xx")[1] < 1.0
    assert all((sizes.mesh["sigma_xx"] < sizes.off["sigma_xx"] / 10)[:-1])


def test_criteria_are_those_that_the_scene_or_the_user_asks_for():
    """swt and principal need no constants: without an own one swt alone is shown."""
    asking = scene().replace({"fatigue.distance": 1e-4})
    assert criteria_of(asking, None) == ["swt"]
    findley = asking.replace({"fatigue.k_findley": 0.3})
    assert criteria_of(findley, None) == ["findley"]
    assert criteria_of(findley, ["principal", "findley"]) == ["principal", "findley"]
    spots = dict.fromkeys(("sigma_xx", "principal", "principal.line", "swt", "swt.line"))
    (shown,) = size.with_criteria([Sized(labels={}, stresses={"fem": spots})], ["swt"])
    assert [*shown.stresses["fem"]] == ["sigma_xx", "swt", "swt.line"]


def test_the_answer_is_of_the_quantities_asked_for():
    asking = scene().replace({"fatigue.distance": 1e-4})
    assert quantities_of(asking, None, ["swt"], asked=False) == ["m", "n", "sigma_xx"]
    assert quantities_of(asking, None, ["swt"], asked=True) == ["m", "n", "sigma_xx", "swt"]
    assert quantities_of(asking, ["p", "swt.line"], ["swt"], asked=False) == ["p", "swt.line"]
    with pytest.raises(InputError, match=r"--show sigma_xx: must be of a, .*, q; no stresses"):
        quantities_of(scene(), ["sigma_xx"], ["swt"], asked=False)


@pytest.mark.parametrize(("changes", "names", "told"), [
    ({"fatigue.distance": 1e-4}, ["ruiz"], "--criterion ruiz: must be another for a study of sizes"),
    ({"fatigue.distance": 1e-4}, ["findley"], "fatigue.k_findley: missing"),
    ({"fatigue.distance": 1e-4}, ["mises"], "criterion 'mises': must be of principal, swt"),
    ({}, ["swt"], "--criterion swt: must be given only with a constant in the table fatigue, for example --set"),
    ({"fatigue": {}}, ["swt"], "must be given only with a constant in the table fatigue"),
])  # fmt: skip
def test_criteria_that_a_study_cannot_show_are_refused(changes, names, told):
    with pytest.raises(InputError, match=told):
        criteria_of(scene().replace(changes), names)


@pytest.mark.slow
def test_unlike_bodies_have_stresses_of_finite_elements_alone():
    """March finds their half-planes, but no stresses in them, and a line says so."""
    unlike = {"lower": {"E": 70e9, "nu": 0.3}, "upper": {"E": 2e11, "nu": 0.3}}
    asking = scene(accuracy=1e-2).replace({"material": unlike, "fatigue.distance": 1e-4})
    axis = read("bodies.*.width+bodies.*.height=8a")
    (case,) = make(asking, [axis])
    found = solve_sized(case)
    assert found.error == ""
    assert {name for name, spots in found.stresses.items() if spots} == {"fem"}
    study = tables.size_study(asking, axis, [found])
    assert 0 < study.models[0].off["a"][0] < 0.1
    assert stresses.in_short(study)[0].startswith("stresses of the half-plane are not known: no method finds them")
