"""Answers that are handed in: each thing that is wrong has a line, and nothing wrong is accepted."""

import hashlib
import json
import os
import re
import shlex
from importlib.resources import files

import numpy as np
import pytest
import tomli_w
import yaml

from partialslip.cli import main
from partialslip.run import run
from partialslip.verify.benchmark import handed_in, read_problems, read_submission, tables
from partialslip.verify.benchmark import handin as checks
from partialslip.verify.benchmark.tables import read_table

KNOWN = read_problems()
PROBLEM = KNOWN["PS-02"]
DECK = "** a deck\n"
SUM = hashlib.sha256(DECK.encode()).hexdigest()
META = {"code": "my code", "version": "1.0", "settings": "elements of a/50", "machine": "a laptop", "author": "A. Body",
        "inputs": {"decks/job.inp": SUM}}  # fmt: skip


@pytest.fixture(scope="module")
def table():
    """Table of tractions of PS-02, from the exact solution, as text."""
    exact = run(PROBLEM.scene, "exact")["exact"]
    x = np.linspace(-1.05, 1.05, 501) * exact.a
    rows = np.column_stack([x, *exact.traction.at(x)[:2]])
    return "x,p,dq\n" + "\n".join(",".join(f"{value:.12g}" for value in row) for row in rows.tolist()) + "\n"


@pytest.fixture
def folder(tmp_path, table, monkeypatch):
    """Folder of answers with nothing wrong: meta.toml, an input file, and an answer with its table."""
    monkeypatch.chdir(tmp_path)
    made = tmp_path / "mine"
    (made / "decks").mkdir(parents=True)
    (made / "decks" / "job.inp").write_text(DECK, "utf-8")
    (made / "meta.toml").write_text(tomli_w.dumps(META), "utf-8")
    (made / "PS-02.csv").write_text(table, "utf-8")
    answer = {"values": read_table(PROBLEM, made / "PS-02.csv").values, "cpu_s": 12.5}
    (made / "PS-02.json").write_text(json.dumps(answer), "utf-8")
    return made


def checked(capsys, code, name="mine"):
    """What the check of a folder prints, which ends with this exit code."""
    capsys.readouterr()
    assert main(["benchmark", "check", name]) == code
    return capsys.readouterr()


def changed_meta(**new):
    def change(folder):
        (folder / "meta.toml").write_text(tomli_w.dumps(META | new), "utf-8")

    return change


def more_inputs(name):
    return changed_meta(inputs=META["inputs"] | {name: SUM})


def without_meta(name):
    def change(folder):
        (folder / "meta.toml").write_text(tomli_w.dumps({key: META[key] for key in META if key != name}), "utf-8")

    return change


def changed_answer(number="PS-02", **new):
    """Change values of the answer by key, or give it other fields."""

    def change(folder):
        told = json.loads((folder / "PS-02.json").read_text("utf-8"))
        fields = {key: value for key, value in new.items() if key in ("values", "note", "ladder", "cpu_s", "colour")}
        told["values"].update({key: value for key, value in new.items() if key not in fields})
        (folder / f"{number}.json").write_text(json.dumps(told | fields), "utf-8")

    return change


def written(name, content):
    return lambda folder: (folder / name).write_text(content, "utf-8")


def factor_of_table(factor):
    """The table is of other tractions than the answer."""

    def change(folder):
        head, *rows = (folder / "PS-02.csv").read_text("utf-8").split()
        spoiled = [row.split(",")[:1] + [repr(float(each) * factor) for each in row.split(",")[1:]] for row in rows]
        (folder / "PS-02.csv").write_text("\n".join([head, *map(",".join, spoiled)]), "utf-8")
        told = json.loads((folder / "PS-02.json").read_text("utf-8"))
        told["values"] = {"p_max": told["values"]["p_max"]}
        (folder / "PS-02.json").write_text(json.dumps(told), "utf-8")

    return change


def linked_out(folder):
    (folder.parent / "other.inp").write_text(DECK, "utf-8")
    (folder / "decks" / "job.inp").unlink()
    (folder / "decks" / "job.inp").symlink_to("../../other.inp")


def linked_table(folder):
    (folder / "PS-02.csv").rename(folder.parent / "other.csv")
    (folder / "PS-02.csv").symlink_to("../other.csv")


def linked_in_a_circle(folder):
    (folder / "loop.inp").symlink_to("loop.inp")


def piped(folder):
    os.mkfifo(folder / "pipe.inp")


def alone(**new):
    """The same as :func:`changed_answer`, without the table, which would differ."""
    return lambda folder: ((folder / "PS-02.csv").unlink(), changed_answer(**new)(folder))


def coarser(**new):
    """A ladder whose first mesh has other values."""

    def change(folder):
        values = json.loads((folder / "PS-02.json").read_text("utf-8"))["values"]
        rungs = [{"h": 4 / 2**k, "values": values | (new if k == 0 else {})} for k in range(3)]
        changed_answer(ladder=rungs)(folder)

    return change


OTHER = "0" * 64
RUNG = {"h": 0.04, "values": {}}
SPOILED = {
    "no author": (without_meta("author"), r"meta.toml: author = '': must be who ran the code"),
    "author that nobody sees": (changed_meta(author="\u200b"), r"meta.toml: author = .*: must be who ran the code"),
    "blank note": (alone(values={}, note="\u200b "), r"values: must have a value, or note must say why"),
    "negative a": (alone(a=-2e-4), r"PS-02.json: values.a = -0.0002: must be > 0"),
    "tension": (alone(**{f"p@{x}": -4e8 for x in ("-0.9", "-0.5", "0", "0.5", "0.9")}),
                r"PS-02.json: values.p@-?0.* = -400000000: must be >= 0: pressure is positive"),
    "ends in the wrong order": (alone(m=-1.1e-4), r"values.n = .*: must be >= -m = 0.00011, the left end"),
    "negative a on a coarse mesh": (coarser(a=-2e-4), r"PS-02.json: ladder.0..values.a = -0.0002: must be > 0"),
    "no unknowns": (lambda folder: written("PS-02.json", '{"values": {"a": 2e-4}, "unknowns": 0}')(folder),
                    r"PS-02.json: unknowns: must be >= 1"),
    "no version": (without_meta("version"), r"meta.toml: version: missing"),
    "empty version": (changed_meta(version=""), r"meta.toml: version = '': must be the version of the code"),
    "unknown field": (changed_meta(licence="MIT"), r"meta.toml: licence: unknown key"),
    "no TOML": (written("meta.toml", "code = "), r"meta.toml: not valid TOML"),
    "input edited": (written("decks/job.inp", "** another deck\n"), r"inputs.'decks/job.inp' = '[0-9a-f]{64}': must be "
                     r"'[0-9a-f]{64}', the SHA-256 checksum"),
    "checksum of something else": (changed_meta(inputs={"decks/job.inp": OTHER}), f"= '{OTHER}': must be '{SUM}'"),
    "input missing": (more_inputs("no.inp"), r"inputs.'no.inp': .*no.inp: cannot be read"),
    "input outside": (more_inputs("../x.inp"), r"inputs.'../x.inp': must be the path of an"),
    "input linked from outside": (linked_out, r"inputs.'decks/job.inp': must be the path of an input file"),
    "table linked from outside": (linked_table, r"PS-02.csv: must be a file of the folder, not a link to a file"),
    "link to itself": (linked_in_a_circle, r"loop.inp: must be a file of the folder, not a link .* to itself"),
    "input empty": (lambda folder: (written("e.inp", "")(folder), more_inputs("e.inp")(folder)),
                    r"inputs.'e.inp': must not be an empty file"),
    "file not listed": (written("more.inp", DECK), rf'more.inp: must be listed in the table inputs of meta.toml, as '
                        rf'"more.inp" = "{SUM}", or left out'),
    "pipe": (piped, r"pipe.inp: cannot be read: must be a regular file"),
    "table without answer": (written("PS-03.csv", DECK), r"PS-03.csv: must be listed in the table inputs"),
    "no such problem": (changed_answer("PS-99"), r"PS-99.json: no problem has this number; known are PS-01"),
    "no such target": (changed_answer(b=1.0), r"PS-02.json: values.b: no target has this key; known are a, m, n"),
    "text for a number": (changed_answer(a="2e-4"), r"PS-02.json: values.*: must be a number, not a string"),
    "unknown field of an answer": (changed_answer(colour="red"), r"PS-02.json: colour: unknown key"),
    "no JSON": (written("PS-02.json", "{"), r"PS-02.json: not JSON"),
    "negative cost": (changed_answer(cpu_s=-1), r"PS-02.json: cpu_s: must be >= 0"),
    "short ladder": (changed_answer(values={}, note="none", ladder=[RUNG]), r"ladder: must have 2 meshes or more"),
    "ladder that grows": (changed_answer(values={}, note="none", ladder=[RUNG | {"h": h} for h in (4, 5, 3)]),
                          r"ladder.1..h = 5.0: must be less than 4.0"),
    "mesh of no size": (changed_answer(values={}, note="none", ladder=[RUNG | {"h": -1}] * 3), r"must be > 0"),
    "ladder that ends elsewhere": (changed_answer(ladder=[RUNG | {"h": 4 - k} for k in range(3)]),
                                   r"PS-02.json: values: must be those of the last mesh of the ladder"),
    "neither value nor reason": (alone(values={}), r"values: must have a value, or note must say why"),
    "value in mm": (alone(a=1.0), r"PS-02.json: values.a = 1: must be within .* m of the target; all values are in SI"),
    "value that the table has not": (changed_answer(p_max=PROBLEM.targets["p_max"].value * 1.001),
                                     r"PS-02.json: values.p_max = \d+.*: must be \d+.*, as PS-02.csv has"),
    "table of other tractions": (factor_of_table(1.01), r"PS-02.json: values.p_max = .* as PS-02.csv has it"),
    "table that is none": (written("PS-02.csv", "x,p\n0,1\n"), r"PS-02.csv: "),
}  # fmt: skip


def test_a_folder_with_nothing_wrong_is_accepted_and_graded_as_by_score(folder, capsys):
    assert main(["benchmark", "score", "mine"]) == 0
    graded = capsys.readouterr().out
    assert checked(capsys, 0).out == graded + "accepted: mine can be handed in\n"
    assert handed_in(folder, KNOWN) == (read_submission(folder, KNOWN), [])


@pytest.mark.parametrize("spoil", SPOILED)
def test_a_spoiled_folder_is_refused_in_a_line(spoil, folder, capsys):
    change, said = SPOILED[spoil]
    change(folder)
    out, err = checked(capsys, 2)
    assert err == "partialslip: mine: not accepted: 1 thing to correct\n"
    (line,) = out.splitlines()
    assert line.startswith("mine")
    assert re.search(said, line)


@pytest.mark.fault
@pytest.mark.parametrize("spoil", ["input edited", "value that the table has not"])
def test_a_check_that_is_left_out_is_seen(spoil, folder, capsys, monkeypatch):
    """Checksums, or tables, are not looked at."""
    name = "_input_faults" if spoil == "input edited" else "_answer_faults"
    monkeypatch.setattr(checks, name, lambda *_: iter(()))
    with pytest.raises(AssertionError):
        test_a_spoiled_folder_is_refused_in_a_line(spoil, folder, capsys)


@pytest.fixture
def coarse(folder):
    """Answer with the values of the targets, beside the table of a coarse mesh of linear elements."""
    solved = run(PROBLEM.scene.replace({"fem.size": 0.1, "fem.order": 1}), "fem")["fem"]
    x = np.linspace(-1.05, 1.05, 501) * solved.a
    rows = np.column_stack([x, *solved.traction.at(x)[:2]])
    np.savetxt(folder / "PS-02.csv", rows, delimiter=",", header="x,p,dq", comments="")
    changed_answer(**TRUE)(folder)
    return folder


TRUE = {key: target.value for key, target in PROBLEM.measured.items()}


def test_a_table_checks_values_and_does_not_replace_them(folder, capsys):
    """The values of the targets are those of the exact table to the error of reading it, and keep their grade."""
    changed_answer(**TRUE)(folder)
    beside = checked(capsys, 0).out
    assert re.search(r"PS-02.csv alone: grade [AB] .*; 16 values are compared with it, to \S+ at worst", beside)
    assert read_submission(folder, KNOWN).answers["PS-02"].values == TRUE
    (folder / "PS-02.csv").unlink()
    assert checked(capsys, 0).out.splitlines() == [line for line in beside.splitlines() if "PS-02.csv" not in line]


def test_values_that_an_answer_leaves_out_are_read_from_its_table(folder, capsys):
    told = read_submission(folder, KNOWN).answers["PS-02"].values
    changed_answer(values={"a": told["a"], "slip": 1.0})(folder)
    assert read_submission(folder, KNOWN).answers["PS-02"].values == told | {"slip": 1.0}
    assert main(["benchmark", "score", "mine"]) == 0
    assert f"1 of {len(KNOWN)} problems count" in capsys.readouterr().out
    changed_answer(values={key: told[key] for key in told if key not in ("m", "n")} | {"m": None})(folder)
    assert read_submission(folder, KNOWN).answers["PS-02"].values == told | {"m": None}
    assert main(["benchmark", "score", "mine"]) == 4
    assert "; read from it: n\n" in capsys.readouterr().out


def test_targets_beside_the_table_of_a_coarse_mesh_are_named(coarse, capsys):
    """Values copied from the targets."""
    assert (coarse / "PS-02.csv").is_file()
    lines = checked(capsys, 2).out.splitlines()
    assert all(
        re.search(r"values\.\S+ = \S+: must be \S+ within \S+ (m|Pa|1), as PS-02.csv has it", line) for line in lines
    )
    assert main(["benchmark", "score", "mine"]) == 0
    # lines over elements of 0.1 a, at 501 points, do not tell m
    assert re.search(r"PS-02.csv alone: .*not offered \(m\)", capsys.readouterr().out)


def test_a_table_that_is_too_coarse_to_compare_with_is_named(folder, capsys):
    """Targets beside a table of few rows, in which no slip zone is seen."""
    head, *rows = (folder / "PS-02.csv").read_text("utf-8").split()
    (folder / "PS-02.csv").write_text("\n".join([head, *rows[::32]]), "utf-8")
    changed_answer(**TRUE)(folder)
    main(["benchmark", "check", "mine"])
    assert re.search(r"PS-02.csv alone: .*; \d+ are not: its rows are too far apart", capsys.readouterr().out)


@pytest.mark.fault
def test_a_table_that_is_not_compared_is_seen(coarse, capsys, monkeypatch):
    """Every difference counts as an error of reading."""
    monkeypatch.setattr(tables, "_SURE", np.inf)
    with pytest.raises(AssertionError):
        test_targets_beside_the_table_of_a_coarse_mesh_are_named(coarse, capsys)


def test_every_thing_that_is_wrong_has_a_line(folder, capsys):
    without_meta("author")(folder)
    written("more.inp", DECK)(folder)
    changed_answer(b=1.0, c=2.0)(folder)
    written("PS-01.json", "{")(folder)
    out, err = checked(capsys, 2)
    assert len(out.splitlines()) == 5
    assert err == "partialslip: mine: not accepted: 5 things to correct\n"


def test_an_answer_that_lacks_a_headline_target_is_not_judged(folder, capsys):
    changed_answer(m=None)(folder)
    told = checked(capsys, 4).out
    assert "not judged: PS-02 (m)" in told
    assert told.endswith("can be handed in, but problems that are not judged do not count (exit code 4)\n")


def test_a_folder_that_is_none_has_a_line(folder, capsys):
    assert checked(capsys, 2, "nowhere").out == "nowhere: must be a folder with meta.toml and PS-01.json and so on\n"
    for path in folder.glob("PS-02.*"):
        path.unlink()
    assert checked(capsys, 2).out == "mine: no answers; must have PS-01.json and so on\n"


def test_the_workflow_runs_commands_that_there_are(folder, capsys):
    assert folder.is_dir()
    told = yaml.safe_load((files("partialslip.verify.benchmark") / "grade.yml").read_text("utf-8"))
    runs = [step["run"] for step in told["jobs"]["grade"]["steps"] if "run" in step]
    (command,) = (run.partition(" | ")[0] for run in runs if run.startswith("partialslip"))
    words = shlex.split(command.replace('"$ANSWERS"', "mine"))[1:]
    assert main(words) == 0
    assert "accepted" in capsys.readouterr().out
    assert told["env"]["PACKAGE"] == ""  # no index has the package: the user names it, and the step asks for it
    assert any("${PACKAGE:?" in step for step in runs)
