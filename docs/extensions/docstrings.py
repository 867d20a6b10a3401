"""Docstrings as they stand in the code, plain text between double backticks, made fit for Sphinx."""

import re

from sphinx.application import Sphinx

_CODE = re.compile(r"(``.*?``|:\w+:`.*?`)")


def escape(_app: Sphinx, what: str, _name: str, _what: object, _options: object, lines: list[str]) -> None:
    """Keep |q| from being read as a substitution, and "Half-width, m: of ..." as a type, m, of a property."""
    lines[:] = ["".join(part.replace("|", r"\|") if k % 2 == 0 else part for k, part in enumerate(_CODE.split(line)))
                for line in lines]  # fmt: skip
    if what == "property":
        lines[:0] = ["..", ""]  # a comment that says nothing, where the type would stand


def setup(app: Sphinx) -> dict[str, bool]:
    """Go before napoleon, which reads the sections."""
    app.connect("autodoc-process-docstring", escape, priority=100)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
