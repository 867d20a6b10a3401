"""Files: written whole or not at all; tables as CSV, data as JSON."""

import csv
import errno
import filecmp
import functools
import glob
import io
import itertools
import os
import tempfile
import zipfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

import msgspec

from partialslip.tools.errors import InputError, printable
from partialslip.tools.inputfile import check_replaceable
from partialslip.tools.output.lock import TRIES, is_at, lock, make_folder

_EARLY = (1980, 1, 1, 0, 0, 0)  # fixed: date of all files in an archive
_FORMULA = ("=", "+", "-", "@")  # what a formula begins with


def csv_text(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a table with headings ``head`` and ``rows`` as the text of a CSV file.

    Text that a spreadsheet would take for a formula, such as the name of a file that begins with =, begins with an
    apostrophe instead.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerows(
        [_safe_cell(cell) if isinstance(cell, str) else cell for cell in row] for row in itertools.chain([head], rows)
    )
    return text.getvalue()


@functools.lru_cache(1024)  # cost: a column repeats its text
def _safe_cell(cell: str) -> str:
    """Return ``cell`` without control characters, and with an apostrophe if it would be a formula. Numbers in text are
    none."""
    cell = printable(cell)
    if not cell.startswith(_FORMULA):
        return cell
    try:
        float(cell)
    except ValueError:
        return f"'{cell}"
    return cell


def json_text(data: object) -> str:
    """Return ``data``, of types known to msgspec, as indented JSON text; null in place of NaN and infinity."""
    return msgspec.json.format(msgspec.json.encode(data), indent=1).decode() + "\n"


def zipped(content: Mapping[str, bytes]) -> bytes:
    """Return files, by name, as a ZIP archive: the same content gives the same bytes."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in content.items():
            archive.writestr(zipfile.ZipInfo(name, _EARLY), data, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


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
    with _writing(folder, files):
        for name, write in files.items():
            with _beside(folder / name, write) as made:
                made.replace(folder / name)
    return [folder / name for name in files]


def write_new_file(path: Path, write: Callable[[Path], object]) -> bool:
    """Write a file at ``path`` unless a file with other content is there.

    Parameters
    ----------
    path : Path
    write : callable
        Writes to the path given to it.

    Returns
    -------
    bool
        Whether the file at ``path`` now has the content.

    Raises
    ------
    InputError
        If the folder cannot be written.
    """
    with _writing(path.parent, [path.name]), _beside(path, write) as made:
        try:
            os.link(made, path)  # fails if the file exists, whoever has written it meanwhile
        except FileExistsError:
            return filecmp.cmp(made, path, shallow=False)
        except OSError:  # a file system without hard links
            if path.exists():
                return filecmp.cmp(made, path, shallow=False)
            made.replace(path)
        return True


def files_in(folder: Path, pattern: str) -> list[Path]:
    """Return the paths in ``folder`` that match ``pattern``, sorted, without hidden ones.

    A hidden file may be a temporary one that a killed command has left.
    """
    return sorted(path for path in folder.glob(pattern) if not path.name.startswith("."))


def write_texts(folder: Path, texts: Mapping[str, str]) -> list[Path]:
    """Write UTF-8 ``texts``, by file name, into ``folder`` with :func:`write_files`. Returns the paths."""

    def writer(text: str) -> Callable[[Path], object]:
        return lambda path: path.write_text(text, "utf-8")

    return write_files(folder, {name: writer(text) for name, text in texts.items()})


@contextmanager
def _writing(folder: Path, names: Iterable[str]) -> Iterator[None]:
    """Create ``folder`` for files of these ``names``. Turn errors of the block into InputError."""
    for name in names:
        check_replaceable(folder / name)
    try:
        make_folder(folder)
        yield
    except (OSError, ValueError) as error:  # ValueError: invalid file name
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(f"--out {folder}: cannot be written: {reason}") from None


@contextmanager
def _beside(path: Path, write: Callable[[Path], object]) -> Iterator[Path]:
    """Provide a temporary path beside ``path``, written by ``write``; removed at the end unless it got another name.

    Temporary files of killed writes are removed.
    """
    beginning, ending = f".{path.stem}-", f".partial{path.suffix}"
    for left in path.parent.glob(glob.escape(beginning) + "*" + glob.escape(ending)):
        _unlink_if_free(left)
    handle, made = _locked_file(path.parent, beginning, ending)
    try:
        write(made)
        made.chmod(0o666 & ~_umask())
        os.fsync(handle)  # the content must be on the disk before the name
        yield made
    finally:
        os.close(handle)
        made.unlink(missing_ok=True)


def _locked_file(folder: Path, beginning: str, ending: str) -> tuple[int, Path]:
    """Make a temporary file and lock it. Returns the handle and the path.

    Until the file is locked, another process takes it for one of a killed write, and may remove it: then another file
    is made.
    """
    for _ in range(TRIES):
        handle, name = tempfile.mkstemp(dir=folder, prefix=beginning, suffix=ending)
        if lock(handle) is not False and is_at(handle, Path(name)):
            return handle, Path(name)
        os.close(handle)
    raise OSError(errno.EBUSY, "other processes keep removing its temporary files")


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
