"""The documents are built without a warning, need no network, and the reference leaves nothing out."""

import importlib
import inspect
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import get_args

import msgspec
import pytest
from tests.cli.test_command_line import COMMANDS

from partialslip import scene
from partialslip.cli import main
from partialslip.scene import bodies
from partialslip.scene.measured import ProfileFile
from partialslip.scene.tolerance import Tolerance

DOCS = Path(__file__).parents[1] / "docs"
TABLES = {
    "Scene": [scene.Scene], "material": [scene.Material], "profile": [*get_args(scene.Profile), ProfileFile],
    "friction": [scene.Friction], "load": [scene.Load], "bodies": [bodies.Bodies, bodies.Body, bodies.Holder],
    "fem": [scene.Fem], "effects": [scene.Effects], "fatigue": [scene.Fatigue],
    "tolerance": [Tolerance],
}  # fmt: skip


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    folder = tmp_path_factory.mktemp("html")
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-d", f"{folder}-cache", DOCS, folder]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env={**os.environ, "NO_COLOR": "1"})
    assert done.returncode == 0, done.stderr
    return folder


def page(built, name):
    return (built / f"{name}.html").read_text("utf-8")


@pytest.mark.slow
def test_every_page_is_built(built):
    pages = [path.relative_to(DOCS).with_suffix("") for path in DOCS.rglob("*.md") if "_build" not in path.parts]
    assert len(pages) > 20
    assert [name for name in pages if not (built / name).with_suffix(".html").exists()] == []
    contents = page(built, "index")
    listed = [name for name in pages if name.name != "index" and name.parts[0] != "upstream"]  # drafts of reports
    assert [name for name in listed if f'href="{name.as_posix()}.html"' not in contents] == []


@pytest.mark.slow
def test_pages_need_no_network(built):
    for path in built.rglob("*.html"):
        needed = re.findall(
            r'<(?:script|img|link|iframe)\b[^>]*?(?:src|href)="(https?:[^"]+)"', path.read_text("utf-8")
        )
        assert needed == [], path
    assert not any("url(http" in path.read_text("utf-8") for path in built.rglob("*.css"))


@pytest.mark.slow
def test_every_command_is_in_the_reference(built, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")
    text = page(built, "reference/commands")
    for words in filter(None, COMMANDS):
        command = " ".join(words)
        assert main([*command.split(), "--help"]) == 0
        assert f'id="partialslip-{command.replace(" ", "-")}"' in text
        options = re.findall(r"--[a-z][\w-]+", capsys.readouterr().out)
        assert [option for option in options if option not in text] == []


@pytest.mark.slow
@pytest.mark.parametrize("name", ["", ".halfplane", ".study.fatigue", ".codes.score", ".codes.export", ".verify"])
def test_all_that_is_handed_out_is_in_the_reference(built, name):
    module = importlib.import_module(f"partialslip{name}")
    source, text = Path(module.__file__).read_text("utf-8"), page(built, "reference/api")
    named = {each: getattr(module, each) for each in getattr(module, "__all__", vars(module))}
    handed = [
        each
        for each, value in named.items()
        if (inspect.isfunction(value) or isinstance(value, type)) and not each.startswith("_")
        if f" as {each}\n" in source or value.__module__ == module.__name__
    ]
    assert handed
    homes = ["partialslip"] if name.startswith(".codes") else ["partialslip", module.__name__]
    assert [each for each in handed if not any(f'id="{home}.{each}"' in text for home in homes)] == []


def rows(heading):
    """Tables below a heading of the scene file's reference: what, unit, range and default by key."""
    text = re.search(
        rf"^## {heading}\n(.*?)(?=^## |\Z)", (DOCS / "reference/scene.md").read_text("utf-8"), re.M | re.S
    )[1]
    tables = [table.strip() for table in text.split("\n\n") if table.strip().startswith("|")]
    cells = [[[cell.strip() for cell in line.split("|")[1:-1]] for line in table.splitlines()[2:]] for table in tables]
    return [{row[0].strip("`"): row[1:] for row in table} for table in cells]


@pytest.mark.parametrize("heading", TABLES)
def test_scene_file_reference_is_what_is_read(heading):
    tables = rows(heading)
    assert len(tables) == len(TABLES[heading])
    for kind, table in zip(TABLES[heading], tables, strict=True):
        info = msgspec.inspect.type_info(kind)
        listed = {key: row for key, row in table.items() if not (key == "kind" and info.tag_field)}
        inner = TABLES.keys() - {"Scene"} if kind is scene.Scene else set()
        assert listed.keys() == {field.encode_name for field in info.fields} - inner
        for field in info.fields:
            if field.encode_name in listed:
                _, _, allowed, default = listed[field.encode_name]
                check(field, allowed, default)


def check(field, allowed, default):
    """Compare a row with what the reader takes."""
    kinds = field.type.types if isinstance(field.type, msgspec.inspect.UnionType) else [field.type]
    for kind in kinds:
        if isinstance(kind, (msgspec.inspect.FloatType, msgspec.inspect.IntType)):
            bounds = {">": kind.gt, ">=": kind.ge, "<": kind.lt, "<=": kind.le}
            said = dict(part.split() for part in allowed.split(", ") if part and not part.startswith("`"))
            assert {sign: float(value) for sign, value in said.items()} == {
                sign: value for sign, value in bounds.items() if value is not None
            }, field.name
        elif isinstance(kind, msgspec.inspect.LiteralType):
            words = {part.strip("`") for part in allowed.split(", ") if kind is kinds[0] or part.startswith("`")}
            assert words == {str(value) for value in kind.values}
        elif isinstance(kind, msgspec.inspect.VarTupleType) and kind is kinds[0]:
            least, most = kind.min_length, kind.max_length
            assert allowed == ("two" if least == most == 2 else f"{least} to {most} numbers")
    if isinstance(field.default, (int, float)) and not isinstance(field.default, bool):
        assert float(default) == field.default
    elif isinstance(field.default, tuple):
        assert default == str([int(value) for value in field.default])
    elif isinstance(field.default, str) and field.default:
        assert default == f"`{field.default}`"


def test_a_wrong_range_is_noticed():
    field = next(f for f in msgspec.inspect.type_info(scene.Material).fields if f.name == "nu")
    check(field, ">= -0.9, < 0.5", "")
    with pytest.raises(AssertionError):
        check(field, ">= -0.9, <= 0.5", "")
