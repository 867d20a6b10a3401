"""Names of files that somebody else has chosen: in tables, reports and terminals they are text and nothing else."""

import csv
import io

import pytest
from tables import sampled, written

from partialslip import load_scene, run
from partialslip.cli import main
from partialslip.tools.output import files as module
from partialslip.tools.output.files import csv_text

FORMULAS = ("=1+1.csv", "+1-cmd.csv", "-1+1.csv", "@SUM(A1).csv", "\t=1.csv", "\r=1.csv")


@pytest.fixture
def table(tmp_path, monkeypatch):
    """Write a table of tractions under a name, in an empty folder."""
    monkeypatch.chdir(tmp_path)
    exact = run(load_scene("hertz-shear"), "exact")["exact"]
    return lambda name: written(tmp_path / name, sampled(exact, 61, 1.2))


def formulas(text):
    """Cells that a spreadsheet would calculate: text that begins like a formula, and no number."""
    cells = [cell for row in csv.reader(io.StringIO(text)) for cell in row]
    return [cell for cell in cells if cell[:1] in ("=", "+", "-", "@", "\t", "\r") and not _is_number(cell)]


def _is_number(cell):
    try:
        return bool(float(cell)) or True
    except ValueError:
        return False


def test_text_is_no_formula_and_numbers_are_numbers():
    rows = [["=1", "-x", "-1.5e-3", -2.5, 3, None, "", "a=1"], [*FORMULAS, "+inf", "x"]]
    found = csv_text(["@a", *"bcdefgh"], rows)
    assert formulas(found) == []
    first, second, _ = csv.reader(io.StringIO(found))
    assert first[0] == "'@a"
    assert second == ["'=1", "'-x", "-1.5e-3", "-2.5", "3", "", "", "a=1"]


@pytest.mark.parametrize("name", [*FORMULAS, "t\x1b[2J.csv", "t\x9b2J.csv", "t\u202egpj.csv"])
def test_scores_of_a_file_with_an_odd_name(table, tmp_path, capsys, name):
    table(name)
    assert main(["score", "hertz-shear", f"./{name}", "--out", "out"]) == 0
    printed = capsys.readouterr()
    assert all(each.isprintable() for each in (printed.out + printed.err).splitlines())
    for path in (tmp_path / "out").glob("*.*"):
        text = path.read_text("utf-8")
        assert "\x1b" not in text
        assert "\x9b" not in text
        assert "\u202e" not in text
    assert formulas((tmp_path / "out" / "tractions.csv").read_text("utf-8")) == []


@pytest.mark.fault
def test_formulas_in_tables_are_caught(monkeypatch):
    """Deliberate fault: text is written as it is, but for control characters."""
    monkeypatch.setattr(module, "_safe_cell", lambda cell: module.printable(cell) if isinstance(cell, str) else cell)
    with pytest.raises(AssertionError):
        test_text_is_no_formula_and_numbers_are_numbers()
