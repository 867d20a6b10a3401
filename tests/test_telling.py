"""Long work within one mesh shows where it is."""

import threading

import pytest

import partialslip
from partialslip.tools import telling

LONG = ["load.Q=[-1e4, 4e4]", "load.steps=3", "load.cycles=2", "fem.accuracy=1e-2", "material.upper={E=200e9, nu=0.3}"]


@pytest.mark.parametrize("method", ["march", "fem"])
def test_load_steps_are_told(monkeypatch, method):
    monkeypatch.setattr(telling, "EVERY", 0.0)
    lines = []
    partialslip.run(partialslip.load_scene("fretting-aluminium", LONG), [method], progress=lines.append)
    assert f"{method}: first loading, step 3 of 3" in lines
    assert f"{method}: cycle 1, way 2 of 2, step 3 of 3" in lines
    assert any(line.startswith(f"{method}: mesh 2") for line in lines)


def test_lines_are_told_now_and_then(monkeypatch):
    """The first at once, others once the time has passed; another thread, and one after the block, tells nobody."""
    lines, clock = [], iter([0.0, 0.1, 0.3, 0.4])
    monkeypatch.setattr(telling.time, "monotonic", lambda: next(clock))
    with telling.told_to(lines.append):
        for line in ("first", "too soon", "second", "too soon"):
            telling.tell(line)
        other = threading.Thread(target=telling.tell, args=["elsewhere"])
        other.start()
        other.join()
    telling.tell("after the end")
    assert lines == ["first", "second"]
