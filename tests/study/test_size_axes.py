"""Axes of sweeps: how they are read, what they change in a scene, and what is refused."""

import msgspec
import pytest
from refusing import line_of
from size_entries import entries, scene

import partialslip
from partialslip.scene.units import N_MM
from partialslip.study.size import sizes as size
from partialslip.study.size.axes import axis as read
from partialslip.study.size.axes import cases as make
from partialslip.study.size.case import compared_methods


@pytest.mark.parametrize(("text", "values", "in_a"), [
    ("load.P=1e5,2e5", (1e5, 2e5), False), ("bodies.*.width=4a..64a:5", (4.0, 8.0, 16.0, 32.0, 64.0), True),
    ("fem.order=2,3", (2.0, 3.0), False),
])  # fmt: skip
def test_axes_are_read(text, values, in_a):
    axis = read(text)
    assert axis.values == pytest.approx(values, rel=1e-11)
    assert axis.in_a is in_a


def test_values_are_in_the_units_in_which_the_scene_is_shown():
    plain = scene()
    shown = msgspec.structs.replace(plain, shown_in="N-mm")
    for one, other in (("bodies.*.width=1..4:3", "bodies.*.width=1e3..4e3:3"), ("bodies.*.height=4a,8a",) * 2):
        jobs = zip(make(plain, [read(one)]), make(shown, [read(other)]), strict=True)
        for job, same in jobs:
            for (_, body), (_, again) in zip(job.scene.bodies, same.scene.bodies, strict=True):
                assert (again.width, again.height) == pytest.approx((body.width, body.height), rel=1e-15)
            assert (same.scene.shown_in, same.scene.load) == ("N-mm", job.scene.load)


@pytest.mark.parametrize(
    "text",
    ["", "load.P", "load.P=", "=1,2", "load.P=1..", "load.P=2..1", "load.P=0..1", "load.P=1..2..3", "load.P=1a,2",
     "load.P=one", "load.P=1..2:1", "load.P=1..2:x", "load.P=1,2:3", "load.P+=1,2",
     "0*load.P=1,2", "2*=1,2", "load.P=1..1e999"],
)  # fmt: skip
def test_bad_axes_are_refused_in_one_line(text):
    with pytest.raises(partialslip.InputError, match="--over"):
        read(text)


@pytest.mark.parametrize(("over", "told"), [
    *((f"bodies.lower.height=2,{value}", f"'{value}': must be a number > 0, such as 4 or 4a")
      for value in ("-2", "nan", "inf", "abc", "-4a", "4 mm")),
    ("bodies.lower.hight=1,2", "not in the scene; did you mean 'height'?"),
    ("bodies.lowr.height=1,2", "no table 'lowr' in the scene; did you mean 'lower'?"),
    ("load.xyzxyz=1,2", "not in the scene"),
])  # fmt: skip
def test_a_value_that_is_no_size_is_named_and_so_is_the_key_nearest_to_one_that_is_not_there(over, told):
    assert line_of(lambda: make(scene(), [read(over)])) == f"--over {over.partition('=')[0]}: {told}"


def test_a_thickness_is_twice_the_height_of_a_body_on_rollers():
    halved = scene().replace({"bodies.lower.support": "roller"})
    axis, plain = read("bodies.lower.thickness=2,6"), read("bodies.lower.height=1,3")
    assert [case.scene for case in make(halved, [axis])] == [case.scene for case in make(halved, [plain])]
    assert (axis.limit, axis.label(halved.units)) == (2 * plain.limit, "bodies.lower.thickness in m")
    assert axis.stays(halved) == plain.stays(halved)
    assert (plain.halves(halved), axis.halves(halved), plain.halves(scene())) == (["bodies.lower"], [], [])
    with pytest.raises(partialslip.InputError, match=r"bodies.upper.support = 'clamped': use bodies.upper.height"):
        make(halved, [read("bodies.*.thickness=2,6")])


def test_displacements_of_the_plates_are_refused_before_anything_is_solved(monkeypatch):
    monkeypatch.setattr("partialslip.study.size.axes.run", None)
    moved = scene().replace(load={"Q": [0, 0], "displacement": [-1e-5, 2e-5]})
    told = "must be left out of a study of sizes, as half-planes have no plates; give load.Q"
    assert line_of(make, moved, [read("bodies.*.width=4a,8a")]) == f"load.displacement = [-1e-05, 2e-05]: {told}"


def test_half_planes_are_marched_where_exact_has_no_solution():
    """Of unlike materials, and out of phase; the half-width of an axis in a is theirs."""
    unlike = scene(accuracy=1e-2).replace(material={"lower": {"E": 70e9, "nu": 0.3}, "upper": {"E": 2e11, "nu": 0.3}})
    turning = scene().replace(load={"Q": [0, 3e4, 0, -3e4], "sigma": [3e7, 0, -3e7, 0]})
    assert [compared_methods(each)[0] for each in (scene(), unlike, turning)] == ["exact", "march", "march"]
    pressed = unlike.replace(load={"Q": [0, 0], "sigma": [0, 0]})  # marched as well, but sooner
    (case,) = make(pressed, [read("bodies.*.width=8a")])
    a = partialslip.run(pressed, "march")["march"].a
    assert (case.methods[0], case.scene.bodies.lower.width) == ("march", pytest.approx(8 * a))


def test_cases_are_written_in_the_units_of_the_scene():
    """With the unit in the heading unless SI, as tractions.csv has them."""
    plain = scene()
    for axis, key in ((read("bodies.lower.height=2,4"), "bodies.lower.height [mm]"),
                      (read("bodies.lower.height=2a,4a"), "bodies.lower.height [a of the half-plane]")):  # fmt: skip
        found = entries(axis.name, {2.0: 0.5}, remains=None)
        head, (row,) = size.case_table([axis], found, N_MM)
        written = dict(zip(head, row, strict=True))
        assert (written[key], written["a [mm]"], written["p_max [MPa]"], written["m [mm]"]) == (2.0, 1500.0, 1e-6, "")
    head, (row,) = size.case_table([axis], found, plain.units)
    assert dict(zip(head, row, strict=True))["a"] == 1.5


@pytest.mark.parametrize("values", ["1e5", "1e5,1e5", "0,1e5"])
def test_a_map_needs_two_values_of_each(values, tmp_path, refused):
    command = ["study", "size", "hertz-shear", "--over", "friction.f=0.5,0.9", "--over", f"load.P={values}"]
    said = refused(*command, "--out", str(tmp_path / "map"))
    assert said == "partialslip: --over load.P: must have at least 2 values, all > 0, for a map\n"


def test_stars_stand_for_every_table_and_a_for_the_half_planes_half_width():
    cases = make(scene(), [read("2*bodies.*.width+bodies.*.height=4a,16a")])
    assert len(cases) == 2
    widths = [case.scene.bodies.lower.width for case in cases]
    assert widths == pytest.approx([8e-3, 32e-3])
    assert cases[0].scene.bodies.upper.height == pytest.approx(4e-3)
    assert [case.labels["bodies.*.height"] for case in cases] == [4.0, 16.0]
    with pytest.raises(partialslip.InputError, match="not in the scene"):
        make(scene(), [read("bodies.*.depth=1,2")])
