"""What several commands share."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from partialslip.errors import InputError

if TYPE_CHECKING:
    import argparse

    from rich.console import Console

    Commands = argparse._SubParsersAction[Any]


def add_scene(parser: "argparse.ArgumentParser") -> None:
    """Add the scene and ``--set``, the changes to it."""
    parser.add_argument("scene", metavar="SCENE", help="a shipped scene (see: partialslip scenes) or a TOML file")
    parser.add_argument("--set", dest="overrides", action="append", default=[], metavar="KEY=VALUE",
                        help="change a setting of the scene, e.g. load.P=2e5; may be repeated")  # fmt: skip


def check_folder(out: str | None) -> None:
    """Raise InputError if ``--out`` names nothing."""
    if out == "":
        raise InputError("--out '': must name a folder")


def print_written(files: list[Path], console: "Console") -> None:
    """Say which files a command leaves behind."""
    console.print("written: " + ", ".join(map(str, files)), soft_wrap=True, markup=False)
