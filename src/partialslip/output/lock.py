"""Locks: a folder that one process writes to is no other's meanwhile."""

import contextlib
import errno
import os
import platform
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from partialslip.errors import InputError
from partialslip.inputfile import reason

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

NAME = ".partialslip.lock"
_TRIES = 20
_BEYOND = 1 << 30  # byte of the file that is locked on Windows, where what is locked cannot be read


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold ``folder``, which is made if need be, for this process until the block ends; if nothing is in it by then, it
    goes again.

    The lock is the operating system's, on a hidden file in there. It ends with the process, however that ends, and is
    known to other machines on NFS. A file system without locks is written to without one.

    Raises
    ------
    InputError
        If another process holds the folder, or it cannot be written.
    """
    path, made = folder / NAME, []
    try:
        made = [each for each in (folder, *folder.parents) if not each.exists()]
        handle, holder = _taken(path)
    except (OSError, ValueError) as error:
        _remove(made)
        raise InputError(f"--out {folder}: cannot be written: {reason(error)}") from None
    if holder:
        raise InputError(f"--out {folder}: {holder} is writing there: wait until it ends, or name another folder")
    try:
        yield
    finally:
        with contextlib.suppress(OSError):  # of Windows, which removes no open file
            path.unlink(missing_ok=True)
        os.close(handle)
        if fcntl is None:
            with contextlib.suppress(OSError):
                path.unlink(missing_ok=True)
        _remove(made)


def lock(handle: int) -> bool | None:
    """Lock an open file to this process, until it is closed or the process ends. Returns whether that is done, False if
    another one holds it, None where there are no locks."""
    try:
        if fcntl is not None:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        else:
            import msvcrt

            os.lseek(handle, _BEYOND, os.SEEK_SET)
            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
            os.lseek(handle, 0, os.SEEK_SET)
    except OSError as error:
        return False if error.errno in (errno.EWOULDBLOCK, errno.EACCES, errno.EDEADLK) else None
    return True


def _taken(path: Path) -> tuple[int, str]:
    """The file at ``path``, open and locked, or who has it."""
    for _ in range(_TRIES):
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        except FileNotFoundError:  # the one before has just removed an empty folder
            continue
        if lock(handle) is False:
            holder = os.read(handle, 200).decode(errors="replace")
            os.close(handle)
            return -1, holder or "another process"
        with contextlib.suppress(FileNotFoundError):  # the one before has just removed it
            if os.path.samestat(os.fstat(handle), os.stat(path)):
                os.truncate(handle, 0)
                os.write(handle, f"process {os.getpid()} on {platform.node()}".encode(errors="replace"))
                return handle, ""
        os.close(handle)
    raise OSError(errno.EBUSY, "others come and go in it")


def _remove(folders: list[Path]) -> None:
    """Remove those of ``folders``, innermost first, that are empty."""
    with contextlib.suppress(OSError, ValueError):
        for each in folders:
            each.rmdir()
