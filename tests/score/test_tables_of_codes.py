"""Tables as codes write them: reports, one file for each load point, no heading, long, normalised, half a contact."""

import meshio
import numpy as np
import pytest
from refusing import line_of

from partialslip import load_scene, run, score
from partialslip.cli import main
from partialslip.codes.score.read import read_tractions

SCENE = load_scene("fretting-aluminium", ["shown_in=N-mm", "load.Q=[-30e3, 30e3]", "load.sigma=[0, 0]"])
EXACT = run(SCENE, ["exact"])["exact"]
X = 1.4 * EXACT.a * np.linspace(-1, 1, 141)
P, DQ, *_ = EXACT.traction.at(X)
ROWS = np.column_stack([X * 1e3, P / 1e6, DQ / 2e6])  # mm, MPa, q at load point 2
NODES = np.arange(1, 142)


def text(rows, head="", separator=","):
    body = [separator.join(f"{value:.10g}" for value in row) for row in np.atleast_2d(rows).tolist()]
    return "\n".join([*([head] if head else []), *body, ""])


def files(folder, **texts):
    paths = [folder / name.replace("__", ".") for name in texts]
    for path, content in zip(paths, texts.values(), strict=True):
        path.write_text(content, "utf-8")
    return paths


def right(found):
    """Whether a, m, n and the tractions are those of the scene."""
    name = next(name for name in found.results if name != "exact")
    compared, result = found.comparisons[name], found[name]
    return max(compared.a, compared.m, compared.n) < 5e-3 and max(compared.p, compared.q) < 1e-3, result


def check(given, *told, scene=SCENE, **settings):
    good, result = right(score(scene, given, **settings))
    assert good, result
    for each in told:
        assert any(each in note for note in result.notes), result.notes
    return result


FIRST, SECOND = ROWS * [1, 1, -1], ROWS


# --- one file for each load point, and without heading


@pytest.mark.parametrize("head", ["X CPRESS CSHEAR1", ""])
def test_one_file_for_each_load_point(tmp_path, head):
    pair = files(tmp_path, first__txt=text(FIRST, head, " "), second__txt=text(SECOND, head, " "))
    result = check(pair, "load points 1 and 2: ", *([] if head else ["no heading: read as --columns x=1, p=2, q=3"]))
    assert result.traction.q1 is not None
    folder = ["--out", str(tmp_path / "out")]
    assert main(["score", "fretting-aluminium", *map(str, pair), "--set", "shown_in=N-mm", *folder]) == 0
    turning = SCENE.replace(load={"Q": [0.0, 30e3]})  # not fully reversed: one file does not tell
    assert "or a file for each load point" in line_of(score, turning, pair[1])


def test_pressure_and_shear_in_two_files(tmp_path):
    p, q = text(ROWS[:, :2], "x,CPRESS"), text(ROWS[::-1, [0, 2]], "x,CSHEAR1")
    check(files(tmp_path, p__csv=p, q__csv=q))
    by_node = [text(np.column_stack([NODES, ROWS[:, :2]]), "Node,x,CPRESS"),
               text(np.column_stack([NODES, ROWS[:, 2]])[::-1], "Node,CSHEAR1")]  # fmt: skip
    check(files(tmp_path, p__csv=by_node[0], q__csv=by_node[1]))
    apart = [
        text(np.column_stack([NODES, ROWS[:, 0]])[::-1], "NODE X", " ") + "500 7.0\n",
        text(np.column_stack([NODES, ROWS[:, 1:]]), "NODE PRES TAUR", " ") + "MINIMUM VALUES\nNODE 1 2\nVALUE 0. 1.\n",
    ]
    check(files(tmp_path, x__lis=apart[0], pq__lis=apart[1]), "left out: 3 lines of sums or extremes")
    four = files(tmp_path, p1__csv=p, q1__csv=text(FIRST[:, [0, 2]], "x,CSHEAR1"), p2__csv=p, q2__csv=q)
    assert check(four).traction.q1 is not None


def test_files_that_do_not_fit_are_refused(tmp_path):
    p, q, few = files(tmp_path, p__csv=text(ROWS[:, :2], "x,p"), q__csv=text(ROWS[:, :2], "x,p"),
                      few__csv=text(ROWS[3:, [0, 2]], "x,q"))  # fmt: skip
    assert "must be a file of p and one of q" in line_of(score, SCENE, [p, q])
    assert "141 and 138 rows: must be at the same x, or have the same nodes" in line_of(score, SCENE, [p, few])
    (whole,) = files(tmp_path, whole__csv=text(ROWS, "x,p,q"))
    assert "3 states: must be 2, one for each load point of the cycle" in line_of(score, SCENE, [whole] * 3)
    assert "no column of shear" in line_of(score, SCENE, [whole, p])


def test_columns_of_a_table_without_heading(tmp_path):
    path = files(tmp_path, t__txt=text(ROWS, "", "  "))[0]
    check(path, "no heading: read as --columns x=1, p=2, q=3", "shear at load point 2")
    for columns in ({"x": "1", "p": "2", "q2": "3"}, {"x": "1", "p": "2", "dq": "3+3"}):
        check(path, columns=columns)
    wide = files(tmp_path, t__txt=text(np.column_stack([NODES, ROWS]), "", "  "))[0]
    assert "or give --columns, for example x=1,p=2,q=3" in line_of(score, SCENE, wide)
    check(wide, columns={"x": "2", "p": "3", "q2": "4"})
    saved = tmp_path / "s.txt"
    np.savetxt(saved, ROWS, header="x p q")  # the heading is a comment
    check(saved)


# --- reports


def report(blocks, names=("COORD.COOR1", "CPRESS", "CSHEAR1"), summary=True):
    """A report of fields at nodes, as Abaqus/Viewer writes it: ``blocks`` of a part, a step, and rows."""
    lines = ["*" * 80, "Field Output Report, written Mon Jan  1 00:00:00 2024", ""]
    for part, step, rows in blocks:
        lines += ["Source 1", "---------", "", "   ODB: C:/temp/job.odb", f"   Step: {step}",
                  "   Frame: Increment     10: Step Time =    1.000", "", "Loc 1 : Nodal values from source 1", "",
                  'Output sorted by column "Node Label".', "",
                  f"Field Output reported at nodes for part: {part}", ""]  # fmt: skip
        lines += ["".join(f"{each:>16}" for each in ("Node", *names)),
                  "".join(f"{each:>16}" for each in ("Label", *["@Loc 1"] * len(names))),
                  "-" * 16 * (len(names) + 1)]  # fmt: skip
        lines += [f"{k + 1:16d}" + "".join(f"{value:16.6g}" for value in row) for k, row in enumerate(rows.tolist())]
        if summary:
            for word, of in (("Minimum", rows.min(0)), ("Maximum", rows.max(0)), ("Total", rows.sum(0))):
                lines += ["", f"  {word:14}" + "".join(f"{value:16.6g}" for value in of)]
                lines += ["        At Node " + "".join(f"{1:16d}" for _ in of)] * (word != "Total")
        lines += ["", ""]
    return "\n".join(lines)


def test_reports_of_fields(tmp_path):
    (path,) = files(tmp_path, r__rpt=report([("FLAT-1", "SHEAR", ROWS)]))
    check(path, "left out: 5 lines of sums or extremes, 10 lines above the heading")


def test_reports_of_several_parts_and_steps(tmp_path):
    nothing = ROWS * [1, 0, 0] + [1e-4, 0, 0]
    (path,) = files(tmp_path, r__rpt=report([("FLAT-1", "SHEAR", ROWS), ("PAD-1", "SHEAR", nothing)]))
    check(path, "left out: rows with part PAD-1, where tractions are zero")
    pad = ROWS * [1, 1, -1] + [1e-4, 0, 0]  # nodes elsewhere: not at equal x
    (path,) = files(tmp_path, r__rpt=report([("FLAT-1", "SHEAR", ROWS), ("PAD-1", "SHEAR", pad)]))
    assert 'part is FLAT-1, PAD-1: must be one: keep one, as by --where "part=PAD-1"' in line_of(score, SCENE, path)
    check(path, where={"part": "flat-1"})
    (path,) = files(tmp_path, r__rpt=report([("FLAT-1", "BACK", FIRST), ("FLAT-1", "SHEAR", ROWS)]))
    assert "step is BACK, SHEAR: must be one" in line_of(score, SCENE, path)
    check(path, where={"step": "SHEAR"})
    assert check(path, where={"step": "BACK,SHEAR"}).traction.q1 is not None


def test_lines_of_a_report_that_are_damaged_are_refused(tmp_path):
    good = report([("FLAT-1", "SHEAR", ROWS)])
    lines = good.splitlines()
    row = next(k for k, line in enumerate(lines) if line.startswith("              50"))
    for new, told in ((lines[row][:40], "must have 4 fields"), ("Maxmum" + lines[row][16:], "'Maxmum"),
                      (lines[row][:-4] + "1x3", "must be a number")):  # fmt: skip
        (path,) = files(tmp_path, r__rpt="\n".join([*lines[:row], new, *lines[row + 1 :]]))
        assert told in line_of(score, SCENE, path)


@pytest.mark.parametrize("pair", ["   ASSEMBLY_FLAT/ASSEMBLY_PAD", " ASSEMBLY_FLAT/ASSEMBLY_PAD"])
def test_names_with_a_pair_of_surfaces(tmp_path, pair):
    (path,) = files(tmp_path, t__csv=text(ROWS, f"X,CPRESS{pair},CSHEAR1{pair}").replace("X,", "x,", 1))
    check(path)
    both = np.column_stack([ROWS, ROWS[:, 1:]])
    (path,) = files(tmp_path, t__csv=text(both, "x,CPRESS   A1/B1,CSHEAR1   A1/B1,CPRESS   C1/D1,CSHEAR1   C1/D1"))
    assert "column 'p': must be there once, not 2 times" in line_of(score, SCENE, path)
    (path,) = files(tmp_path, t__csv=text(ROWS, "x,CPRESS   A1/B1,CSHEAR1   C1/D1"))
    assert "columns of the pairs A1/B1, C1/D1: must be of one" in line_of(score, SCENE, path)


# --- long tables


@pytest.mark.parametrize(
    ("label", "values"), [("surface", ("FLAT", "PAD")), ("case", ("1", "2")), ("pair", ("7", "8"))]
)
def test_long_tables(tmp_path, label, values):
    rows = [
        f"{value},{line}" for value, of in zip(values, (FIRST, ROWS), strict=True) for line in text(of).splitlines()
    ]
    (path,) = files(tmp_path, t__csv="\n".join([f"{label},x,CPRESS,CSHEAR1", *rows]))
    told = f'{label} is {values[0]}, {values[1]}: must be one: keep one, as by --where "{label}={values[1]}"'
    assert told in line_of(score, SCENE, path)
    check(path, where={label: values[1]})
    assert "must be one of" in line_of(score, SCENE, path, where={label: "9"})
    assert "has the columns" in line_of(score, SCENE, path, where={"part": "9"})
    if label == "case":
        assert check(path, where={"case": "1,2"}).traction.q1 is not None


def test_two_lines_of_points_are_not_mixed(tmp_path):
    """At other x, so that no rows are at equal x."""
    other = ROWS * [1, 0.5, 0.5] + [1e-3, 0, 0]
    y = np.repeat([0.0, -10.0], len(ROWS))
    (path,) = files(tmp_path, t__csv=text(np.column_stack([np.vstack([ROWS, other]), y]), "x,p,q,y"))
    assert 'y is 0, -10: keep one, as by --where "y=0"' in line_of(score, SCENE, path)
    check(path, where={"y": "0"})


# --- other columns


def test_normalised_tables(tmp_path):
    a, p0, f = EXACT.a * 1e3, EXACT.p0 / 1e6, 0.3
    for head, scale in (("x/a,p/p0,q/(f p0)", [a, p0, f * p0]), ("x / a,p / p0,dq/(2 f p0)", [a, p0, f * p0]),
                        ("x/a,cpress/p0,q/p0", [a, p0, p0])):  # fmt: skip
        (path,) = files(tmp_path, t__csv=text(ROWS / scale, head))
        check(path, "normalised columns: times the scene's ", "a = 0.2066977 mm, ")


HEADS = ("x/mm,p/MPa,q/MPa", "x_mm,p_MPa,q_MPa", "x in mm,p in MPa,q in MPa", "x mm,p MPa,q MPa",
         "x,p,q\nmm,MPa,MPa", "x (mm),p (N/mm²),q [n/mm^2]")  # fmt: skip


@pytest.mark.parametrize("head", HEADS)
def test_units_of_a_heading(tmp_path, head):
    scene = load_scene("fretting-aluminium", ["load.Q=[-30e3, 30e3]", "load.sigma=[0, 0]"])  # SI
    check(files(tmp_path, t__csv=text(ROWS, head)), scene=scene)


def test_the_way_along_a_path_is_x_where_there_is_no_other(tmp_path):
    rows = text(ROWS + np.array([1, 0, 0]), "True distance along path,CPRESS,CSHEAR1")
    check(files(tmp_path, t__csv=rows), "x = 0 was put in the middle", centre="auto")


def test_names_behind_others_and_points_of_paraview(tmp_path):
    (path,) = files(tmp_path, t__csv=text(np.column_stack([ROWS, 0 * X]), "x,pad_normal_lm,pad_frictional_lm,disp_x"))
    check(path)
    rows = text(np.column_stack([ROWS[:, 1:], X, ROWS[:, 0]]), '"CPRESS","CSHEAR1","arc_length","Points:0"').split("\n")
    rows[1:1] = ["nan,nan,0,-9", "nan,nan,0,-8"]
    (path,) = files(tmp_path, t__csv="\n".join(rows))
    check(path, "left out: 2 rows without values")


@pytest.mark.parametrize("ending", ["vtu", "vtk", "xdmf"])
def test_point_data_by_other_names_and_components(tmp_path, ending):
    points = np.column_stack([ROWS[:, 0], 0 * X, 0 * X])
    cells = [("line", np.column_stack([np.arange(140), np.arange(1, 141)]))]
    path = tmp_path / f"t.{ending}"
    meshio.write(path, meshio.Mesh(points, cells, point_data={"CPRESS": ROWS[:, 1], "CSHEAR1": ROWS[:, 2]}))
    check(path)
    traction = np.column_stack([ROWS[:, 2], -ROWS[:, 1], 0 * X])
    meshio.write(path, meshio.Mesh(points, cells, point_data={"t": traction}))
    assert "'t:0', 't:1', 't:2': must be x; p or Fn" in line_of(score, SCENE, path)
    check(path, columns={"x": "Points:0", "p": "-t:1", "q2": "t:0"})


def test_pressure_alone_where_there_is_no_friction(tmp_path):
    scene = SCENE.replace(friction={"f": 0.0}, load={"Q": [0.0, 0.0]})
    (path,) = files(tmp_path, t__csv=text(ROWS[:, :2], "x,contact_pressure"))
    found = score(scene, path, bar=1e-2)
    assert found.comparisons["t.csv"].p < 1e-5
    assert found.passed
    assert "must be x; p or Fn; and one of" in line_of(score, SCENE, path)
    (path,) = files(tmp_path, t__csv=text(ROWS[:, :2]))
    assert score(scene, path).comparisons["t.csv"].p < 1e-5


def test_pressure_below_zero_is_turned(tmp_path):
    (path,) = files(tmp_path, t__csv=text(ROWS * [1, -1, 1], "x,p,q"))
    check(path, "p is below zero: read as a compressive stress, its sign turned")
    check(path, factors=(1.0, -1.0, 1.0))


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("begins", [70, 71])
def test_half_of_the_contact_is_mirrored_where_both_are_alike(tmp_path, side, begins):
    rows = ROWS[begins:] if begins == 70 else ROWS[70:] + 0
    if begins == 71:  # middles of cells: none at x = 0
        x = (X[70:-1] + X[71:]) / 2
        rows = np.column_stack([x * 1e3, *(each / 1e6 for each in EXACT.traction.at(x)[:2])]) * [1, 1, 0.5]
    (path,) = files(tmp_path, t__csv=text(rows * [side, 1, 1], "x,p,q"))
    result = check(path, "half of the contact: mirrored at x = 0")
    assert len(result.traction.x) > len(rows)
    pulled = SCENE.replace(load={"sigma": [-1e7, 1e7]})
    notes = score(pulled, path)["t.csv"].notes
    assert any("within the contact: give all of it" in note for note in notes)


def test_tables_are_read_once_decoded(tmp_path):
    """A Latin-1 heading; UTF-16 without a mark."""
    path = tmp_path / "t.csv"
    path.write_bytes(text(ROWS * [1e3, 1, 1], "x [µm],p [MPa],q [MPa]").encode("latin-1"))
    check(path, "read as Latin-1")
    path.write_bytes(text(ROWS, "x,p,q").encode("utf-16-le"))
    check(path)
    assert read_tractions(path, SCENE).p == pytest.approx(P, rel=1e-8)


# --- what is no row, and what is none of a column


SUMS = ("Max,0.289,418.104,118.9", "AVERAGE,0.01,93.2,20", '"Mittelwert",0.01,93.2,20', "Rz,1,2,3")


@pytest.mark.parametrize("place", [1, 50, None])
def test_rows_of_sums_are_no_points(tmp_path, place):
    rows = text(np.column_stack([NODES, ROWS]), "Node,x,CPRESS,CSHEAR1").split("\n")
    at = len(rows) if place is None else place
    given = "\n".join([*rows[:at], *SUMS, *rows[at:]])
    check(files(tmp_path, t__csv=given), "left out: 4 lines of sums or extremes")
    semicolons = given.replace(",", ";").replace(".", ",")
    check(files(tmp_path, t__csv=semicolons), "left out: 4 lines of sums or extremes")
    for wrong, told in ((",0.05,26214,5200", "''"), ("Median,0.05,26214,5200", "'Median'")):
        (path,) = files(tmp_path, t__csv="\n".join([*rows[:at], wrong, *rows[at:]]))
        assert f"line {at + 1}: Node = {told}: must be a number" in line_of(score, SCENE, path)


@pytest.mark.parametrize("label", ["Node {}", "mean of faces", "Sum", "N{}"])
def test_rows_may_begin_with_words(tmp_path, label):
    rows = "".join(f"{label.format(k)},{line}\n" for k, line in enumerate(text(ROWS).split()))
    check(files(tmp_path, t__csv=f"label,x,CPRESS,CSHEAR1\n{rows}"))


def test_a_sum_among_rows_that_begin_with_words_is_refused(tmp_path):
    rows = "".join(f"pad,{line}\n" for line in text(ROWS).split())
    (path,) = files(tmp_path, t__csv=f"part,x,CPRESS,CSHEAR1\n{rows}Sum,0.05,26214,5200\n")
    assert "line 143: 'Sum': must not be a sum" in line_of(score, SCENE, path)


@pytest.mark.parametrize("none", ["1.#IND", "-1.#QNAN", "1.#INF00", "#N/A", "#DIV/0!"])
@pytest.mark.parametrize("column", [0, 1, 2])
def test_no_value_is_no_comment(tmp_path, none, column):
    rows = text(ROWS, "x,CPRESS,CSHEAR1").split("\n")
    fields = rows[70].split(",")
    rows[69] += " # bad"
    rows.insert(70, ",".join([*fields[:column], none, *fields[column + 1 :]]))
    check(files(tmp_path, t__csv="\n".join(rows)), "left out: 1 row without values")


def test_a_name_may_have_a_hash(tmp_path):
    rows = text(np.column_stack([NODES, ROWS]), "Node #,x,CPRESS,CSHEAR1")
    check(files(tmp_path, t__csv=rows))
    check(files(tmp_path, t__txt=rows.replace(",", "\t")))


def test_a_column_is_numbered_in_decimals(tmp_path):
    (path,) = files(tmp_path, t__csv=text(ROWS, "x,CPRESS,CSHEAR1"))
    assert "--columns ²: " in line_of(score, SCENE, path, columns={"x": "²", "p": "2", "q2": "3"})


# --- rows of several surfaces or load points


def test_files_of_several_parts_steps_or_pairs_are_not_joined(tmp_path):
    p, q = ("COORD.COOR1", "CPRESS"), ("COORD.COOR1", "CSHEAR1")
    for part, step, told in (("PAD-1", "SHEAR", "p.rpt is of part FLAT-1, "), ("FLAT-1", "BACK", "of step SHEAR, ")):
        pair = files(tmp_path, p__rpt=report([("FLAT-1", "SHEAR", ROWS[:, :2])], p),
                     q__rpt=report([(part, step, ROWS[:, [0, 2]])], q))  # fmt: skip
        assert told in line_of(score, SCENE, pair)
    check(files(tmp_path, p__rpt=report([("FLAT-1", "SHEAR", ROWS[:, :2])], p),
                q__rpt=report([("FLAT-1", "SHEAR", ROWS[:, [0, 2]])], q)))  # fmt: skip
    pair = files(tmp_path, p__csv=text(ROWS[:, :2], "x,CPRESS   A1/B1"), q__csv=text(ROWS[:, ::2], "x,CSHEAR1   C1/D1"))
    assert "is of pair A1/B1, " in line_of(score, SCENE, pair)
    for part in ("FLAT-1", "PAD-1"):
        pair = files(tmp_path, a__rpt=report([("FLAT-1", "BACK", FIRST)]), b__rpt=report([(part, "SHEAR", ROWS)]))
        if part == "FLAT-1":
            check(pair)
        else:
            assert "b.rpt is of part PAD-1, " in line_of(score, SCENE, pair)


OTHER = ROWS * [1, 1, -1] + [1.3e-3, 0, 0]


@pytest.mark.parametrize("name", ["Part Instance Name", "Time [s]", "substep", "t", "vtkCompositeIndex"])
def test_a_column_of_any_name_tells_passes_apart(tmp_path, name):
    rows = np.column_stack([np.repeat([1.0, 2.0], len(ROWS)), np.vstack([OTHER, ROWS])])
    (path,) = files(tmp_path, t__csv=text(rows, f"{name},x,CPRESS,CSHEAR1"))
    assert f'{name} is 1, 2: keep one, as by --where "{name}=' in line_of(score, SCENE, path)
    check(path, where={name: "2"})


@pytest.mark.parametrize("way", ["again", "back", "in turn"])
def test_passes_without_a_column_are_refused(tmp_path, way):
    both = np.vstack([ROWS, OTHER[::-1] if way == "back" else OTHER])
    rows = both[np.argsort(both[:, 0], kind="stable")] if way == "in turn" else both
    (path,) = files(tmp_path, t__csv=text(rows, "x,CPRESS,CSHEAR1"))
    assert "rows are of 2 passes over the contact, which differ by" in line_of(score, SCENE, path)


def test_corners_and_then_middles_are_one_pass(tmp_path):
    """As meshes of quadratic elements number their nodes; and pairs left and right."""
    check(files(tmp_path, t__csv=text(np.vstack([ROWS[::2], ROWS[1::2]]), "x,CPRESS,CSHEAR1")))
    pairs = np.column_stack([np.abs(X), ROWS])[np.argsort(np.abs(X), kind="stable")]
    check(files(tmp_path, t__csv=text(pairs, "radius,x,CPRESS,CSHEAR1")))


# --- marks of thousands, and headings that are not known


def test_thousands_are_not_separated(tmp_path):
    kilo = np.column_stack([ROWS[:, 0] * 1e3, ROWS[:, 1:] * 1e3]).round()
    grouped = [[f"{value:,.0f}" for value in row] for row in kilo.tolist()]
    head = ("x [um]", "p [kPa]", "q [kPa]")
    dots = [[f"{x:.6f}".replace(".", ","), *(each.replace(",", ".") for each in row[1:])]
            for x, row in zip(ROWS[:, 0].tolist(), grouped, strict=True)]  # fmt: skip
    for rows, separator in ((grouped, "\t"), ([[f'"{each}"' for each in row] for row in grouped], ","), (dots, ";")):
        given = "\n".join(map(separator.join, [head, *rows]))
        (path,) = files(tmp_path, t__txt=given)
        assert "thousands separators?" in line_of(score, SCENE, path)
    body = "\n".join("\t".join(f"{value:.3f}" for value in row) for row in ROWS.tolist())
    read = read_tractions(files(tmp_path, t__txt="\t".join(("x", "p", "q")) + f"\n{body}")[0], SCENE)
    assert read.p == pytest.approx(P, abs=1e3)  # three digits behind the decimal mark


HEADINGS = (
    "# x q p\n# -------",
    "# columns: x q p",
    'VARIABLES = "X" "CSHEAR1" "CPRESS"\nZONE',
    "x,q,p",
    "X shear p\nbegin data",
)


@pytest.mark.parametrize("heading", HEADINGS)
def test_a_heading_that_is_not_known_is_refused(tmp_path, heading):
    (path,) = files(tmp_path, t__txt=text(ROWS[:, [0, 2, 1]], heading, ";"))
    assert "line 1 seems to be a heading: must name each column, or give --columns" in line_of(score, SCENE, path)
    check(path, columns={"x": "1", "q2": "2", "p": "3"})


def test_a_comment_with_commas_is_a_heading(tmp_path):
    check(files(tmp_path, t__txt=text(ROWS[:, [0, 2, 1]], "# x,q,p", "\t")))


# --- units and names that are of something else


@pytest.mark.parametrize("head", ["x [mm],p [N/mm],q [MPa]", "x [MPa],p,q", "x,p,q [mm]", "x,p,q\nmm,MPa,mm"])
def test_units_of_another_dimension_are_refused(tmp_path, head):
    (path,) = files(tmp_path, t__csv=text(ROWS, head))
    assert "must be in a unit of " in line_of(score, SCENE, path)


def test_a_unit_that_is_not_known_is_told(tmp_path):
    (path,) = files(tmp_path, t__csv=text(ROWS * [1, 10, 10], "x [mm],p [bar],q [bar]"))
    assert "must be x; p or Fn" in line_of(score, SCENE, path)
    columns = {"x": "x", "p": "p [bar]", "q2": "q [bar]"}
    check(path, "unit bar of p is not known: read in MPa", columns=columns, factors=(1.0, 0.1, 0.1))


def test_the_largest_shear_stress_is_no_shear_traction(tmp_path):
    (path,) = files(tmp_path, t__csv=text(ROWS, "x,contact_pressure,max_shear_stress"))
    assert "must be x; p or Fn" in line_of(score, SCENE, path)
