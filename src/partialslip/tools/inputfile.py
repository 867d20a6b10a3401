"""Files from outside: regular files of limited size are read; others are refused with a one-line InputError.

Every module that reads a file of a user does so here. Opening a pipe may wait for ever, and reading a device such as
/dev/zero does not end.
"""

import hashlib
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from io import BufferedReader

from partialslip.tools.errors import InputError

LARGEST_MESH = 2**31  # limit: bytes of a mesh file
# An opened pipe does not wait for a writer. Windows reads text unless told otherwise.
_READ = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0)
_NOT_REGULAR = "must be a regular file, not a pipe or a device"

Name = str | os.PathLike[str]


@contextmanager
def opened(path: Name, most: int, named: str | None = None) -> Iterator[BufferedReader]:
    """Open ``path`` for reading while the block runs. OSErrors of the block are turned into InputErrors, too.

    Parameters
    ----------
    path : str or path
    most : int
        Largest size, bytes.
    named : str, optional
        Name of the file in messages; default: ``path``.

    Raises
    ------
    InputError
        If ``path`` cannot be read, is not a regular file, or has more than ``most`` bytes.
    """
    if not isinstance(path, (str, os.PathLike)):
        raise InputError(f"{path!r:.60}: must be the path of a file")
    told = os.fspath(path) if named is None else named
    try:
        with open(path, "rb", opener=lambda name, _: os.open(name, _READ)) as file:  # raises for a folder
            about = os.fstat(file.fileno())
            if not stat.S_ISREG(about.st_mode):
                raise InputError(f"{told}: cannot be read: {_NOT_REGULAR}")
            if about.st_size > most:
                raise InputError(f"{told}: {about.st_size} bytes: must be at most {most}")
            yield file
    except InputError:
        raise
    except (OSError, ValueError) as error:  # ValueError: invalid file name
        raise InputError(f"{told}: cannot be read: {reason(error)}") from None


def check_regular(path: Name, most: int) -> None:
    """Raise InputError as :func:`opened`, before another library opens ``path``."""
    with opened(path, most):
        pass


def read_bytes(path: Name, most: int) -> bytes:
    """Return the content of ``path``, a regular file of at most ``most`` bytes. Raises InputError as :func:`opened`."""
    with opened(path, most) as file:
        content = file.read(most + 1)  # files in /proc report a size of 0
        if content is None:  # one that would wait, such as /proc/kmsg
            raise InputError(f"{path}: cannot be read: {_NOT_REGULAR}")
    if len(content) > most:
        raise InputError(f"{path}: more than {most} bytes: must be at most {most}")
    return content


def read_text(path: Name, most: int) -> str:
    """Return the UTF-8 text of ``path``, a regular file of at most ``most`` bytes, with newlines as line ends.

    A byte order mark is removed. Raises InputError if the file is not UTF-8 text, and as :func:`opened`.
    """
    try:
        return read_bytes(path, most).decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not UTF-8 text (byte {error.start}): save the file as UTF-8") from None


def checksum(path: Name, most: int) -> str:
    """Return the SHA-256 checksum of ``path``, in hexadecimal digits. Raises InputError as :func:`opened`."""
    with opened(path, most) as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def check_replaceable(path: Name) -> None:
    """Raise InputError if there is something at ``path`` that is not a regular file: a file that is written there would
    replace a folder, a pipe, or a device such as /dev/null."""
    try:
        mode = os.stat(path).st_mode
    except (OSError, ValueError):  # nothing is there, or whoever writes the file says why it cannot
        return
    if stat.S_ISDIR(mode):
        raise InputError(f"{path}: cannot be written: is a folder")
    if not stat.S_ISREG(mode):
        raise InputError(f"{path}: cannot be written: {_NOT_REGULAR}")


def reason(error: OSError | ValueError) -> str:
    """Return the message of ``error``, without error number and file name."""
    return (error.strerror if isinstance(error, OSError) else None) or str(error)
