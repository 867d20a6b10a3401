"""Use of the command line: help, completion, colours and widths."""

import argparse
import contextlib
import io
import re
import shutil
import subprocess

import pytest

from partialslip.cli import main, parser
from partialslip.scene.reading import shipped_scenes

ESCAPE = "\x1b["
EXACT = ("run", "hertz-shear", "--with", "exact")


def commands(top, above=()):
    """Return the parsers of all commands by the words of the command."""
    yield above, top
    for action in top._actions:
        if isinstance(action, argparse._SubParsersAction):
            for name, below in action.choices.items():
                yield from commands(below, (*above, name))


COMMANDS = dict(commands(parser()))


def printed(arguments, **environment):
    out = io.StringIO()
    with pytest.MonkeyPatch.context() as patch, contextlib.redirect_stdout(out):
        for name in ("NO_COLOR", "FORCE_COLOR"):
            patch.delenv(name, raising=False)
        for name, value in environment.items():
            patch.setenv(name, value)
        main(arguments)
    return out.getvalue()


@pytest.mark.parametrize("words", COMMANDS, ids=lambda words: " ".join(words) or "partialslip")
def test_help_describes_shows_and_says_how_it_ends(words):
    text = printed([*words, "--help"], COLUMNS="80")
    options, _, end = text.partition("\nexamples:\n")
    examples, _, codes = end.partition("\nexit codes:\n")
    assert len(COMMANDS[words].description) > 40
    lines = [line.strip() for line in examples.strip().splitlines()]
    assert 2 <= len(lines) <= 3
    assert all("partialslip" in line for line in lines)
    known = ["0", "2", "130"], ["0", "1", "2", "130"], ["0", "2", "4", "130"], ["0", "1", "2", "4", "130"]
    assert re.findall(r"^  (\d+) +\S", codes, re.MULTILINE) in known
    assert all(len(line) <= 80 for line in options.splitlines())
    assert all(action.help for action in COMMANDS[words]._actions if not isinstance(action, argparse._SubParsersAction))


def test_negative_numbers_are_values():
    """Not options that argparse knows nothing of."""
    found = parser().parse_args(["score", "hertz-shear", "t.csv", "--factors", "-1,1e-3,-.5", "--bar", "-1e-3"])
    assert (found.factors, found.bar) == ("-1,1e-3,-.5", "-1e-3")


def examples():
    for words in COMMANDS:
        text = printed([*words, "--help"], COLUMNS="200").partition("\nexamples:\n")[2].partition("\n\n")[0]
        yield from (line.split() for line in text.splitlines() if line.strip().startswith("partialslip"))


@pytest.mark.parametrize("words", list(examples()), ids=" ".join)
def test_examples_are_read(words):
    arguments = [word for word in words[1:] if not word.startswith((">", '"$'))]
    arguments = arguments[: words.index(">") - 1] if ">" in words else arguments
    if "--help" not in arguments:
        assert callable(parser().parse_args(arguments).command)


@pytest.mark.parametrize("columns", [60, 80, 200])
def test_tables_fit_the_width(columns, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = printed([*EXACT, "--verbose"], COLUMNS=str(columns))
    longest = max(len(line.rstrip()) for line in text.splitlines() if " in results" not in line)
    assert longest <= columns
    assert longest > 59 if columns < 200 else longest > 120


@pytest.mark.parametrize("columns", [60, 200])
def test_no_digit_is_left_out(columns, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = printed(["run", "hertz-shear", "--with", "exact,march", "--accuracy", "1e-2"], COLUMNS=str(columns))
    assert "…" not in text
    assert re.search(r"m, stick zone +a +0\.\d{7} +0\.\d{7} +(?:[\d.]+e[-+]\d\d +){2}1.0e-02 +ok", text)


def test_colours_only_where_they_are_wanted(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert ESCAPE not in printed(EXACT)
    assert ESCAPE in printed(EXACT, FORCE_COLOR="1")
    bold_alone = re.findall(r"\x1b\[([\d;]+)m", printed(EXACT, FORCE_COLOR="1", NO_COLOR="1"))
    assert set(bold_alone) <= {"0", "1"}


def test_json_has_no_colours():
    assert ESCAPE not in printed([*EXACT, "--json"], FORCE_COLOR="1")


def completed(script, line):
    """Return bash's completions of the last word of ``line``."""
    words = line.split(" ")
    asked = f"""
        source {script}
        COMP_WORDS=({" ".join(f"'{word}'" for word in words)}) COMP_CWORD={len(words) - 1}
        _shtab_partialslip partialslip '{words[-1]}' '{words[-2]}'
        printf '%s\\n' "${{COMPREPLY[@]}}"
    """
    done = subprocess.run(["bash", "-c", asked], capture_output=True, text=True, check=True, cwd=script.parent)
    return done.stdout.split()


@pytest.mark.skipif(not shutil.which("bash"), reason="bash is not installed")
def test_bash_completes_commands_options_scenes_and_files(tmp_path):
    script = tmp_path / "completion.bash"
    script.write_text(printed(["completion", "bash"]), "utf-8")
    (tmp_path / "mine.toml").touch()
    (tmp_path / "notes.txt").touch()
    assert completed(script, "partialslip ver") == ["verify"]
    assert completed(script, "partialslip study co") == ["cost"]
    assert completed(script, "partialslip run --acc") == ["--accuracy"]
    assert completed(script, "partialslip run fre") == ["fretting-aluminium"]
    assert set(completed(script, "partialslip score ")) >= {*shipped_scenes(), "mine.toml"}
    assert "notes.txt" not in completed(script, "partialslip run ")


@pytest.mark.skipif(not shutil.which("zsh"), reason="zsh is not installed")
def test_zsh_reads_its_completion():
    subprocess.run(["zsh", "-n"], input=printed(["completion", "zsh"]), text=True, check=True)
