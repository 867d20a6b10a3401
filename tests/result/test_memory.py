"""Memory of a method, not of what the process needed before."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from partialslip.result import Clock
from partialslip.result import cost as memory

MB = 2**20
ROOT = Path(__file__).parents[2]
RESETS = pytest.mark.skipif(not memory._CLEAR.exists(), reason="the peak cannot be reset here")


def need(size_mb):
    """Use so many MB and free them."""
    return float(np.ones(size_mb * MB // 8).sum())


ALONE = """
from tests.result.test_memory import need
from partialslip.result import Clock
from partialslip.result import cost as memory
need(160)
clock = Clock()
need(40)
cost = clock.cost()
after = Clock().cost()
print(cost.peak_rss_mb - cost.start_rss_mb, memory.process_peak_mb() - cost.peak_rss_mb,
      after.peak_rss_mb - cost.start_rss_mb)
"""


@RESETS
def test_the_past_is_not_counted():
    """In a process of its own: what other tests have left to be freed would be counted against what is needed here."""
    done = subprocess.run([sys.executable, "-c", ALONE], cwd=ROOT, capture_output=True, text=True, check=True)
    needed, before, after = map(float, done.stdout.split())
    assert needed == pytest.approx(40, abs=8)
    assert before > 80  # the process has needed more, and the study of cost knows
    assert after < 8


@pytest.mark.parametrize("reports", [True, False])
def test_without_a_reset_only_a_new_peak_is_known(monkeypatch, tmp_path, reports):
    """As on other systems than Linux, and where /proc cannot be written."""
    mark = [100.0]
    monkeypatch.setattr(memory, "_CLEAR", tmp_path / "none" / "clear_refs")
    monkeypatch.setattr(memory, "_memory", lambda: (50.0 if reports else None, mark[0]))
    clock = Clock()
    cost = clock.cost()
    assert (cost.peak_rss_mb, cost.start_rss_mb) == (None, 50.0 if reports else None)
    assert cost.peak_rss_unknown == "at most 100 MB, which this process had needed before"
    mark[0] = 120.0
    assert clock.cost().peak_rss_mb == 120.0


def test_a_system_that_reports_nothing(monkeypatch):
    monkeypatch.setattr(memory, "_memory", lambda: (None, None))
    cost = Clock().cost()
    assert (cost.peak_rss_mb, cost.peak_rss_unknown) == (None, "this system does not report it")
    assert memory.process_peak_mb() is None
