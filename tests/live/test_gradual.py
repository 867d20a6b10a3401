"""The page's gradual stick zones, and its bound on the mean of Q, by node, against Python."""

import contextlib
import json
import shutil
import subprocess
from importlib.resources import files

import numpy as np
import pytest

from partialslip.halfplane.gradual_path.half_cycle import steady
from partialslip.halfplane.gradual_path.stage import Loads, LostError
from partialslip.halfplane.gradual_table import parted, tabled
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.loading import one_step
from partialslip.halfplane.steady import stick_zones
from partialslip.scene.gradual import turns_round
from partialslip.study import live

NODE = shutil.which("node")
pytestmark = pytest.mark.skipif(not NODE, reason="node is not installed")
ASK = """
const told = JSON.parse(require("fs").readFileSync(0));
const zones = told.loads.map(([Qf, sf]) => {
  const once = hertz.stickZone(Qf, sf);
  const zone = hertz.reverses(once, Qf, sf) ? hertz.gradualZone(told.table, once, Qf, sf) : once;
  return zone && [zone.centre - zone.c, zone.centre + zone.c, zone.s];
});
console.log(JSON.stringify(zones));
"""


def answered(script, told, change=lambda text: text):
    """What the page's program and a ``script`` print of what they are ``told``."""
    source = change((files("partialslip.study.live") / "hertz.js").read_text("utf-8"))
    run = subprocess.run(
        [NODE, "-e", source + script], input=json.dumps(told), capture_output=True, text=True, check=True
    )
    return json.loads(run.stdout)


def asked(loads, change=lambda text: text):
    """Left end, right end and s by the page's program, None where it has none."""
    return answered(ASK, {"table": live._gradual_table(), "loads": loads.tolist()}, change)


def turned():
    """Random loads (k, 2) whose slip turns round."""
    random = np.random.default_rng(4711)
    Qf, sf = random.random(2000), 12 * random.random(2000)
    zone = stick_zones(Qf, sf, HertzShape())
    return np.column_stack([Qf, sf])[turns_round(Qf, sf, zone.s, zone.centre, zone.half_width)]


def check(change=lambda text: text):
    """Check that the page has the zones that Python has, within 1e-5: Python's are within 1e-6 of the solver
    (tests/halfplane/test_gradual_table.py), and the page claims 1e-4."""
    loads = turned()
    zone, found = tabled(*loads.T), asked(loads, change)
    known = ~np.isnan(zone.centre)
    assert [each is not None for each in found] == known.tolist()
    ends = np.array([each for each in found if each])
    assert (ends[:, 2] == zone.s[known]).all()
    assert known.sum() > 300
    np.testing.assert_allclose(ends[:, :2], np.column_stack([zone.left, zone.right])[known], rtol=0, atol=1e-5)


def test_the_page_has_the_zones_of_python():
    check()


@pytest.mark.slow
def test_the_page_against_the_solver_where_an_inner_zone_slips():
    """20 random loads whose solver is not lost; the page claims 1e-4."""
    random = np.random.default_rng(4712)
    Qf, sf = 0.9975 * random.random(2000), 5.71 + 4.29 * random.random(2000)
    there = parted(Qf, sf)
    there[there] = ~np.isnan(tabled(Qf[there], sf[there]).centre)
    loads, ends = np.column_stack([Qf, sf])[there], []
    found = asked(loads[:40])
    for (Q, s), zone in zip(loads.tolist(), found, strict=False):
        with contextlib.suppress(LostError):
            ends.append((zone[:2], steady(Loads(s, np.pi * Q), HertzShape()).last.zone))
        if len(ends) == 20:
            break
    np.testing.assert_allclose(*np.swapaxes(ends, 0, 1), rtol=0, atol=1e-4)


@pytest.mark.fault
def test_a_wrong_series_shows():
    """Fault: a sign in the recurrence of Chebyshev series."""
    right = "2 * x * one - two, one]"
    with pytest.raises(AssertionError):
        check(lambda text: text.replace(right, right.replace("-", "+")))


BOUND = """
const told = JSON.parse(require("fs").readFileSync(0));
console.log(JSON.stringify(told.map((sf) => hertz.meanLoadBound(hertz.stickZone(0, sf), 0, sf))));
"""


def test_tension_alone_leaves_room_for_a_mean_of_Q():
    """Without shear the zone stays in the middle: the points at which dq has an extreme on the way are one point."""
    tensions = np.linspace(0.5, 12, 47)
    bounds = answered(BOUND, tensions.tolist())
    assert bounds == pytest.approx([one_step(0.0, sf, HertzShape()).mean_load_bound for sf in tensions], abs=1e-9)


@pytest.mark.fault
def test_a_rounded_middle_shows():
    """Fault: the page integrates over that one point, between places that rounding puts apart."""
    wrong = lambda text: text.replace("ends[1] - ends[0] > SETTLED", "ends[1] > ends[0]")  # noqa: E731
    assert None in answered(BOUND, np.linspace(0.5, 12, 47).tolist(), wrong)
