"""The directive ``commands``: a section for each command of partialslip, with its help as it is printed."""

import argparse
import os
from collections.abc import Iterator
from unittest import mock

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from partialslip.cli import parser

_COLUMNS = "100"


def commands(top: argparse.ArgumentParser) -> Iterator[argparse.ArgumentParser]:
    """``top`` and all commands below it, those that only lead to others included."""
    yield top
    for action in top._actions:
        if isinstance(action, argparse._SubParsersAction):
            for below in action.choices.values():
                yield from commands(below)


class Commands(SphinxDirective):
    """Sections for all commands."""

    def run(self) -> list[nodes.Node]:
        """One section a command, its help in it."""
        sections: list[nodes.Node] = []
        with mock.patch.dict(os.environ, COLUMNS=_COLUMNS):
            for command in commands(parser()):
                section = nodes.section(ids=[nodes.make_id(command.prog)], names=[command.prog])
                text = command.format_help()
                section += nodes.title("", command.prog)
                section += nodes.literal_block(text, text, language="text")
                sections.append(section)
        return sections


def setup(app: Sphinx) -> dict[str, bool]:
    """Add the directive."""
    app.add_directive("commands", Commands)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
