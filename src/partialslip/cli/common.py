"""What several commands share."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from partialslip.errors import InputError

if TYPE_CHECKING:
    import argparse

    from rich.console import Console

    Commands = argparse._SubParsersAction[Any]


def check_folder(out: str | None) -> None:
    """Raise InputError if ``--out`` names nothing."""
    if out == "":
        raise InputError("--out '': must name a folder")


def print_written(files: list[Path], console: "Console") -> None:
    """Say which files a command leaves behind."""
    console.print("written: " + ", ".join(map(str, files)), soft_wrap=True, markup=False)
