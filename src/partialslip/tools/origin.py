"""Origin of a result: date, command, versions, commit and machine."""

import hashlib
import os
import platform
import subprocess
from collections.abc import Iterable, Sequence
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

import msgspec

from partialslip.tools.errors import printable

_SOURCES = ("partialslip", "partialslip_fem", "partialslip_meshes")
_LIBRARIES = ("partialslip", "numpy", "scipy", "scikit-fem", "gmsh", "meshio")


class Machine(msgspec.Struct, frozen=True):
    """Machine that computed a result: operating ``system``, ``processor``, number of ``cores``."""

    system: str
    processor: str
    cores: int | None


class Made(msgspec.Struct, frozen=True, kw_only=True):
    """Origin of a result.

    Parameters
    ----------
    date : str
        Date and time, UTC.
    versions : dict of str to str
        Versions of Python and of the packages that compute the results.
    machine : Machine
    commit : str or None
        Commit of a clone; None outside a clone.
    code : str
        Checksum of the source files.
    command : str or None
        Command line; None for a call from Python.
    overrides : tuple of str
        Settings changed with ``--set``, as ``KEY=VALUE``.
    """

    date: str = ""
    versions: dict[str, str]
    machine: Machine
    commit: str | None
    code: str
    command: str | None = None
    overrides: tuple[str, ...] = ()


def made_now(command: str | None = None, overrides: Sequence[str] = ()) -> Made:
    """Return the origin of a result that is finished now, by ``command`` with the settings ``overrides``."""
    date = datetime.now(UTC).isoformat(timespec="seconds")
    told = None if command is None else printable(command)
    return msgspec.structs.replace(_here(), date=date, command=told, overrides=tuple(map(printable, overrides)))


def origin_lines(origins: Sequence[Made]) -> list[tuple[str, str]]:
    """Return rows of key and text about ``origins``: date, command, settings, commit, versions and machine.

    Several origins share rows; each text appears once.
    """
    dates = sorted(origin.date.replace("T", " ").replace("+00:00", " UTC") for origin in origins)
    machines = [origin.machine for origin in origins]
    found = {
        "date": [" to ".join(dict.fromkeys([dates[0], dates[-1]]))] if dates else [],
        "command": [origin.command for origin in origins if origin.command],
        "overrides": [", ".join(origin.overrides) for origin in origins if origin.overrides],
        "version": [", ".join(map(" ".join, origin.versions.items())) for origin in origins],
        "commit": [origin.commit or "none: not from a clone" for origin in origins],
        "machine": [f"{each.processor}, {each.cores} cores, {each.system}" for each in machines],
    }
    return [(key, "; ".join(dict.fromkeys(texts))) for key, texts in found.items() if texts]


def versions() -> dict[str, str]:
    """Return the versions of Python and of the packages that compute the results."""
    return {"python": platform.python_version(), **_libraries()}


@cache
def _libraries() -> dict[str, str]:
    return {package: version(package) for package in _LIBRARIES}


@cache
def source_checksum() -> str:
    """Return the checksum of all installed files of the packages, code and data."""
    roots = [Path(place) for name in _SOURCES for place in find_spec(name).submodule_search_locations]  # type: ignore[union-attr]
    return checksum_of(roots)


def checksum_of(folders: Iterable[Path]) -> str:
    """Return the checksum of names and contents of the files in ``folders``, without ``__pycache__``; empty if a file
    cannot be read."""
    files = [path for folder in folders for path in sorted(folder.rglob("*")) if path.is_file()]
    found = hashlib.sha256()
    try:
        for path in files:
            if "__pycache__" not in path.parts:
                found.update(f"{path.name}\0{path.stat().st_size}\0".encode())
                found.update(path.read_bytes())
    except OSError:
        return ""
    return found.hexdigest()[:16]


@cache
def _here() -> Made:
    """Return versions, machine, checksum of the source files and, in a clone, the commit."""
    here = Path(__file__).parent
    git = ["git", "-C", str(here), "describe", "--always", "--dirty", "--abbrev=12"]
    try:
        commit = subprocess.run(git, capture_output=True, text=True, check=True, timeout=10).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        commit = None
    machine = Machine(platform.system(), _processor(), os.cpu_count())
    return Made(versions=versions(), machine=machine, commit=commit, code=source_checksum())


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text("utf-8").splitlines()
        return next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration, IndexError):
        return platform.processor() or platform.machine()
