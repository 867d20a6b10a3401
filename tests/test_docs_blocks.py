"""Every block of code in the documents runs, page by page and in order, as a reader would run it.

``python`` blocks share their names; ``sh`` blocks run in the page's own folder, beside the files that lie beside the
page; ``toml`` blocks are scenes, whole ones or tables to change in a shipped one, and are saved where their first line
names a file. A ``text`` block is what the block before it prints: numbers with an exponent are errors, which agree to
a factor of three or are rounding; others agree to 1e-5, to the last digit shown, or to four times the error that their
line shows, since meshes differ from processor to processor and values on two of them by both their errors. Costs need
not agree; ``...`` stands for anything. What is not run says why in a comment before it, or is ``slow``, as other codes
are.
"""

import contextlib
import io
import math
import os
import re
import shlex
import shutil
import subprocess
import tomllib
from pathlib import Path
from typing import NamedTuple
from unittest import mock

import pytest

from partialslip.cli import main
from partialslip.scene.reading import load_scene, parse_scene

DOCS = Path(__file__).parents[1] / "docs"
SHIPPED = "src/partialslip/scene/shipped/fretting-aluminium.toml"
SMOKE = "howto/csv.md"  # runs always, the others with the slow tests
BLOCK = re.compile(r"^(?:<!-- (not run: [^\n]+|slow) -->\n)?```(\w+)\n(.*?)^```$", flags=re.MULTILINE | re.DOTALL)
NUMBER = r"-?\d+(?:\.\d+)?e[-+]\d+|-?\d+\.\d+"
PARTS = re.compile(rf"(\.\.\.|(?<![\w.])(?:{NUMBER})(?![\w.]))")
COSTS = re.compile(  # differ from run to run
    r"cost\s.*?peak\s+memory\s+\d+\s+MB\s+\(\d+\s+MB\s+before\s+the\s+method\)|[\d.]+\s+CPU\s+s\b", re.DOTALL
)
ROUNDING = 1e-9
TWO_MESHES = 4  # times an error of one: that error, and up to three times as much on the other
SCREEN = {"COLUMNS": "80"}
PLAIN = ("head", "cat", "ls")
ALONE = ("ccx",)  # other codes, which need not be installed


class Block(NamedTuple):
    """A block of code, and what it prints if the page says so."""

    mark: str
    language: str
    code: str
    shown: str | None


def blocks(text):
    """Blocks of a page; those of what is printed go with the ones before them."""
    found = []
    for mark, language, code in BLOCK.findall(text):
        if language == "text":
            assert found, code
            assert found[-1].shown is None, code
            found[-1] = found[-1]._replace(shown=code)
        else:
            found.append(Block(mark, language, code, None))
    return found


PAGES = {str(path.relative_to(DOCS)): blocks(path.read_text("utf-8")) for path in sorted(DOCS.rglob("*.md"))
         if "_build" not in path.parts}  # fmt: skip
PAGES = {name: found for name, found in PAGES.items() if found}


def agrees(printed, shown):
    """Whether ``printed`` is what a page shows."""
    printed, shown = (re.sub("─+", "─", COSTS.sub("", text)) for text in (printed, shown))
    lines = [PARTS.split(" ".join(line.split())) for line in shown.splitlines() if line.strip()]
    # both values of a row are in its unit, and so is the error
    numbers = [(part, _error(line)) for line in lines for part in line[1::2] if part != "..."]
    pattern = " ".join("".join(_pattern(*each) for each in enumerate(line)) for line in lines)
    found = re.fullmatch(pattern, " ".join(printed.split()))
    return bool(found) and all(same(value, *wanted) for value, wanted in zip(found.groups(), numbers, strict=True))


def _pattern(number, part):
    return re.escape(part) if number % 2 == 0 else ".*" if part == "..." else f"({NUMBER})"


def _error(line):
    """The error that a line shows: its first number with an exponent."""
    return next((abs(float(part)) for part in line[1::2] if "e" in part), 0.0)


def same(printed, shown, error=0.0):
    value, other = float(printed), float(shown)
    if "e" in shown:
        rounding = max(abs(value), abs(other)) < ROUNDING
        return rounding or (value * other > 0 and abs(math.log(value / other)) < math.log(3))
    last_digit = 10.0 ** -len(shown.partition(".")[2])
    return abs(value - other) <= max(1e-5 * abs(other), TWO_MESHES * error, 2 * last_digit)


def shell(code):
    """Run the lines of a ``sh`` block; commands of partialslip in this process. Returns what they print."""
    printed = io.StringIO()
    for line in code.replace("\\\n", "").splitlines():
        words = shlex.split(line, comments=True)
        *words, into = [*words, None] if ">" not in words else [*words[: words.index(">")], words[-1]]
        if not words:
            continue
        if words[0] == "partialslip":
            out, err = io.StringIO(), io.StringIO()
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), mock.patch.dict(os.environ, SCREEN):
                code = main(words[1:])
            assert code in (0, 1, 2, 4), line
            text = out.getvalue() + (err.getvalue() if code == 2 else "")  # which the page shows, or fails
        else:
            assert words[0] in PLAIN + ALONE, line
            done = subprocess.run(words, capture_output=True, text=True, check=True)
            text = "" if words[0] in ALONE else done.stdout
        if into:
            Path(into).write_text(text, "utf-8")
        else:
            printed.write(text)
    return printed.getvalue()


def scene(code):
    """Read a ``toml`` block, and save it where it names a file."""
    data = tomllib.loads(code)
    if name := re.match(r"# (\S+\.toml)\n", code):
        Path(name[1]).write_text(code, "utf-8")
        load_scene(name[1])
    elif "name" in data:
        parse_scene(data)
    else:
        whole = tomllib.loads((DOCS.parent / SHIPPED).read_text("utf-8"))
        parse_scene(whole | data)


def run_page(name, folder, slow):
    """Run the blocks of a page in ``folder``; returns how many were run."""
    for file in (DOCS / name).parent.iterdir():
        if file.suffix not in (".md", ".py", ".svg") and file.is_file():
            shutil.copy(file, folder)
    names, count = {"__name__": "page"}, 0
    for block in PAGES[name]:
        if block.mark.startswith("not run") or (block.mark == "slow" and not slow):
            continue
        printed = io.StringIO()
        if block.language == "python":
            assert "assert" in block.code or block.shown is not None, block.code
            with contextlib.redirect_stdout(printed):
                exec(compile(block.code, name, "exec"), names)
        elif block.language == "sh":
            printed.write(shell(block.code))
        elif block.language == "toml":
            scene(block.code)
        else:
            raise AssertionError(f"{block.language}: {block.code}")
        if block.shown is not None or printed.getvalue().startswith("partialslip: "):
            assert block.shown, printed.getvalue()
            assert agrees(printed.getvalue(), block.shown), f"{block.code}\n{printed.getvalue()}"
        count += 1
    return count


@pytest.mark.parametrize(
    "name", [name if name == SMOKE else pytest.param(name, marks=pytest.mark.slow) for name in PAGES]
)
def test_page_runs(name, tmp_path, monkeypatch):
    """With its slow blocks where the codes are installed that they call."""
    codes = {line.split()[0] for block in PAGES[name] if block.mark == "slow" for line in block.code.splitlines()}
    monkeypatch.chdir(tmp_path)
    run_page(name, tmp_path, slow=all(shutil.which(code) for code in codes & set(ALONE)))


def test_what_differs_is_noticed():
    shown = "a 0.2066977 mm 2.6e-06 ok\ncost ...\nend"
    assert agrees("a  0.2066979 mm 3.1e-06 ok\n cost 1.2 s and more\nend\n", shown)
    assert not agrees("a 0.2067977 mm 2.6e-06 ok cost 1.2 s end", shown)
    assert not agrees("a 0.2066977 mm 2.6e-05 ok cost 1.2 s end", shown)
    assert not agrees("a 0.2066977 mm 2.6e-06 missed cost 1.2 s end", shown)
    coarse = "m, stick from -m a 0.2066 0.2071 4.7e-04 2.0e-02 ok"
    assert agrees("m, stick from -m a 0.2066 0.2075 9.0e-04 2.0e-02 ok", coarse)
    assert not agrees("m, stick from -m a 0.2066 0.2095 9.0e-04 2.0e-02 ok", coarse)


def test_most_blocks_are_run():
    found = [block for page in PAGES.values() for block in page]
    assert sum(block.mark != "" for block in found) < len(found) / 5
