"""Somebody else's results: what is read from tractions that are known, coarse, noisy or wrong."""

import io
import json
from pathlib import Path

import meshio
import numpy as np
import pytest
from tables import sampled, written

import partialslip
from partialslip import load_scene, run, score
from partialslip.cli import main
from partialslip.codes.score.samples import Samples
from partialslip.run.judge import Outcome
from partialslip.tools.output import place

SCENES = ("hertz-shear", "hertz-small-tension", "hertz-large-tension", "fretting-aluminium", "flat-rounded")
FIXTURES = Path(__file__).parent


@pytest.fixture(scope="module")
def exact():
    scenes = {name: load_scene(name) for name in SCENES}
    return {name: (scene, run(scene, ["exact"]).results["exact"]) for name, scene in scenes.items()}


def errors(scene, path, **settings):
    outcome = score(scene, path, **settings)
    return outcome.results[path.name], outcome.comparisons[path.name]


@pytest.mark.parametrize("name", SCENES)
def test_errors_fall_with_the_spacing(exact, tmp_path, name):
    """p and q at points are those of the solution; what the spacing hides of them falls by first order in L2, as lines
    between points are near square roots; a, m and n far below the spacing."""
    scene, result = exact[name]
    tables = [errors(scene, written(tmp_path / "t.csv", sampled(result, n))) for n in (81, 321, 1281)]
    found = [comparison for _, comparison in tables]
    for key in ("p", "q"):
        assert max(getattr(comparison, key) for comparison in found) < 1e-10
        coarse, fine = (tables[k][0].settings[f"spacing_hides_{key}"] for k in (0, 2))
        assert np.log(coarse / fine) / np.log(16) > 0.9
    for key in ("a", "m", "n"):
        # the flat's corner has three points at the widest spacing: two unknowns and the end
        assert getattr(found[0], key) < (0.5 if name == "flat-rounded" else 0.25) * 2.2 / 80
        # of the flat's m the points within the corner, beside the kink of p, are few at that spacing
        assert getattr(found[1], key) < (0.01 if name == "flat-rounded" else 0.002) * 2.2 / 320
        assert getattr(found[2], key) < 0.002 * 2.2 / 1280
    assert {c.outcome for c in found} == {Outcome.NOT_JUDGED}  # without bars nothing passes


@pytest.mark.parametrize("name", SCENES)
def test_ends_from_twenty_points(exact, tmp_path, name):
    """A spacing of a ninth of a: ends to a fifth of that. To half of it, where four points stick; to the whole beside
    the flat's corner, which is narrower than the spacing, where m and n may not be given. The estimates tell."""
    scene, result = exact[name]
    found, comparison = errors(scene, written(tmp_path / "t.csv", sampled(result, 20)))
    part = {"fretting-aluminium": 0.5, "flat-rounded": 1.0}.get(name, 0.2)
    given = "a" if name == "flat-rounded" and found.m is None else "amn"
    assert max(getattr(comparison, key) for key in given) < part * 2.2 / 19
    assert all(getattr(comparison, key) <= found.estimate[key] for key in given)


@pytest.mark.parametrize("name", SCENES[:4])
def test_noise_is_seen_and_told(exact, tmp_path, name):
    """One percent of p0 and of f p0 at every point: ends to a tenth of a spacing or so. As noise hides what kind the
    values are, and whether the end is blurred, the estimate is a spacing or two."""
    scene, result = exact[name]
    random = np.random.default_rng(3)
    off, told = [], []
    for _ in range(10):
        table = sampled(result, 80)
        table[:, 1:] += 0.01 * result.p0 * random.standard_normal((80, 2)) * [1, 2 * scene.friction.f]
        found, comparison = errors(scene, written(tmp_path / "t.csv", table))
        given = "a" if found.m is None else "amn"
        off += [getattr(comparison, key) for key in given]
        told += [found.estimate[key] for key in given]
    spacing = 2.2 / 79
    assert len(off) >= 20  # of 30, the others not given
    assert np.median(off) < 0.15 * spacing
    assert max(off) < 2 * spacing
    assert all(error <= own for error, own in zip(off, told, strict=True))
    assert 0.5 * spacing < np.median(told) < 2 * spacing
    assert found.settings["noise_over_p0"] == pytest.approx(0.01, rel=0.6)


def test_all_ways_of_writing_the_same(exact, tmp_path):
    scene, result = exact["fretting-aluminium"]
    x, p, dq = sampled(result, 81).T
    tables = {
        "x,p,dq": (x, p, dq),
        "x,p,q": (x, p, dq / 2),
        "X, x,p,q1,q2": (x, x, p, -dq / 2, dq / 2),
        "p,x,other,dq": (p, x, 0 * x, dq),
    }

    def told(path, **settings):
        found, comparison = errors(scene, path, **settings)
        return found.a, found.m, found.n, comparison.p, comparison.q

    ends = [told(written(tmp_path / "t.csv", columns, names)) for names, columns in tables.items()]
    order = np.random.default_rng(0).permutation(81)
    text = "\n".join(f"{a!r};\t{b!r} ; {c!r}  # point" for a, b, c in np.column_stack([x, p, dq])[order].tolist())
    (tmp_path / "t.csv").write_text(f"# a comment\n\n x; p; dq\n{text}\n", "utf-8")
    ends.append(told(tmp_path / "t.csv"))
    units = written(tmp_path / "t.csv", (x * 1e3, -p / 1e6, dq / 1e6))
    ends.append(told(units, factors=(1e-3, -1e6, 1e6)))
    for other in ends[1:]:
        assert other == pytest.approx(ends[0], rel=1e-9)


@pytest.mark.parametrize("ending", ["vtu", "vtk", "xdmf"])
def test_meshes(exact, tmp_path, ending):
    """A body with a line of elements along its contact, which alone is read; and points without values."""
    scene, result = exact["fretting-aluminium"]
    x, p, dq = sampled(result, 81).T
    points = np.concatenate([np.column_stack([x, 0 * x, 0 * x]), [[0.0, -1e-3, 0]]])
    cells = [("triangle", np.column_stack([np.arange(80), np.arange(1, 81), np.full(80, 81)]))]
    cells.append(("line", np.column_stack([np.arange(80), np.arange(1, 81)])))
    data = {"p": np.append(p, 7.0), "dq": np.append(dq, 0.0), "u": points}
    path = tmp_path / f"t.{ending}"
    if ending == "xdmf":
        pytest.importorskip("h5py")
    settings = {"data_format": "XML"} if ending == "xdmf" else {}
    meshio.write(path, meshio.Mesh(points, cells, point_data=data), **settings)
    found, comparison = errors(scene, path)
    same, expected = errors(scene, written(tmp_path / "t.csv", np.column_stack([x, p, dq])))
    assert (found.a, found.m, comparison.q) == pytest.approx((same.a, same.m, expected.q), rel=1e-6)


@pytest.mark.parametrize(("ending", "off"), [("frd", 0.2), ("dat", 0.4)])
def test_calculix(ending, off):
    """From a run of CalculiX 2.20 (elements of 0.16 a, surface-to-surface, blocks of 16 a): ends to part of an
    element, with two points in a slip zone, so that f is not seen; errors are within the estimates."""
    scene = load_scene("hertz-shear")
    found, comparison = errors(scene, FIXTURES / f"calculix.{ending}")
    assert found.regime == "small tension"
    assert max(comparison.a, comparison.m, comparison.n) < off * 0.1625
    assert all(getattr(comparison, key) < 3 * found.estimate[key] for key in "amn")
    assert comparison.p < 0.12
    chosen, _ = errors(scene, FIXTURES / f"calculix.{ending}", at=(1, 2))
    assert chosen.m == found.m
    turned, opposite = errors(scene, FIXTURES / f"calculix.{ending}", at=(2, 1))
    assert turned.traction.dq == pytest.approx(-found.traction.dq)
    assert opposite.q > 1.9
    assert any("dq may be of the opposite sign" in note for note in turned.notes)


def times(*factors):
    return lambda table, _: table * factors


MISTAKES = {
    "shifted by half a cell": (lambda t, h: t + np.array([h / 2, 0, 0]), "left right p", "middle is at x = 0.0034 a"),
    "q of the other sign": (times(1, 1, -1), "q dQ", "dq may be of the opposite sign: correct with --factors 1,1,-1"),
    "half a cycle": (times(1, 1, 0.5), "q dQ", "dq may be of half a cycle: correct with --factors 1,1,2"),
    "without the right half": (lambda t, _: t[: len(t) // 2], "a p q P", "of the scene's P"),
    "a hole": (lambda t, _: np.delete(t, slice(24, 52), axis=0), "p q", ""),
    "p and q exchanged": (lambda t, _: np.column_stack([t[:, 0], t[:, 2], t[:, 1]]), "p q P dQ", "of the scene's P"),
    "mirrored": (times(-1, 1, 1), "m n q", "on the other side: is the sign of x, or of the tension, reversed?"),
    "pressure scaled": (times(1, 1.1, 1), "p P", "p adds up to 1.1 of the scene's P"),
    "shear scaled": (times(1, 1, 1.05), "q dQ", "dq adds up to 1.05 of the scene's dQ"),
    "less friction": (times(1, 1, 0.987), "q", "|dq|/(2 p) is 0.2961 in the slip zones, but the scene's f"),
    "in MPa": (times(1, 1e-6, 1e-6), "p q P dQ", "MPa: correct with --factors 1,1e+06,1e+06"),
    # no point lies within the contact, so that nothing is known of p and q there
    "in mm and MPa": (times(1e3, 1e-6, 1e-6), "a", "correct with --factors 0.001,1e+06,1e+06"),
    "in mm": (times(1e3, 1, 1), "a", "x may be in mm: correct with --factors 0.001,1,1"),
}


@pytest.mark.fault
@pytest.mark.parametrize("mistake", MISTAKES)
def test_mistakes_in_a_table_are_named(exact, tmp_path, mistake):
    """Against bars that the table meets without the mistake."""
    scene, result = exact["fretting-aluminium"]
    table = sampled(result, 321)
    clean, good = errors(scene, written(tmp_path / "t.csv", table), bar=5e-4)
    assert good.passed
    assert not clean.notes
    spoil, seen, note = MISTAKES[mistake]
    found, comparison = errors(scene, written(tmp_path / "t.csv", spoil(table, table[1, 0] - table[0, 0])), bar=5e-4)
    missed = {what.split(":")[0] for what in comparison.missed}
    assert set(seen.split()) <= missed
    assert note in " ".join(found.notes)
    if "x may be in" in note:
        assert found.m is None
        assert "another unit" in found.undetermined["m"]


@pytest.mark.fault
def test_tension_left_out_is_named(exact, tmp_path):
    scene, _ = exact["fretting-aluminium"]
    without = run(load_scene("fretting-aluminium", ["load.sigma=[0.0, 0.0]"]), ["exact"]).results["exact"]
    found, comparison = errors(scene, written(tmp_path / "t.csv", sampled(without, 161)), bar=5e-4)
    assert {"m", "n", "q"} <= {what.split(":")[0] for what in comparison.missed}
    assert any("was the tension left out?" in note for note in found.notes)


def test_a_moment_moves_the_contact(tmp_path):
    """Its middle is not at x = 0, and is no mistake; elsewhere than in the solution it is one."""
    scene = load_scene("hertz-small-tension", ["load.e=2e-4"])
    result = run(scene, ["exact"]).results["exact"]
    table = sampled(result, 141, reach=1.3)
    found, comparison = errors(scene, written(tmp_path / "t.csv", table))
    assert not found.notes
    assert max(comparison.a, comparison.m, comparison.n) < 0.1 * 2.6 / 140
    found, _ = errors(scene, written(tmp_path / "t.csv", table + np.array([5e-5, 0, 0])))
    assert found.notes == ("the contact's middle is at x = 0.25 a, not at 0.2 a",)
    with pytest.raises(partialslip.InputError, match="centre 'auto': must be 'given' with a moment"):
        score(scene, tmp_path / "t.csv", centre="auto")


def test_shear_that_is_not_scored_needs_no_other_reference(tmp_path):
    """Only of a table with q1 and q2 it matters that exact does not know them."""
    scene = load_scene("hertz-small-tension", ["load.sigma=[0,4e7]"])
    table = sampled(run(scene, ["exact"])["exact"], 81)
    for names, columns, told in (("x,p,dq", table, 0), ("x,p,q1,q2", table[:, [0, 1, 2, 2]] * [1, 1, -0.5, 0.5], 1)):
        found = score(scene, written(tmp_path / "t.csv", columns, names))["exact"]
        said = [*found.undetermined.values(), *found.notes]
        assert sum("use march" in text for text in said) == 3 * told


def test_other_references(tmp_path):
    """March where loads are out of phase; the finite elements where bodies are of a size."""
    loads = "load.Q=[0, 1e5, 0, -1e5]", "load.sigma=[1e8, 0, -1e8, 0]", "load.cycles=2"
    scene = load_scene("hertz-shear", [*loads, "fem.accuracy=1e-3"])
    march = run(scene, ["march"]).results["march"]
    table = np.column_stack([march.traction.x, march.traction.p, march.traction.dq])
    outcome = score(scene, written(tmp_path / "t.csv", table), bar=1e-2)
    assert (outcome.reference, outcome.passed) == ("march", True)
    block = "{width = 0.02, height = 0.02}"
    finite = load_scene("hertz-shear", [f"bodies.upper={block}", f"bodies.lower={block}", "fem.accuracy=1e-2"])
    fem = run(finite, ["fem"]).results["fem"]
    table = np.column_stack([fem.traction.x, fem.traction.p, fem.traction.dq])
    outcome = score(finite, written(tmp_path / "t.csv", table), bar=2e-2)
    assert (outcome.reference, outcome.passed) == ("fem", True)


def test_on_the_command_line(exact, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    _, result = exact["hertz-shear"]
    written(tmp_path / "$a_[red]$.csv", sampled(result, 161))
    assert main(["score", "hertz-shear", "$a_[red]$.csv"]) == 0
    printed = capsys.readouterr().out
    assert "$a_[red]$.csv" in printed
    assert "no bars: none were asked for" in printed
    folder = tmp_path / "results" / "hertz-shear-$a_[red]$"
    files = {place.REQUEST_NAME, "report.html", "results.json", "tractions.csv"}
    assert {path.name for path in folder.iterdir()} == files
    assert "p/p0, $a_[red]$.csv" in (folder / "report.html").read_text("utf-8")
    record = json.loads((folder / "results.json").read_text("utf-8"))
    assert record["comparison"]["$a_[red]$.csv"]["errors"]["m"] < 1e-6
    for f, code in (("0.5", 0), ("0.51", 1)):
        given = "--set", f"friction.f={f}", "$a_[red]$.csv", "--bar", "1e-4"  # options may stand before the file
        assert main(["score", "hertz-shear", *given, "--json"]) == code
        assert json.loads(capsys.readouterr().out)["methods"].keys() == {"exact", "$a_[red]$.csv"}


def test_template_is_filled_in_and_scored(exact, tmp_path, capsys):
    scene, result = exact["flat-rounded"]
    assert main(["score", "flat-rounded", "--template"]) == 0
    table = capsys.readouterr().out
    x = np.loadtxt(io.StringIO(table), delimiter=",", comments=["#", "x"])[:, 0]
    assert x[0] < -1.05 * result.a
    assert x[-1] > 1.05 * result.a
    (tmp_path / "empty.csv").write_text(table, "utf-8")
    with pytest.raises(partialslip.InputError, match=r"p > 0 at 0 points"):
        score(scene, tmp_path / "empty.csv")
    head = table[: table.index("x,p,dq")]
    rows = "".join(f"{a!r},{b!r},{c!r}\n" for a, b, c in np.column_stack([x, *result.traction.at(x)[:2]]).tolist())
    (tmp_path / "full.csv").write_text(f"{head}x,p,dq\n{rows}", "utf-8")
    assert errors(scene, tmp_path / "full.csv")[1].n < 1e-3


def test_friction_that_varies_along_the_contact(tmp_path):
    """The room is that up to f(x) p; with the largest f alone, neither end would be found."""
    scene = load_scene("hertz-shear")
    a = run(scene, ["exact"]).results["exact"].a
    varying = scene.replace(friction={"f": [0.6, 0.4], "x": [-a, a]})
    result = run(varying, ["exact"]).results["exact"]
    path = written(tmp_path / "t.csv", sampled(result, 401))
    seen, comparison = errors(varying, path)
    assert (comparison.m, comparison.n) == pytest.approx((0, 0), abs=5e-5)
    assert seen.settings["f_seen"] == pytest.approx(0.6, rel=1e-3)
    assert score(scene.replace(friction={"f": 0.6}), path).results[path.name].m is None


def test_every_second_point_is_a_coarser_table():
    """Points are left out; means over cells become means over two cells, so that no force is lost."""
    x = np.array([0.0, 1.0, 2.0, 4.0, 5.0, 6.0, 8.0])
    points = Samples(x, x**2, -x)
    assert points.coarser(1).x.tolist() == [1.0, 4.0, 6.0]
    assert points.coarser(0).dq.tolist() == [0.0, -2.0, -5.0, -8.0]
    assert points.coarser(0).p1 is None
    cells = np.array([-0.5, 0.5, 1.5, 3.0, 4.5, 5.5, 7.0, 9.0])
    means = Samples(x, x**2, -x, cells=cells)
    for first in (0, 1):
        coarse = means.coarser(first)
        assert len(coarse.cells) == len(coarse.p) + 1
        assert coarse.p @ np.diff(coarse.cells) == pytest.approx((means.p * np.diff(cells))[first:].sum())
