"""Finite bodies beside half-planes: it is half-planes that are off; whose units and stick zones are shown."""

import re
from dataclasses import replace

import numpy as np
import pytest
from known import EXACT, SCENE, A, C, F, P, result
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from partialslip import load_scene
from partialslip.report import rows
from partialslip.report.figure import draw_errors, draw_run
from partialslip.report.page import run_page
from partialslip.run import compared
from partialslip.scene.plan import plan
from partialslip.tools.origin import made_now

BLOCK = load_scene(
    "hertz-shear",
    [f"load={{P={P}, Q=[{-C * F * P}, {C * F * P}]}}", f"friction.f={F}", "bodies.lower={width=0.02, height=0.01}"],
)
FEM = result(a=0.98, half_width=0.5)


def ran(scene=BLOCK, **others):
    return compared(scene, plan(scene), {"exact": EXACT, "fem": FEM} | others, None)


def shaded(run):
    """Ends of the shaded zone, x/a."""
    axes = Figure().subplots()
    draw_run(axes, run)
    (zone,) = (patch for patch in axes.patches if isinstance(patch, Rectangle))
    return zone.get_x(), zone.get_x() + zone.get_width()


def test_the_table_of_finite_bodies_blames_half_planes():
    run = ran()
    assert rows.error_headings(run, "fem")[2:5] == ["half-planes", "fem", "difference"]
    page = run_page(run, made_now())
    assert "What half-planes are off by, beside fem" in page
    assert "Errors of fem" not in page
    assert "difference, in p0 and f p0" in page
    values = page.partition("<h2>Values</h2>")[2].partition("</table>")[0]
    assert re.findall(r"half-planes \(exact\)|>fem<", values) == ["half-planes (exact)", ">fem<"]


def test_half_planes_beside_half_planes_have_errors():
    run = ran(march=result("march"))
    assert rows.error_headings(run, "march")[2:5] == ["exact", "march", "error"]
    assert rows.error_title(run, "march") == "Errors of march"
    assert not rows.shown_half_planes(ran(SCENE))


def test_equivalent_half_planes_beside_fem_have_errors():
    run = compared(BLOCK, plan(BLOCK), {"fem": FEM, "equivalent": result("equivalent")}, None)
    assert rows.error_headings(run, "equivalent")[2:5] == ["fem", "equivalent", "error"]


def test_the_units_of_the_table_tell_whose_a_they_are():
    told = rows.units(ran())
    assert told.startswith("half-planes (exact): a = ")
    assert f"{A * 1e3:.7g} mm (m, n above: in a of fem)" in told
    assert "above" not in rows.units(ran(SCENE))  # exact answers


@pytest.mark.parametrize(("scene", "answering"), [(BLOCK, FEM), (SCENE, EXACT)])
def test_the_stick_zone_of_the_answer_is_shaded(scene, answering):
    """In its own a: the figure shows the numbers of the answer."""
    expected = -answering.m / answering.a, answering.n / answering.a
    assert shaded(ran(scene)) == pytest.approx(expected, rel=1e-12)


def test_errors_end_where_both_contacts_end():
    """Beyond its own end p is zero, of both methods, but for rounding."""

    def at(x):
        found = FEM.traction.at(x)
        return found._replace(p=np.where(np.abs(x) < 0.97 * A, found.p, 1e-9))

    x = np.linspace(-1.1 * A, 1.1 * A, 301)
    spread = replace(FEM.traction, x=x, values=at(x))
    run = ran(fem=replace(FEM, traction=replace(spread, at=at)))
    axes = Figure().subplots()
    draw_errors(axes, run)
    (p,) = (line for line in axes.get_lines() if line.get_label() == "p, fem")
    x, error = p.get_xdata() * FEM.a, p.get_ydata()
    assert np.abs(x).max() < A
    assert np.nanmin(error[np.abs(x) > 0.99 * A]) > 1e-3
