"""The page on the architecture shows the packages that there are, and what they import today."""

import re
import runpy
from pathlib import Path
from xml.etree import ElementTree

import pytest

DOCS = Path(__file__).parents[1] / "docs"
SCRIPT = runpy.run_path(str(DOCS / "architecture.py"))
IMPORTS = SCRIPT["imports"]()


def drawn(svg):
    """Names in the boxes, and how many shapes there are: a box each, and line and head of each arrow."""
    nodes = list(ElementTree.fromstring(svg).iter())
    names = {"".join(node.itertext()).strip() for node in nodes if node.tag.endswith("}text")}
    return names, len([node for node in nodes if node.tag.endswith("}path")])


def test_the_picture_is_todays():
    assert drawn((DOCS / "architecture" / "imports.svg").read_text("utf-8")) == drawn(SCRIPT["picture"]())


def test_the_table_has_every_package():
    page = (DOCS / "architecture.md").read_text("utf-8")
    names = re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE)
    assert sorted(names) == sorted(IMPORTS)


def test_longer_ways_explain_imports_and_circles_are_noticed():
    assert SCRIPT["direct"]({"a": {"b", "c"}, "b": {"c"}, "c": set()}) == {"a": {"b"}, "b": {"c"}, "c": set()}
    assert SCRIPT["levels"]({"a": {"b", "c"}, "b": {"c"}, "c": set()}) == {"a": 2, "b": 1, "c": 0}
    with pytest.raises(RecursionError):
        SCRIPT["levels"]({"a": {"b"}, "b": {"a"}})
