"""The page of symptoms shows the table of what was measured."""

import json
import runpy
from pathlib import Path

ROOT = Path(__file__).parents[2]
PEERS = ROOT / "benchmarks" / "peers"


def test_the_table_of_stiffness_is_todays():
    lines = [json.loads(line) for line in (PEERS / "stiffness.jsonl").read_text("utf-8").splitlines()]
    assert len(lines) > 24
    table = runpy.run_path(str(PEERS / "stiffness.py"))["table"](lines)
    assert table in (ROOT / "docs" / "symptoms.md").read_text("utf-8")
