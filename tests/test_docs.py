"""The documents say what is so, and their formulas are well-formed."""

import importlib
import re
from pathlib import Path

import pytest

from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.loading import one_step

FOLDER = Path(__file__).parents[1] / "docs"
DOCS = {str(path.relative_to(FOLDER)): path.read_text("utf-8") for path in sorted(FOLDER.rglob("*.md"))
        if "_build" not in path.parts}  # fmt: skip
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", flags=re.MULTILINE | re.DOTALL)
NAMES = sorted({name for text in DOCS.values() for name in re.findall(r"`(partialslip\w*(?:\.\w+)+)`", text)})
SPOT = re.compile(r"^\| ([\d.]+) \| ([\d.]+) \| ([+-]1) \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$", flags=re.MULTILINE)


def resolve(name):
    """The object that a dotted name leads to: the longest module, then attributes."""
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        module = ".".join(parts[:count])
        try:
            found = importlib.import_module(module)
        except ModuleNotFoundError as error:
            if not module.startswith(error.name or " "):
                raise
            continue
        except DeprecationWarning:  # a module's name of version 1.0, now that of a function
            continue
        for part in parts[count:]:
            found = getattr(found, part)
        return found
    raise ModuleNotFoundError(name)


def prose(text):
    """``text`` without code."""
    return re.sub(r"`[^`\n]+`", "", FENCE.sub("", text))


def displays(text):
    """Lines of the formulas between double dollars."""
    return [line for formula in prose(text).split("$$")[1::2] for line in formula.strip("\n").splitlines()]


@pytest.mark.parametrize("name", NAMES)
def test_names_exist(name):
    assert resolve(name) is not None


def test_a_wrong_name_is_noticed():
    with pytest.raises(AttributeError):
        resolve("partialslip.halfplane.shape.Hertz.no_such_thing")


def test_there_is_something_to_check():
    assert NAMES
    assert len(SPOT.findall(DOCS["theory.md"])) == 5


@pytest.mark.parametrize("row", SPOT.findall(DOCS["theory.md"]), ids=lambda row: f"{row[0]}-{row[1]}")
def test_spot_values(row):
    Qf, sf, s, m, n, bound = row
    cycle = one_step(float(Qf), float(sf), HertzShape())
    zone = cycle.zone
    assert zone.s == int(s)
    assert (len(m), len(n)) == (14, 14)  # twelve digits
    values = zone.half_width - zone.centre, zone.half_width + zone.centre, cycle.mean_load_bound
    for value, printed in zip(values, (m, n, bound), strict=True):
        assert value == pytest.approx(float(printed), rel=0, abs=10.0 ** -len(printed.split(".")[1]))


@pytest.mark.parametrize("name", DOCS)
def test_dollars_are_balanced(name):
    text = prose(DOCS[name])
    assert text.count("$$") % 2 == 0
    lines = text.splitlines()
    assert all(line == "$$" for line in lines if "$$" in line)  # a display's dollars stand alone
    for line in lines:
        assert line.replace("$$", "").count("$") % 2 == 0, line


@pytest.mark.parametrize("name", DOCS)
def test_formulas_survive_markdown(name):
    inline = re.findall(r"\$([^$\n]+)\$", re.sub(r"\$\$.*?\$\$", "", prose(DOCS[name]), flags=re.DOTALL))
    for line in displays(DOCS[name]):
        assert line.strip()  # an empty line ends a paragraph, and the formula with it
        assert not re.match(r"\s*([-+*>#=]|\d+[.)]\s)", line), line  # a list, a quotation, a heading
    for formula in [*inline, *displays(DOCS[name])]:
        assert not re.search(r"\\[^A-Za-z]", formula), formula  # Markdown eats the backslash before punctuation
        assert "](" not in formula, formula
        assert "<" not in formula, formula  # may pass for a tag; write \lt
    for formula in inline:
        assert formula.count("{") == formula.count("}"), formula
        assert formula == formula.strip(), formula  # dollars with blanks inside are not a formula


@pytest.mark.parametrize("name", DOCS)
def test_no_line_is_too_long(name):
    assert [line for line in DOCS[name].splitlines() if len(line) > 120] == []
