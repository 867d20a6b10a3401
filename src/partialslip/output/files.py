"""Write files atomically: a stopped write leaves no partial file."""

import glob
import os
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from partialslip.errors import InputError
from partialslip.output.lock import lock


def write_files(folder: Path, files: Mapping[str, Callable[[Path], object]]) -> list[Path]:
    """Write ``files`` into ``folder``.

    Parameters
    ----------
    folder : Path
    files : mapping of str to callable
        By file name, a function that writes to the path given to it.

    Returns
    -------
    list of Path
        Paths of the files.

    Raises
    ------
    InputError
        If the folder cannot be written.
    """
    for name in files:
        if os.path.isdir(folder / name):
            raise InputError(f"{folder / name}: cannot be written: is a folder")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, write in files.items():
            with _replacing(folder / name) as path:
                write(path)
    except (OSError, ValueError) as error:  # ValueError: invalid file name
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(f"--out {folder}: cannot be written: {reason}") from None
    return [folder / name for name in files]


def write_texts(folder: Path, texts: Mapping[str, str]) -> list[Path]:
    """Write UTF-8 ``texts``, by file name, into ``folder`` with :func:`write_files`. Returns the paths."""

    def writer(text: str) -> Callable[[Path], object]:
        return lambda path: path.write_text(text, "utf-8")

    return write_files(folder, {name: writer(text) for name, text in texts.items()})


@contextmanager
def _replacing(path: Path) -> Iterator[Path]:
    """Provide a temporary path beside ``path``, which replaces ``path`` if the block succeeds.

    Temporary files of killed writes are removed.
    """
    beginning, ending = f".{path.stem}-", f".partial{path.suffix}"
    for left in path.parent.glob(glob.escape(beginning) + "*" + glob.escape(ending)):
        _unlink_if_free(left)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=beginning, suffix=ending)
    beside = Path(name)
    try:
        lock(handle)
        yield beside
        beside.chmod(0o666 & ~_umask())
        os.fsync(handle)  # the content must be on the disk before the name
        beside.replace(path)
    finally:
        os.close(handle)
        beside.unlink(missing_ok=True)


def _unlink_if_free(path: Path) -> None:
    """Remove a temporary file unless a process still writes it."""
    try:
        handle = os.open(path, os.O_RDWR)
    except OSError:
        return
    try:
        if lock(handle):
            path.unlink(missing_ok=True)
    finally:
        os.close(handle)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
