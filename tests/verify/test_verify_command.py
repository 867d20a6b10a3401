"""partialslip verify: what it writes, how it goes on, what it refuses."""

import csv
import itertools
import json
from dataclasses import asdict

import pytest

from partialslip.cli import main
from partialslip.cli import verify as command
from partialslip.report import verdicts as files
from partialslip.run import run
from partialslip.verify import Case, case, run_case, stress_suite, suite
from partialslip.verify.random_scenes import KINDS, draw
from partialslip.verify.stress import stress_numbers

STRESS = ["verify", "--suite", "stress", "--method", "march", "--seed", "5"]


def verify(tmp_path, *arguments):
    return main([*arguments, "--out", str(tmp_path)]), json.loads((tmp_path / "results.json").read_text("utf-8"))


def test_one_case_by_name(tmp_path, capsys):
    code, record = verify(tmp_path, "verify", "--suite", "full", "--only", "one-contact-node")
    assert code == 0
    assert record["finished"]
    assert list(record["cases"]) == ["one-contact-node"]
    with (tmp_path / "results.csv").open(newline="") as table:
        rows = list(csv.DictReader(table))
    assert [row["check"] for row in rows] == [one["check"] for one in record["cases"]["one-contact-node"]]
    assert {"one-contact-node", "fem"} <= set(capsys.readouterr().out.split())


def test_a_missed_bar_is_exit_1(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(case, "CERTIFICATE_BAR", 0.0)
    code, record = verify(tmp_path, *STRESS, "--only", "1")
    assert code == 1
    assert [one["check"] for one in record["cases"]["stress-5-1"] if not one["passed"]] == ["certificate"]
    assert "missed: stress-5-1, march: certificate" in capsys.readouterr().out


def test_what_is_raised_is_a_verdict(monkeypatch):
    def raising(*_):
        raise ZeroDivisionError("none left")

    monkeypatch.setattr("partialslip.verify.case.run", raising)
    kind, scene = draw(0, 1)
    (verdict,) = run_case(Case(kind, scene, ("march",), compared=False))
    assert (verdict.check, verdict.passed, verdict.found) == ("finishes", False, "ZeroDivisionError: none left")


def test_interrupted_it_goes_on(tmp_path, capsys, monkeypatch):
    """Ctrl-C in the third scene: two are written; the next run solves the other two, and one after that all four."""
    solved = []

    def stopped(scene, methods):
        if len(solved) == 2:
            raise KeyboardInterrupt
        solved.append(scene.name)
        return run(scene, methods)

    monkeypatch.setattr("partialslip.verify.case.run", stopped)
    code, record = verify(tmp_path, *STRESS, "--count", "4")
    assert (code, record["finished"], list(record["cases"])) == (130, False, solved)
    monkeypatch.setattr(
        "partialslip.verify.case.run", lambda scene, methods: (solved.append(scene.name), run(scene, methods))[1]
    )
    code, record = verify(tmp_path, *STRESS, "--count", "4")
    assert (code, record["finished"]) == (0, True)
    assert solved == list(record["cases"]) == [f"stress-5-{number}" for number in range(4)]
    verify(tmp_path, *STRESS, "--count", "4")
    assert len(solved) == 8
    assert "2 cases were finished before" in capsys.readouterr().err


def test_other_settings_begin_anew(tmp_path):
    settings = {"suite": "stress", "only": [], "method": "march", "seed": 5}
    found = run_case(stress_suite("march", 5, 2)["stress-5-1"]())
    files.write_verdicts(tmp_path, settings, {"stress-5-1": found}, finished=False)
    assert files.read_verdicts(tmp_path, settings) == {"stress-5-1": found}
    assert files.read_verdicts(tmp_path, settings | {"seed": 6}) == {}
    (tmp_path / "results.json").write_text("{", "utf-8")
    assert files.read_verdicts(tmp_path, settings) == {}
    assert asdict(found[0])["case"] == "stress-5-1"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--suite", "quick", "--count", "3"], "--count 3: only with --suite stress"),
        (["--suite", "full", "--only", "near-slide"], "--only 'near-slide': no case of the suite full; did you mean"),
        (["--suite", "stress", "--count", "0"], "--count '0': must be a whole number from 1 to 999999999"),
        (["--suite", "stress", "--seed", "x"], "--seed 'x': must be a whole number"),
        (["--suite", "stress", "--method", "bem"], "--method 'bem': must be one of exact, march, fem"),
        (["--suite", "stress", "--only", "one"], "--only 'one': must be the number of a random scene"),
        (["--suite", "all"], "argument --suite"),
    ],
)
def test_what_it_refuses(arguments, said, tmp_path, capsys):
    assert main(["verify", *arguments, "--out", str(tmp_path / "none")]) == 2
    printed = capsys.readouterr()
    assert printed.err.startswith(f"partialslip: {said}")
    assert len(printed.err.splitlines()) == 1
    assert not (tmp_path / "none").exists()


def test_suites():
    quick, full = suite("quick"), suite("full")
    assert list(full)[: len(quick)] == list(quick)
    assert set(suite("full", ["near-s*"])) == {
        f"near-{what}-1e-{power}" for what in ("sliding", "stuck") for power in (3, 6, 9)
    }
    assert all(full[name]().name == name for name in full)
    assert command._SUITES == ("quick", "full", "stress")


def test_a_random_scene_is_its_seed_and_number():
    assert draw(3, 17) == draw(3, 17)
    assert draw(3, 17) != draw(4, 17)
    numbers = list(itertools.islice(stress_numbers("exact"), 30))
    assert {draw(0, number).kind for number in numbers} == set(KINDS) - {"out of phase"}
    assert all(draw(0, number).scene.load.in_phase for number in numbers)


@pytest.mark.parametrize(
    ("method", "count"),
    [
        ("march", 20),
        ("fem", 8),
        pytest.param("march", 2000, marks=pytest.mark.slow),
        pytest.param("fem", 200, marks=pytest.mark.slow),
    ],
)
def test_random_scenes_have_certificates(method, count):
    missed = [v for make in stress_suite(method, 1, count).values() for v in run_case(make()) if not v.passed]
    assert not missed
