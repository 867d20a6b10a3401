"""A ledger: finished cases as JSON lines, written one at a time and never changed, so that a study can be continued."""

import hashlib
import json
import os
import platform
import subprocess
from collections.abc import Iterator, Mapping
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any

from partialslip.errors import InputError
from partialslip.report.record import versions


class Ledger:
    """Entries by key, kept in a file of JSON lines.

    Parameters
    ----------
    path : Path
        Made with the first entry. A last line that a killed study left unfinished is dropped.

    Raises
    ------
    InputError
        If the file is not a ledger, or cannot be read or written.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._entries: dict[str, dict[str, Any]] = {}
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
                    f"{path}: line {number}: must be an entry of a ledger, as it was written: remove the line, and its "
                    "case is solved again"
                ) from None

    def __contains__(self, key: str) -> bool:
        return key in self._entries

    def __getitem__(self, key: str) -> dict[str, Any]:
        return self._entries[key]

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return iter(self._entries.values())

    def __len__(self) -> int:
        return len(self._entries)

    def add(self, key: str, found: Mapping[str, Any]) -> None:
        """Append an entry, on the disk when this returns. Raises InputError if the file cannot be written."""
        entry = {"key": key, **found, "made": {"at": datetime.now(UTC).isoformat(timespec="seconds"), **_origin()}}
        line = _sealed(json.dumps(entry, allow_nan=False)) + b"\n"
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            with open(self.path, "ab", buffering=0) as file:
                file.write(line)
                os.fsync(file.fileno())
        except OSError as error:
            raise InputError(f"{self.path}: cannot be written: {error.strerror}") from None
        self._entries[key] = entry


_SEAL = b', "sum": "'


def _sealed(entry: str) -> bytes:
    """An entry, a JSON object, with a checksum of its text as its last key: what reads it can rely on its shape."""
    text = entry.encode()
    return text[:-1] + _SEAL + _sum(text) + b'"}'


def _unsealed(line: bytes) -> dict[str, Any]:
    """The entry of a line. Raises ValueError if it is not as :func:`_sealed` has made it."""
    text, seal, end = line.rpartition(_SEAL)
    text += b"}"
    if not seal or end != _sum(text) + b'"}':
        raise ValueError
    entry: dict[str, Any] = json.loads(text)
    return entry


def _sum(text: bytes) -> bytes:
    return hashlib.sha256(text).hexdigest()[:16].encode()


def key_of(data: Mapping[str, Any]) -> str:
    """A key that is the same for the same plain data only."""
    return hashlib.sha256(json.dumps(data, sort_keys=True).encode()).hexdigest()[:16]


@cache
def _origin() -> dict[str, Any]:
    """Versions, machine and, in a clone, the commit."""
    here = Path(__file__).parent
    git = ["git", "-C", str(here), "describe", "--always", "--dirty", "--abbrev=12"]
    try:
        commit = subprocess.run(git, capture_output=True, text=True, check=True, timeout=10).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        commit = None
    machine = {"system": platform.system(), "processor": _processor(), "cores": os.cpu_count()}
    return {"versions": versions(), "machine": machine, "commit": commit}


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text("utf-8").splitlines()
        return next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration, IndexError):
        return platform.processor() or platform.machine()
