"""Nothing is overwritten in silence: the same request overwrites, other requests go elsewhere or are refused."""

import contextlib
import json
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

from partialslip.cli import main
from partialslip.errors import InputError
from partialslip.output import lock, place
from partialslip.output.files import write_new_file
from partialslip.output.place import NAME, placed, write_placed

EXACT = ("run", "hertz-shear", "--with", "exact")
USUAL = Path("results", "a")


def request(command="run", **settings):
    return {"command": command, "scene": {"name": "a", "load": {"p0": 4e8}}, "settings": settings}


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def answer(asked, out=None, force=False, name="results.json"):
    """Write the request into a file of results, as a command would."""
    with placed(USUAL, out, asked, force) as (folder, passed):
        (folder / name).write_text(json.dumps(asked), "utf-8")
    return folder, passed


def test_the_same_request_overwrites_and_others_are_numbered():
    one, two, three = request(methods=["exact"]), request(methods=["exact", "fem"]), request("score")
    assert answer(one) == (USUAL, "")
    folder, passed = answer(two)
    assert folder == Path("results", "a-2")
    assert passed == f'{USUAL} holds run a with other settings: methods = ["exact"]'
    assert answer(three) == (Path("results", "a-3"), f"{USUAL} holds run a")
    assert [answer(asked)[0].name for asked in (one, two, three)] == ["a", "a-2", "a-3"]
    assert json.loads((USUAL / "results.json").read_text("utf-8")) == one


def test_a_named_folder_is_refused_unless_forced():
    one, two = request(), {**request(), "scene": {"name": "a", "load": {"p0": 3e8, "cycles": 2}}}
    answer(one, "mine")
    before = (Path("mine") / "results.json").read_bytes()
    with pytest.raises(InputError, match=r"^--out mine: holds run a with other settings: load.p0 = 4e\+08, no load.c"):
        answer(two, "mine")
    assert (Path("mine") / "results.json").read_bytes() == before
    assert answer(one, "mine") == (Path("mine"), "")
    assert answer(two, "mine", force=True) == (Path("mine"), "")
    with pytest.raises(InputError, match="holds run a"):
        answer(one, "mine")


@pytest.mark.fault
def test_settings_that_are_left_out_of_the_comparison_are_noticed(monkeypatch):
    """Deliberate fault: only command and scene are compared, so that other settings overwrite."""

    def without_settings(asked):
        return {**json.loads(json.dumps(asked)), "settings": {}}

    answer(request(methods=["exact"]))
    assert answer(request(methods=["fem"]))[0] != USUAL
    (USUAL / NAME).unlink()
    (USUAL / "results.json").unlink()
    monkeypatch.setattr(place, "_plain", without_settings)
    answer(request(methods=["exact"]))
    assert answer(request(methods=["fem"]))[0] == USUAL


def test_files_of_others_stay():
    """Their folder is used; results of unknown settings are not overwritten."""
    USUAL.mkdir(parents=True)
    (USUAL / "notes.txt").write_text("mine", "utf-8")
    assert answer(request()) == (USUAL, "")
    assert (USUAL / "notes.txt").read_text("utf-8") == "mine"
    (USUAL / NAME).unlink()  # as an earlier version left it
    folder, passed = answer(request())
    assert (folder.name, passed) == ("a-2", f"{USUAL} holds results.json of unknown settings")


def test_an_end_without_results_leaves_no_trace():
    with contextlib.suppress(KeyboardInterrupt), placed(USUAL, None, request()):
        raise KeyboardInterrupt
    assert not Path("results").exists()
    answer(request())
    with contextlib.suppress(KeyboardInterrupt), placed(USUAL, str(USUAL), request("score"), force=True):
        raise KeyboardInterrupt
    assert answer(request()) == (USUAL, "")  # what is there is still known


def test_a_killed_command_takes_no_name():
    USUAL.mkdir(parents=True)
    (USUAL / NAME).write_text(json.dumps(request("score")), "utf-8")  # killed before the first result
    assert answer(request()) == (USUAL, "")


def test_processes_at_the_same_time():
    """Another request than that of the process at work goes on to the next folder, the same one is refused."""
    with placed(USUAL, None, request(seed=1)) as (first, _), placed(USUAL, None, request(seed=2)) as (second, _):
        assert (first.name, second.name) == ("a", "a-2")
        for out in (None, str(USUAL)):
            with pytest.raises(lock.FolderInUseError, match="is writing there"):
                answer(request(seed=1), out)


def test_a_process_that_has_just_begun_is_waited_for(monkeypatch):
    """It has the lock, but has not written its request yet."""
    began, write, go = threading.Event(), place._write_request, threading.Event()

    def slowly(folder, asked):
        if asked["settings"]["seed"] == 1:
            began.set()
            go.wait(10)
        write(folder, asked)

    monkeypatch.setattr(place, "_write_request", slowly)
    monkeypatch.setattr(place.time, "sleep", lambda _: go.set() or first.join(0.2))
    first = threading.Thread(target=answer, args=(request(seed=1),))
    first.start()
    began.wait(10)
    folder, _ = answer(request(seed=2))
    first.join()
    assert folder.name == "a-2"
    assert json.loads((USUAL / "results.json").read_text("utf-8")) == request(seed=1)


@pytest.mark.slow
def test_ten_runs_at_once_write_ten_folders():
    command = [sys.executable, "-m", "partialslip", *EXACT, "--set"]
    runs = [subprocess.Popen([*command, f"friction.f=0.{number}"], stdout=subprocess.DEVNULL) for number in range(10)]
    assert {run.wait() for run in runs} == {0}
    scenes = [json.loads(path.read_text("utf-8"))["scene"] for path in Path("results").glob("*/results.json")]
    assert sorted(scene["friction"]["f"] for scene in scenes) == [number / 10 for number in range(10)]


def test_a_file_is_overwritten_by_its_own_content_only():
    def text(content):
        return lambda path: path.write_text(content, "utf-8")

    usual = Path("results", "a.v1-calculix.inp")
    assert write_placed(usual, None, text("one")) == (usual, "")
    assert write_placed(usual, None, text("one")) == (usual, "")
    second = Path("results", "a.v1-calculix-2.inp")
    assert write_placed(usual, None, text("two")) == (second, f'{usual} holds other content, "one"')
    with pytest.raises(InputError, match=r'^--out .*inp: holds other content, "one": name another file, or'):
        write_placed(usual, usual, text("two"))
    assert write_placed(usual, usual, text("two"), force=True) == (usual, "")
    assert [path.read_text("utf-8") for path in (usual, second)] == ["two", "two"]
    assert len(list(Path("results").iterdir())) == 2


def test_without_hard_links_a_file_is_safe_all_the_same(monkeypatch):
    def none(*_):
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr("os.link", none)
    path = Path("a.inp")
    assert write_new_file(path, lambda made: made.write_text("one", "utf-8"))
    assert not write_new_file(path, lambda made: made.write_text("two", "utf-8"))
    assert write_new_file(path, lambda made: made.write_text("one", "utf-8"))
    assert [each.read_text("utf-8") for each in Path().iterdir()] == ["one"]


def test_runs(capsys):
    """A title changes no result."""
    assert main(EXACT) == 0
    assert main([*EXACT, "--set", "title=Another", "-v"]) == 0
    assert [path.name for path in Path("results").iterdir()] == ["hertz-shear"]
    capsys.readouterr()
    assert main([*EXACT, "--set", "friction.f=0.4"]) == 0
    said = capsys.readouterr().out.splitlines()[-1]
    usual = Path("results", "hertz-shear")
    assert said.endswith(f"; files in {usual}-2 ({usual} holds run hertz-shear with other settings: friction.f = 0.5)")
    assert main([*EXACT, "--set", "friction.f=0.4", "--out", str(usual)]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert main(["map", "hertz-shear", "--out", str(usual)]) == 2
    assert "holds run hertz-shear: name another folder" in capsys.readouterr().err


def test_scores_of_another_content_or_factor():
    """The folder of the file does not count, its content does."""
    rows = [f"{x},{4e8 * (1 - (x / 1e-3) ** 2) ** 0.5},{3e8 * x**2 * 1e6}" for x in np.linspace(-1e-3, 1e-3, 41)]
    Path("other").mkdir()
    for path in (Path("mine.csv"), Path("other", "mine.csv")):
        path.write_text("\n".join(["x,p,dq", *rows]), "utf-8")
    for arguments in (["mine.csv"], ["other/mine.csv"], ["mine.csv", "--factors", "1,2,1"]):
        assert main(["score", "hertz-shear", *arguments]) == 0
    Path("mine.csv").write_text("\n".join(["x,p,dq", *rows[:-1]]), "utf-8")
    assert main(["score", "hertz-shear", "mine.csv"]) == 0
    folders = sorted(path.name for path in Path("results").iterdir())
    assert folders == [f"hertz-shear-mine{number}" for number in ("", "-2", "-3")]


def test_a_folder_below_any_number_of_new_ones(capsys):
    deep = "/".join(["a"] * 1500)
    assert main([*EXACT, "--out", deep]) == 0
    assert Path(deep, "results.json").is_file()
    # Python's functions that remove folders stop at 1,000 of them, pytest's clean-up, too
    subprocess.run(["rm", "-rf", "a"] if sys.platform != "win32" else ["rmdir", "/s", "/q", "a"], check=True)
    assert main([*EXACT, "--out", "/".join(["b" * 200] * 30)]) == 2  # more than a path may have
    assert "cannot be written: File name too long" in capsys.readouterr().err
    assert not [*Path().iterdir()]


@pytest.mark.skipif(sys.platform == "win32", reason="Windows does not delete a working folder")
@pytest.mark.parametrize("out", [(), ("--out", "x"), ("--out", "x/y")])
def test_a_working_folder_that_has_been_deleted(tmp_path, monkeypatch, capsys, out):
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    assert main([*EXACT, *out]) == 2
    assert "cannot be written: the working folder has been deleted" in capsys.readouterr().err
    monkeypatch.chdir(tmp_path)
