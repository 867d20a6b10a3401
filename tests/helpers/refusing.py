"""Bad input: exit code 2, one line that names the field, nothing on stdout."""

import re

import pytest

from partialslip.tools.errors import InputError

# Wording of the libraries below, which says nothing to whoever wrote the scene.
FOREIGN = ("Traceback", "Object ", "Number ", "datetime", "str ", "`", "NoneType", "Errno")


def check(code, printed):
    """Assert that a command was refused; return the message."""
    assert code == 2
    assert printed.out == ""
    assert printed.err.startswith("partialslip: ")
    assert printed.err.endswith("\n")
    assert len(printed.err.splitlines()) == 1
    assert printed.err[:-1].isprintable()
    assert len(printed.err) < 5000
    said = re.sub(r" = '.*?': ", ": ", printed.err)  # without what a file says
    assert not [word for word in FOREIGN if word in said]
    return printed.err


def line_of(call, *arguments, **named):
    """Return the line with which a call refuses bad input."""
    with pytest.raises(InputError) as raised:
        call(*arguments, **named)
    assert "\n" not in str(raised.value)
    return str(raised.value)
