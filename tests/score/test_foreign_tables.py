"""Tables as codes write them: names, units, separators, decimals, encodings, rows without values."""

import re
from pathlib import Path

import numpy as np
import pytest
from refusing import line_of

from partialslip import InputError, load_scene, run
from partialslip.cli import main
from partialslip.codes.score import headers, score
from partialslip.codes.score.read import read_tractions

SCENE = load_scene("fretting-aluminium")
EXACT = run(SCENE, ["exact"]).results["exact"]
X = 1.1 * EXACT.a * np.linspace(-1, 1.003, 61)
P, DQ, *_ = EXACT.traction.at(X)


def lines(*columns, separator=",", decimal="."):
    rows = zip(*(column.tolist() for column in columns), strict=True)
    return "\n".join(separator.join(repr(value).replace(".", decimal) for value in row) for row in rows)


@pytest.fixture
def read(tmp_path):
    """What is read of a text in a file."""

    def read(text, scene=SCENE, encoding="utf-8", **settings):
        (tmp_path / "t.txt").write_text(text, encoding)
        return read_tractions(tmp_path / "t.txt", scene, **settings)

    return read


def same(found):
    for column, wanted in ((found.x, X), (found.p, P), (found.dq, DQ)):
        assert column == pytest.approx(wanted, rel=1e-12, abs=1e-9 * np.abs(wanted).max())


TABLES = {
    "Abaqus": "COOR1 CPRESS CSHEAR1\n" + lines(X, P, DQ / 2, separator="   "),
    "CalculiX": "x,CPRESS,CSHEAR1\n" + lines(X, P, DQ / 2),
    "ANSYS": "Node\tX Location (mm)\tPressure (MPa)\tTAUR (MPa)\n"
    + lines(X * 0 + 7, X * 1e3, P / 1e6, DQ / 2e6, separator="\t"),
    "Code_Aster": "COOR_X;LAGS_C;LAGS_F1\n" + lines(X, -P, DQ / 2, separator=";"),
    "MOOSE": "x,y,normal_lm,tangential_lm\n" + lines(X, 0 * X, P, DQ / 2),
    "GetFEM": "x lambda_n lambda_t\n" + lines(X, P, DQ / 2, separator=" "),
    "decimal commas": "x [mm];p [MPa];dq [MPa]\n" + lines(X * 1e3, P / 1e6, DQ / 1e6, separator=";", decimal=","),
    "blanks": "  x [mm]   p (MPa)  dq [kPa]\n" + lines(X * 1e3, P / 1e6, DQ / 1e3, separator="     "),
}  # fmt: skip


@pytest.mark.parametrize("code", TABLES)
def test_tables_of_other_codes(read, code):
    found = read(TABLES[code])
    same(found)
    assert ("CPRESS" in found.made_of) == ("CPRESS" in TABLES[code])
    if "dq" not in TABLES[code]:
        assert any("at load point 2" in note for note in found.notes)
        turning = load_scene("fretting-aluminium", ["load.Q=[0.0, 38750.0]", "load.sigma=[0.0, 1e8]"])
        with pytest.raises(InputError, match="not fully reversed"):
            read(TABLES[code], turning)


@pytest.mark.parametrize("encoding", ["utf-16", "utf-8-sig"])
def test_encodings(read, encoding):
    assert read("x,p,dq\n" + lines(X, P, DQ), encoding=encoding).p == pytest.approx(P)


def test_columns_by_name_number_and_difference(read):
    table = lines(X * 1e3, DQ * 0.25 / 1e6, DQ * 1.25 / 1e6, P)
    for shear in ("S2-S1", "3-2", "S2 (MPa) - S1", "-S1+S2"):
        found = read(f"X (mm),S1 (MPa),S2 (MPa),PN\n{table}", chosen={"x": "X", "p": "4", "dq": shear})
        assert found.dq == pytest.approx(DQ, abs=1e-9 * P.max())
        assert found.x == pytest.approx(X)
    without_header = {"x": "1", "p": "4", "q1": "2", "q2": "3"}
    found = read(table, chosen=without_header, factors=(1e-3, 1, 1e6))
    assert found.dq == pytest.approx(DQ, abs=1e-9 * P.max())


def test_rows_without_values_are_left_out_and_counted(read):
    rows = lines(X, P, DQ).splitlines()
    rows[5:5] = ["1.0,,", "2.0,NoValue,NoValue", "3.0,-,-"]
    found = read("\n".join(["x,p,dq", *rows]))
    assert len(found.x) == len(X)
    assert found.notes == ("left out: 3 rows without values",)
    assert read("\n".join(["x,p,dq", *rows[:6], *rows[8:]])).notes == ("left out: 1 row without values",)


def test_centre_auto_puts_x_in_the_middle(tmp_path, capsys):
    path = tmp_path / "t.csv"
    path.write_text("x,p,dq\n" + lines(X + 3 * EXACT.a, P, DQ), "utf-8")
    off = score(SCENE, path).results["t.csv"]
    assert off.m is None
    put = score(SCENE, path, centre="auto")
    assert put.comparisons["t.csv"].m < min(2e-4, put["t.csv"].estimate["m"])
    assert f"at x = {3 * EXACT.a:.6g} m" in " ".join(put.results["t.csv"].notes)
    folder = str(tmp_path / "out")
    assert main(["score", "fretting-aluminium", str(path), "--centre", "auto", "--bar", "1e-2", "--out", folder]) == 4
    assert "this table tells m to" in capsys.readouterr().out  # 61 points do not tell it to 1e-2
    columns = "--columns", "x=1,p=2,dq=dq", "--out", folder, "--force"
    assert main(["score", "fretting-aluminium", str(path), *columns]) == 0
    assert "not judged" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("table", "columns", "said"),
    [
        ("1,2,3,4\n4,5,6,7", None, "line 1: must be a header line"),
        ("x,p,CSHEAR1,TAUR\n1,2,3,4", None, "column 'q': must be there once, not 2 times"),
        ("x,p,dq\n1,2,3", {"x": "x", "p": "p", "dq": "s"}, "--columns s: .*has the columns 'x', 'p', 'dq'"),
        ("x,p,dq\n1,2,3", {"x": "9", "p": "p", "dq": "dq"}, "--columns 9: "),
        ("x,p,dq\n1,2,3", {"y": "x"}, "--columns y: must be one of x, p, Fn, dq"),
        ("x,p,s [Pa],t [MPa]\n1,2,3,4", {"x": "x", "p": "p", "dq": "t-s"}, "must be in the same unit"),
        ("x;p;dq\n1,5;2;1.000,5", None, "line 2: 1.000,5: thousands separators"),
    ],
)
def test_what_cannot_be_read_is_one_line(read, table, columns, said):
    assert re.search(said, line_of(read, table, chosen=columns))


def test_names_of_other_codes_change_a_sign_at_most():
    """Only Code_Aster gives the pressure as a force on the body, negative in contact."""
    signs = {(key, name): sign for key, names in headers.NAMES.items() for name, sign in names.items()}
    assert {name: sign for name, sign in signs.items() if sign != 1} == {("p", "lags_c"): -1}
    assert all(name == name.lower() for _, name in signs)


# --- units of the scene

SHOWN = load_scene("fretting-aluminium", ["shown_in=N-mm"])
IN_MM = {
    "Abaqus": "COOR1 CPRESS CSHEAR1\n" + lines(X * 1e3, P / 1e6, DQ / 2e6, separator="   "),
    "one column with a unit": "x,p,dq [kPa]\n" + lines(X * 1e3, P / 1e6, DQ / 1e3),
    "all columns with units": "x [m],p [Pa],dq [Pa]\n" + lines(X, P, DQ),
    "negative pressure": "COOR_X;LAGS_C;LAGS_F1\n" + lines(X * 1e3, -P / 1e6, DQ / 2e6, separator=";"),
}


@pytest.mark.parametrize("kind", IN_MM)
def test_a_table_is_in_the_units_of_its_scene_unless_it_states_others(read, kind):
    found = read(IN_MM[kind], SHOWN)
    same(found)
    assert read(IN_MM[kind], SHOWN, factors=(1.0, 1.0, -1.0)).dq == pytest.approx(-found.dq)


def test_nodal_forces_are_in_N_per_mm_of_depth(read):
    h = X[1] - X[0]
    for scene, size, force in ((SCENE, 1.0, 1.0), (SHOWN, 1e-3, 1e3)):
        found = read("x,Fn,dFt\n" + lines(X / size, P * h / force, DQ * h / force), scene)
        assert found.p[1:-1] == pytest.approx(P[1:-1], rel=1e-9)


def test_a_table_in_other_units_than_the_scene_is_named_with_the_factors_that_help(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text("x,p,dq\n" + lines(X, P, DQ), "utf-8")
    notes = score(SHOWN, path).results["t.csv"].notes
    told = "x may be in m, p may be in Pa, dq may be in Pa: correct with --factors 1000,1e-06,1e-06 "
    assert f"{told}or --set shown_in=SI" in notes
    (tmp_path / "mm.txt").write_text(IN_MM["Abaqus"], "utf-8")
    assert "or --set shown_in=N-mm" in " ".join(score(SCENE, tmp_path / "mm.txt").results["mm.txt"].notes)
    helped = score(SHOWN, path, factors=(1e3, 1e-6, 1e-6))
    assert not any("may be" in note for note in helped.results["t.csv"].notes)
    assert helped.results["t.csv"].m == pytest.approx(score(SCENE, path).results["t.csv"].m, rel=1e-9)


def test_the_files_of_a_run_and_the_template_state_their_units(tmp_path, monkeypatch, capsys):
    """In the units of the scene or not: they are scored without factors."""
    monkeypatch.chdir(tmp_path)
    assert main(["score", "fretting-aluminium", "--set", "shown_in=N-mm", "--template"]) == 0
    text = capsys.readouterr().out
    assert "P = 135.75 N/mm, dQ = 77.5 N/mm, dsigma = 200 MPa" in text
    head, *rows = [line for line in text.splitlines() if not line.startswith("#")]
    assert head == "x [mm],p [MPa],dq [MPa]"
    x = np.array([float(row.partition(",")[0]) for row in rows]) / 1e3
    (tmp_path / "t.csv").write_text(
        f"{head}\n" + lines(x * 1e3, *(each / 1e6 for each in EXACT.traction.at(x)[:2])), "utf-8"
    )
    for scene in (SCENE, SHOWN):
        assert score(scene, tmp_path / "t.csv").comparisons["t.csv"].m < 1e-3


@pytest.mark.parametrize(("ending", "size"), [("", 1e-3), ("_SI", 1.0), ("_N_UM", 1e-6), ("_N_NM", 1e-9)])
def test_a_result_of_an_exported_deck_states_the_units_of_the_deck(tmp_path, ending, size):
    """In the names of its materials; other results are in the units of the scene."""
    text = (Path(__file__).parent / "calculix.frd").read_text("ascii")
    name, plain = f"    1UMAT    1{'LOWER' + ending:20s}", "    1UMAT    1AL                  "
    path = tmp_path / "a.frd"
    path.write_text(
        text.replace(next(line for line in text.splitlines() if line.startswith(plain[:16])), name), "ascii"
    )
    (tmp_path / "si.frd").write_text(text, "ascii")
    found, known = read_tractions(path, SHOWN), read_tractions(tmp_path / "si.frd", SCENE)
    assert found.x == pytest.approx(known.x * size, rel=1e-12)
    assert sum("the units of the deck" in note for note in found.notes) == bool(ending)
    assert found.p == pytest.approx(known.p * {1.0: 1.0}.get(size, size**-2), rel=1e-12)
