"""Commands with tolerances: what they print and write."""

import csv
import json
import re

import numpy as np
import pytest

from partialslip import load_scene, run
from partialslip.cli import main
from partialslip.study.tolerance import propagation

NAME = "fretting-aluminium"
FEW = ["--set", "load.Q=[-30e3,30e3]", "--tolerance", "friction.f=1%", "--tolerance", "load.P={std=500}"]


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "120")
    monkeypatch.setattr(propagation, "_DRAWS", 4)
    monkeypatch.setattr(propagation, "_DRAWN", 1)
    return tmp_path


def test_run_prints_a_second_table_and_records_it(here, capsys):
    assert main(["run", NAME, "--with", "exact", *FEW]) == 0
    printed = capsys.readouterr().out
    assert printed.index("p_max") < printed.index("within friction.f 1 %, load.P 500 N/m (std): by exact, differences")
    assert re.search("95% interval +num. error +from", printed)
    assert "regime: small tension throughout" in printed
    (folder,) = here.glob("results/*")
    data = json.loads((folder / "results.json").read_text())
    assert data["tolerance"]["inputs"] == {"friction.f": "1 %", "load.P": "500 N/m (std)"}
    assert data["scene"]["tolerance"]["friction"] == {"f": "1%"}
    page = (folder / "report.html").read_text("utf-8")
    assert "Tolerances of the inputs" in page
    assert "What each input alone does" in page


@pytest.mark.slow
def test_study_writes_figure_and_tables(here, capsys):
    assert main(["study", "tolerance", NAME, *FEW, "--set", "shown_in=N-mm", "--out", "found"]) == 0
    assert f"{NAME}, within" in capsys.readouterr().out
    files = {path.name for path in (here / "found").iterdir() if not path.name.startswith(".")}
    assert files == {"tolerance.csv", "draws.csv", "tolerance.svg", "report.html"}
    with (here / "found/tolerance.csv").open() as file:
        rows = {row["quantity"]: row for row in csv.DictReader(file)}
    assert rows["a"]["unit"] == "mm"
    assert float(rows["m"]["low"]) < float(rows["m"]["value"]) < float(rows["m"]["high"])
    shares = [float(each) for key, each in rows["a"].items() if key.startswith("share of")]
    assert sum(shares) == pytest.approx(1, abs=1e-3)
    with (here / "found/draws.csv").open() as file:
        drawn = list(csv.DictReader(file))
    assert drawn[0]["load.P [N/mm]"] == "135.75"
    exact = run(load_scene(NAME, ["load.Q=[-30e3,30e3]", f"friction.f={drawn[1]['friction.f']}"]), "exact")["exact"]
    assert float(drawn[1]["m"]) == pytest.approx(exact.m / exact.a, rel=1e-12)


@pytest.mark.slow
def test_score_puts_the_error_beside_what_the_inputs_allow(here, capsys):
    """A table of a code with 2 % too much friction, inside and outside what f to 4 % or to 0.5 % allows."""
    off = run(load_scene(NAME, ["load.Q=[-30e3,30e3]", "friction.f=0.306"]), "exact")["exact"].traction
    x = np.linspace(-1.05, 1.05, 1201) * 2.067e-4
    at = off.at(x)
    table = np.nan_to_num(np.column_stack([x, at.p, at.q1, at.q2]))
    np.savetxt("code.csv", table, delimiter=",", header="x,p,q1,q2", comments="")
    for width, word in (("4%", "within"), ("0.5%", "beyond")):
        assert main(["score", NAME, "code.csv", "--set", FEW[1], "--tolerance", f"friction.f={width}"]) == 0
        line = next(each for each in capsys.readouterr().out.splitlines() if "code.csv: m off by" in each)
        assert f"of a, {word} what the inputs allow" in line.replace("\n", " ")
    assert here
