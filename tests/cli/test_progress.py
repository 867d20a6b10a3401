"""Progress in logs: a line from time to time on stderr, without control characters."""

import json
import math
import re

import pytest

import partialslip
from partialslip import InputError
from partialslip.cli import consoles, main


@pytest.fixture
def clock(monkeypatch):
    """A clock that stands still until a test moves it."""
    now = [0.0]
    monkeypatch.setattr(consoles.time, "monotonic", lambda: now[0])
    return now


def test_a_line_at_most_every_few_seconds(clock, capsys):
    with consoles.working("scene") as tell:
        for clock[0] in (0.0, 1.0, 4.0, 6.0, 7.0, 10.0, 12.0):
            tell(f"fem: mesh at {clock[0]:g}")
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err.splitlines() == ["scene: fem: mesh at 6 (6 s)", "scene: fem: mesh at 12 (12 s)"]


def test_cases_are_counted(clock, capsys):
    with consoles.counting("verify full", "writing the report") as progress:
        for clock[0], done in ((0.0, 3), (8.0, 4), (9.0, 5), (20.0, 6)):
            progress(done, 6, math.nan if done == 3 else 60.0 - clock[0])
        progress(6, 9, math.nan)  # a study adds cases
    assert capsys.readouterr().err.splitlines() == [
        "3 cases were finished before",
        "verify full: 4 of 6 cases, 52 s left (8 s)",
        "verify full: 6 of 6 cases, writing the report (20 s)",
    ]


@pytest.mark.parametrize("variable", ["FORCE_COLOR", "CLICOLOR_FORCE"])
def test_colours_in_a_log_bring_no_control_characters(clock, capsys, monkeypatch, variable):
    monkeypatch.setenv(variable, "1")
    with consoles.working("scene") as tell, consoles.counting("cases") as progress:
        clock[0] = 10.0
        progress(0, 2, math.nan)
        tell("mesh 1")
    assert "\r" not in (said := capsys.readouterr().err)
    assert "\x1b[" not in re.sub(r"\x1b\[[\d;]*m", "", said)


def test_a_run_with_json_tells_on_stderr_only(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(consoles, "EVERY", 0.0)
    monkeypatch.chdir(tmp_path)
    assert main(["run", "hertz-shear", "--with", "exact,march", "--set", "fem.accuracy=1e-2", "--json"]) == 0
    printed = capsys.readouterr()
    assert json.loads(printed.out)["scene"]["name"] == "hertz-shear"
    lines = printed.err.splitlines()
    assert lines
    assert all(re.fullmatch(r"hertz-shear: march: mesh \d: .* \(\d+ s\)", line) for line in lines)


@pytest.mark.parametrize(("asked", "said"), [(250, "750 load steps"), (2, None)])
def test_many_load_steps_are_told_before_they_are_taken(tmp_path, monkeypatch, capsys, asked, said):
    told = []

    def run(*_, **__):
        told.append(capsys.readouterr().err)
        raise InputError("enough")

    monkeypatch.setattr(partialslip, "run", run)
    varied = ("--set", "load.M=[10.0, -10.0]", "--set", f"load.steps={asked}", "--out", str(tmp_path / "out"))
    assert main(["run", "flat-rounded", "--with", "march", *varied]) == 2
    assert len(told) == 1
    assert (said in told[0] and "load.steps = 250" in told[0]) if said else not told[0]
