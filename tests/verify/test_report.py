"""The report of a verification: every verdict can be traced, and the data of every figure are in files."""

import csv
import functools
import html
import json
import re
from dataclasses import replace

import numpy as np
import pytest

import partialslip
from partialslip.run import run
from partialslip.verify import REQUIREMENTS, case, driver
from partialslip.verify.driver import verify_suite
from partialslip.verify.entry import TitleBlock
from partialslip.verify.ladder import convergence

CASES = ["no-shear", "one-contact-node"]
SVG = '<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg"><title>picture of costs</title></svg>'


BLOCK = TitleBlock(project="Rig <7>", reviewer="R. Reviewer")


def verified(folder, **settings):
    return verify_suite("full", CASES, processes=1, out=folder, block=BLOCK, ladder=True, **settings)


@pytest.fixture(scope="module", autouse=True)
def _climbed():
    """Ladders are made by hand: tests/verify/test_ladder.py is about them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(driver, "climb", lambda *_: (convergence("m", [0.064, 0.032, 0.016, 0.008], 0.004),))
        yield


@functools.cache
def solved(scene, methods):
    return run(scene, methods)


@pytest.fixture(scope="module", autouse=True)
def _solved_once():
    """Cases are solved once: what is tested is what is told of them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(case, "run", lambda scene, methods: solved(scene, tuple(methods)))
        yield


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A verification of two cases with a study."""
    folder = tmp_path_factory.mktemp("verified")
    (folder / "study").mkdir()
    (folder / "study" / "cost.svg").write_text(SVG, "utf-8")
    (folder / "study" / "cost.csv").write_text("setting,m\n", "utf-8")
    verified(folder, include=[folder / "study"], pdf=True)
    return folder


def page(folder):
    return (folder / "report.html").read_text("utf-8")


def words(text):
    """Return the text of each row of each table."""
    rows = re.findall(r"<tr>(.*?)</tr>", text, re.DOTALL)
    return [
        [html.unescape(re.sub("<[^>]*>", "", cell)) for cell in re.findall(r"<t[dh].*?</t[dh]>", row, re.DOTALL)]
        for row in rows
    ]


def section(text, name):
    return re.search(rf'<section class="scene" id="{name}">.*?</section>', text, re.DOTALL)[0]


def test_every_verdict_is_there_with_its_requirement_and_bar(folder):
    with (folder / "results.csv").open(newline="") as table:
        verdicts = list(csv.DictReader(table))
    assert {verdict["requirement"].partition(":")[0] for verdict in verdicts} == {f"R{n}" for n in range(1, 11)}
    for name in CASES:
        shown = {tuple(row[:2]): row for row in words(section(page(folder), name))}
        for verdict in (one for one in verdicts if one["case"] == name):
            number = verdict["requirement"].partition(":")[0]
            row = shown[number, f"{verdict['method']}.{verdict['quantity']}"]
            if float(verdict["error"] or 0):
                assert f"{float(verdict['error']):.1e}" in row
            assert not verdict["bar"] or f"{float(verdict['bar']):.1e}" in row or verdict["bar"] == "0.0"
            assert verdict["reason"] in html.unescape(page(folder))
    assert all(required in html.unescape(page(folder)) for required in REQUIREMENTS.values())


def test_what_repeats_a_case_and_the_data_of_its_figure_are_named(folder):
    for name in CASES:
        own = section(page(folder), name)
        assert f"<code>partialslip verify --suite full --only {name} --ladder</code>" in own
        for file in ("scene.toml", "tractions.csv"):
            assert f"scenes/{name}/{file}" in own
            assert (folder / "scenes" / name / file).exists()
    assert "picture of costs" in page(folder)
    assert str(folder / "study" / "cost.csv") in page(folder)


def test_a_filed_scene_gives_the_filed_tractions(folder):
    scene = partialslip.load_scene(folder / "scenes" / "no-shear" / "scene.toml")
    exact = run(scene, ["exact"]).results["exact"]
    with (folder / "scenes" / "no-shear" / "tractions.csv").open(newline="") as table:
        dq = [float(row["dq"]) for row in csv.DictReader(table) if row["method"] == "exact"]
    np.testing.assert_array_equal(exact.traction.dq, dq)


def test_it_needs_nothing_but_itself(folder):
    text = page(folder)
    assert not re.search(r"<(script|link|img|iframe)\b|@import|url\((?!#)", text)
    assert re.findall(r'(?:src|href)="(?!#|http://www.w3.org/)([^"]*)"', text) == []
    assert (folder / "report.pdf").read_bytes().startswith(b"%PDF-")


def test_where_it_was_found_is_told(folder):
    made = json.loads((folder / "ledger.jsonl").read_text("utf-8").splitlines()[0])["made"]
    assert "<h1>Verification of partialslip, suite full, in part</h1>" in page(folder)
    table = dict(row for row in words(page(folder)) if len(row) == 2)
    assert table["command"] == "partialslip verify --suite full --only no-shear --only one-contact-node --ladder"
    assert table["project"] == "Rig <7>"
    assert table["reviewer"] == "R. Reviewer"
    assert "author" not in table
    assert made["machine"]["processor"] in table["machine"]
    assert all(number in table["version"] for number in made["versions"].values())
    assert made["date"][:10] in table["date"]


def test_estimates_stand_against_true_errors(folder):
    text = page(folder)
    rows = words(text[text.index("<h2>Estimates against true errors") :])
    shown = next(row for row in rows if row[1] == "fem.a")
    found = json.loads((folder / "results.json").read_text("utf-8"))["cases"]["no-shear"]
    verdict = next(each for each in found if (each["method"], each["quantity"]) == ("fem", "a"))
    assert float(shown[4]) == pytest.approx(verdict["error"] / verdict["estimate"], abs=0.005)
    assert shown[5] == str(int(verdict["error"] > verdict["estimate"]))


def test_a_ladder_has_orders_and_indices(folder):
    own = section(page(folder), "no-shear")
    row = next(row for row in words(own[own.index("<h3>Refinement ladder") :]) if row[1] == "m")
    assert row == ["R6", "m", "6.4e-02", "3.2e-02", "1.6e-02", "8.0e-03", "1.00", "1.0e-02", "4.0e-03", "40 %"]
    assert "<h3>Refinement ladder" not in section(page(folder), "one-contact-node")  # on a given mesh


def test_each_case_has_a_sketch_formulas_and_references(folder):
    own = html.unescape(section(page(folder), "no-shear"))
    assert "half-plane" in own
    cited = set(re.findall(r"\[(\d)(?:, (\d))?\]", own[own.index("<h3>Formulas") : own.index("</ul>")]))
    assert cited
    references = html.unescape(page(folder)).split("<h2>References</h2>")[1]
    assert all(f"[{number}]" in references for pair in cited for number in pair if number)
    assert (folder / "scenes" / "no-shear" / "sketch.svg").exists()


def test_a_missed_bar_cannot_be_overlooked(tmp_path, monkeypatch):
    """Deliberate fault: solvers that stop at a residual of 1e-3 f p0. The missed bar
    is in the heading, first in the table, and at the scene."""

    solve = case._result_or_failure

    def stopped_early(one, method):
        return replace(solve(one, method), certificate={"kkt": 1e-3})

    monkeypatch.setattr(case, "_result_or_failure", stopped_early)
    verified(tmp_path)
    text = page(tmp_path)
    assert re.search(r'<div class="verdict">[1-9]\d* of \d+ verdicts missed</div>', text)
    nearest = text[text.index("Nearest to their bars") :]
    assert words(nearest)[1][1] == "R3"
    assert words(nearest)[1][-1] == "MISSED"
    assert "MISSED" in section(text, "one-contact-node")
    assert "again with <code>partialslip verify --suite full --only one-contact-node --ladder</code>" in text


def test_stopped_and_continued_it_is_the_same(folder, tmp_path, monkeypatch):
    """Ctrl-C in the second case: the first case is not solved again, and is fully reported."""
    begun = []

    def stopped(scene, methods):
        if scene.name == CASES[1]:
            raise KeyboardInterrupt
        begun.append(scene.name)
        return solved(scene, tuple(methods))

    with monkeypatch.context() as patch:
        patch.setattr(case, "run", stopped)
        with pytest.raises(KeyboardInterrupt):
            verified(tmp_path)
    assert set(begun) == {CASES[0]}
    assert list(json.loads((tmp_path / "results.json").read_text("utf-8"))["cases"]) == [CASES[0]]
    assert not (tmp_path / "report.html").exists()
    known = []
    verified(tmp_path, progress=lambda done, *_: known.append(done))
    assert known == [1, 2]

    def lasting(text):
        times = r"<td>[^<]*CPU s[^<]*</td>|<td[^>]*>[\d.]+</td>|<td>[^<]*UTC</td>"
        return re.sub(times, "", text)

    assert [section(lasting(page(tmp_path)), name) for name in CASES] == [
        section(lasting(page(folder)), name) for name in CASES
    ]


@pytest.mark.slow
def test_random_scenes_are_summed_up(tmp_path):
    verified = verify_suite("stress", method="exact", seed=5, count=10, processes=1, out=tmp_path)
    text = page(tmp_path)
    assert '<section class="scene" id=' not in text  # no scene has a section of its own
    assert not (tmp_path / "scenes").exists()
    by_kind = [row for row in words(text[text.index("<h2>Certificates") :]) if len(row) == 5][1:]
    found = [v.error for some in verified.verdicts.values() for v in some if v.quantity == "certificate"]
    assert len(found) >= 7
    assert sum(int(row[1]) for row in by_kind) == len(found)
    assert max(float(row[3]) for row in by_kind if row[3]) == pytest.approx(max(found), rel=0.05)


@pytest.mark.parametrize("content", [None, "no picture"])
def test_what_is_no_study_is_refused(content, tmp_path, refused):
    (tmp_path / "study").mkdir()
    if content:
        (tmp_path / "study" / "cost.svg").write_text(content, "utf-8")
    said = refused("verify", "--include", str(tmp_path / "study"), "--out", str(tmp_path / "none"))
    assert said == f"partialslip: --include {tmp_path / 'study'}: must be the folder of a study, with figures (.svg)\n"
    assert not (tmp_path / "none").exists()
