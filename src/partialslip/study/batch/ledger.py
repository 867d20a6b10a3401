"""A ledger: finished cases as JSON lines, appended one at a time, so that a stopped study can continue.

The key of a case is a checksum of scene, settings and the packages' source files. If one of them changes, the case is
solved again. Commit and versions are recorded only.
"""

import errno
import hashlib
import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from partialslip.scene import Scene
from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import LARGEST_MESH, check_replaceable, checksum, read_bytes, reason
from partialslip.tools.origin import made_now, source_checksum
from partialslip.tools.output.lock import make_folder
from partialslip.tools.strictjson import decoded

_Kind = TypeVar("_Kind")

_LARGEST = 2**32  # limit: bytes of a file


class Ledger:
    """Entries by key, stored in a file of JSON lines.

    Parameters
    ----------
    path : Path, optional
        File, created with the first entry. An unfinished last entry, left by a killed study, is removed. Without a
        file the entries last as long as the object.

    Raises
    ------
    InputError
        If the file is not a ledger, or cannot be read or written; the file is then as before.
    """

    def __init__(self, path: Path | None = None) -> None:
        self._path = path
        self._entries: dict[str, dict[str, Any]] = {}
        if path is None:
            return
        text = read_bytes(path, _LARGEST) if os.path.lexists(path) else b""
        *lines, last = text.split(b"\n")
        torn = _is_torn(last)
        for number, line in enumerate(lines if torn or not last else [*lines, last], start=1):
            try:
                entry = _unsealed(line)
                self._entries[entry["key"]] = entry
            except (ValueError, KeyError):
                raise InputError(
                    f"{path}: line {number}: must be an entry of a ledger, unchanged since it was written; remove the "
                    "line to solve the case again"
                ) from None
        if torn:
            _cut(path, len(last))
        elif last:
            _append(path, b"\n")

    @property
    def path(self) -> Path:
        """The file of a ledger that has one."""
        assert self._path
        return self._path

    def __contains__(self, key: str) -> bool:
        return key in self._entries

    def __getitem__(self, key: str) -> dict[str, Any]:
        return self._entries[key]

    def read(self, key: str, kind: type[_Kind]) -> _Kind:
        """Return the entry under ``key`` as a ``kind``.

        Raises
        ------
        InputError
            If the entry has other fields, as one that some other program has written.
        """
        try:
            return msgspec.convert(self._entries[key], kind)
        except msgspec.ValidationError as error:
            raise InputError(
                f"{self._path}: entry {key}: {error!s:.300}; remove its line to solve the case again"
            ) from None

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
        entry = {"key": key, **msgspec.to_builtins(found), "made": msgspec.to_builtins(made_now())}
        if self._path:
            _append(self._path, _sealed(json.dumps(entry, allow_nan=False)) + b"\n")
        self._entries[key] = entry


def _append(path: Path, line: bytes) -> None:
    """Append ``line`` to the file and sync the file to disk. What was there before stays as it is, even if there is
    no room for the whole line."""
    check_replaceable(path)
    try:
        make_folder(path.parent)
        with open(path, "ab", buffering=0) as file:
            size = os.fstat(file.fileno()).st_size
            try:
                if file.write(line) < len(line):
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
                os.fsync(file.fileno())
            except OSError:
                file.truncate(size)
                raise
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {reason(error)}") from None


def _cut(path: Path, count: int) -> None:
    """Remove the last ``count`` bytes of the file."""
    try:
        with open(path, "rb+") as file:
            file.truncate(file.seek(-count, os.SEEK_END))
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {reason(error)}") from None


_BEGINS, _SEAL = b'{"key": "', b', "sum": "'


def _is_torn(line: bytes) -> bool:
    """Return whether ``line`` is the beginning of an entry, and not all of one. Text of somebody else is neither."""
    if not (line.startswith(_BEGINS) or (line and _BEGINS.startswith(line))):
        return False
    try:
        json.loads(line)
    except ValueError:
        return True
    except RecursionError:
        pass
    return False


def _sealed(entry: str) -> bytes:
    """Append a checksum of the text to ``entry``, a JSON object, as the last key."""
    text = entry.encode()
    return text[:-1] + _SEAL + _line_checksum(text) + b'"}'


def _unsealed(line: bytes) -> dict[str, Any]:
    """Return the entry of a line. Raises ValueError if the checksum of :func:`_sealed` does not match, or the
    line is no strict JSON."""
    text, seal, end = line.rpartition(_SEAL)
    text += b"}"
    if not seal or end != _line_checksum(text) + b'"}':
        raise ValueError
    return decoded(text, dict, "entry")


def _line_checksum(text: bytes) -> bytes:
    return hashlib.sha256(text).hexdigest()[:16].encode()


def case_key(data: Mapping[str, Any]) -> str:
    """Return the key of plain ``data``: a checksum of the data and of the source files."""
    text = json.dumps({"data": data, "code": source_checksum()}, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def scene_content(scene: Scene) -> dict[str, Any]:
    """Return ``scene`` as plain data, with checksums of its mesh files (None for a file that cannot be read).

    The units in which the scene is shown, the constants of fatigue criteria and tolerances are left out: they change no
    result, and entries are in SI units.
    """
    files = [body.mesh for _, body in scene.bodies if body.mesh is not None]
    content = msgspec.to_builtins(scene)
    del content["shown_in"], content["fatigue"], content["tolerance"]
    return {**content, "mesh files": {file: _sum_of_mesh(file) for file in files}}


def _sum_of_mesh(file: str) -> str | None:
    """Return the checksum of a mesh file; None if it cannot be read, which the method tells that needs the mesh."""
    try:
        return checksum(file, LARGEST_MESH)
    except InputError:
        return None
