"""Reports that one can file: origin, verdict, units, sketch, errors along the contact, mesh; dark screens."""

import json
import re
import sys
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from known import EXACT, P0, SCENE, A, result, traction
from matplotlib.figure import Figure

import partialslip
from partialslip.cli import main
from partialslip.report import files
from partialslip.report.answer import amounts
from partialslip.report.figure import draw_errors, mesh_svg
from partialslip.report.page import Section, run_page, study_page
from partialslip.report.sketch import sketch_svg
from partialslip.run import compared
from partialslip.scene.plan import plan
from partialslip.study import cost
from partialslip.tools.origin import made_now, origin_lines
from partialslip.tools.output.svg import with_dark_mode

MADE = made_now("partialslip run hertz-shear --set 'friction.f=0.4'", ["friction.f=0.4"])
EDGES = np.array([[[-1.2, 0], [0, -0.8]], [[0, -0.8], [1.2, 0]]]) * A


def page_of(*results):
    return run_page(compared(SCENE, plan(SCENE), {each.method: each for each in results}, 1e-3), MADE)


def words(svg):
    return [text for node in ElementTree.fromstring(svg).iter() if node.tag.endswith("}text") and (text := node.text)]


@pytest.fixture(scope="module")
def page():
    return page_of(EXACT, replace(result(), edges=(EDGES, EDGES * (1, -1))))


def test_the_origin_is_on_the_page(page):
    lines = dict(origin_lines([MADE]))
    assert lines.keys() == {"date", "command", "overrides", "version", "commit", "machine"}
    assert MADE.date[:10] in lines["date"]
    assert partialslip.__version__ in lines["version"]
    text = page[page.index("<h2>How it was run</h2>") :].replace("&#39;", "'")
    for line in lines.values():
        assert line in text


def test_what_was_asked_is_told_before_how_it_was_run(page):
    """After the answer; after the errors of another code, where these are scored."""
    study = study_page("study of it", SCENE, MADE, [Section("Answer", ["yes"]), Section("Details", ["many"])])
    run = compared(SCENE, plan(SCENE), {"exact": EXACT, "mine.csv": replace(result(a=1.1), method="mine.csv")}, 1e-3)
    told = {
        page: ["exact: small tension", "Scene", "Tractions", "Errors of fem", "Methods and costs", "How it was run"],
        run_page(run, MADE): ["Errors of mine.csv", "Scene", "exact: small tension", "Tractions", "How it was run"],
        study: ["Answer", "Scene", "Details", "How it was run"],
    }
    for each, titles in told.items():
        found = re.findall("<h2>(.*?)</h2>", each)
        assert [title for title in found if title in titles] == titles


def test_the_verdict_has_a_box_with_one_method_too(page):
    assert '<div class="verdict">all bars met: within 0.1 % of a, 1 % of p, 1.5 % of q</div>' in page
    assert '<div class="verdict">no bars: nothing to compare with</div>' in page_of(EXACT)
    missed = page_of(EXACT, result(a=1.1))
    assert re.search(r'<div class="verdict">missed: fem: a: error 0.1 ', missed)


def test_values_have_units(page):
    headings, rows = amounts({"exact": EXACT})
    assert headings == ["quantity", "unit", "exact"]
    found = {quantity: (unit, float(value)) for quantity, unit, value in rows}
    assert found["m, stick from -m"] == ("mm", pytest.approx(EXACT.m * 1e3, rel=1e-6))
    assert found["p_max, largest p"] == ("MPa", pytest.approx(P0 / 1e6, rel=1e-6))
    assert "<td>7.28e+10 Pa</td>" in page
    assert re.search(r"<td>[\d.e+]+ N/m</td>", page)


def test_nothing_sticks_and_nothing_slips():
    sliding = replace(EXACT, stick_centre=None, stick_half_width=None, traction=traction(q=0.0))
    rows = {row[0]: row[2] for row in amounts({"exact": sliding})[1]}
    assert rows["m, stick from -m"] == "none"
    assert "q = (q2 - q1)/2, largest" not in rows


def test_errors_along_the_contact_are_those_of_the_methods():
    """A pressure 1e-4 too large, and a shear off by 1e-6 f p0, are invisible in the figure of the tractions."""
    fem = result(of=traction(p=1 + 1e-4, add=lambda x: 2e-6 + 0 * x))
    run = compared(SCENE, plan(SCENE), {"exact": EXACT, "fem": fem}, None)
    axes = Figure().subplots()
    draw_errors(axes, run)
    drawn = {line.get_label(): line.get_xydata() for line in axes.get_lines()}
    x, p = drawn["p, fem"].T
    inner = np.abs(x) < 0.99
    np.testing.assert_allclose(p[inner], 1e-4 * np.sqrt(1 - x[inner] ** 2), rtol=1e-6)
    np.testing.assert_allclose(drawn["q, fem"][:, 1], 1e-6, rtol=1e-6)
    assert axes.get_yscale() == "log"


def test_the_mesh_is_drawn_where_there_is_one(page):
    assert "<h2>Mesh near the contact</h2>" in page
    assert "<h2>Mesh near the contact</h2>" not in page_of(EXACT, result())
    run = compared(SCENE, plan(SCENE), {"fem": replace(result(), edges=(EDGES, EDGES))}, None)
    assert len(ElementTree.fromstring(mesh_svg(run)).findall(".//*")) < 300


def test_edges_of_finite_elements_are_few_and_near():
    scene = partialslip.load_scene("hertz-shear", ["fem.size=0.25", "fem.order=1"])
    fem = partialslip.run(scene, ["fem"]).results["fem"]
    lower, upper = fem.edges
    assert 20 < len(lower) < 5000
    np.testing.assert_array_equal(upper, lower * np.array([1, -1], np.float32))
    assert (lower[..., 1] <= 0).all()
    assert (np.abs(lower[..., 0]).min(axis=1) < 1.5 * fem.a).mean() > 0.9
    assert np.hypot(*(lower[:, 1] - lower[:, 0]).T).min() > 0.009 * fem.a
    assert (lower[..., 1] == 0).all(axis=1).sum() >= 8  # contact edges


def test_everything_wide_scrolls_within_the_page(page):
    tables = re.findall(r'(.{20})<table class="(?!grouped)|(.{20})<table>', page, re.DOTALL)
    assert tables
    assert all('<div class="scroll">' in first + second for first, second in tables)
    assert not re.search(r"<(script|link|img|iframe)\b|@import|url\((?!#)", page)


def test_stresses_and_shear_are_drawn_where_stresses_are_asked_for():
    """Together with q1 and q2; a contact without friction has no shear to draw."""
    plain = partialslip.run(SCENE, ["exact"])
    asked = partialslip.run(SCENE, ["exact"], subsurface=True)
    smooth = partialslip.run(SCENE.replace({"friction.f": 0.0, "load.Q": [0, 0]}), ["exact"], subsurface=True)
    drawn = {name: run_page(run, MADE) for name, run in {"plain": plain, "asked": asked, "smooth": smooth}.items()}
    assert {name: "<h2>At load points 1 and 2</h2>" in page for name, page in drawn.items()} == {
        "plain": False, "asked": True, "smooth": True,
    }  # fmt: skip
    assert "q1, exact" in drawn["asked"]
    assert "sigma_xx, load point 2" in drawn["asked"]
    assert "q1, exact" not in drawn["smooth"]


def test_a_study_of_cost_writes_its_page(tmp_path, monkeypatch):
    def point(series, error, cpu_s, **counts):
        errors = dict.fromkeys("amnpq", error)
        return cost.CostPoint(
            series, f"{error:g}", errors, cpu_s, cpu_s + 1, 0.1, cpu_s, 100.0, {"mesh": cpu_s}, counts
        )

    found = [point("exact", 1e-15, 0.1)]
    found += [point("P4, adapted", 10.0**-k, float(k), dofs=1000 * k) for k in (2, 3, 4)]
    monkeypatch.setattr(cost, "measure_costs", lambda *_: cost.MeasuredCosts(found, []))
    assert main(["study", "cost", "hertz-shear", "--set", "friction.f=0.4", "--out", str(tmp_path)]) == 0
    page = (tmp_path / "report.html").read_text("utf-8")
    assert page.count("<svg") == 3  # costs, phases, sketch
    assert "<td>friction.f=0.4</td>" in page
    assert '<td class="number">1.0e-04</td>' in page
    ids = re.findall(r'\bid="([^"]+)"', page)
    assert len(ids) == len(set(ids))


# sketches
FINITE = [
    "bodies.upper={kind='pad',width=12e-3,height=5e-3,holder={width=20e-3,height=8e-3}}",
    "bodies.lower={width=80e-3,height=10e-3,support='roller',pulled=true}",
]


def test_a_sketch_names_bodies_and_loads():
    texts = words(sketch_svg(partialslip.load_scene("fretting-aluminium", FINITE)))
    for text in ("P = 135.8 kN/m", "Q = -38.75, 38.75 kN/m", "σ = -100, 100 MPa", "12 mm × 5 mm", "80 mm × 10 mm",
                 "holder 20 mm × 8 mm", "hertz, R = 10 mm, f = 0.3"):  # fmt: skip
        assert text in texts
    texts = words(sketch_svg(partialslip.load_scene("hertz-shear", ["load.sigma=[0,0]"])))
    assert texts.count("half-plane") == 2
    assert not any("σ" in text for text in texts)


def arrows_and_rollers(settings):
    svg = sketch_svg(partialslip.load_scene("fretting-aluminium", settings)).split("</style>")[1]
    return svg.count('fill="#000000"'), svg.count("<circle")


def test_a_sketch_shows_supports_and_the_pulled_side():
    """The arrows are those of P, Q, x and sigma: on the right only if the body is pulled. Rollers roll."""
    pulled, rolling = arrows_and_rollers(FINITE)
    both, still_rolling = arrows_and_rollers([FINITE[0], FINITE[1].replace("true", "false")])
    clamped, none = arrows_and_rollers([FINITE[0], "bodies.lower={width=80e-3,height=10e-3}"])
    assert (pulled, both, clamped) == (5, 7, 7)
    assert rolling < still_rolling  # a pulled side has no support
    assert none == 0


def test_a_sketch_of_a_given_mesh_needs_no_file():
    svg = sketch_svg(partialslip.load_scene("fretting-aluminium", ["bodies.lower={mesh='no/such/file<1>.msh'}"]))
    assert any(text.endswith("file<1>.msh") for text in words(svg))


# dark screens
def test_every_shade_has_one_for_dark_screens():
    svg = with_dark_mode('<svg xmlns="x"><path style="fill: none; stroke: #000000"/><path fill="#e0e0e0"/></svg>')
    assert svg.count("@media screen and (prefers-color-scheme: dark)") == 1
    assert 'style="fill: none; stroke: #000000"' in svg  # as it was, for print and for other programs
    dark = {
        shade: int(new[:2], 16) for shade, new in re.findall(r'\[stroke="#(\w{2})\w{4}"\] \{ stroke: #(\w{6})', svg)
    }
    assert dark["00"] > 0xC0
    assert dark["e0"] < 0x40


@pytest.mark.fault
def test_a_figure_of_a_report_has_no_shade_without_its_dark_one(page):
    """Deliberate fault: a shade that has no rule for dark screens."""

    def without_rule(text):
        drawn = re.sub(r"<style>.*?</style>", "", text, flags=re.DOTALL)
        shades = set(re.findall(r'(?:fill|stroke)(?:: |=")(#[0-9a-f]{6})', drawn))
        return {shade for shade in shades if f'[fill="{shade}"]' not in text}

    svg = re.search(r'<figure class="narrow">(.*?)</figure>', page, re.DOTALL)[1]
    assert without_rule(svg) == set()
    assert without_rule(svg.replace("stroke: #000000", "stroke: #0000ff")) == {"#0000ff"}


# command line
def test_results_tell_the_command_and_the_overrides(tmp_path):
    arguments = ["run", "hertz-shear", "--with", "exact", "--set", "friction.f=0.45", "--out", str(tmp_path / "it")]
    assert main(arguments) == 0
    made = json.loads((tmp_path / "it" / "results.json").read_text("utf-8"))["made"]
    assert made["command"] == f"partialslip {' '.join(arguments)}"
    assert made["overrides"] == ["friction.f=0.45"]
    assert made["date"].endswith("+00:00")
    assert made["command"] in (tmp_path / "it" / "report.html").read_text("utf-8")


def test_a_pdf_is_written_on_request(tmp_path, monkeypatch):
    """The page itself is turned into the PDF; tests of the verification write a true one."""
    written = []
    monkeypatch.setattr(files, "write_pdf", lambda html, folder, name: written.append(html) or [folder / name])
    assert main(["run", "hertz-shear", "--with", "exact", "--pdf", "--out", str(tmp_path)]) == 0
    assert written == [(tmp_path / "report.html").read_text("utf-8")]


@pytest.mark.parametrize(
    "command",
    ["run hertz-shear", "score hertz-shear none.csv", "study cost hertz-shear", "study effects hertz-shear",
     "study size hertz-shear --over friction.f=0.1,0.2", "verify"],
)  # fmt: skip
def test_a_missing_library_is_named_before_anything_is_solved(command, tmp_path, monkeypatch, refused):
    monkeypatch.setitem(sys.modules, "weasyprint", None)
    said = refused(*command.split(), "--pdf", "--out", str(tmp_path / "none"))
    assert said == "partialslip: --pdf needs WeasyPrint: pip install 'partialslip[pdf]'\n"
    assert not (tmp_path / "none").exists()


def test_a_command_with_bytes_that_are_no_text_is_written(tmp_path):
    folder = tmp_path / "no\udcfftext"
    assert main(["run", "hertz-shear", "--with", "exact", "--out", str(folder)]) == 0
    made = json.loads((folder / "results.json").read_text("utf-8"))["made"]
    assert "no?text" in made["command"]


def test_q_of_the_sketch_pushes_the_upper_body_along_minus_x():
    """Q is the resultant of q on the upper body, which acts along +x; the force from outside balances it."""
    svg = sketch_svg(partialslip.load_scene("hertz-shear"))
    heads = [
        np.array([corner.split(",") for corner in found.split()], float)  # the tip is the first corner
        for found in re.findall(r'<polygon points="([^"]+)" fill="#000000"', svg)
    ]
    (along,) = (head for head in heads if head[0, 1] == head[:, 1].mean() and head[0, 1] < 100)  # above the bodies
    assert along[0, 0] < along[1:, 0].min()
