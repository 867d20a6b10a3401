"""A ledger: finished cases as JSON lines, appended one at a time, so that a stopped study can continue.

The key of a case is a checksum of scene, settings and the packages' source files. If one of them changes, the case is
solved again. Commit and versions are recorded only.
"""

import hashlib
import json
import os
import platform
import subprocess
from collections.abc import Iterable, Iterator, Mapping
from datetime import UTC, datetime
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import msgspec

from partialslip.errors import InputError
from partialslip.record import versions
from partialslip.scene import Scene

_PACKAGES = ("partialslip", "partialslip_fem", "partialslip_meshes")


class Machine(msgspec.Struct, frozen=True):
    """Machine that solved a case: operating ``system``, ``processor``, number of ``cores``."""

    system: str
    processor: str
    cores: int | None


class Made(msgspec.Struct, frozen=True, kw_only=True):
    """Origin of an entry.

    Parameters
    ----------
    at : str
        Date and time, UTC.
    versions : dict of str to str
        Versions of Python and packages.
    machine : Machine
    commit : str or None
        Commit of a clone; None outside a clone.
    code : str
        Checksum of the source files.
    """

    at: str = ""
    versions: dict[str, str]
    machine: Machine
    commit: str | None
    code: str


class Ledger:
    """Entries by key, stored in a file of JSON lines.

    Parameters
    ----------
    path : Path, optional
        File, created with the first entry. An unfinished last line, left by a killed study, is removed. Without a file
        the entries last as long as the object.

    Raises
    ------
    InputError
        If the file is not a ledger, or cannot be read or written.
    """

    def __init__(self, path: Path | None = None) -> None:
        self._path = path
        self._entries: dict[str, dict[str, Any]] = {}
        if path is None:
            return
        try:
            text = path.read_bytes() if path.exists() else b""
            whole, _, torn = text.rpartition(b"\n")
            if torn:
                os.truncate(path, len(text) - len(torn))
        except OSError as error:
            raise InputError(f"{path}: cannot be read: {error.strerror}") from None
        for number, line in enumerate(whole.splitlines(), start=1):
            try:
                entry = _unsealed(line)
                self._entries[entry["key"]] = entry
            except ValueError:
                raise InputError(
                    f"{path}: line {number}: must be an entry of a ledger, unchanged since it was written; remove the "
                    "line to solve the case again"
                ) from None

    @property
    def path(self) -> Path:
        """The file of a ledger that has one."""
        assert self._path
        return self._path

    def __contains__(self, key: str) -> bool:
        return key in self._entries

    def __getitem__(self, key: str) -> dict[str, Any]:
        return self._entries[key]

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return iter(self._entries.values())

    def __len__(self) -> int:
        return len(self._entries)

    @property
    def outdated(self) -> int:
        """Number of entries made by other source files than the present ones; the cases are solved again."""
        return sum(entry.get("made", {}).get("code") != source_checksum() for entry in self)

    def add(self, key: str, found: object) -> None:
        """Add an entry under ``key``; a file is synced to disk.

        Parameters
        ----------
        key : str
        found : mapping or Struct
            Content of the entry.

        Raises
        ------
        InputError
            If the file cannot be written.
        """
        made = msgspec.structs.replace(_origin(), at=datetime.now(UTC).isoformat(timespec="seconds"))
        entry = {"key": key, **msgspec.to_builtins(found), "made": msgspec.to_builtins(made)}
        if self._path:
            _append(self._path, _sealed(json.dumps(entry, allow_nan=False)) + b"\n")
        self._entries[key] = entry


def _append(path: Path, line: bytes) -> None:
    """Append ``line`` to the file and sync the file to disk."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with open(path, "ab", buffering=0) as file:
            file.write(line)
            os.fsync(file.fileno())
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None


_SEAL = b', "sum": "'


def _sealed(entry: str) -> bytes:
    """Append a checksum of the text to ``entry``, a JSON object, as the last key."""
    text = entry.encode()
    return text[:-1] + _SEAL + _sum(text) + b'"}'


def _unsealed(line: bytes) -> dict[str, Any]:
    """Return the entry of a line. Raises ValueError if the checksum of :func:`_sealed` does not match."""
    text, seal, end = line.rpartition(_SEAL)
    text += b"}"
    if not seal or end != _sum(text) + b'"}':
        raise ValueError
    entry: dict[str, Any] = json.loads(text)
    return entry


def _sum(text: bytes) -> bytes:
    return hashlib.sha256(text).hexdigest()[:16].encode()


def key_of(data: Mapping[str, Any]) -> str:
    """Return the key of plain ``data``: a checksum of the data and of the source files."""
    text = json.dumps({"data": data, "code": source_checksum()}, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def scene_content(scene: Scene) -> dict[str, Any]:
    """Return ``scene`` as plain data, with checksums of its mesh files (None for a file that cannot be read).

    The units in which the scene is shown are left out: they change no result, and entries are in SI units.
    """
    files = [body.mesh for _, body in scene.bodies if body.mesh is not None]
    content = msgspec.to_builtins(scene)
    del content["shown_in"]
    return {**content, "mesh files": {file: _checksum([Path(file)]) for file in files}}


@cache
def source_checksum() -> str:
    """Return the checksum of all installed files of the packages, code and data."""
    roots = [Path(place) for name in _PACKAGES for place in find_spec(name).submodule_search_locations]  # type: ignore[union-attr]
    return checksum_of(roots)


def checksum_of(folders: Iterable[Path]) -> str:
    """Return the checksum of names and contents of the files in ``folders``, without ``__pycache__``."""
    files = [path for folder in folders for path in sorted(folder.rglob("*")) if path.is_file()]
    return _checksum([path for path in files if "__pycache__" not in path.parts]) or ""


def _checksum(files: Iterable[Path]) -> str | None:
    found = hashlib.sha256()
    try:
        for path in files:
            found.update(f"{path.name}\0{path.stat().st_size}\0".encode())
            found.update(path.read_bytes())
    except OSError:
        return None
    return found.hexdigest()[:16]


@cache
def _origin() -> Made:
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
