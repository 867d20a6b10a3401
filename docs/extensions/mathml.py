"""Formulas as MathML, made when the documents are built: no script and no network."""

from xml.etree import ElementTree as ET

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator

_THIN = "0.1667em"
_SIGNS = "+\u2212\u00b1"
_CLOSING = ")]}"


def mathml(formula: str, display: str) -> str:
    """``formula``, in LaTeX, as MathML; ``display`` is "inline" or "block"."""
    tree = ET.fromstring(convert(formula, display=display))
    ET.register_namespace("", tree.tag[1:].partition("}")[0])
    for element in tree.iter():
        if _kind(element) in ("math", "mrow"):
            _space(element)
    return ET.tostring(tree, encoding="unicode")


def _space(row: ET.Element) -> None:
    """Set the spaces in ``row`` as TeX does: latex2mathml leaves them to the browser, which takes a sign after a
    bracket for a difference, both bars of |q| for operators, and sin for one more factor."""
    bars = 0
    before: ET.Element | None = None
    for element in list(row):
        text, kind = element.text or "", _kind(element)
        if kind == "mo" and text == "|" and element.get("fence") is None:
            element.set("form", "postfix" if bars % 2 else "prefix")
            bars += 1
        elif kind == "mo" and text == "/":
            element.set("lspace", "0")
            element.set("rspace", "0")
        elif kind == "mo" and text in _SIGNS and before is not None and not _ends(before):
            element.set("form", "prefix")
        if _function(element) and before is not None and _ends(before):
            row.insert(list(row).index(element), _thin(row))
        if before is not None and _function(before) and not (kind == "mo" or kind == "mspace"):
            row.insert(list(row).index(element), _thin(row))
        before = element


def _kind(element: ET.Element) -> str:
    return element.tag.rpartition("}")[2]


def _ends(element: ET.Element) -> bool:
    """Whether a factor ends with ``element``."""
    if _kind(element) == "mo":
        return element.get("form") == "postfix" or (element.text or "") in _CLOSING
    return _kind(element) != "mspace" and not _function(element)


def _function(element: ET.Element) -> bool:
    """Whether ``element`` is the name of one: sin, ln, and such with an exponent."""
    base = element[0] if _kind(element) == "msup" else element
    return _kind(base) == "mi" and len(base.text or "") > 1 and (base.text or "").isalpha()


def _thin(row: ET.Element) -> ET.Element:
    return ET.Element(row.tag.rpartition("}")[0] + "}mspace", width=_THIN)


def inline(self: HTML5Translator, node: nodes.math) -> None:
    """Write a formula within a line."""
    self.body.append(mathml(node.astext(), "inline"))
    raise nodes.SkipNode


def display(self: HTML5Translator, node: nodes.math_block) -> None:
    """Write a formula of its own."""
    self.body.append(f'<div class="math">{mathml(node.astext(), "block")}</div>')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Add the renderer ``mathml``."""
    app.add_html_math_renderer("mathml", (inline, None), (display, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
