"""Notebook display of scenes, results, comparisons and runs: tables, plots, data frames."""

import csv

import matplotlib
import numpy as np
import pytest
from outline import Outline

import partialslip
from partialslip import InputError
from partialslip.report import answer, rows
from partialslip.report.files import tractions_csv

matplotlib.use("Agg")


@pytest.fixture(scope="module")
def run():
    return partialslip.run(partialslip.load_scene("hertz-large-tension", ["fem.accuracy=1e-2"]))


def test_scene():
    title = "<b>P & Q</b>"
    cells = Outline(partialslip.load_scene("hertz-shear", [f'title="{title}"'])._repr_html_())
    assert f"hertz-shear: {title}" in "".join(cells.text)
    assert ["material", "E", "7.28e+10 Pa"] in cells.rows
    assert ["friction", "f", "0.5"] in cells.rows


@pytest.mark.parametrize("name", ["exact", "fem"])
def test_result(run, name):
    result = run.results[name]
    shown = {row[-2]: row[-1] for row in Outline(result._repr_html_()).rows}
    assert shown == rows.facts(result)
    assert shown["regime"] == "large tension"
    assert f"n = {result.n / result.a:.7f} a" in shown["found"]


def test_comparison_and_run(run):
    comparison = run.comparisons["fem"]
    alone, whole = Outline(comparison._repr_html_()).rows, Outline(run._repr_html_())
    first = [["", *line] for line in answer.answers(run)]
    assert alone[1:] == [list(row) for row in rows.error_rows(comparison)]
    labels = [row[0] for row in alone[1:]]
    assert labels[:3] == ["a, half-width", "m, stick zone", "n, stick zone"]
    assert {"P, sum of p", "p, pressure", "dQ, sum of dq", "q, shear"} <= set(labels)
    assert [row[-2:] for row in whole.rows[: len(first)]] == [row[-2:] for row in first]
    assert whole.rows[len(first) + 1 : len(first) + len(alone)] == alone[1:]
    estimate = run.results["fem"].estimate["a"]
    assert alone[1][4:] == [f"{comparison.a:.1e}", f"{estimate:.1e}", "1.0e-02", "ok"]
    assert alone[1][2] == "1.0000000"
    assert "hertz-large-tension: all bars met" in "".join(whole.text)


def test_a_missed_bar_is_marked(run):
    strict = partialslip.compare(run.results["fem"], run.results["exact"], run.scene, 1e-12)
    text = strict._repr_html_()
    missed = {each.quantity for each in strict.verdicts if each.outcome is partialslip.Outcome.MISSED}
    assert {"a", "m", "n", "p", "q"} <= missed
    assert [row[-1] for row in Outline(text).rows[1:]].count("MISSED") == len(missed) == len(strict.missed)
    assert strict.missed[0] in "".join(Outline(text).text)
    assert text.count('class="missed"') == 2 * len(missed)


def test_plot_of_a_run(run):
    axes = run.plot()
    assert isinstance(axes, matplotlib.axes.Axes)
    assert axes.get_xlabel() == "x/a"
    lines = {line.get_label(): line.get_xydata() for line in axes.lines}
    exact = run.results["exact"]
    np.testing.assert_allclose(lines["q/(f p0), exact"][:, 1], exact.traction.dq / 2 / (0.5 * exact.p0), atol=1e-15)
    assert {"p/p0, exact", "p/p0, fem", "q/(f p0), fem"} < lines.keys()
    matplotlib.pyplot.close(axes.figure)


def test_plot_of_a_result_on_axes_of_ones_own(run):
    figure = matplotlib.figure.Figure()
    mine = figure.subplots()
    fem = run.results["fem"]
    assert fem.plot(mine) is mine
    lines = {line.get_label(): line.get_xydata() for line in mine.lines}
    x, q = lines["q/p0, fem"].T
    np.testing.assert_allclose(q * fem.p0, fem.traction.at(x * fem.a).dq / 2, atol=1e-9 * fem.p0)
    (zone,) = (patch for patch in mine.patches if patch.get_label().startswith("stick"))
    assert (zone.get_x(), zone.get_x() + zone.get_width()) == pytest.approx((-fem.m / fem.a, fem.n / fem.a))


@pytest.mark.parametrize(("in_units", "across", "up"), [(False, "x/a", "q/(f p0)"), (True, "x in mm", "q in MPa")])
def test_plot_of_shear_at_the_load_points(run, in_units, across, up):
    axes = run.plot(what="shear", in_units=in_units)
    assert (axes.get_xlabel(), axes.get_ylabel()) == (across, up)
    exact = run.results["exact"]
    a, unit = (1e-3, 1e6) if in_units else (exact.a, 0.5 * exact.p0)
    lines = {line.get_label(): line.get_xydata() for line in axes.lines}
    x, q = lines["q2, exact"].T
    np.testing.assert_allclose(q * unit, exact.traction.at(x * a).q2, atol=1e-9 * exact.p0)
    assert {"q1, exact", "q1, fem", "q2, fem", "bounds f p"} < lines.keys()
    matplotlib.pyplot.close(axes.figure)


def test_plot_of_stresses():
    found = partialslip.run("hertz-shear", "exact", subsurface=True)
    axes = found.plot(what="stress", in_units=True)
    largest = max(np.max(line.get_ydata()) for line in axes.lines)
    assert largest * 1e6 == pytest.approx(found["exact"].surface.largest[1], rel=1e-12)
    matplotlib.pyplot.close(axes.figure)


@pytest.mark.parametrize(
    ("what", "in_units", "told"),
    [("pressure", False, "must be one of"), ("stress", False, "no result of this run"), ("tractions", True, "share")],
)
def test_what_cannot_be_plotted_is_one_line(run, what, in_units, told):
    with pytest.raises(InputError, match=told):
        run.plot(matplotlib.figure.Figure().subplots(), what, in_units)


def test_data_frames(run):
    exact = run.results["exact"].to_dataframe()
    assert list(exact) == ["x", "x_over_a", "p", "q1", "q2", "dq"]
    np.testing.assert_array_equal(exact["q2"] - exact["q1"], exact["dq"])
    whole = run.to_dataframe()
    table = list(csv.DictReader(tractions_csv(run).splitlines()))
    assert list(whole) == list(table[0])
    assert whole["method"].tolist() == [row["method"] for row in table]
    for key in exact:
        assert whole[key].tolist() == [float(row[key]) for row in table]
