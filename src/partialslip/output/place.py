"""Choose the place of a command's files: nothing is overwritten in silence.

A hidden file in the folder holds the request that the files answer: command, scene and the settings that change the
results. The same request overwrites the files. Other requests go to another folder, NAME-2, NAME-3 and so on; a folder
that the user names is refused instead. A single file is overwritten only by the same content.
"""

import itertools
import json
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any, NamedTuple

from partialslip.errors import InputError
from partialslip.inputfile import checksum, opened, read_bytes
from partialslip.output.files import write_files, write_new_file, write_texts
from partialslip.output.lock import FolderInUseError, locked
from partialslip.strictjson import decoded

NAME = ".partialslip"
# Files of results: a folder that holds one of them, but no request, was written by an earlier version or copied.
RESULTS = ("results.json", "report.html", "ledger.jsonl", "effects.json", "fatigue.json", "map.csv", "page.html",
           "meta.toml")  # fmt: skip
_TRIES, _PAUSE = 20, 0.1  # cost: s: the holder of a lock writes the request at once
_LARGEST, _LARGEST_REQUEST = 2**40, 2**24  # limit: bytes of a file, and of a request
_LONGEST, _MOST = 24, 3  # display: characters of a setting, and number of settings, in a message

Request = Mapping[str, Any]


class Place(NamedTuple):
    """Place of a command's files.

    Parameters
    ----------
    path : Path
        Folder or file.
    passed : str
        What the usual place holds, in words, if the files go elsewhere; empty otherwise.
    """

    path: Path
    passed: str = ""


@contextmanager
def placed(usual: Path, out: str | Path | None, request: Request, force: bool = False) -> Iterator[Place]:
    """Choose a folder for the answer to ``request``, and lock it until the block ends.

    Parameters
    ----------
    usual : Path
        Folder if ``out`` is None. If it holds the answer to another request, ``usual``-2, ``usual``-3, ...
    out : str or Path or None
        Folder that the user names.
    request : mapping
        Plain data: ``command``, ``scene`` and ``settings``.
    force : bool
        Whether to overwrite the answer to another request. No file is removed.

    Raises
    ------
    InputError
        If ``out`` holds the answer to another request, the folder cannot be written, or another process answers the
        same request there.
    """
    asked, passed = _plain(request), ""
    with ExitStack() as stack:
        for folder in [Path(out)] if out is not None else _numbered(usual, ""):
            held = None if force else _other(folder, asked)
            if held is None:
                try:
                    stack.enter_context(locked(folder))
                    held = None if force else _other(folder, asked)
                    if held is None:
                        break
                    stack.pop_all().close()  # another process has just finished there
                except FolderInUseError:
                    if out is not None or (held := _asked_by_holder(folder, asked)) is None:
                        raise
            if out is not None:
                raise InputError(f"--out {folder}: holds {held}: name another folder, or overwrite it with --force")
            passed = passed or f"{folder} holds {held}"
        stack.enter_context(_answering(folder, asked))
        yield Place(folder, passed)


def write_placed(usual: Path, out: str | Path | None, write: Callable[[Path], object], force: bool = False) -> Place:
    """Write one file: at ``out`` if the user names it, else at ``usual``, or ``usual``-2, ``usual``-3, ...

    Parameters
    ----------
    usual : Path
    out : str or Path or None
    write : callable
        Writes to the path given to it.
    force : bool
        Whether to overwrite a file with other content.

    Raises
    ------
    InputError
        If ``out`` has other content, or the folder cannot be written.
    """
    passed = ""
    for path in [Path(out)] if out is not None else _numbered(usual, usual.suffix):
        if force:
            write_files(path.parent, {path.name: write})
            return Place(path)
        if write_new_file(path, write):
            return Place(path, passed)
        if out is not None:
            raise InputError(f"--out {path}: {_first_lines(path)}: name another file, or overwrite it with --force")
        passed = passed or f"{path} {_first_lines(path)}"
    raise AssertionError  # the numbers do not end


def content(path: Path) -> list[str]:
    """Return the name of an input file, without the folder, and a checksum of its content, for a request."""
    return [path.name, checksum(path, _LARGEST)[:16]]


def _numbered(usual: Path, suffix: str) -> Iterator[Path]:
    """Yield ``usual`` and the same name with -2, -3, ... before ``suffix``, without end."""
    yield usual
    for number in itertools.count(2):
        yield usual.with_name(f"{usual.name.removesuffix(suffix)}-{number}{suffix}")


def _plain(request: Request) -> dict[str, Any]:
    """Return ``request`` as JSON reads it back."""
    plain: dict[str, Any] = json.loads(json.dumps(request))
    return plain


@contextmanager
def _answering(folder: Path, asked: dict[str, Any]) -> Iterator[None]:
    """Write the request ``asked`` into ``folder``. An end by an exception that has written nothing else undoes it."""
    files = _files(folder)
    before = _request(folder) if files else None
    if before != asked:
        _write_request(folder, asked)
    try:
        yield
    except BaseException:
        with suppress(InputError, OSError):
            if _files(folder) == files and before is None:
                (folder / NAME).unlink()
            elif _files(folder) == files and before != asked:
                _write_request(folder, before)
        raise


def _write_request(folder: Path, request: Request | None) -> None:
    write_texts(folder, {NAME: json.dumps(request, indent=1) + "\n"})


def _other(folder: Path, asked: dict[str, Any]) -> str | None:
    """Return in words what ``folder`` holds; None if it holds no results, or the answer to ``asked``."""
    held, files = _request(folder), _files(folder)
    if not files or held == asked:
        return None
    if held is None:
        own = next((name for name in RESULTS if name in files and (folder / name).is_file()), None)
        return None if own is None else f"{own} of unknown settings"
    return _in_words(held, asked)


def _asked_by_holder(folder: Path, asked: dict[str, Any]) -> str | None:
    """Return in words what the process that has locked ``folder`` answers; None if it answers ``asked``, or if it does
    not say."""
    for _ in range(_TRIES):
        if (held := _request(folder)) is not None:
            return None if held == asked else _in_words(held, asked)
        time.sleep(_PAUSE)
    return None


def _request(folder: Path) -> dict[str, Any] | None:
    """Return the request that the files in ``folder`` answer; None if there is none."""
    try:
        return decoded(read_bytes(folder / NAME, _LARGEST_REQUEST), dict, NAME)
    except InputError:  # none, or no JSON
        return None


def _files(folder: Path) -> dict[str, int]:
    """Return the times of the last change of all files in ``folder`` that are not hidden, by name."""
    try:
        return {path.name: path.stat().st_mtime_ns for path in folder.iterdir() if not path.name.startswith(".")}
    except (OSError, ValueError):  # none yet, no folder, or no valid name
        return {}


def _in_words(held: Request, asked: Request) -> str:
    """Return the request ``held`` in words, with the settings that differ from ``asked``."""
    theirs, ours = _flat(held), _flat(asked)
    who = " ".join(str(theirs[key]) for key in ("command", "scene.name") if theirs.get(key))
    if any(theirs.get(key) != ours.get(key) for key in ("command", "scene.name")):
        return who
    differ = [key for key in {**theirs, **ours} if theirs.get(key) != ours.get(key)]
    shown = [_setting(key, theirs.get(key)) for key in differ[:_MOST]]
    more = [f"{len(differ) - _MOST} more"] if len(differ) > _MOST else []
    return f"{who} with other settings: {', '.join(shown + more)}"


def _setting(key: str, value: object) -> str:
    name = key.removeprefix("scene.").removeprefix("settings.")
    text = f"{value:g}" if isinstance(value, float) else json.dumps(value)
    return f"no {name}" if value is None else f"{name} = {text}" if len(text) <= _LONGEST else f"other {name}"


def _flat(request: Request, before: str = "") -> dict[str, Any]:
    """Return the settings of nested tables by dotted name."""
    flat: dict[str, Any] = {}
    for key, value in request.items():
        flat |= _flat(value, f"{before}{key}.") if isinstance(value, dict) else {f"{before}{key}": value}
    return flat


def _first_lines(path: Path) -> str:
    """Return in words what a file holds: its first two lines, shortened."""
    try:
        with opened(path, _LARGEST) as file:
            lines = [file.readline(200).decode("utf-8").strip() for _ in range(2)]
    except (InputError, ValueError):  # ValueError: no text
        lines = []
    text = " ".join(filter(None, lines))
    return f'holds other content, "{text[:60]}"' if text and text.isprintable() else "holds other content"
