"""The scripts in examples/ run as they are, and print what they are there to show."""

import runpy
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[1] / "examples"
TWICE = "size_of_a_body"
SHOWN = {
    "first_run": ["small tension", "m: error", "passed; the finite elements took"],
    "mean_loads": ["1 cycles followed", "x = +0.9 a", "against the exact solution: passed"],
    "score_a_table": ["f = 0.4995 (the scene has 0.5)", "passed; notes: none"],
    "stick_zones": ["26 stick zones", "tension turns large at dsigma = 380.0 MPa"],
    "sweep_friction": ["6 of 50 values slide", "sticks from f = 0."],
    TWICE: [" of them solved now", "blocks of 64 a"],
}


@pytest.fixture
def run(tmp_path, monkeypatch, capsys):
    """Runs an example as a script, but in this process."""

    def here(name):
        script = str(EXAMPLES / f"{name}.py")
        monkeypatch.chdir(tmp_path)
        monkeypatch.setattr(sys, "argv", [script])
        runpy.run_path(script, run_name="__main__")
        printed = capsys.readouterr()
        assert printed.err == ""
        return printed.out

    return here


def test_every_example_is_here():
    assert {path.stem for path in EXAMPLES.glob("*.py")} == SHOWN.keys()


@pytest.mark.parametrize(
    "name",
    [name if name == "stick_zones" else pytest.param(name, marks=pytest.mark.slow) for name in SHOWN if name != TWICE],
)
def test_an_example_shows_what_it_is_for(name, run):
    printed = run(name)
    assert [text for text in SHOWN[name] if text not in printed] == []


@pytest.mark.slow
def test_a_second_run_of_the_sweep_solves_nothing(run):
    first, second = run(TWICE), run(TWICE)
    assert [text for text in SHOWN[TWICE] if text not in first] == []
    assert "0 of them solved now" in second
    assert first.splitlines()[1:] == second.splitlines()[1:]


@pytest.mark.parametrize("script", sorted(EXAMPLES.parent.glob("benchmarks/*.py")), ids=lambda script: script.stem)
def test_what_benchmarks_import_is_there(script, monkeypatch):
    """They run for minutes, and no test runs them."""
    monkeypatch.setattr(sys, "path", [str(script.parent), *sys.path])
    runpy.run_path(str(script), run_name="imported")
