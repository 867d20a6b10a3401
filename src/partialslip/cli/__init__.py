"""The command line. Exit codes: 0 fine, 1 a bar missed, 2 bad input (one line on stderr)."""

import argparse
import os
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

from partialslip import __version__
from partialslip.cli import export, maps, page, run, score, study, verify
from partialslip.errors import InputError, PartialslipError
from partialslip.reading import shipped_scenes


class _Parser(argparse.ArgumentParser):
    """Errors in one line, like all others; no abbreviations."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(allow_abbrev=False, **settings)

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message} (see {self.prog} --help)")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    try:
        options = _parser().parse_args(arguments)
        code: int = options.command(options)
        sys.stdout.flush()
    except PartialslipError as error:
        print(f"partialslip: {error}", file=sys.stderr)
        return 2
    except MemoryError:
        print("partialslip: not enough memory: ask for less accuracy, or larger elements", file=sys.stderr)
        return 2
    except BrokenPipeError:  # whoever read the output has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except KeyboardInterrupt:
        print("partialslip: interrupted", file=sys.stderr)
        return 130
    return code


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(
        prog="partialslip",
        description="How right is a frictional contact calculation? Exact solution and finite elements, side by side.",
    )
    parser.add_argument("--version", action="version", version=f"partialslip {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND", parser_class=_Parser)

    for command in (run, maps, page, verify, study, score, export):
        command.add(commands)

    scenes = commands.add_parser("scenes", help="list the shipped scenes")
    scenes.set_defaults(command=_scenes)
    return parser


def _scenes(_: argparse.Namespace) -> int:
    scenes = shipped_scenes()
    width = max(map(len, scenes))
    for name, title in scenes.items():
        print(f"{name:{width}}  {title}")
    return 0
