"""What several commands share."""

from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

from partialslip.errors import InputError

if TYPE_CHECKING:
    import argparse

    from rich.console import Console

    from partialslip.batch.ledger import Ledger
    from partialslip.run import Run

    Commands = argparse._SubParsersAction[Any]


def add_scene(parser: "argparse.ArgumentParser") -> None:
    """Add the scene and ``--set``, the changes to it."""
    parser.add_argument("scene", metavar="SCENE", help="a shipped scene (see: partialslip scenes) or a TOML file")
    parser.add_argument("--set", dest="overrides", action="append", default=[], metavar="KEY=VALUE",
                        help="change a setting of the scene, e.g. load.P=2e5; may be repeated")  # fmt: skip


def held(folder: Path | None) -> AbstractContextManager[None]:
    """Hold ``folder`` for this command, until the block ends. Raises InputError if another one writes there."""
    from partialslip.output.lock import locked

    return nullcontext() if folder is None else locked(folder)


def check_folder(out: str | None) -> None:
    """Raise InputError if ``--out`` names nothing."""
    if out == "":
        raise InputError("--out '': must name a folder")


def out_folder(options: "argparse.Namespace", name: str) -> Path | None:
    """Where a run's files go: into ``--out``, or results/NAME; with ``--json`` into ``--out`` alone."""
    return Path(options.out) if options.out else None if options.json else Path("results") / name


def print_written(files: list[Path], console: "Console") -> None:
    """Say which files a command leaves behind."""
    console.print("written: " + ", ".join(map(str, files)), soft_wrap=True, markup=False)


def print_outdated(ledger: "Ledger", console: "Console") -> None:
    """Say how many entries of a study's ledger the program no longer fits."""
    if count := ledger.outdated:
        console.print(f"{ledger.path}: {count:,} entries are by other source files: not used", markup=False)


def print_outcome(outcome: "Run", options: "argparse.Namespace", files: list[Path], last: str = "") -> int:
    """Print a run, a ``last`` line and which files there are, or with ``--json`` the record alone. Returns the exit
    code."""
    from partialslip.cli.consoles import output
    from partialslip.judge import Outcome
    from partialslip.report import print_run, record

    if options.json:
        print(record(outcome).json, end="")
    else:
        console = output()
        print_run(outcome, console)
        if last:
            console.print(last, soft_wrap=True, markup=False)
        print_written(files, console)
    return 1 if outcome.outcome is Outcome.MISSED else 0
