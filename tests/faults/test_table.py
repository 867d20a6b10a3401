"""docs/faults.md lists the deliberate faults: all of them, and no other."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "faults.md").read_text("utf-8")
WHOLE, BESIDE = (re.findall(r"^\| (?!fault \|)([^-|].+?) \| (.+?) \|", part, re.M) for part in TEXT.split("## Beside"))


def faults():
    """(file, what its name says) of every test that is marked as a fault."""
    for path in sorted((ROOT / "tests").rglob("test_*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            marks = [ast.unparse(mark) for mark in getattr(node, "decorator_list", ())]
            if isinstance(node, ast.FunctionDef) and "pytest.mark.fault" in marks:
                yield path, node.name.removeprefix("test_").replace("_", " ")


def test_the_table_lists_all_faults_and_no_other():
    here = [name for path, name in faults() if path.parent == Path(__file__).parent]
    beside = [(name, f"`{path.relative_to(ROOT)}`") for path, name in faults() if path.parent != Path(__file__).parent]
    assert sorted(name for name, _ in WHOLE) == sorted(here)
    assert sorted(BESIDE) == sorted(beside)
    assert len(here) >= 18
    assert len(set(here)) == len(here)


def test_every_fault_that_is_said_to_be_somebody_elses_is_linked():
    links = dict(re.findall(r"^\[(.+?)\]: (https://github\.com/\S+)$", TEXT, flags=re.MULTILINE))
    cited = set(re.findall(r"\[([A-Za-z0-9-]+ #\d+)\](?!:)", TEXT))
    assert cited == set(links)
    assert all(name.split("#")[1] == link.rsplit("/", 1)[1] for name, link in links.items())
