"""Functions shared by several commands."""

from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

from partialslip.errors import InputError

if TYPE_CHECKING:
    import argparse

    from rich.console import Console

    from partialslip.batch.ledger import Ledger
    from partialslip.origin import Made
    from partialslip.report.page import Section
    from partialslip.run import Run
    from partialslip.scene import Scene

    Commands = argparse._SubParsersAction[Any]


def add_scene(parser: "argparse.ArgumentParser") -> None:
    """Add SCENE and ``--set`` to ``parser``."""
    parser.add_argument("scene", metavar="SCENE", help="a shipped scene (see: partialslip scenes) or a TOML file")
    parser.add_argument("--set", dest="overrides", action="append", default=[], metavar="KEY=VALUE",
                        help="change a setting of the scene, e.g. load.P=2e5; may be repeated")  # fmt: skip


def add_pdf(parser: "argparse.ArgumentParser") -> None:
    """Add ``--pdf`` to ``parser``."""
    parser.add_argument("--pdf", action="store_true", help="also write the report as report.pdf, A4")


def origin(options: "argparse.Namespace") -> "Made":
    """Return the origin of results by the command of ``options``: the same for what is printed and what is written."""
    from partialslip.origin import made_now

    if "made" not in options:
        options.made = made_now(options.line, options.overrides)
    made: Made = options.made
    return made


def check_report(options: "argparse.Namespace") -> None:
    """Raise MissingLibraryError if ``--pdf`` is given and a library is missing, before anything is solved."""
    if options.pdf:
        from partialslip.output.pdf import check_pdf

        check_pdf("--pdf")


def write_study(
    options: "argparse.Namespace",
    folder: Path,
    title: str,
    scene: "Scene",
    sections: "list[Section]",
) -> list[Path]:
    """Write the report of a study into ``folder``. Returns the paths."""
    from partialslip.report.files import write_page
    from partialslip.report.page import study_page

    return write_page(study_page(title, scene, origin(options), sections), folder, pdf=options.pdf)


def held(folder: Path | None) -> AbstractContextManager[None]:
    """Lock ``folder`` until the block ends. Raises InputError if another process writes to the folder."""
    from partialslip.output.lock import locked

    return nullcontext() if folder is None else locked(folder)


def check_folder(out: str | None) -> None:
    """Raise InputError if ``out``, the value of ``--out``, is empty."""
    if out == "":
        raise InputError("--out '': must name a folder")


def out_folder(options: "argparse.Namespace", name: str) -> Path | None:
    """Return the folder for the files of a run: ``--out`` of ``options``, else results/``name``.

    With ``--json`` and without ``--out``, None: no files.
    """
    return Path(options.out) if options.out else None if options.json else Path("results") / name


def print_written(files: list[Path], console: "Console") -> None:
    """Print the paths of ``files`` on ``console``."""
    console.print("written: " + ", ".join(map(str, files)), soft_wrap=True, markup=False)


def print_outdated(ledger: "Ledger", console: "Console") -> None:
    """Print on ``console`` how many entries of ``ledger`` were made by other source files."""
    if count := ledger.outdated:
        console.print(f"{ledger.path}: {count:,} entries ignored: made by other source files", markup=False)


def print_outcome(outcome: "Run", options: "argparse.Namespace", files: list[Path], last: str = "") -> int:
    """Print a run and return the exit code.

    Parameters
    ----------
    outcome : Run
    options : Namespace
        With ``json`` set, only the record is printed.
    files : list of Path
        Files written.
    last : str
        Line to print after the run.
    """
    from partialslip.cli.consoles import output
    from partialslip.judge import Outcome
    from partialslip.report import print_run, record

    if options.json:
        print(record(outcome, made=origin(options)).json, end="")
    else:
        console = output()
        print_run(outcome, console)
        if last:
            console.print(last, soft_wrap=True, markup=False)
        print_written(files, console)
    return 1 if outcome.outcome is Outcome.MISSED else 0
