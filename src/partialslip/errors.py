"""What can be wrong from outside: one line that names the field, the value and what is allowed."""


class PartialslipError(Exception):
    """A problem the user can mend. Its text is one line; the command line prints it and exits with 2."""


class InputError(PartialslipError, ValueError):
    """A scene, an option or a file that cannot be used."""


class MissingLibraryError(PartialslipError, ImportError):
    """A system library that a dependency needs is not on this machine."""
