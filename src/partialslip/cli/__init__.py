"""The command line. Exit codes: 0 fine, 1 a bar missed, 2 bad input (one line on stderr)."""

import argparse
import os
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

from partialslip import __version__
from partialslip.cli import completion, export, maps, page, run, score, study, verify
from partialslip.errors import InputError, PartialslipError
from partialslip.reading import shipped_scenes


class _Parser(argparse.ArgumentParser):
    """Errors in one line, like all others; no abbreviations; examples and exit codes at the end of the help."""

    def __init__(self, examples: Sequence[str] = (), failure: str = "", **settings: Any) -> None:
        super().__init__(allow_abbrev=False, **settings)
        codes = ["0    fine", *([f"1    {failure}"] if failure else []), "2    bad input", "130  interrupted"]
        self._end = {"examples": examples, "exit codes": codes}

    def format_help(self) -> str:
        """The help, its examples one a line as they are typed."""
        ends = ["\n  ".join([f"\n{head}:", *lines]) + "\n" for head, lines in self._end.items() if lines]
        return super().format_help() + "".join(ends)

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message} (see {self.prog} --help)")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit code. With ``arguments`` it is not a process of its own that is run."""
    try:
        options = parser().parse_args(arguments, argparse.Namespace(own_process=arguments is None))
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


def parser() -> argparse.ArgumentParser:
    """What reads the command line: all commands and their options."""
    root = _Parser(
        prog="partialslip",
        description="How right is a frictional contact calculation? Exact solution and finite elements, side by side.",
        examples=[
            "partialslip run fretting-aluminium",
            "partialslip scenes",
            "partialslip run --help",
        ],
        failure="a bar missed, or a case not solved",
    )
    root.add_argument("--version", action="version", version=f"partialslip {__version__}")
    commands = root.add_subparsers(required=True, metavar="COMMAND", parser_class=_Parser)

    for command in (run, maps, page, verify, study, score, export):
        command.add(commands)

    scenes = commands.add_parser(
        "scenes",
        help="list the shipped scenes",
        description="List the scenes that come with partialslip: their names, by which every command knows them, and "
        "titles.",
        examples=["partialslip scenes", "partialslip run hertz-shear"],
    )
    scenes.set_defaults(command=_scenes)
    completion.add(commands, root)
    return root


def _scenes(_: argparse.Namespace) -> int:
    scenes = shipped_scenes()
    width = max(map(len, scenes))
    for name, title in scenes.items():
        print(f"{name:{width}}  {title}")
    return 0
