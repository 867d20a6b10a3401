"""Deliberate faults: mistakes that contact codes have made. Each must turn a named check red.

Without the fault the same scene passes. The number that is seen is the one in the table of docs/faults.md, but for what
other versions of gmsh and LAPACK make of it.
"""

import functools
import re
from pathlib import Path

import pytest

import partialslip
from partialslip.halfplane import method

TEXT = (Path(__file__).parents[2] / "docs" / "faults.md").read_text("utf-8")
TABLE = {
    fault: (check, float(seen), float(bar))
    for fault, check, seen, bar in re.findall(r"^\| (.+?) \| (.+?) \| (\d\S*) \| (\d\S*) \|", TEXT, flags=re.MULTILINE)
}
ACCURACY = "fem.accuracy=1e-3"


@functools.cache
def passing(name, *overrides):
    scene = partialslip.load_scene(name, [ACCURACY, *overrides])
    assert partialslip.run(scene).passed
    return scene


@pytest.fixture
def sound():
    """A scene that passes as long as nothing is wrong."""
    return passing


class Red:
    """Says which check has turned red."""

    def __init__(self, test, green):
        self._test, self._green = test, green

    def passes(self, number, bar):
        """Without the fault: by the number that the check sees, not above its bar."""
        assert number <= bar
        self._green = True

    def __call__(self, check, number, bar):
        """By the number that it has seen, above its bar."""
        assert self._green, "the check must pass without the fault: ask sound or red.passes before"
        assert number > bar
        fault = self._test.removeprefix("test_").replace("_", " ")
        assert TABLE[fault] == (check, pytest.approx(number, rel=0.5), pytest.approx(bar))

    def run(self, scene, *methods):
        """A run that knows nothing of the one without the fault."""
        method._change.cache_clear()
        return partialslip.run(scene, methods)

    def comparison(self, key, scene):
        """One of the comparison's with the exact solution: error ``key`` of a run of the scene."""
        found = self.run(scene, "exact", "fem").comparisons["fem"]
        assert key in {what.split(":")[0] for what in found.missed}
        self(f"compare: {key}", found.errors[key], found.bars[key])


@pytest.fixture
def red(request):
    return Red(request.node.originalname, green="sound" in request.fixturenames)
