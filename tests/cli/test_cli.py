"""The command line: files, output and exit codes."""

import contextlib
import csv
import io
import json
import os
import re
import shutil
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

import meshio
import numpy as np
import pytest
from outline import Outline

import partialslip
from partialslip.cli import main
from partialslip.report import files
from partialslip.scene.reading import load_scene, shipped_scenes
from partialslip.tools.output import place

EXACT = ("run", "hertz-shear", "--with", "exact")
WITHIN = "within 1 % of a, 10 % of p and q"
FILES = ["report.html", "results.json", "tractions.csv"]


def call(folder, *arguments):
    """Run in ``folder``, 80 columns wide. Returns exit code, stdout ``out``, record and folder of results."""
    out = io.StringIO()
    with contextlib.chdir(folder), contextlib.redirect_stdout(out), mock.patch.dict(os.environ, COLUMNS="80"):
        code = main(arguments)
    (results,) = Path(folder, "results").iterdir()
    return SimpleNamespace(code=code, out=out.getvalue(), folder=results, record=strict(results / "results.json"))


def strict(source):
    """Return JSON from a file or a string; NaN and Infinity are errors."""
    text = source.read_text("utf-8") if isinstance(source, Path) else source
    return json.loads(text, parse_constant=lambda token: pytest.fail(token))


def rows(folder):
    return list(csv.DictReader((folder / "tractions.csv").read_text("utf-8").splitlines()))


def names(folder):
    return sorted(path.name for path in folder.iterdir() if path.name != place.REQUEST_NAME)


@pytest.fixture(scope="module")
def exact(tmp_path_factory):
    return call(tmp_path_factory.mktemp("exact"), *EXACT)


@pytest.fixture(scope="module")
def both(tmp_path_factory):
    return call(tmp_path_factory.mktemp("both"), "run", "hertz-shear", "--set", "fem.accuracy=1e-2", "--fields")


@pytest.fixture(scope="module")
def missed(tmp_path_factory):
    settings = ("--set", "fem.far_field=box", "--set", "fem.width=4", "--accuracy", "1e-3")  # off by 2e-2
    return call(tmp_path_factory.mktemp("missed"), "run", "hertz-shear", *settings)


def test_a_run_is_short_and_verbose_on_demand(both, tmp_path):
    """What is found, one line a method, the verdict and the folder; the rest with --verbose."""
    title, answered, *_, exact, fem, last = both.out.splitlines()
    assert title.startswith("hertz-shear: Cattaneo")
    assert answered == "exact: small tension"
    assert re.fullmatch(r"exact +small tension, 0\.\d+ CPU s *", exact)
    assert re.fullmatch(r"fem +small tension, \d+\.\d CPU s, [\d,]+ dofs *", fem)
    folder = Path("results", both.folder.name)
    assert last == f"all bars met: {WITHIN}; files in {folder} (settings: fem.accuracy, fields)"
    assert len(both.out.splitlines()) <= 30
    verbose = call(tmp_path, *EXACT, "--verbose").out
    for word in ("certificate", "limits", "slip", "wall time", "peak memory", "called for", "left out", "written: "):
        assert word in verbose
        assert word not in both.out


def test_tractions_table(both):
    table = rows(both.folder)
    assert list(table[0]) == ["method", "x", "x_over_a", "p", "q1", "q2", "dq"]
    for name, method in both.record["methods"].items():
        listed = [row for row in table if row["method"] == name]
        assert len(listed) == len(method["traction"]["x"]) > 50
        for key, column in method["traction"].items():
            assert [float(row[key]) for row in listed] == column
        scaled = np.array([float(row["x_over_a"]) for row in listed])
        np.testing.assert_allclose(scaled * method["a"], method["traction"]["x"], rtol=1e-14, atol=1e-20)


def test_fields_read_back(both):
    assert names(both.folder) == sorted([*FILES, "bodies.vtu", "mesh.msh", "surface.csv"])
    with contextlib.redirect_stdout(io.StringIO()):
        mesh, bodies = (meshio.read(both.folder / name) for name in ("mesh.msh", "bodies.vtu"))
    assert {"triangle", "line"} <= mesh.cells_dict.keys()
    assert mesh.field_data.keys() >= {"contact", "face", "back", "left", "right"}
    assert set(bodies.cell_data["body"][0].tolist()) == {0, 1}
    assert {values.shape for values in bodies.point_data.values()} == {bodies.points.shape}
    for displacements in bodies.point_data.values():
        assert 0 < np.abs(displacements).max() < np.inf


def test_json_with_a_folder_prints_what_it_writes(tmp_path, capsys):
    assert main([*EXACT, "--json", "--out", str(tmp_path / "deep" / "down")]) == 0
    assert strict(capsys.readouterr().out) == strict(tmp_path / "deep" / "down" / "results.json")
    assert names(tmp_path / "deep" / "down") == FILES


def test_what_a_method_does_not_determine_is_left_empty(tmp_path):
    sliding = call(tmp_path, *EXACT, "--set", "load.Q=[0, 1e6]")
    method = sliding.record["methods"]["exact"]
    assert (sliding.code, method["regime"]) == (0, "sliding")
    assert method["m"] is method["n"] is method["traction"]["q1"] is None
    assert {(row["q1"], row["q2"]) for row in rows(sliding.folder)} == {("", "")}


def page_of(done):
    return Outline((done.folder / "report.html").read_text("utf-8"))


def test_what_a_cheap_method_refuses_costs_no_finite_elements(monkeypatch):
    """The results are in the order in which the methods were asked for."""
    scene = load_scene("hertz-shear", ["fem.accuracy=0.1"])
    assert [*partialslip.run(scene, ["fem", "march", "exact"]).results] == ["fem", "march", "exact"]
    solved = mock.Mock()
    monkeypatch.setattr("partialslip_fem.method.solve", solved)
    apart = scene.replace(load={"Q": [0.0, 1e4, 0.0, -1e4], "sigma": [1e7, 0.0, -1e7, 0.0]})
    with pytest.raises(partialslip.InputError, match="must be in phase for the exact method"):
        partialslip.run(apart, ["fem", "exact"])
    solved.assert_not_called()


@pytest.mark.parametrize("kind", ["exact", "both", "missed"])
def test_page_stands_alone(request, kind):
    page = page_of(request.getfixturevalue(kind))
    assert page.open == []  # every tag is closed
    # tractions, sketch, what stands at the load points; errors if two are compared, and a mesh if there is one
    assert page.names.count("svg") == (3 if kind == "exact" else 5)
    assert not {"script", "link", "img", "iframe", "object", "base"} & {*page.names}
    assert [link for link in page.links if not link.startswith("#")] == []


def test_page_takes_a_title_as_text(tmp_path):
    title = "<script>x</script> & [bold] R&D"
    page = page_of(call(tmp_path, *EXACT, "--set", f"title={json.dumps(title)}"))
    assert "script" not in page.names
    assert title in "".join(page.text)


def test_missed_bar(missed):
    said = " ".join(missed.out.split())
    comparison = missed.record["comparison"]["fem"]
    assert (missed.code, comparison["outcome"]) == (1, "missed")
    assert comparison["errors"]["a"] > comparison["bars"]["a"] == 1e-3
    assert "missed: fem: a: error " in said
    assert all(what in said for what in comparison["missed"])
    assert comparison["missed"][0] in " ".join(page_of(missed).text)


def test_errors_are_legible_in_80_columns(missed):
    table = [line.strip() for line in missed.out.partition("\nexact  ")[0].partition(" quantity ")[2].splitlines()]
    comparison = missed.record["comparison"]["fem"]
    assert "…" not in missed.out
    assert all(len(line) <= 80 for line in missed.out.splitlines() if not line.startswith("missed: "))
    for key in ("a", "m", "n", "p", "q"):
        (row,) = (line for line in table if line.startswith(f"{key}, ") and "largest" not in line)
        words, bar = row.split(), comparison["bars"][key]
        assert words[-1] == "MISSED"
        assert words[-2] == f"{bar:.1e}"
        assert f"{comparison['errors'][key]:.1e}" in words
    for each in comparison["verdicts"]:  # the difference of the printed values is the error
        if each["quantity"] in ("a", "m", "n", "p_max", "q_max"):
            assert abs(each["found"] - each["reference"]) == pytest.approx(each["error"], abs=1e-12)


@pytest.mark.parametrize("arguments", [("--set", 'title="[bold]x"'), ("--set", "title=x[/x]"), ("--out", "out[red]")])
def test_brackets_are_printed_as_they_are(tmp_path, monkeypatch, capsys, arguments):
    monkeypatch.chdir(tmp_path)
    assert main([*EXACT, *arguments]) == 0
    assert arguments[1].removeprefix("title=").strip('"') in capsys.readouterr().out


def test_scenes_are_listed(capsys):
    assert main(["scenes"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(maxsplit=1) for line in lines] == [[name, title] for name, title in shipped_scenes().items()]


def stop(*_, **__):
    raise KeyboardInterrupt


@pytest.mark.parametrize("what", ["run_page", "tractions_csv", "record"])
def test_stopped_over_older_files(exact, tmp_path, monkeypatch, what):
    shutil.copytree(exact.folder, tmp_path, dirs_exist_ok=True)
    page = (tmp_path / "report.html").read_bytes()
    monkeypatch.setattr(files, what, stop)
    assert main([*EXACT, "--set", "load.p0=3e8", "--out", str(tmp_path), "--force"]) == 130
    assert names(tmp_path) == FILES
    assert strict(tmp_path / "results.json")["scene"]["load"]["p0"] in (3e8, 4e8)
    assert (tmp_path / "report.html").read_bytes() == page


def test_a_contact_that_ratchets_ends_with_4_and_prints_no_stick_zone(capsys):
    loads = ["load.Q=[69115, 257610]", "load.sigma=[2e8, 1e9]", "load.cycles=6", "fem.accuracy=1e-2"]
    settings = [word for each in loads for word in ("--set", each)]
    assert main(["run", "hertz-large-tension", "--with", "exact,march", *settings, "--json"]) == 4
    written = json.loads(capsys.readouterr().out)
    assert {method["regime"] for method in written["methods"].values()} == {"ratchets"}
    assert written["outcome"] == "not judged"
    assert {"p0", "p_max"} < written["methods"]["exact"].keys()


def test_ends_whose_errors_are_not_estimated_are_named():
    from known import result

    from partialslip.cli.run import _reached

    assert _reached(result(estimate={"a": 1e-5, "m": 2e-5, "n": 3e-5})) == "fem: a, m and n known to 3.0e-05 a"
    assert _reached(result(estimate={"a": 1e-5})) == "fem: a known to 1.0e-05 a, no error estimate of m and n"
    assert _reached(result(estimate={})) == "fem: no error estimate of a, m and n"
