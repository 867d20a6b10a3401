"""Input files: read regular files of limited size; refuse others with a one-line InputError."""

import os
import stat

from partialslip.errors import InputError


def check_regular(path: str | os.PathLike[str], most: int) -> None:
    """Raise InputError if ``path`` cannot be read, is not a regular file, or has more than ``most`` bytes.

    Reading a pipe, or a device such as /dev/zero, might not end.
    """
    try:
        about = os.stat(path)
        if not (stat.S_ISREG(about.st_mode) or stat.S_ISDIR(about.st_mode)):
            raise InputError(f"{path}: cannot be read: must be a regular file, not a pipe or a device")
        if stat.S_ISREG(about.st_mode) and about.st_size > most:
            raise InputError(f"{path}: {about.st_size} bytes: must be at most {most}")
        with open(path, "rb"):  # raises for a folder
            pass
    except InputError:
        raise
    except (OSError, ValueError) as error:  # ValueError: invalid file name
        raise InputError(f"{path}: cannot be read: {reason(error)}") from None


def read_bytes(path: str | os.PathLike[str], most: int) -> bytes:
    """Return the content of ``path``, a regular file of at most ``most`` bytes. Raises InputError as
    :func:`check_regular`."""
    check_regular(path, most)
    try:
        with open(path, "rb") as file:
            content = file.read(most + 1)  # files in /proc report a size of 0
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {reason(error)}") from None
    if len(content) > most:
        raise InputError(f"{path}: more than {most} bytes: must be at most {most}")
    return content


def read_text(path: str | os.PathLike[str], most: int) -> str:
    """Return the UTF-8 text of ``path``, a regular file of at most ``most`` bytes, with newlines as line ends.

    A byte order mark is removed. Raises InputError if the file is not UTF-8 text, and as :func:`check_regular`.
    """
    try:
        return read_bytes(path, most).decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not UTF-8 text (byte {error.start}): save the file as UTF-8") from None


def reason(error: OSError | ValueError) -> str:
    """Return the message of ``error``, without error number and file name."""
    return (error.strerror if isinstance(error, OSError) else None) or str(error)
