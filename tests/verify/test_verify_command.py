"""partialslip verify: files written, continuing a stopped run, errors."""

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import msgspec
import pytest

from partialslip.cli import main
from partialslip.march import changes
from partialslip.run.judge import Bar
from partialslip.scene.reading import load_scene
from partialslip.study.batch.ledger import Ledger
from partialslip.tools.output.lock import LOCK_NAME
from partialslip.verify import Case, driver
from partialslip.verify.hard_cases.meshes import shifted
from partialslip.verify.suites import _same
from partialslip.verify.verdicts import VerificationRecord

ROOT = Path(__file__).parents[2]
ROOTS = ("src/partialslip", "fem/partialslip_fem", "meshes/partialslip_meshes")

STRESS = ["verify", "--suite", "stress", "--method", "march", "--seed", "5", "--processes", "1"]


def verify(tmp_path, *arguments):
    return main([*arguments, "--out", str(tmp_path)]), json.loads((tmp_path / "results.json").read_text("utf-8"))


def test_one_case_by_name(tmp_path, capsys):
    code, record = verify(tmp_path, "verify", "--suite", "full", "--only", "one-contact-node")
    assert code == 0
    assert record["finished"]
    assert list(record["cases"]) == ["one-contact-node"]
    with (tmp_path / "results.csv").open(newline="") as table:
        rows = list(csv.DictReader(table))
    assert [row["quantity"] for row in rows] == [one["quantity"] for one in record["cases"]["one-contact-node"]]
    assert {"one-contact-node", "fem"} <= set(capsys.readouterr().out.split())


@pytest.mark.fault
def test_estimates_that_are_too_small_are_seen(tmp_path, capsys, monkeypatch):
    """Deliberate fault: march takes its errors of m and n for a thousandth of what they are. No bar is missed."""
    true = changes.of_ends
    monkeypatch.setattr(changes, "of_ends", lambda *ends: 1e-3 * true(*ends))
    code, record = verify(tmp_path, "verify", "--suite", "full", "--only", "no-tension")
    assert code == 1
    missed = [one for one in record["cases"]["no-tension"] if one["outcome"] == "missed"]
    assert [(one["method"], one["quantity"]) for one in missed] == [
        ("march", "estimate of m"),
        ("march", "estimate of n"),
    ]
    assert all(one["requirement"].startswith("R10: ") and "estimated to be" in one["reason"] for one in missed)
    assert "missed: no-tension, march: estimate of m: error" in capsys.readouterr().out


# A verification with one case per worker, stopped by kill -9 when the first case is in the ledger.
KILLED = """
import os, signal, sys
from partialslip.study.batch import ledger
from partialslip.verify import driver
from partialslip.study.batch.ledger import Ledger
add = Ledger.add
def added(self, key, found):
    add(self, key, found)
    os.kill(os.getpid(), signal.SIGKILL)
Ledger.add = added
from partialslip.cli import main
main(sys.argv[1:])
"""


@pytest.mark.fault
@pytest.mark.parametrize("edited", [pytest.param(False, marks=pytest.mark.slow), True])
def test_a_killed_verification_takes_up_nothing_of_other_code(edited, tmp_path):
    """Deliberate fault: between kill -9 and the next run a source file is edited, with no commit and no other version.
    The finished case is solved again, with a message."""
    for root in ROOTS:
        shutil.copytree(ROOT / root, tmp_path / root, ignore=shutil.ignore_patterns("__pycache__"))
    paths = os.pathsep.join(str((tmp_path / root).parent) for root in ROOTS)
    environment = {**os.environ, "PYTHONPATH": paths}

    def verified(*program):
        command = [sys.executable, *program, *STRESS, "--only", "1", "--out", "out"]
        done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout, [json.loads(line)["key"] for line in lines()]

    def lines():
        return (tmp_path / "out" / "ledger.jsonl").read_text("utf-8").splitlines()

    code, _, keys = verified("-c", KILLED)
    assert (code, len(keys)) == (-signal.SIGKILL, 1)
    if edited:
        with (tmp_path / ROOTS[0] / "friction" / "history.py").open("a", encoding="utf-8") as file:
            file.write("# edited\n")
    code, said, again = verified("-c", "import sys; from partialslip.cli import main; sys.exit(main(sys.argv[1:]))")
    assert code == 0
    assert again[0] == keys[0]
    assert len(again) == (2 if edited else 1)
    assert ("solved again, as the scene, its settings or the program have changed: stress-5-1" in said) == edited


@pytest.mark.fault
@pytest.mark.parametrize("change", ["nothing", "scene", "bars", "methods", "meshes"])
def test_a_case_that_changed_under_its_name_is_solved_again(change, tmp_path, monkeypatch):
    """Deliberate fault: a case finished by a stopped verification changes but keeps the name."""
    scene = load_scene("hertz-shear")
    one = Case("made", scene, ("exact",))
    other = {
        "nothing": one,
        "scene": replace(one, scene=load_scene("hertz-shear", ["friction.f=0.49"])),
        "bars": replace(one, bars={"exact.a": Bar(1.0, "why")}),
        "methods": replace(one, methods=("exact", "march")),
        "meshes": replace(one, meshes=partial(shifted, share=0.5)),
    }[change]
    solved = []
    judged = driver.solve_case
    monkeypatch.setattr(driver, "solve_case", lambda case: (solved.append(case.scene.friction.f), judged(case))[1])
    for case in (one, other):
        monkeypatch.setattr(driver, "suite", lambda *_, case=case: {case.name: partial(_same, case)})
        verified = driver.verify_suite("quick", processes=1, out=tmp_path)
        (tmp_path / "results.json").write_text("{", "utf-8")  # as after a killed run
    assert len(solved) == (1 if change == "nothing" else 2)
    assert verified.again == (() if change == "nothing" else ("made",))


def test_settings_that_are_not_the_defaults_have_folders_of_their_own(tmp_path, monkeypatch):
    """Whatever ran before, and also if the defaults are given."""

    def verified(_settings, _makers, _keys, _studies, folder, *_):
        (folder / "results.json").write_text("{}", "utf-8")
        folders.append(folder.name)
        return driver.Verification({}, [])

    monkeypatch.setattr(driver, "_verify", verified)
    monkeypatch.chdir(tmp_path)
    folders = []
    for name, settings in (
        ("quick", {"ladder": True}),
        ("quick", {"only": ["hertz-shear"]}),
        ("quick", {}),
        ("stress", {"seed": 1}),
        ("stress", {"seed": 0, "count": 100, "method": "exact"}),
        ("stress", {}),
    ):
        found = driver.verify_suite(name, **settings)
        assert bool(found.elsewhere) == (len(folders[-1].split("-")) == 3)
    assert (folders[2], folders[4], folders[5]) == ("verify-quick", "verify-stress", "verify-stress")
    assert len({*folders}) == 5


@pytest.mark.slow
def test_two_processes_find_what_one_finds(tmp_path):
    """And Python gives the verdicts that the command writes."""
    one, two = (
        driver.verify_suite("stress", method="march", seed=5, count=4, processes=processes, out=tmp_path / f"{n}")
        for n, processes in enumerate((1, 2))
    )
    assert list(one.verdicts) == list(two.verdicts)
    for case_name, some in one.verdicts.items():
        others = two.verdicts[case_name]
        assert [(v.quantity, v.reason) for v in some] == [(v.quantity, v.reason) for v in others]
        # sums over an array depend, by rounding, on where it lies in memory
        assert [v.error is None for v in some] == [v.error is None for v in others]
        errors = ([v.error for v in each if v.error is not None] for each in (some, others))
        assert next(errors) == pytest.approx(next(errors), rel=1e-9, abs=1e-11, nan_ok=True)
    assert {entry["case"] for entry in Ledger(tmp_path / "1" / "ledger.jsonl")} == set(two.verdicts)


def test_verdicts_are_kept_as_they_are_read_back(tmp_path):
    """Also for shear below a thousandth of f p, where f p's norm is used: a NumPy number left in one of these verdicts
    once ended every verification of the full suite."""
    verified = driver.verify_suite("full", only=["near-stuck-1e-9"], processes=1, out=tmp_path)
    (verdicts,) = verified.verdicts.values()
    kept = msgspec.json.decode((tmp_path / "results.json").read_bytes(), type=VerificationRecord)
    assert kept.finished
    assert kept.settings.only == ("near-stuck-1e-9",)
    assert kept.cases == {"near-stuck-1e-9": tuple(verdicts)}


@pytest.mark.parametrize("kind", ["killed", pytest.param("interrupted", marks=pytest.mark.slow)])
def test_a_second_run_that_is_stopped_leaves_the_first(kind, tmp_path):
    """Ledger, verdicts and report of the finished run stay as they are; a third run goes on from the second."""
    settings = {"only": ["1", "2"], "method": "exact", "seed": 5, "processes": 1, "out": tmp_path}
    driver.verify_suite("stress", **settings)
    first = {path.name: path.read_bytes() for path in tmp_path.iterdir() if path.name != LOCK_NAME}
    assert {"ledger.jsonl", "report.html", "results.csv", "results.json"} < set(first)

    def stop(done, *_):
        if done and kind == "killed":
            os._exit(9)
        if done:
            raise KeyboardInterrupt

    if kind == "killed":
        if not (child := os.fork()):
            driver.verify_suite("stress", **settings, progress=stop)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 9
    else:
        with pytest.raises(KeyboardInterrupt):
            driver.verify_suite("stress", **settings, progress=stop)
    assert {name: (tmp_path / name).read_bytes() for name in first} == first
    known = []
    driver.verify_suite("stress", **settings, progress=lambda done, *_: known.append(done))
    assert known == [1, 2]
    assert {path.name for path in tmp_path.iterdir()} - {LOCK_NAME} == set(first)
    assert (tmp_path / "ledger.jsonl").read_bytes() != first["ledger.jsonl"]


def test_a_finished_run_begins_anew(tmp_path):
    """A finished verification starts anew when repeated, because the program may have changed."""
    settings = {"only": ["1"], "method": "march", "seed": 5, "processes": 1, "out": tmp_path}
    driver.verify_suite("stress", **settings)
    first = (tmp_path / "ledger.jsonl").read_text("utf-8")
    known = []
    driver.verify_suite(
        "stress", **settings, progress=lambda done, *_: known.append((done, (tmp_path / "report.html").exists()))
    )
    assert known == [(0, True), (1, True)]  # its report stays until the new one is there
    assert len(first.splitlines()) == len((tmp_path / "ledger.jsonl").read_text("utf-8").splitlines()) == 1
