"""Tuning constants say what they do."""

import runpy
from pathlib import Path

import pytest

SCRIPT = runpy.run_path(str(Path(__file__).parents[1] / "docs" / "constants.py"))
CONSTANTS = SCRIPT["constants"]()


@pytest.mark.parametrize("package", sorted({each.package for each in CONSTANTS}))
def test_every_constant_says_what_it_does(package):
    own = [each for each in CONSTANTS if each.package == package]
    assert [f"{each.module}.{each.name}" for each in own if not each.kind or not each.what] == []


def test_a_comment_without_its_word_is_noticed():
    assert SCRIPT["_split"]("cost: nodes in a factor") == ("cost", "nodes in a factor")
    assert SCRIPT["_split"]("nodes in a factor") == ("", "nodes in a factor")
    assert SCRIPT["_comments"](["# limit: most", "_MOST = 3", "_LEAST = 1  # cost: least"], 2, 2) == ("", "limit: most")
