"""Make the folders of files."""

import errno
import os
from pathlib import Path


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
