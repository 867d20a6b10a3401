"""Make folders, and lock a folder, so that one process at a time writes to it."""

import contextlib
import errno
import os
import platform
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import reason

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

LOCK_NAME = ".partialslip.lock"
TRIES = 20  # cost: to open and lock a file
_HOLDER = "process "  # begin of the text in the file
_BEYOND = 1 << 30  # limit: byte locked on Windows: beyond the text, because locked bytes cannot be read


class FolderInUseError(InputError):
    """Another process writes to the folder."""


def make_folder(folder: Path) -> None:
    """Make ``folder`` and its parents, those that do not exist. Any number of parents may be missing.

    Raises
    ------
    OSError
        If a folder cannot be made. Says so if the working folder has been deleted.
    """
    try:
        for each in reversed([folder, *folder.parents]):
            try:
                os.mkdir(each)
            except OSError:  # is there; in a folder that is there, but read-only, too
                if not os.path.isdir(each):
                    raise
    except FileNotFoundError:
        if not folder.is_absolute():
            _check_working_folder()
        raise


def _check_working_folder() -> None:
    try:
        os.getcwd()
    except FileNotFoundError:
        raise OSError(errno.ESTALE, "the working folder has been deleted") from None


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Lock ``folder`` for this process until the block ends. Create the folder if needed; remove it if left empty.

    The operating system locks a hidden file in the folder. The lock ends with the process and holds across machines on
    NFS. On a file system without locks, nothing is locked.

    Raises
    ------
    FolderInUseError
        If another process holds the folder.
    InputError
        If the folder cannot be written.
    """
    path, made = folder / LOCK_NAME, []
    try:
        made = [each for each in (folder, *folder.parents) if not each.exists()]
        handle, holder = _taken(path)
    except (OSError, ValueError) as error:
        _remove(made)
        raise InputError(f"--out {folder}: cannot be written: {reason(error)}") from None
    if holder:
        raise FolderInUseError(f"--out {folder}: {holder} is writing there: wait until it ends, or name another folder")
    try:
        yield
    finally:
        with contextlib.suppress(OSError):  # Windows does not remove an open file
            path.unlink(missing_ok=True)
        os.close(handle)
        if fcntl is None:
            with contextlib.suppress(OSError):
                path.unlink(missing_ok=True)
        _remove(made)


def lock(handle: int) -> bool | None:
    """Lock the open file ``handle`` for this process, until the file is closed or the process ends.

    Returns True if locked, False if another process holds the lock, None if the file system has no locks.
    """
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


def is_at(handle: int, path: Path) -> bool:
    """Whether the open file ``handle`` is the one at ``path``, which another process may have removed."""
    with contextlib.suppress(FileNotFoundError):
        return os.path.samestat(os.fstat(handle), os.stat(path))
    return False


def _taken(path: Path) -> tuple[int, str]:
    """Open and lock the file at ``path``. Returns the handle, and the holder if another process has the lock."""
    failed = OSError(errno.EBUSY, "other processes keep locking it")
    for _ in range(TRIES):
        try:
            make_folder(path.parent)
            handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        except FileNotFoundError as error:  # no folder can be, or the last holder has just removed the empty one
            failed = error
            continue
        if lock(handle) is False:
            holder = os.read(handle, 200).decode(errors="replace")
            os.close(handle)
            return -1, holder if holder.startswith(_HOLDER) else "another process"
        if is_at(handle, path):  # the previous holder has not just removed the file
            _sign(handle, path)
            return handle, ""
        os.close(handle)
    raise failed


def _sign(handle: int, path: Path) -> None:
    """Write into the locked file at ``path`` who holds it. A disk that is full leaves no file, which would keep the
    folder from being removed."""
    holder = f"{_HOLDER}{os.getpid()} on {platform.node()}".encode(errors="replace")
    try:
        os.truncate(handle, 0)
        if os.write(handle, holder) < len(holder):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    except OSError:
        with contextlib.suppress(OSError):
            path.unlink(missing_ok=True)
        os.close(handle)
        raise


def _remove(folders: list[Path]) -> None:
    """Remove the empty ones of ``folders``, innermost first."""
    with contextlib.suppress(OSError, ValueError):
        for each in folders:
            each.rmdir()
