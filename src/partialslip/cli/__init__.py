"""The command line. Exit codes: see :mod:`partialslip.cli.ending`."""

import argparse
import difflib
import functools
import itertools
import re
import shlex
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NoReturn

import partialslip
from partialslip.cli import (
    benchmark,
    completion,
    equivalent,
    export,
    fatigue,
    identify,
    maps,
    page,
    run,
    score,
    study,
    verify,
)
from partialslip.cli.ending import ended
from partialslip.tools.errors import InputError

if TYPE_CHECKING:
    from _typeshed import SupportsWrite


_ALIKE = 0.65  # display: least similarity of an option that is suggested: that of --acc and --accuracy


class _Parser(argparse.ArgumentParser):
    """Parser with one-line errors, without abbreviations, and with examples and exit codes at the end of the help."""

    def __init__(self, examples: Sequence[str] = (), failure: str = "", unjudged: str = "", **settings: Any) -> None:
        super().__init__(allow_abbrev=False, **settings)
        self._negative_number_matcher = re.compile(r"-\.?\d")  # -1e-3 and -1,1,1 are values, too, not options
        codes = [
            "0    success",
            *([f"1    {failure}"] if failure else []),
            "2    bad input, or output that cannot be written",
            *([f"4    {unjudged}"] if unjudged else []),
            "130  interrupted",
        ]
        self._end = {"examples": examples, "exit codes": codes}

    @property
    def version(self) -> str:
        """Text of ``--version``; read when it is asked for, as reading takes long."""
        return f"partialslip {partialslip.__version__}"

    def format_help(self) -> str:
        """Return the help with examples and exit codes, one per line."""
        ends = ["\n  ".join([f"\n{head}:", *lines]) + "\n" for head, lines in self._end.items() if lines]
        return super().format_help() + "".join(ends)

    def _print_message(self, message: str, file: "SupportsWrite[str] | None" = None) -> None:
        """Print help and version with ``print``, so that a failed write raises."""
        print(message, end="", file=file)

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> tuple[Any, list[str]]:
        """Parse; refuse what is unknown here, where the options of the command are known."""
        found, unknown = super().parse_known_args(args, namespace)
        # argparse takes optional positionals for absent if options stand before them
        for action in self._get_positional_actions():
            most = {"?": 1, "*": len(unknown)}.get(str(action.nargs), 0)
            given = list(itertools.takewhile(lambda each: not each.startswith("-"), unknown[:most]))
            if given and getattr(found, action.dest) == action.default:
                setattr(found, action.dest, self._get_values(action, given))
                del unknown[: len(given)]
        if unknown:
            near = difflib.get_close_matches(unknown[0].partition("=")[0], self._option_string_actions, 1, _ALIKE)
            self.error(f"unknown argument {unknown[0]}" + (f": did you mean {near[0]}?" if near else ""))
        return found, unknown

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Refuse a value that is none of the choices, and tell which one was meant."""
        try:
            super()._check_value(action, value)
        except argparse.ArgumentError as error:
            from partialslip.scene.reading import meant

            error.message += meant(value, action.choices or ())
            raise

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message} (see {self.prog} --help)")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return the exit code.

    Parameters
    ----------
    arguments : sequence of str, optional
        Arguments of a call from Python; default: the arguments of this process.
    """
    return ended(lambda: _command(arguments))


def _command(arguments: Sequence[str] | None) -> int:
    line = shlex.join(["partialslip", *(sys.argv[1:] if arguments is None else arguments)])
    line = line.encode("utf-8", "replace").decode()  # bytes of file names that are no text cannot be written
    options = parser().parse_args(arguments, argparse.Namespace(own_process=arguments is None, line=line))
    return options.command(options)


@functools.cache  # for calls from Python, one after the other
def parser() -> argparse.ArgumentParser:
    """Return the parser with all commands and options."""
    root = _Parser(
        prog="partialslip",
        description="Benchmark frictional contact calculations: compare the exact solution, finite elements and other "
        "codes.",
        examples=[
            "partialslip run fretting-aluminium",
            "partialslip scenes",
            "partialslip run --help",
        ],
        failure="a bar missed, or a case not solved",
        unjudged="headline quantities not judged",
    )
    root.add_argument("--version", action="version")  # of _Parser.version
    commands = root.add_subparsers(required=True, metavar="COMMAND", parser_class=_Parser)

    for command in (run, maps, page, equivalent, fatigue, identify, verify, study, score, export, benchmark):
        command.add(commands)

    scenes = commands.add_parser(
        "scenes",
        help="list the shipped scenes",
        description="List names and titles of the shipped scenes. Every command accepts a name in place of a file.",
        examples=["partialslip scenes", "partialslip run hertz-shear"],
    )
    scenes.set_defaults(command=_scenes)
    completion.add(commands, root)
    return root


def _scenes(_: argparse.Namespace) -> int:
    scenes = partialslip.shipped_scenes()
    width = max(map(len, scenes))
    for name, title in scenes.items():
        print(f"{name:{width}}  {title}")
    return 0
