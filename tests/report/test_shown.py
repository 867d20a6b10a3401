"""Reprs say in a few lines what one needs, and never print arrays."""

import numpy as np
import pytest

import partialslip
from partialslip import halfplane
from partialslip.report import record
from partialslip.scene import Tabulated
from partialslip.study.map import stick_map

SCENE = partialslip.load_scene("hertz-large-tension", ["fem.accuracy=1e-2"])


@pytest.fixture(scope="module")
def run():
    return partialslip.run(SCENE, ["exact", "march"], subsurface=True)


def test_a_result_in_a_line(run):
    exact = run["exact"]
    assert repr(exact) == (
        f"Result of exact: large tension; a = {exact.a:.7g} m, m = {exact.m / exact.a:.7g} a, "
        f"n = {exact.n / exact.a:.7g} a; p0 = {exact.p0:.7g} Pa"
    )
    sliding = partialslip.run(SCENE.replace(load={"Q": [-1e9, 1e9]}), "exact")["exact"]
    assert ", no stick zone; p0 = " in repr(sliding)


def test_a_run_is_its_results_and_comparisons(run):
    lines = repr(run).splitlines()
    assert lines[0] == "Run of hertz-large-tension: all bars met"
    assert [line.strip() for line in lines[1:]] == [
        repr(run["exact"]), repr(run["march"]), repr(run.comparisons["march"])
    ]  # fmt: skip
    assert lines[3].startswith(
        f"  Comparison: all bars met; errors in a: a 0.0e+00, m {run.comparisons['march'].m:.1e}, n "
    )


def test_many_numbers_are_a_shape_and_a_range(run):
    exact, pressed = run["exact"], halfplane.contact(SCENE)
    assert f"x=<{len(exact.traction.x)}: {-exact.a:g} to {exact.a:g}>" in repr(exact.traction)
    zones = halfplane.stick_zone(pressed, 0.5, [1e4, 1e9], np.zeros((3, 1)))
    assert repr(zones).endswith("shape (3, 2), 3 sliding)")
    assert repr(pressed).startswith(f"Contact: a = {pressed.a:.7g} m, P = {pressed.P:.7g} N/m")
    x = np.linspace(0, 1, 500)
    loop = halfplane.hysteresis(pressed, SCENE.material.A, 0.5, 1e4, 1e6)
    states = (run["march"].state, run["march"].slip, exact.surface, loop, Tabulated(x=x, gap=x**2))
    records = (record(run), record(run).methods["exact"].traction)
    for each in (*states, *records, exact, exact.traction, run, zones, stick_map().grid.zone):
        assert len(repr(each)) < 1000
