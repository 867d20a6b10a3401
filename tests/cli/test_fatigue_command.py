"""partialslip fatigue: what it prints and writes, and what it refuses."""

import csv
import importlib
import json

import pytest

from partialslip.cli import main

SWT = ["fatigue", "fretting-aluminium", "--criterion", "swt,ruiz"]


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "120")
    return tmp_path


@pytest.mark.slow
def test_tables_and_files(here, capsys):
    assert main([*SWT, "--distance", "50e-6"]) == 0
    printed = capsys.readouterr().out
    for line in ("fretting-aluminium, lower body, by exact: 8 load points", "Averaged over 0.05 mm", "ruiz F2 = "):
        assert line in printed
    (folder,) = here.glob("results/fretting-aluminium-fatigue-*")
    names = {path.name for path in folder.iterdir() if not path.name.startswith(".")}
    texts = {"fatigue.json", "along-surface.csv", "over-depth.csv", "report.html"}
    assert names == texts | {"stresses.svg", "criteria.svg", "planes.svg"}
    data = json.loads((folder / "fatigue.json").read_text())
    swt = data["criteria"]["swt"]
    assert (swt["unit"], swt["surface"]["x"]) == ("Pa", data["a"])
    with (folder / "over-depth.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert float(rows[0]["swt"]) == pytest.approx(swt["surface"]["value"], rel=1e-12)
    assert "Critical planes" in (folder / "report.html").read_text("utf-8")


@pytest.mark.slow
def test_other_units(here, capsys):
    assert main([*SWT, "--set", "shown_in=N-mm", "--out", "mm"]) == 0
    assert "MPa^2 mm" in capsys.readouterr().out
    head = (here / "mm" / "over-depth.csv").read_text().splitlines()[0]
    assert head == "x [mm],depth [mm],swt [MPa]"


@pytest.mark.slow
def test_criteria_in_capitals_and_the_former_name_of_an_option(here):
    """--method is the former name of --with: the same settings, so the same folder."""
    for how in (["--with", "exact"], ["--method", "exact"]):
        assert main(["fatigue", "fretting-aluminium", "--criterion", "SWT", *how]) == 0
    assert len(list((here / "results").iterdir())) == 1


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["--criterion", "findley"], "fretting-aluminium: fatigue.k_findley: missing; the criterion findley needs it"),
        (["--criterion", "miner"], "fretting-aluminium: criterion 'miner': must be of principal, swt, fatemi-socie, "
         "findley, dang-van, crossland, ruiz"),
        (["--criterion", "stw"], "fretting-aluminium: criterion 'stw': must be of principal, swt, fatemi-socie, "
         "findley, dang-van, crossland, ruiz; did you mean 'swt'?"),
        (["--distance", "-1"], "fretting-aluminium: fatigue.distance = -1: must be > 0.0"),
        (["--distance", "far"], "fretting-aluminium: fatigue.distance = 'far': must be a number, not a string"),
        (["--method", "fem", "--set", "fatigue.k_finley=1"],
         "fretting-aluminium: fatigue.k_finley: unknown key; did you mean 'k_findley'?"),
        (["--with", "march", "--set", "material.upper={E=1e9, nu=0.3}"],
         "fretting-aluminium: --with march: must be fem for unlike materials; march finds no stresses in them"),
    ],
)  # fmt: skip
def test_bad_input_gets_one_line(here, refused, arguments, line, monkeypatch):
    run = importlib.import_module("partialslip.run")
    monkeypatch.setattr(run, "solved_with_stresses", None)  # before anything is solved
    assert refused("fatigue", "fretting-aluminium", *arguments) == f"partialslip: {line}\n"
    assert not list(here.iterdir())
