"""What can be wrong from outside: one line that names the field, the value and what is allowed."""

_LONGEST = 1000  # characters of a message
_END = 300  # of them from its end, which says what is allowed


class PartialslipError(Exception):
    """A problem the user can mend. Its text is one line of at most 1,000 characters, whatever names and values are in
    it; the command line prints it and exits with 2."""

    def __init__(self, text: str) -> None:
        super().__init__(one_line(text))


class InputError(PartialslipError, ValueError):
    """A scene, an option or a file that cannot be used."""


class MissingLibraryError(PartialslipError, ImportError):
    """A library that is asked for, or that a dependency needs, is not on this machine."""


def one_line(text: str) -> str:
    """``text`` with what is not printable escaped, and its middle left out where it is long."""
    shown = "".join(c if c.isprintable() else repr(c)[1:-1] for c in _shortened(text))
    return _shortened(shown)


def _shortened(text: str) -> str:
    if len(text) <= _LONGEST:
        return text
    return f"{text[: _LONGEST - _END - 5]} ... {text[-_END:]}"
