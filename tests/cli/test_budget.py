"""run --accuracy and --budget: what they took, and what it led to."""

import importlib
import json
from types import SimpleNamespace

import pytest

import partialslip
from partialslip.cli import main
from partialslip.cli import run as command


def test_what_the_choice_of_methods_takes_is_part_of_a_budget(monkeypatch, refused):
    """The exact way is followed for it, which may take more than all else."""
    clock, allowed = [0.0], []

    def default_methods(_):
        clock[0] += 100.0
        return "exact", "fem"

    def run(*_, **__):
        raise partialslip.InputError("no run")

    monkeypatch.setattr(command, "time", SimpleNamespace(process_time=lambda: clock[0]))
    monkeypatch.setattr(importlib.import_module("partialslip.run"), "default_methods", default_methods)
    monkeypatch.setattr(command, "Allowance", allowed.append)
    monkeypatch.setattr(partialslip, "run", run)
    refused("run", "hertz-shear", "--budget", "1000s")
    assert allowed == [pytest.approx(1000 - 100 - command._CLOSING)]


@pytest.mark.parametrize("asked", [("--accuracy", "1e-3"), ("--budget", "1000s", "--set", "fem.accuracy=1e-3")])
def test_the_seconds_are_told_and_the_accuracy_reached(tmp_path, capsys, asked):
    assert main(["run", "hertz-shear", *asked, "--out", str(tmp_path)]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    text = json.loads((tmp_path / "results.json").read_text("utf-8"))
    found, fem = text["comparison"]["fem"]["errors"], text["methods"]["fem"]
    assert fem["settings"]["accuracy"] == 1e-3
    assert max(found[key] for key in ("a", "m", "n")) <= 1e-3
    assert f"known to {max(fem['estimate'][key] for key in ('a', 'm', 'n')):.1e} a" in printed
    assert f"{'accuracy 1e-3' if asked[0] == '--accuracy' else 'budget of 1000s'}: " in printed


def test_a_budget_of_nothing_still_gives_an_estimate(tmp_path, capsys):
    assert main(["run", "hertz-shear", "--budget", "0.01s", "--out", str(tmp_path)]) in (0, 4)
    assert "known to" in capsys.readouterr().out
    fem = json.loads((tmp_path / "results.json").read_text("utf-8"))["methods"]["fem"]
    assert {"a", "m", "n", "p", "q"} <= {*fem["estimate"]}
