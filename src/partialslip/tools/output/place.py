"""Choose the place of a command's files: it follows from the request, and nothing is overwritten in silence.

A request is command, scene and the settings that change the results. The plain request is that of the command without
options, for the scene as its file has it. A plain request goes to NAME, all others go to NAME-HASH, with a checksum of
the request: the same request goes to the same folder, whatever ran before. One case is left: two scene files of one
name, or two editions of one file, both have plain requests. Then NAME belongs to the request that it holds, and the
other one goes to its NAME-HASH.

A hidden file in the folder holds the request that the files answer. The same request overwrites the files. A folder
that holds something else is refused. A single file is overwritten only by the same content.
"""

import hashlib
import json
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import checksum, opened, read_bytes
from partialslip.tools.output.files import write_files, write_new_file, write_texts
from partialslip.tools.output.lock import FolderInUseError, locked
from partialslip.tools.strictjson import decoded

REQUEST_NAME = ".partialslip"
# Files of results: a folder that holds one of them, but no request, was written by an earlier version or copied.
RESULTS = ("results.json", "report.html", "ledger.jsonl", "effects.json", "fatigue.json", "map.csv", "page.html",
           "tolerance.csv", "meta.toml")  # fmt: skip
_TRIES, _PAUSE = 20, 0.1  # cost: s: the holder of a lock writes the request at once
_LARGEST, _LARGEST_REQUEST = 2**40, 2**24  # limit: bytes of a file, and of a request
_LONGEST, _MOST = 24, 3  # display: characters of a setting, and number of settings, in a message
_DIGITS = 8  # limit: of a checksum in a name: two of 1,000 requests share one by a chance of 1e-4: one is refused
_WHO = ("command", "scene.name")  # whose files they are

Data = Mapping[str, Any]


def _as_json(_: str, value: object) -> str:
    """Return the value of a setting as text."""
    return f"{value:g}" if isinstance(value, float) else json.dumps(value)


@dataclass(frozen=True)
class Request:
    """Request of a command: files are overwritten only by the same request.

    Parameters
    ----------
    asked : mapping
        Plain data: ``command``, ``scene`` and ``settings``, with all that changes the results.
    plain : mapping or None
        The same of the command without options, for the scene as its file has it. None if there is no such request, as
        the file needs an option to be a scene, or if the user names the place.
    text : callable, optional
        ``text(key, value)``: the value of a setting as the user knows it, by dotted key.
    """

    asked: Data
    plain: Data | None
    text: Callable[[str, object], str] = field(default=_as_json, compare=False)

    def __post_init__(self) -> None:
        for key in ("asked", "plain"):  # as JSON reads them back
            object.__setattr__(self, key, json.loads(json.dumps(getattr(self, key))))

    def places(self, usual: Path, suffix: str = "") -> list[Path]:
        """Return where the answer may go, the first choice first: ``usual`` for a plain request only, and ``usual``
        with a checksum of the request before ``suffix``."""
        text = json.dumps(self.asked, sort_keys=True)
        digest = hashlib.sha256(text.encode()).hexdigest()[:_DIGITS]
        own = usual.with_name(f"{usual.name.removesuffix(suffix)}-{digest}{suffix}")
        return [usual, own] if self.asked == self.plain else [own]

    @property
    def changed(self) -> str:
        """Names of the settings that differ from the plain request, in words; empty if none do."""
        names = _differing(self.asked, self.plain) if self.plain is not None else []
        return f"settings: {_some([_key_for_user(name) for name in names])}" if names else ""


class Place(NamedTuple):
    """Place of a command's files.

    Parameters
    ----------
    path : Path
        Folder or file.
    elsewhere : str
        Why this is not the usual place, in words: the settings, or what the usual place holds. Empty if it is.
    """

    path: Path
    elsewhere: str = ""


@contextmanager
def placed(usual: Path, out: str | Path | None, request: Request, force: bool = False) -> Iterator[Place]:
    """Choose a folder for the answer to ``request``, and lock it until the block ends.

    Parameters
    ----------
    usual : Path
        Folder of plain requests. If ``out`` is None, other requests, and a plain one if ``usual`` holds the answer to
        another one, go to ``usual``-HASH (:meth:`Request.places`).
    out : str or Path or None
        Folder that the user names.
    request : Request
    force : bool
        Whether to overwrite the answer to another request. No file is removed.

    Raises
    ------
    InputError
        If the folder holds the answer to another request, it cannot be written, or another process answers the same
        request there.
    """
    folders, elsewhere = (request.places(usual), request.changed) if out is None else ([Path(out)], "")
    with ExitStack() as stack:
        for folder in folders:
            held = None if force else _other(folder, request)
            if held is None:
                try:
                    stack.enter_context(locked(folder))
                    held = None if force else _other(folder, request)
                    if held is None:
                        break
                    stack.pop_all().close()  # another process has just finished there
                except FolderInUseError:
                    if folder == folders[-1] or (held := _asked_by_holder(folder, request)) is None:
                        raise
            if folder == folders[-1]:
                raise InputError(f"--out {folder}: holds {held}: name another folder, or overwrite it with --force")
            elsewhere = f"{folder} holds {held}"
        stack.enter_context(_answering(folder, request.asked))
        yield Place(folder, elsewhere)


def write_placed(
    usual: Path, out: str | Path | None, request: Request, write: Callable[[Path], object], force: bool = False
) -> Place:
    """Write one file, at ``out`` if the user names it, else at ``usual`` or ``usual``-HASH, as :func:`placed` chooses a
    folder. A file does not hold its request: its content decides whether it may be overwritten.

    Parameters
    ----------
    usual : Path
    out : str or Path or None
    request : Request
    write : callable
        Writes to the path given to it.
    force : bool
        Whether to overwrite a file with other content.

    Raises
    ------
    InputError
        If the file has other content, or the folder cannot be written.
    """
    paths, elsewhere = (request.places(usual, usual.suffix), request.changed) if out is None else ([Path(out)], "")
    if force:
        write_files(paths[0].parent, {paths[0].name: write})
        return Place(paths[0], elsewhere)
    for path in paths:
        if write_new_file(path, write):
            return Place(path, elsewhere)
        elsewhere = f"{path} {_first_lines(path)}"
    raise InputError(f"--out {path}: {_first_lines(path)}: name another file, or overwrite it with --force")


def content(path: Path) -> list[str]:
    """Return the name of an input file, without the folder, and a checksum of its content, for a request."""
    return [path.name, checksum(path, _LARGEST)[:16]]


@contextmanager
def _answering(folder: Path, asked: Data) -> Iterator[None]:
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
                (folder / REQUEST_NAME).unlink()
            elif _files(folder) == files and before != asked:
                _write_request(folder, before)
        raise


def _write_request(folder: Path, request: Data | None) -> None:
    write_texts(folder, {REQUEST_NAME: json.dumps(request, indent=1) + "\n"})


def _other(folder: Path, request: Request) -> str | None:
    """Return in words what ``folder`` holds; None if it holds no results, or the answer to ``request``."""
    held, files = _request(folder), _files(folder)
    if not files or held == request.asked:
        return None
    if held is None:
        own = next((name for name in RESULTS if name in files and (folder / name).is_file()), None)
        return None if own is None else f"{own} of unknown settings"
    return _in_words(held, request)


def _asked_by_holder(folder: Path, request: Request) -> str | None:
    """Return in words what the process that has locked ``folder`` answers; None if it answers ``request``, or if it
    does not say."""
    for _ in range(_TRIES):
        if (held := _request(folder)) is not None:
            return None if held == request.asked else _in_words(held, request)
        time.sleep(_PAUSE)
    return None


def _request(folder: Path) -> dict[str, Any] | None:
    """Return the request that the files in ``folder`` answer; None if there is none."""
    try:
        return decoded(read_bytes(folder / REQUEST_NAME, _LARGEST_REQUEST), dict, REQUEST_NAME)
    except InputError:  # none, or no JSON
        return None


def _files(folder: Path) -> dict[str, int]:
    """Return the times of the last change of all files in ``folder`` that are not hidden, by name."""
    try:
        return {path.name: path.stat().st_mtime_ns for path in folder.iterdir() if not path.name.startswith(".")}
    except (OSError, ValueError):  # none yet, no folder, or no valid name
        return {}


def _in_words(held: Data, request: Request) -> str:
    """Return the request ``held`` in words, with the settings that differ from ``request``."""
    theirs, differ = _flat(held), _differing(held, request.asked)
    who = " ".join(str(theirs[key]) for key in _WHO if theirs.get(key))
    if any(key in differ for key in _WHO):
        return who
    return f"{who} with other settings: {_some([_setting(key, theirs.get(key), request.text) for key in differ])}"


def _differing(one: Data, other: Data) -> list[str]:
    """Return the dotted names of the settings in which two requests differ."""
    first, second = _flat(one), _flat(other)
    return [key for key in {**first, **second} if first.get(key) != second.get(key)]


def _some(texts: list[str]) -> str:
    """Return the first few of ``texts``, and how many more there are."""
    more = [f"{len(texts) - _MOST} more"] if len(texts) > _MOST else []
    return ", ".join(texts[:_MOST] + more)


def _setting(key: str, value: object, text: Callable[[str, object], str]) -> str:
    name = _key_for_user(key)
    if value is None:
        return f"no {name}"
    told = text(name, value)
    return f"{name} = {told}" if len(told) <= _LONGEST else f"other {name}"


def _key_for_user(key: str) -> str:
    """Return a dotted name of a request as the user knows it."""
    return key.removeprefix("scene.").removeprefix("settings.")


def _flat(request: Data, before: str = "") -> dict[str, Any]:
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
