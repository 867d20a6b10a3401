"""The command line. Exit codes: 0 fine, 1 a bar missed, 2 bad input (one line on stderr)."""

import argparse
import json
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from partialslip import __version__
from partialslip.errors import InputError, PartialslipError
from partialslip.reading import load_scene, shipped_scenes
from partialslip.run import METHODS, Run, run
from partialslip.state import State, load_state

if TYPE_CHECKING:
    from rich.console import Console


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

    runs = commands.add_parser(
        "run",
        help="solve a scene, compare the methods, write the report",
        epilog="example: partialslip run fretting-aluminium --set fem.far_field=box --out results/box",
    )
    runs.add_argument("scene", metavar="SCENE", help="a shipped scene (see: partialslip scenes) or a TOML file")
    runs.add_argument("--with", dest="methods", metavar="METHODS",
                      help="methods, separated by commas, of exact, march, fem (default: exact,fem; march,fem where "
                      "Q and sigma are out of phase)")  # fmt: skip
    runs.add_argument("--set", dest="overrides", action="append", default=[], metavar="KEY=VALUE",
                      help="change a setting of the scene, e.g. load.P=2e5; may be repeated")  # fmt: skip
    runs.add_argument("--accuracy", metavar="FRACTION",
                      help="of a, m and n, as a fraction of a; short for --set fem.accuracy=FRACTION")  # fmt: skip
    runs.add_argument("--fields", action="store_true",
                      help="also stresses: compared, and written to surface.csv and bodies.vtu")  # fmt: skip
    runs.add_argument("--start", metavar="FILE",
                      help="begin with the state that FILE holds, instead of without shear")  # fmt: skip
    runs.add_argument("--save", metavar="FILE",
                      help="write the state that the path ends with to FILE, .npz (of fem, else of march)")  # fmt: skip
    runs.add_argument("--out", metavar="DIR", help="folder for the files (default: results/NAME)")
    runs.add_argument("--json", action="store_true", help="print results.json and nothing else; files only with --out")
    runs.set_defaults(command=_run)

    maps = commands.add_parser(
        "map",
        help="draw the stick zones over all loads",
        epilog="example: partialslip map flat-rounded",
    )
    maps.add_argument("scene", nargs="?", metavar="SCENE",
                      help="a shipped scene or a TOML file, whose profile is mapped and loads marked "
                      "(default: Hertz)")  # fmt: skip
    maps.add_argument("--out", metavar="DIR", help="folder for the files (default: results/map, results/NAME-map)")
    maps.set_defaults(command=_map)

    scenes = commands.add_parser("scenes", help="list the shipped scenes")
    scenes.set_defaults(command=_scenes)
    return parser


def _run(options: argparse.Namespace) -> int:
    overrides = [*options.overrides]
    if options.accuracy is not None:
        try:
            overrides.append(f"fem.accuracy={float(options.accuracy)!r}")
        except ValueError:
            raise InputError(f"--accuracy {options.accuracy!r}: must be a number, for example 1e-4") from None
    methods = None if options.methods is None else [method.strip() for method in options.methods.split(",")]
    for method in methods or []:
        if method not in METHODS:
            raise InputError(f"--with {method!r}: must be of {', '.join(METHODS)}")
    _check_folder(options.out)
    if options.fields and methods and "fem" not in methods:
        raise InputError("--fields: needs the method fem")
    scene = load_scene(options.scene, overrides)
    start = load_state(options.start) if options.start is not None else None

    from rich.console import Console

    from partialslip.report import print_run, record, write_files, write_run

    messages = Console(stderr=True, highlight=False)
    with messages.status(f"{scene.name} ...") as status:
        outcome = run(
            scene,
            methods,
            subsurface=options.fields,
            progress=lambda line: status.update(f"{scene.name}: {line}"),
            start=start,
        )
        folder = Path(options.out) if options.out else None if options.json else Path("results") / scene.name
        files = write_run(outcome, folder) if folder else []
        if options.save is not None:
            save = Path(options.save)
            files += write_files(save.parent, {save.name: _state(outcome).save})
    if options.json:
        print(json.dumps(record(outcome), indent=1, allow_nan=False))
    else:
        console = Console(highlight=False)
        print_run(outcome, console)
        _print_written(files, console)
    return 0 if outcome.passed else 1


def _state(outcome: Run) -> State:
    """The one to save."""
    for name in ("fem", "march"):
        if name in outcome.results and (state := outcome.results[name].state):
            return state
    raise InputError("--save: no method has followed a path of loads with friction; take march or fem")


def _map(options: argparse.Namespace) -> int:
    _check_folder(options.out)
    scene = None if options.scene is None else load_scene(options.scene)
    name = "map" if scene is None else f"{scene.name}-map"

    from rich.console import Console

    from partialslip.report import place, stick_map, write_map

    messages = Console(stderr=True, highlight=False)
    with messages.status(f"{name} ...") as status:
        data = stick_map(scene, progress=lambda line: status.update(f"{name}: {line}"))
        files = write_map(data, Path(options.out) if options.out else Path("results") / name)
    console = Console(highlight=False)
    for line in place(data):
        console.print(line, soft_wrap=True, markup=False)
    _print_written(files, console)
    return 0


def _check_folder(out: str | None) -> None:
    if out == "":
        raise InputError("--out '': must name a folder")


def _print_written(files: list[Path], console: "Console") -> None:
    console.print("written: " + ", ".join(map(str, files)), soft_wrap=True, markup=False)


def _scenes(_: argparse.Namespace) -> int:
    scenes = shipped_scenes()
    width = max(map(len, scenes))
    for name, title in scenes.items():
        print(f"{name:{width}}  {title}")
    return 0
