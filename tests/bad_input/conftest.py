"""Bad input: exit code 2, one line that names the field, nothing on stdout and no file."""

import json

import pytest
from refusing import check

from partialslip.cli import main


@pytest.fixture
def called(tmp_path, monkeypatch, capsys):
    """Call with arguments, in an empty folder: exit code and what was printed. No file may be left behind."""
    monkeypatch.chdir(tmp_path)

    def call(arguments):
        before = sorted(tmp_path.rglob("*"))
        code = main(list(arguments))
        assert sorted(tmp_path.rglob("*")) == before
        return code, capsys.readouterr()

    return call


@pytest.fixture
def rejected(tmp_path, called):
    """Call with a scene's text and the arguments: checks how they are refused, returns the message."""

    def call(text, arguments):
        if text is not None:
            (tmp_path / "bench.toml").write_bytes(text if isinstance(text, bytes) else text.encode())
        return check(*called(arguments))

    return call


@pytest.fixture
def judged(called):
    """Call with arguments: checks that they are either done without a word of complaint or refused in one line;
    returns whether they were refused."""
    return lambda arguments: fair(*called(arguments))


def fair(code, printed):
    """Whether a command was refused, which must be in one line; otherwise it must print JSON, and nothing else."""
    if code == 2:
        check(code, printed)
        return True
    assert code in (0, 1)
    assert printed.err == ""
    json.loads(printed.out, parse_constant=pytest.fail)
    return False
