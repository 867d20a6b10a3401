"""Files that meshio opens: what they refer to is checked, and what meshio prints is kept away."""

import io
import os
import re
import sys
import threading
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import LARGEST_MESH, opened

_one = threading.Lock()  # sys.stdout, sys.stderr and the warning filters are shared by all threads
_INCLUDES = re.compile(rb"^\*\s*INCLUDE\b[^\n]*=([^\n]*)", re.IGNORECASE | re.MULTILINE)  # Abaqus
_ELSEWHERE = re.compile(rb"<DataItem\b[^>]*Format\s*=\s*[\"'](?:Binary|HDF)[\"'][^>]*>([^<]*)<", re.IGNORECASE)  # XDMF
_REFERS = {".inp": _INCLUDES, ".xdmf": _ELSEWHERE, ".xmf": _ELSEWHERE}
_MOST = 64  # limit: files


class _Caught:
    """A stream that collects the output of its own thread and passes on the output of other threads."""

    def __init__(self, printed: io.StringIO, stream: Any) -> None:
        self._printed, self._stream, self._thread = printed, stream, threading.get_ident()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._printed if threading.get_ident() == self._thread else self._stream, name)


@contextmanager
def quiet() -> Iterator[io.StringIO]:
    """Collect the output of this thread and suppress warnings; yields the stream with the output."""
    printed = io.StringIO()
    with _one, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        out, err = _Caught(printed, sys.stdout), _Caught(printed, sys.stderr)
        with redirect_stdout(out), redirect_stderr(err):
            yield printed


def check_files(path: str | os.PathLike[str], named: str) -> dict[Path, bytes]:
    """Return the texts of ``path`` and of the files that it refers to, of formats that refer to files.

    Raise InputError if one of them cannot be read or is not a regular file: meshio would wait for a pipe, and read a
    device without end. ``named`` is the name of ``path`` in messages."""
    found, texts = {Path(path): named}, dict[Path, bytes]()
    for file, its in (unseen := list(found.items())):
        with opened(file, LARGEST_MESH, its) as content:
            pattern = _REFERS.get(file.suffix.lower())
            text = content.read() if pattern else b""
        texts |= {file: text} if pattern else {}
        for other in _referred(file, pattern, text) if pattern else ():
            if other not in found:
                found[other] = f"{named}: {other}"
                unseen.append((other, found[other]))
        if len(found) > _MOST:
            raise InputError(f"{named}: cannot be read: refers to more than {_MOST} files")
    return texts


def spliced(path: Path, texts: Mapping[Path, bytes], named: str, above: tuple[Path, ...] = ()) -> bytes:
    """Return the deck of Abaqus at ``path`` with the files that it includes in their places, from ``texts``."""
    if path in above:
        raise InputError(f"{named}: {path}: must not include itself")

    def content(line: re.Match[bytes]) -> bytes:
        return b"\n".join(spliced(each, texts, named, (*above, path)) for each in _referred(path, _INCLUDES, line[0]))

    return _INCLUDES.sub(content, texts[path])


def _referred(file: Path, pattern: re.Pattern[bytes], text: bytes) -> Iterator[Path]:
    """Files that the ``text`` of ``file`` refers to, in the folders in which meshio looks for them."""
    for each in pattern.findall(text):
        name = each.decode("utf-8", "replace").strip()
        if pattern is _ELSEWHERE:
            name = name.partition(":")[0]
        places = [Path(name), file.parent / name] if name else []
        yield from [place for place in places if os.path.lexists(place)] or places[1:]
