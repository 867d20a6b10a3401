"""Bad input: exit code 2, one line that names the field, nothing on stdout and no file."""

import json

import pytest
from refusing import check

from partialslip.cli import main


@pytest.fixture
def rejected(tmp_path, monkeypatch, capsys):
    """Call with a scene's text and the arguments: checks how they are refused, returns the message."""
    monkeypatch.chdir(tmp_path)

    def call(text, arguments):
        if text is not None:
            (tmp_path / "bench.toml").write_bytes(text if isinstance(text, bytes) else text.encode())
        before = sorted(tmp_path.rglob("*"))
        code = main(list(arguments))
        printed = capsys.readouterr()
        assert sorted(tmp_path.rglob("*")) == before
        return check(code, printed)

    return call


@pytest.fixture
def judged(tmp_path, monkeypatch, capsys):
    """Call with arguments: checks that they are either done without a word of complaint or refused in one line, and
    that nothing but whole results is left; returns whether they were refused."""
    monkeypatch.chdir(tmp_path)

    def call(arguments):
        before = sorted(tmp_path.rglob("*"))
        code = main(list(arguments))
        printed = capsys.readouterr()
        assert sorted(tmp_path.rglob("*")) == before
        if code == 2:
            check(code, printed)
        else:
            assert code in (0, 1)
            assert printed.err == ""
            json.loads(printed.out)
        return code == 2

    return call
