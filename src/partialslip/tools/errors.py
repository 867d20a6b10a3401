"""Errors of input and environment. Each message is one line: field, value, what is allowed."""

_LONGEST = 1000  # display: characters of a message
_END = 300  # display: characters kept from the end of a long message, which says what is allowed


class PartialslipError(Exception):
    """A problem that the user can solve; the command line prints the message and exits with 2.

    Parameters
    ----------
    text : str
        Message, shortened to one line of at most 1,000 characters.
    """

    def __init__(self, text: str) -> None:
        super().__init__(one_line(text))


class InputError(PartialslipError, ValueError):
    """An invalid scene, option or file."""


class MissingLibraryError(PartialslipError, ImportError):
    """A required library is not installed."""


def one_line(text: str) -> str:
    """Return ``text`` with unprintable characters escaped and the middle of a long text left out."""
    return _shortened(printable(_shortened(text)))


def printable(text: str) -> str:
    """Return ``text`` with unprintable characters escaped."""
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)


def _shortened(text: str) -> str:
    if len(text) <= _LONGEST:
        return text
    return f"{text[: _LONGEST - _END - 5]} ... {text[-_END:]}"
