"""docs/faults.md lists the deliberate faults in whole runs: all of them, and no other."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "faults.md").read_text("utf-8")
WHOLE = re.findall(r"^\| (?!fault \|)([^-|].+?) \| .+? \|", TEXT, re.M)


def faults():
    """What its name says, of every test here that is marked as a fault."""
    for path in sorted(Path(__file__).parent.glob("test_*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            marks = [ast.unparse(mark) for mark in getattr(node, "decorator_list", ())]
            if isinstance(node, ast.FunctionDef) and "pytest.mark.fault" in marks:
                yield node.name.removeprefix("test_").replace("_", " ")


def test_the_table_lists_all_faults_and_no_other():
    here = list(faults())
    assert sorted(WHOLE) == sorted(here)
    assert len(here) >= 18
    assert len(set(here)) == len(here)


def test_every_fault_that_is_said_to_be_somebody_elses_is_linked():
    links = dict(re.findall(r"^\[(.+?)\]: (https://github\.com/\S+)$", TEXT, flags=re.MULTILINE))
    cited = set(re.findall(r"\[([A-Za-z0-9-]+ #\d+)\](?!:)", TEXT))
    assert cited == set(links)
    assert all(name.split("#")[1] == link.rsplit("/", 1)[1] for name, link in links.items())
