"""Answers of any code are plain files; what is wrong with them is said in one line."""

import csv
import io
import json
import zipfile

import msgspec
import numpy as np
import pytest

from partialslip.cli import main
from partialslip.run import run
from partialslip.tools.output.files import json_text
from partialslip.tools.output.lock import locked
from partialslip.verify.benchmark import Answer, Meta, Submission, book_zip, read_problems, read_submission, scoreboard
from partialslip.verify.benchmark.codes import CODES, code_answers
from partialslip.verify.benchmark.codes.own import Own
from partialslip.verify.benchmark.problem import read_frozen

SOME = {"PS-02": read_problems()["PS-02"]}


def test_answers_that_are_kept_need_no_tables(tmp_path):
    found = code_answers("exact", SOME, folder=tmp_path)
    (tmp_path / "PS-02.csv").write_text("no table", "utf-8")
    assert code_answers("exact", SOME, folder=tmp_path).answers == found.answers  # with the same CPU seconds


def test_a_code_that_lacks_something_does_not_offer_it():
    assert code_answers("equivalent", SOME).answers == {}
    assert scoreboard(SOME, [code_answers("equivalent", SOME)]).rows[0][1] == "–"
    failed = Submission(Meta("mine", "1"), {"PS-02": Answer({}, note="did not converge in step 'press'")})
    assert scoreboard(SOME, [failed]).rows[0][1] == "none"


def test_the_zip_has_all_that_is_needed_and_is_always_the_same(tmp_path):
    data = book_zip(SOME)
    assert data == book_zip(SOME)
    (tmp_path / "problems.zip").write_bytes(data)
    with zipfile.ZipFile(tmp_path / "problems.zip") as archive:
        names = set(archive.namelist())
        assert {"README.txt", "PS-02/problem.json", "PS-02/scene.toml", "PS-02/targets.csv"} <= names
        assert {"PS-02/model.json", "PS-02/lower.msh", "PS-02/upper.inp", "PS-02/calculix-mortar.inp"} <= names
        told = json.loads(archive.read("PS-02/problem.json"))
        readme = archive.read("README.txt").decode()
        targets = archive.read("PS-02/targets.csv").decode()
    assert told["data"]["load"]["P"] == SOME["PS-02"].scene.load.P
    assert told["targets"]["m"]["value"] == SOME["PS-02"].targets["m"].value
    assert told["checksum"] == read_frozen().checksums["PS-02"]
    assert told["data"]["load"].keys() == {"P", "Q", "sigma"}  # neither null nor settings
    (row,) = (row for row in csv.DictReader(io.StringIO(targets)) if row["key"] == "dq@0.5")
    assert float(row["x"]) == told["targets"]["dq@0.5"]["x"] == 0.5 * told["targets"]["a"]["value"]
    for key in {key.partition("@")[0] for problem in read_problems().values() for key in problem.targets}:
        assert key in readme.replace("@0.5", ""), key  # every key is explained
    assert max(map(len, readme.splitlines())) <= 120


def test_commands(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["benchmark", "list"]) == 0
    assert main(["benchmark", "run", "--code", "march", "--problems", "PS-02"]) == 0
    (answers,) = tmp_path.glob("results/benchmark-march-*")
    assert f"in {answers.relative_to(tmp_path)} (settings: problems)" in capsys.readouterr().out
    assert main(["benchmark", "score", str(answers)]) == 0
    assert "partialslip march" in capsys.readouterr().out
    assert main(["benchmark", "build", str(answers), "--problems", "PS-02"]) == 0
    (book,) = {*(tmp_path / "results").iterdir()} - {answers}
    page = (book / "book.html").read_text("utf-8")
    assert "PS-02 Cattaneo and Mindlin" in page
    assert "partialslip march" in page
    names = {path.name for path in book.iterdir()}
    assert {"book.html", "problems.zip", "badge-partialslip-march.svg"} <= names
    assert main(["benchmark", "run", "--code", "ansys"]) == 2
    assert main(["benchmark", "score", "nowhere"]) == 2
    said = capsys.readouterr().err.splitlines()
    assert said == [
        "partialslip: --code 'ansys': must be one of " + ", ".join(CODES),
        "partialslip: nowhere: must be a folder with meta.toml and PS-01.json and so on",
    ]


def test_likely_mistakes_are_told_with_what_corrects_them(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    problem = SOME["PS-02"]
    exact = run(problem.scene, "exact")["exact"]
    x = np.linspace(-1.05, 1.05, 201) * exact.a
    for name, sign in (("one", 1), ("two", -1)):
        table = np.column_stack([x * 1e3, *exact.traction.at(x)[:2]]) * [1, 1e-6, sign * 0.5e-6]
        np.savetxt(tmp_path / f"{name}.txt", table)
    assert main(["benchmark", "read", "PS-02", "two.txt", "one.txt", "-o", "new", "--factors", "1e-3,1e6,1e6"]) == 0
    assert "no heading: read as --columns x=1, p=2, q=3" in capsys.readouterr().out
    assert main(["benchmark", "read", "PS-02", "one.txt", "two.txt", "-o", "turned"]) == 0
    told = "x may be in mm, p may be in MPa, dq may be in MPa of the opposite sign: correct with --factors "
    assert f"{told}0.001,1e+06,-1e+06" in capsys.readouterr().out


@pytest.fixture
def tables(tmp_path, monkeypatch):
    """Work in a folder with two different tables of tractions for PS-02."""
    monkeypatch.chdir(tmp_path)
    problem = SOME["PS-02"]
    exact = run(problem.scene, "exact")["exact"]
    x = np.linspace(-1.2, 1.2, 241) * exact.a
    for name, factor in (("mine", 1.0), ("other", 1.01)):
        table = np.column_stack([x, *exact.traction.at(x)[:2]]) * [1.0, 1.0, factor]
        np.savetxt(tmp_path / f"{name}.csv", table, delimiter=",", header="x,p,dq", comments="")


def read_into(folder, name, *words):
    return main(["benchmark", "read", "PS-02", f"{name}.csv", "-o", folder, *words])


@pytest.mark.usefixtures("tables")
def test_answers_from_tables_are_replaced_on_demand_only(tmp_path, capsys):
    folder = tmp_path / "answers"
    assert read_into("answers", "mine") == 0
    assert main(["benchmark", "score", "answers", "--problems", "PS-02"]) == 0
    assert read_submission(folder, SOME).meta.code == "mine"
    first = (folder / "PS-02.json").read_bytes()
    assert read_into("answers", "mine") == 0  # the same again
    assert read_into("answers", "other") == 2
    assert "answers/PS-02.json: is another answer" in capsys.readouterr().err
    assert (folder / "PS-02.json").read_bytes() == first
    assert read_into("answers", "other", "--code", "mine", "--force") == 0
    assert (folder / "PS-02.json").read_bytes() != first
    assert read_into("answers", "other", "--code", "another", "--force") == 2
    assert "answers holds answers of 'mine'" in capsys.readouterr().err
    with locked(folder):
        assert read_into("answers", "mine", "--force") == 2
    assert "is writing there" in capsys.readouterr().err
    assert sorted(path.name for path in folder.iterdir()) == ["PS-02.json", "meta.toml"]


@pytest.mark.usefixtures("tables")
def test_answers_of_a_command_and_of_a_table_are_never_mixed(tmp_path, capsys):
    made = ["benchmark", "run", "--code", "exact", "--problems", "PS-02", "--out"]
    assert main([*made, "run"]) == 0
    before = {path.name: path.read_bytes() for path in (tmp_path / "run").iterdir()}
    for words in ([], ["--force"], ["--code", "partialslip exact", "--force"]):
        assert read_into("run", "other", *words) == 2
        assert "holds what a command of partialslip has written" in capsys.readouterr().err
    assert {path.name: path.read_bytes() for path in (tmp_path / "run").iterdir()} == before
    assert read_into("answers", "other", "--code", "my code") == 0
    assert read_submission("answers", SOME).meta == Meta("my code", "")
    assert main([*made, "answers"]) == 2
    assert "holds meta.toml of unknown settings" in capsys.readouterr().err


def test_what_was_finished_before_an_interruption_is_kept(tmp_path, monkeypatch):
    two = {number: each for number, each in read_problems().items() if number in ("PS-01", "PS-02")}
    true, asked = Own.solve, []

    def interrupted(code, scene):
        asked.append(scene.name.upper())
        if asked == ["PS-01", "PS-02"]:
            raise KeyboardInterrupt
        return true(code, scene)

    monkeypatch.setattr(Own, "solve", interrupted)
    with pytest.raises(KeyboardInterrupt):
        code_answers("exact", two, folder=tmp_path)
    found = code_answers("exact", two, folder=tmp_path)
    assert asked == ["PS-01", "PS-02", "PS-02"]
    assert read_submission(tmp_path, read_problems()) == found
    assert list(found.answers) == ["PS-01", "PS-02"]


def test_a_temporary_file_of_a_killed_command_is_no_answer(tmp_path):
    """kill -9 while an answer is written: what was finished is read and kept, and the next run removes the file."""
    two = {number: each for number, each in read_problems().items() if number in ("PS-01", "PS-02")}
    found = code_answers("exact", {"PS-01": two["PS-01"]}, folder=tmp_path)
    (left := tmp_path / ".PS-02-abcd1234.partial.json").write_text("{", "utf-8")
    assert read_submission(tmp_path, read_problems()) == found
    assert code_answers("exact", two, folder=tmp_path).answers["PS-01"] == found.answers["PS-01"]
    assert not left.exists()


@pytest.mark.usefixtures("tables")
def test_a_second_run_writes_nothing_of_a_table_into_answers(tmp_path):
    """A value that an answer leaves out is read from the table beside it when it is graded, and only then."""
    folder = tmp_path / "answers"
    told = json_text(msgspec.structs.replace(code_answers("exact", SOME, folder=folder).answers["PS-02"], values={}))
    (folder / "PS-02.json").write_text(told, "utf-8")
    (tmp_path / "mine.csv").rename(folder / "PS-02.csv")
    assert {"a", "m", "n"} <= read_submission(folder, SOME).answers["PS-02"].values.keys()
    assert code_answers("exact", SOME, folder=folder).answers["PS-02"].values == {}
    assert (folder / "PS-02.json").read_text("utf-8") == told
