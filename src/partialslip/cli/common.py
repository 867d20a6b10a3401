"""Functions shared by several commands."""

import argparse
import json
import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

import partialslip
from partialslip.tools.errors import InputError
from partialslip.tools.groups import grouped

if TYPE_CHECKING:
    from rich.console import Console

    from partialslip.run import Run
    from partialslip.scene import Scene
    from partialslip.study.batch.ledger import Ledger
    from partialslip.tools.origin import Made
    from partialslip.tools.output.place import Place, Request

Commands: TypeAlias = "argparse._SubParsersAction[Any]"

_MANY_STEPS = 500  # cost: load steps of a path that take longer than all else


_SCENE = "a shipped scene (see: partialslip scenes) or a TOML file"


def add_scene(
    parser: argparse.ArgumentParser, text: str = _SCENE, optional: bool = False, usual: str | None = None
) -> None:
    """Add SCENE, which ``text`` explains, and ``--set`` to ``parser``; if it is ``optional``, it is the ``usual`` one
    where none is given."""
    parser.add_argument("scene", metavar="SCENE", help=text, nargs="?" if optional else None, default=usual)
    parser.add_argument("--set", dest="overrides", action="append", default=[], metavar="KEY=VALUE",
                        help="change a setting of the scene, e.g. load.P=2e5, in the scene's units; may be "
                        "repeated")  # fmt: skip


def add_tolerance(parser: argparse.ArgumentParser) -> None:
    """Add ``--tolerance``, a setting of the scene, to ``parser``."""
    parser.add_argument("--tolerance", dest="overrides", action="append", type=_tolerance, metavar="KEY=HALF-WIDTH",
                        help="how far an input may be off: friction.f=5%%, load.P=1e3 in the scene's units, or "
                        "load.P={std=1e3}; tells what it allows the results; may be repeated")  # fmt: skip


def _tolerance(text: str) -> str:
    """Return the setting of the scene that ``--tolerance`` asks for."""
    key, equals, width = (part.strip() for part in text.partition("="))
    if not (key and equals and width):
        raise argparse.ArgumentTypeError(f"{text!r}: must be KEY=HALF-WIDTH, for example friction.f=5%")
    return f"tolerance.{key}={json.dumps(width) if width.endswith('%') else width}"


def add_out(
    parser: argparse.ArgumentParser,
    usual: str,
    *short: str,
    what: str = "folder for the files",
    metavar: str = "DIR",
) -> None:
    """Add ``--out``, with the default ``usual`` and ``short`` forms, and ``--force`` to ``parser``."""
    parser.add_argument(*short, "--out", metavar=metavar, help=f"{what} (default: {usual}, HASH of the options)")
    parser.add_argument("--force", action="store_true",
                        help="overwrite the files of another scene or other settings")  # fmt: skip
    parser.set_defaults(default=parser.get_default)  # the command without options has a folder of its own


def add_method(parser: argparse.ArgumentParser, text: str, **more: Any) -> None:
    """Add ``--with METHOD``, which ``text`` explains, to ``parser``, and its former name ``--method``."""
    parser.add_argument("--with", dest="method", metavar="METHOD", help=text, **more)
    parser.add_argument("--method", help=argparse.SUPPRESS, default=argparse.SUPPRESS, **more)  # until 2.0


_T = TypeVar("_T")


def add_columns(parser: argparse.ArgumentParser) -> None:
    """Add ``--factors``, ``--columns`` and ``--where``, which :func:`factors_of` and so on parse."""
    parser.add_argument("--factors", metavar="X,P,Q", default="1,1,1",
                        help="multiply x, p and q by these factors, after the units of the scene or of the columns: "
                        "1e-3,1e6,1e6 for mm and MPa in an SI scene; -1 changes the sign")  # fmt: skip
    parser.add_argument("--columns", metavar="NAMES",
                        help="columns of x, p and dq by name or number (from 1): x=X,p=CPRESS,dq=S2-S1, "
                        "or q2=CSHEAR1 for the shear at load point 2")  # fmt: skip
    parser.add_argument("--where", metavar="COLUMN=VALUE", action="append",
                        help="keep the rows in which a column has this value: surface=FLAT; step=A,B are those of load "
                        "points 1 and 2")  # fmt: skip


def columns_of(text: str | None) -> dict[str, str] | None:
    """Parse the value of ``--columns``."""
    if text is None:
        return None
    pairs = [pair.partition("=") for pair in text.split(",")]
    if not all(name.strip() and made.strip() for name, _, made in pairs):
        raise InputError(f"--columns {text}: must be pairs NAME=COLUMN, for example x=X,p=CPRESS,dq=S2-S1")
    return {name.strip(): made.strip() for name, _, made in pairs}


def where_of(options: list[str] | None) -> dict[str, str]:
    """Parse the values of ``--where``."""
    pairs = [option.partition("=") for option in options or ()]
    for option, (name, _, value) in zip(options or (), pairs, strict=True):
        if not name.strip() or not value.strip():
            raise InputError(f"--where {option}: must be COLUMN=VALUE, for example surface=FLAT")
    return {name.strip(): value.strip() for name, _, value in pairs}


def factors_of(text: str) -> tuple[float, float, float]:
    """Parse the value of ``--factors``."""
    x, p, q = numbers_of(text, float, "--factors", "three numbers, for example 1e-3,1e6,1e6", 3)
    if not all(0 < abs(factor) < math.inf for factor in (x, p, q)):
        raise InputError(f"--factors {text}: must be finite and not zero")
    return x, p, q


def numbers_of(text: str, kind: Callable[[str], _T], option: str, wanted: str, *counts: int) -> tuple[_T, ...]:
    """Parse the value of an ``option``: numbers, as ``wanted``, of which there must be one of ``counts``."""
    try:
        numbers = tuple(kind(word) for word in text.split(","))
    except ValueError:
        numbers = ()
    if len(numbers) not in counts:
        raise InputError(f"{option} {text}: must be {wanted}")
    return numbers


def add_pdf(parser: argparse.ArgumentParser, told: str = "also write the report as report.pdf, A4") -> None:
    """Add ``--pdf`` to ``parser``; ``told`` is its help."""
    parser.add_argument("--pdf", action="store_true", help=told)


def origin(options: argparse.Namespace) -> "Made":
    """Return the origin of results by the command of ``options``: the same for what is printed and what is written."""
    from partialslip.tools.origin import made_now

    if "made" not in options:
        options.made = made_now(options.line, options.overrides)
    return options.made


def print_long_path(scene: "Scene", methods: Sequence[str]) -> None:
    """Print at once on stderr that ``methods`` take many load steps, if the scene asks for many."""
    load, marching = scene.load, [method for method in methods if method in ("march", "fem")]
    if marching and load.path_steps >= _MANY_STEPS:
        from partialslip.cli.consoles import messages

        messages().print(
            f"{scene.name}: {' and '.join(marching)}: {load.path_steps:,} load steps or more on each mesh, as "
            f"load.steps = {load.steps}, load.cycles = {load.cycles or 1} and there are {len(load.points)} points; "
            "with load.steps = 1 the steps are chosen by their errors",
            soft_wrap=True,
            markup=False,
        )


@contextmanager
def naming(scene: str) -> Iterator[None]:
    """Let messages about bad input in the block begin with the ``scene`` as the user gave it."""
    try:
        yield
    except InputError as error:
        raise InputError(f"{scene}: {error}") from None


def check_output(options: argparse.Namespace) -> None:
    """Check, before anything is solved, that files can be written.

    Raises
    ------
    InputError
        If ``--out`` is empty.
    MissingLibraryError
        If ``--pdf`` is given and a library is missing.
    """
    if options.out == "":
        raise InputError("--out '': must name a folder")
    if "pdf" in options and options.pdf:
        from partialslip.tools.output.page import check_pdf

        check_pdf("--pdf")


def add_verbose(parser: argparse.ArgumentParser, what: str) -> None:
    """Add ``--verbose``, which also prints ``what``, to ``parser``."""
    parser.add_argument("-v", "--verbose", action="store_true", help=f"also print {what}")


# Options that do not change the results.
_NEUTRAL = {"command", "scene", "overrides", "own_process", "line", "default"}
_NEUTRAL |= {"out", "force", "json", "pdf", "verbose", "save", "processes", "cluster", "shown", "quantities", "levels"}


def methods_of(text: str, known: Collection[str]) -> list[str]:
    """Return the methods of ``--with``, separated by commas; each must be ``known``."""
    methods = [method.strip() for method in text.split(",")]
    for method in methods:
        if method not in known:
            from partialslip.scene.reading import meant

            raise InputError(f"--with {method!r}: must be of {', '.join(known)}{meant(method, known)}")
    return methods


def seconds(budget: str, others: str = "") -> float:
    """Return the CPU seconds of ``--budget``, which may be followed by s; ``others`` names what else is allowed."""
    try:
        found = float(budget.removesuffix("s"))
    except ValueError:
        found = 0.0
    if not 0 < found < math.inf:
        raise InputError(
            f"--budget {budget!r}: must be a number of seconds > 0, for example 5s{others and ','}{others}"
        )
    return found


def results_folder(
    options: argparse.Namespace, command: str, name: str, scene: "Scene | None", *more: Any
) -> "AbstractContextManager[Place]":
    """Choose and lock the folder for the files of a command (:func:`partialslip.tools.output.place.placed`).

    Parameters
    ----------
    options : Namespace
        ``out``, ``force`` and all other options.
    command : str
    name : str
        The usual folder is results/``name``.
    scene : Scene or None
        Scene as the user gave it.
    more : optional
        ``known``, ``usual`` and ``constants`` of :func:`request`.
    """
    from partialslip.tools.output.place import placed

    asked = request(options, command, scene, *more)
    return placed(Path("results") / name, options.out, asked, options.force)


def folder_if_wanted(
    options: argparse.Namespace, command: str, name: str, scene: "Scene", *more: Any
) -> AbstractContextManager[tuple[Path | None, str]]:
    """As :func:`results_folder`; but with ``--json`` and without ``--out`` there is no folder, None."""
    if options.json and options.out is None:
        return nullcontext((None, ""))
    return results_folder(options, command, name, scene, *more)


def request(
    options: argparse.Namespace,
    command: str,
    scene: "Scene | None",
    known: Mapping[str, object] = {},
    usual: Callable[[], Mapping[str, object]] = dict,
    constants: bool = False,
) -> "Request":
    """Return the request of a command, by which result files are recognised: files are overwritten only by the same
    request.

    Parameters
    ----------
    options : Namespace
    command : str
    scene : Scene or None
        Scene as the user gave it.
    known : mapping
        By option, in place of its text: an input file, which counts by its content, or a setting that was interpreted.
    usual : callable
        ``usual()``: the values of ``known`` without options, where they differ from the parser's defaults. They name
        the default folder. Called only without ``--out``.
    constants : bool
        Whether constants of fatigue criteria change the results.
    """
    from partialslip.scene.dimensions import shown
    from partialslip.scene.units import SI
    from partialslip.tools.output.place import Request

    units = scene.units if scene else SI

    def text(key: str, value: object) -> str:
        return shown(key, value, units)

    def data(of: "Scene | None", settings: Mapping[str, object]) -> dict[str, Any]:
        return {"command": command, "scene": _content(of, constants), "settings": _given_settings(settings)}

    given = {key: value for key, value in vars(options).items() if key not in _NEUTRAL}
    asked = data(scene, {**given, **known})
    if options.out is not None:
        return Request(asked, None, text)
    try:
        own = partialslip.load_scene(options.scene) if scene and options.overrides else scene
    except InputError:  # the file lacks what --set gives
        return Request(asked, None, text)
    return Request(asked, data(own, {**{key: options.default(key) for key in given}, **usual()}), text)


def _content(scene: "Scene | None", constants: bool) -> dict[str, Any]:
    """Return ``scene`` as plain data, without its title; with the units of its files and tables, and its ``constants``
    of fatigue criteria."""
    if scene is None:
        return {}
    import msgspec

    from partialslip.study.batch.ledger import scene_content

    more = {"shown_in": scene.shown_in} | ({"fatigue": msgspec.to_builtins(scene.fatigue)} if constants else {})
    if scene.tolerance:
        more["tolerance"] = msgspec.to_builtins(scene.tolerance)
    return {key: value for key, value in scene_content(scene).items() if key != "title"} | more


def _given_settings(settings: Mapping[str, object]) -> dict[str, object]:
    """Return ``settings`` that are given, as plain data."""
    from partialslip.tools.output.place import content

    return {
        key: content(value) if isinstance(value, Path) else value
        for key, value in settings.items()
        if value is not None and value is not False
    }


def print_written(files: list[Path], console: "Console", elsewhere: str = "") -> None:
    """Print the paths of ``files`` on ``console``, and why they are ``elsewhere`` than usual, if they are."""
    places = [f"{', '.join(names)} in {folder}" for folder, names in _by_folder(files).items()]
    text = str(files[0]) if len(files) == 1 else "; ".join(places)
    console.print(f"written: {text}{_why(elsewhere)}", soft_wrap=True, markup=False)


def _by_folder(files: list[Path]) -> dict[Path, list[str]]:
    """Return the names of ``files`` by folder."""
    return grouped((file.parent, file.name) for file in files)


def _why(elsewhere: str) -> str:
    return f" ({elsewhere})" if elsewhere else ""


def study_ledger(folder: Path) -> "Ledger":
    """Open the ledger of a study in ``folder``, from which a stopped study continues. Tell how many entries of the
    ledger were made by other source files."""
    from partialslip.cli.consoles import messages
    from partialslip.study.batch.ledger import Ledger

    ledger = Ledger(folder / "ledger.jsonl")
    if count := ledger.outdated:
        entries = "entries" if count > 1 else "entry"
        messages().print(f"{ledger.path}: {count:,} {entries} ignored: made by other source files", markup=False)
    return ledger


def print_outcome(
    outcome: "Run", options: argparse.Namespace, files: list[Path], lines: Sequence[str] = (), elsewhere: str = ""
) -> int:
    """Print a run and return the exit code.

    Parameters
    ----------
    outcome : Run
    options : Namespace
        With ``json`` set, only the record is printed. ``verbose``: with details.
    files : list of Path
        Files written.
    lines : sequence of str
        Lines to print before the last one.
    elsewhere : str
        Why the files are not in the usual folder, if they are not.
    """
    from partialslip.cli.consoles import output
    from partialslip.report import print_run, record

    if options.json:
        print(record(outcome, made=origin(options)).json, end="")
    else:
        console, folders = output(), _by_folder(files)
        places = [str(folder if len(names) > 1 else folder / names[0]) for folder, names in folders.items()]
        where = f"files in {', '.join(places)}{_why(elsewhere)}" if places else ""
        print_run(outcome, console, verbose=options.verbose, lines=lines, where=where)
        if options.verbose and files:
            print_written(files, console)
    return outcome.conclusion.code
