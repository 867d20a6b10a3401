"""Files from outside: read whole if they are regular files of a sane size, refused in one line if not."""

import os
import stat

from partialslip.errors import InputError


def check_regular(path: str | os.PathLike[str], most: int) -> None:
    """Raise InputError if ``path`` cannot be read, is not a regular file, or has more than ``most`` bytes: a pipe, or
    a device such as /dev/zero, could be read for ever."""
    try:
        about = os.stat(path)
        if not (stat.S_ISREG(about.st_mode) or stat.S_ISDIR(about.st_mode)):
            raise InputError(f"{path}: cannot be read: must be a regular file, not a pipe or a device")
        if stat.S_ISREG(about.st_mode) and about.st_size > most:
            raise InputError(f"{path}: {about.st_size} bytes: must be at most {most}")
        with open(path, "rb"):  # a folder says so here
            pass
    except InputError:
        raise
    except (OSError, ValueError) as error:  # ValueError: a name that no file can have
        raise InputError(f"{path}: cannot be read: {reason(error)}") from None


def read_bytes(path: str | os.PathLike[str], most: int) -> bytes:
    """The content of a regular file of at most ``most`` bytes. Raises InputError if it is none."""
    check_regular(path, most)
    try:
        with open(path, "rb") as file:
            content = file.read(most + 1)  # files of /proc say that they have no bytes
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {reason(error)}") from None
    if len(content) > most:
        raise InputError(f"{path}: more than {most} bytes: must be at most {most}")
    return content


def read_text(path: str | os.PathLike[str], most: int) -> str:
    """The UTF-8 text, with or without a byte order mark, of a regular file of at most ``most`` bytes, its line ends as
    newlines. Raises InputError if it is none."""
    try:
        return read_bytes(path, most).decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not UTF-8 text (byte {error.start})") from None


def reason(error: OSError | ValueError) -> str:
    """What ``error`` says, without numbers and names."""
    return (error.strerror if isinstance(error, OSError) else None) or str(error)
