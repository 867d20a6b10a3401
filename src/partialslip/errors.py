"""What can be wrong from outside: one line that names the field, the value and what is allowed."""


class PartialslipError(Exception):
    """A problem the user can mend. Its text is one line, whatever names and values are in it; the command line prints
    it and exits with 2."""

    def __init__(self, text: str) -> None:
        super().__init__("".join(c if c.isprintable() else repr(c)[1:-1] for c in text))


class InputError(PartialslipError, ValueError):
    """A scene, an option or a file that cannot be used."""


class MissingLibraryError(PartialslipError, ImportError):
    """A library that is asked for, or that a dependency needs, is not on this machine."""
