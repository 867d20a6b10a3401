"""partialslip verify: the shipped scenes, hard cases or random scenes against their bars."""

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING

from partialslip.cli.common import check_folder, print_written
from partialslip.errors import InputError
from partialslip.run import METHODS

if TYPE_CHECKING:
    from partialslip.cli.common import Commands
    from partialslip.verify.suites import Makers

_SUITES = ("quick", "full", "stress")
_DEFAULTS = {"count": 100, "seed": 0, "method": "exact"}
_SHARE = 20  # of the time that may go into writing what is finished: a twentieth


def add(commands: "Commands") -> None:
    """Add the command to the parser."""
    verify = commands.add_parser(
        "verify",
        help="hold the methods against their bars: shipped scenes, hard cases, random scenes",
        description="Hold every method against its bars. What was interrupted goes on where it stopped.",
        examples=[
            "partialslip verify",
            "partialslip verify --suite full --only near-sliding-1e-6",
            "partialslip verify --suite stress --count 1000 --seed 0 --method march",
        ],
        failure="a bar missed",
    )
    verify.add_argument("--suite", choices=_SUITES, default="quick",
                        help="quick: the shipped scenes; full: these and the hard cases; stress: random scenes "
                        "(default: quick)")  # fmt: skip
    verify.add_argument("--only", action="append", default=[], metavar="NAME",
                        help="only these cases (* and ? stand for anything; of random scenes their numbers); may be "
                        "repeated")  # fmt: skip
    verify.add_argument("--count", metavar="N", help="stress: how many scenes (default: 100)")
    verify.add_argument("--seed", metavar="S", help="stress: other scenes (default: 0)")
    verify.add_argument("--method", metavar="METHOD", help="stress: exact, march or fem (default: exact)")
    verify.add_argument("--out", metavar="DIR", help="folder for the files (default: results/verify-SUITE)")
    verify.set_defaults(command=_verify)


def _verify(options: argparse.Namespace) -> int:
    check_folder(options.out)
    settings, makers = _suite(options)

    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    from partialslip.report.verdicts import print_verdicts, read_verdicts, write_verdicts
    from partialslip.verify import run_case

    folder = Path(options.out) if options.out else Path("results") / _folder(options)
    verdicts = {name: some for name, some in read_verdicts(folder, settings).items() if name in makers}
    messages = Console(stderr=True, highlight=False)
    if verdicts:
        messages.print(f"{len(verdicts)} cases were finished before", markup=False)
    files = write_verdicts(folder, settings, verdicts, finished=False)
    written, took = time.monotonic(), 0.0
    columns = (TextColumn("{task.description}", markup=False), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    try:
        with Progress(*columns, console=messages, transient=True) as progress:
            task = progress.add_task("", total=len(makers), completed=len(verdicts))
            for name, make in makers.items():
                if name in verdicts:
                    continue
                progress.update(task, description=name)
                verdicts[name] = run_case(make())
                progress.advance(task)
                if (now := time.monotonic()) > written + _SHARE * took:
                    write_verdicts(folder, settings, verdicts, finished=False)
                    written = time.monotonic()
                    took = written - now
    finally:
        write_verdicts(folder, settings, verdicts, finished=len(verdicts) == len(makers))
    console = Console(highlight=False)
    print_verdicts(verdicts, console, every=options.suite != "stress" or bool(options.only))
    print_written(files, console)
    return 0 if all(verdict.passed for some in verdicts.values() for verdict in some) else 1


def _suite(options: argparse.Namespace) -> "tuple[dict[str, object], Makers]":
    """What was asked for, and the cases."""
    settings: dict[str, object] = {"suite": options.suite, "only": options.only}
    if options.suite != "stress":
        for key in _DEFAULTS:
            if getattr(options, key) is not None:
                raise InputError(f"--{key} {getattr(options, key)}: only with --suite stress")

        from partialslip.verify import suite

        return settings, suite(options.suite, options.only)
    method = _DEFAULTS["method"] if options.method is None else options.method
    if method not in METHODS:
        raise InputError(f"--method {method!r}: must be one of {', '.join(METHODS)}")
    count, seed = _whole(options, "count", 1), _whole(options, "seed", 0)

    from partialslip.verify import stress_suite

    return {**settings, "method": method, "seed": seed}, stress_suite(method, seed, count, options.only)


def _whole(options: argparse.Namespace, key: str, least: int) -> int:
    text = str(_DEFAULTS[key] if getattr(options, key) is None else getattr(options, key))
    if not (text.isascii() and text.isdecimal() and len(text) <= 9 and int(text) >= least):
        raise InputError(f"--{key} {text!r}: must be a whole number from {least} to 999999999")
    return int(text)


def _folder(options: argparse.Namespace) -> str:
    parts = ["verify", options.suite, options.method if options.suite == "stress" else None]
    return "-".join([*filter(None, parts), *(["only"] if options.only else [])])
