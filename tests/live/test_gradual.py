"""The page's gradual stick zones, by node, against Python and the solver."""

import json
import shutil
import subprocess
from importlib.resources import files

import numpy as np
import pytest

from partialslip.gradual import turns_round
from partialslip.halfplane.gradual_table import tabled
from partialslip.halfplane.hertz import Hertz
from partialslip.halfplane.steady import stick_zones
from partialslip.live import page

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


def asked(loads, change=lambda text: text):
    """Left end, right end and s by the page's program, None where it has none."""
    source = change((files("partialslip.live") / "hertz.js").read_text("utf-8"))
    told = json.dumps({"table": page._table(), "loads": loads.tolist()})
    run = subprocess.run([NODE, "-e", source + ASK], input=told, capture_output=True, text=True, check=True)
    return json.loads(run.stdout)


def turned():
    """Random loads (k, 2) whose slip turns round."""
    random = np.random.default_rng(4711)
    Qf, sf = random.random(2000), 12 * random.random(2000)
    zone = stick_zones(Qf, sf, Hertz())
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


@pytest.mark.fault
def test_a_wrong_series_shows():
    """Fault: a sign in the recurrence of Chebyshev series."""
    right = "2 * x * one - two, one]"
    with pytest.raises(AssertionError):
        check(lambda text: text.replace(right, right.replace("-", "+")))


def test_the_table_on_the_page_is_small():
    assert len(json.dumps(page._table())) < 60_000
