"""Boundary elements that share no code with partialslip confirm targets, and the page shows what they found."""

import ast
import json
import runpy
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
SCRIPT = ROOT / "benchmarks" / "peers" / "boundary.py"
BOUNDARY = runpy.run_path(str(SCRIPT))
CELLS = 50


def test_it_imports_nothing_of_partialslip():
    found = set()
    for node in ast.walk(ast.parse(SCRIPT.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            found |= {name.name.partition(".")[0] for name in node.names}
        elif isinstance(node, ast.ImportFrom):
            found.add(node.module.partition(".")[0])
    assert {name for name in found if name.startswith("partialslip")} == set()
    assert "numpy" in found


@pytest.mark.parametrize("number", ["PS-02", "PS-18", "PS-22", "PS-25"])
def test_coarse_elements_come_near_the_targets(number):
    """With elements of 0.02 a lengths are right to a quarter of an element, tractions to 4e-3."""
    errors = BOUNDARY["measured"](number, CELLS)["errors"]
    lengths = {"a", "m", "n", "left_1", "right_1", "left_2", "right_2"}
    assert {key for key in lengths & errors.keys() if abs(errors[key]) > 1 / (4 * CELLS)} == set()
    assert {key for key, error in errors.items() if "@" in key and abs(error) > 4e-3} == set()
    assert abs(errors.get("dissipated", 0)) < 2e-3


def test_a_frictionless_pressure_is_that_of_hertz():
    line = BOUNDARY["Line"](CELLS, 0.0, 0.0)
    end = line.load(np.pi / 2, 0.0, 0.0)
    inside = np.abs(line.x) < 0.9
    assert np.allclose(end.p[inside], np.sqrt(1 - line.x[inside] ** 2), atol=1e-3)
    assert end.dissipated == 0


@pytest.mark.fault
def test_a_coupling_left_out_is_seen():
    """Unlike bodies treated as alike miss the shear of PS-22 by more than a tenth of f p0."""
    given = BOUNDARY["task"]("PS-22", CELLS)
    alike = given._replace(line=BOUNDARY["Line"](CELLS, 0.0, given.line.f))
    found, wanted = BOUNDARY["values"]("PS-22", alike), BOUNDARY["targets"]("PS-22")
    assert abs(found["q1@0.5"] - wanted["q1@0.5"]["value"]) / wanted["q1@0.5"]["scale"] > 0.1


def test_the_table_is_todays():
    lines = [json.loads(line) for line in (SCRIPT.parent / "boundary.jsonl").read_text("utf-8").splitlines()]
    assert {line["problem"] for line in lines} == set(BOUNDARY["PROBLEMS"])
    assert BOUNDARY["table"](lines) in (ROOT / "docs" / "verification.md").read_text("utf-8")
