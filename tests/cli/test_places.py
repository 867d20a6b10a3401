"""The folder follows from the request, whatever ran before, and nothing is overwritten in silence."""

import contextlib
import itertools
import json
import re
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

import partialslip
from partialslip.cli import common, main
from partialslip.study.map import files as map_files
from partialslip.study.map import grid
from partialslip.tools.errors import InputError
from partialslip.tools.output import lock, place
from partialslip.tools.output.files import write_new_file
from partialslip.tools.output.place import REQUEST_NAME, Request, placed, write_placed

EXACT = ("run", "hertz-shear", "--with", "exact")
USUAL = Path("results", "a")


def data(command="run", p0=4e8, **settings):
    return {"command": command, "scene": {"name": "a", "load": {"p0": p0}}, "settings": settings}


def request(command="run", **settings):
    """A request with ``settings`` that are not those of the scene."""
    return Request(data(command, **settings), data(command))


def plain(**scene):
    """The request of a command without options, for a scene file."""
    return Request(data(**scene), data(**scene))


def own(asked):
    """The folder of a request alone."""
    return asked.places(USUAL)[-1]


@pytest.fixture
def coarse(monkeypatch):
    """Maps of few zones, without figures: where they go does not depend on what is in them."""
    monkeypatch.setattr(grid, "_COUNT", 4)
    monkeypatch.setattr(grid, "_RATIOS", np.linspace(0, 8, 5))
    for name in ("map_svg", "ends_svg"):
        monkeypatch.setattr(map_files, name, lambda _: "<svg/>")


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def answer(asked, out=None, force=False, name="results.json"):
    """Write the request into a file of results, as a command would."""
    with placed(USUAL, out, asked, force) as (folder, elsewhere):
        (folder / name).write_text(json.dumps(asked.asked), "utf-8")
    return folder, elsewhere


def test_the_folder_follows_from_the_request_in_any_order(tmp_path, monkeypatch):
    every = [plain(), request(methods=["exact"]), request(methods=["exact", "fem"]), request("map", methods=["exact"])]
    folders = {}
    for number, order in enumerate(itertools.permutations(range(len(every)))):
        (tmp_path / str(number)).mkdir()
        monkeypatch.chdir(tmp_path / str(number))
        for index in (*order, *order):
            found = answer(every[index])
            assert folders.setdefault(index, found) == found
            assert json.loads((found[0] / "results.json").read_text("utf-8")) == every[index].asked
    assert folders[0] == (USUAL, "")
    assert len({folder for folder, _ in folders.values()}) == len(every)
    for folder, elsewhere in list(folders.values())[1:]:
        assert re.fullmatch("a-[0-9a-f]{8}", folder.name)
        assert elsewhere == "settings: methods"


def test_what_differs_from_the_plain_request_is_named():
    assert request(seed=1, methods=["fem"], count=None).changed == "settings: seed, methods"
    assert request(**dict.fromkeys("abcde", 1)).changed == "settings: a, b, c, 2 more"
    assert Request(data(p0=3e8), data()).changed == "settings: load.p0"
    assert Request(data(), data(bar=1)).changed == "settings: bar"
    assert (plain().changed, Request(data(), None).changed) == ("", "")


def test_two_files_of_one_name_have_two_folders():
    """Both requests are plain: the usual folder belongs to the one that it holds."""
    one, two = plain(), plain(p0=3e8)
    assert answer(one) == (USUAL, "")
    for _ in range(2):
        assert answer(two) == (own(two), f"{USUAL} holds run a with other settings: load.p0 = 4e+08")
        assert answer(one) == (USUAL, "")
    assert json.loads((USUAL / "results.json").read_text("utf-8")) == one.asked
    assert answer(two, force=True) == (USUAL, "")
    assert answer(one)[0] == own(one)


def test_a_folder_of_ones_own_that_holds_something_else_is_refused():
    asked = request(methods=["exact"])
    answer(request(methods=["fem"]), own(asked))
    with pytest.raises(
        InputError, match=r'^--out \S*a-\w{8}: holds run a with other settings: methods = \["fem"\]: name'
    ):
        answer(asked)
    assert answer(asked, force=True) == (own(asked), "settings: methods")


def test_a_named_folder_is_refused_unless_forced():
    one, two = plain(), Request({**data(), "scene": {"name": "a", "load": {"p0": 3e8, "cycles": 2}}}, None)
    answer(one, "mine")
    before = (Path("mine") / "results.json").read_bytes()
    with pytest.raises(InputError, match=r"^--out mine: holds run a with other settings: load.p0 = 4e\+08, no load.c"):
        answer(two, "mine")
    assert (Path("mine") / "results.json").read_bytes() == before
    assert answer(one, "mine") == (Path("mine"), "")
    assert answer(two, "mine", force=True) == (Path("mine"), "")
    with pytest.raises(InputError, match="holds run a"):
        answer(one, "mine")


@pytest.mark.slow
@pytest.mark.fault
def test_settings_that_are_left_out_of_the_request_are_noticed(monkeypatch):
    """Deliberate fault: a request has command and scene only, so that other settings overwrite."""
    every = (EXACT, (*EXACT[:-1], "march"))
    assert [main(each) for each in every] == [0, 0]
    assert len(folders()) == 2
    monkeypatch.setattr(common, "_given_settings", lambda _: {})
    monkeypatch.chdir("results")
    assert [main(each) for each in every] == [0, 0]
    assert folders() == ["hertz-shear"]


def test_files_of_others_stay():
    """Their folder is used; results of unknown settings are not overwritten."""
    USUAL.mkdir(parents=True)
    (USUAL / "notes.txt").write_text("mine", "utf-8")
    assert answer(plain()) == (USUAL, "")
    assert (USUAL / "notes.txt").read_text("utf-8") == "mine"
    (USUAL / REQUEST_NAME).unlink()  # as an earlier version left it
    assert answer(plain()) == (own(plain()), f"{USUAL} holds results.json of unknown settings")


def test_an_end_without_results_leaves_no_trace():
    with contextlib.suppress(KeyboardInterrupt), placed(USUAL, None, plain()):
        raise KeyboardInterrupt
    assert not Path("results").exists()
    answer(plain())
    with contextlib.suppress(KeyboardInterrupt), placed(USUAL, str(USUAL), request("score"), force=True):
        raise KeyboardInterrupt
    assert answer(plain()) == (USUAL, "")  # what is there is still known


def test_a_killed_command_takes_no_name():
    USUAL.mkdir(parents=True)
    (USUAL / REQUEST_NAME).write_text(json.dumps(data("score")), "utf-8")  # killed before the first result
    assert answer(plain()) == (USUAL, "")


def test_processes_at_the_same_time():
    """The same request is refused. Another one has another folder, also if both are plain."""
    one, two, third = plain(), plain(p0=3e8), request(seed=1)
    with placed(USUAL, None, one) as (a, _), placed(USUAL, None, two) as (b, _), placed(USUAL, None, third) as (c, _):
        assert (a, b, c) == (USUAL, own(two), own(third))
        for asked, folder in ((one, a), (two, b), (third, c)):
            for out in (None, str(folder)):
                with pytest.raises(lock.FolderInUseError, match="is writing there"):
                    answer(asked, out)


def test_a_process_that_has_just_begun_is_waited_for(monkeypatch):
    """It has the lock, but has not written its request yet."""
    began, write, go = threading.Event(), place._write_request, threading.Event()
    one, two = plain(), plain(p0=3e8)

    def slowly(folder, asked):
        if asked == one.asked:
            began.set()
            go.wait(10)
        write(folder, asked)

    monkeypatch.setattr(place, "_write_request", slowly)
    monkeypatch.setattr(place.time, "sleep", lambda _: go.set() or first.join(0.2))
    first = threading.Thread(target=answer, args=(one,))
    first.start()
    began.wait(10)
    folder, _ = answer(two)
    first.join()
    assert folder == own(two)
    assert json.loads((USUAL / "results.json").read_text("utf-8")) == one.asked


def test_a_file_is_overwritten_by_its_own_content_only():
    def text(content):
        return lambda path: path.write_text(content, "utf-8")

    usual, asked, other = Path("results", "a.v1-calculix.inp"), plain(), request(size=0.1)
    for _ in range(2):
        assert write_placed(usual, None, asked, text("one")) == (usual, "")
    second, third = (each.places(usual, ".inp")[-1] for each in (asked, other))
    assert second.name == "a.v1-calculix-" + own(asked).name.removeprefix("a-") + ".inp"
    for _ in range(2):
        assert write_placed(usual, None, asked, text("two")) == (second, f'{usual} holds other content, "one"')
        assert write_placed(usual, None, other, text("two")) == (third, "settings: size")
    for out, request_of, path in ((usual, asked, usual), (None, asked, second), (None, other, third)):
        before = path.read_text("utf-8")
        with pytest.raises(
            InputError, match=rf'^--out \S*{path.name}: holds other content, "{before}": name another f'
        ):
            write_placed(usual, out, request_of, text("three"))
        assert path.read_text("utf-8") == before
    assert write_placed(usual, usual, asked, text("three"), force=True) == (usual, "")
    assert write_placed(usual, None, other, text("three"), force=True) == (third, "settings: size")
    assert [path.read_text("utf-8") for path in (usual, second, third)] == ["three", "two", "three"]
    assert len(list(Path("results").iterdir())) == 3


def test_without_hard_links_a_file_is_safe_all_the_same(monkeypatch):
    def none(*_):
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr("os.link", none)
    path = Path("a.inp")
    assert write_new_file(path, lambda made: made.write_text("one", "utf-8"))
    assert not write_new_file(path, lambda made: made.write_text("two", "utf-8"))
    assert write_new_file(path, lambda made: made.write_text("one", "utf-8"))
    assert [each.read_text("utf-8") for each in Path().iterdir()] == ["one"]


def folders():
    return sorted(path.name for path in Path("results").iterdir())


@pytest.mark.parametrize(
    ("command", "name"), [("map", "hertz-shear-map"), ("page", "hertz-shear-page"), ("export", "hertz-shear-gmsh.msh")]
)
@pytest.mark.usefixtures("coarse")
def test_the_usual_folder_is_that_of_the_scene_alone(command, name):
    """Whatever ran before, and however its own settings are given."""
    more = ["--to", "gmsh", "--size", "0.5"] if command == "export" else []
    plain_more = ["--to", "gmsh", "--size", "5e-2"] if command == "export" else []
    assert main([command, "hertz-shear", *more, "--set", "friction.f=0.4"]) == 0
    (other,) = folders()
    assert other != name
    assert main([command, "hertz-shear", *plain_more]) == 0
    assert main([command, "hertz-shear", *plain_more, "--set", "friction.f=5e-1"]) == 0
    assert main([command, "hertz-shear", *more, "--set", "friction.f=0.4"]) == 0
    assert folders() == sorted([other, name])


MILLIMETRES = """
units = "N-mm"
name = "mm"
material = { E = 72100, nu = 0.33 }
profile = { kind = "hertz", R = 10 }
load = { P = 200, Q = [-30, 30] }
friction = { f = 0.3 }
"""


@pytest.mark.slow
@pytest.mark.usefixtures("coarse")
def test_units_are_a_setting_unless_they_are_the_scenes_own(capsys):
    """Files are written in them, and tables read in them."""
    Path("mm.toml").write_text(MILLIMETRES, "utf-8")
    rows = [f"{x},{5e2 * (1 - x**2 / 0.063) ** 0.5 if x**2 < 0.063 else 0},{x**2}" for x in np.linspace(-0.3, 0.3, 41)]
    Path("t.csv").write_text("\n".join(["x,p,dq", *rows]), "utf-8")
    for command in (["run", "mm.toml", "--with", "exact"], ["score", "mm.toml", "t.csv"], ["map", "mm.toml"]):
        before = {*folders()} if Path("results").exists() else set()
        assert main(command) == 0
        capsys.readouterr()
        assert main([*command, "--set", "shown_in=SI"]) == 0
        assert "(settings: shown_in" in capsys.readouterr().out.splitlines()[-1]
        assert main([*command, "--set", "shown_in=N-mm"]) == 0
        assert len({*folders()} - before) == 2


@pytest.mark.usefixtures("coarse")
def test_what_a_folder_holds_is_told_in_the_units_of_the_scene(refused, capsys):
    for P in (200, 190):
        Path("mm.toml").write_text(MILLIMETRES.replace("200", str(P)), "utf-8")
        assert main(["map", "mm.toml"]) == 0
    capsys.readouterr()
    said = refused("map", "mm.toml", "--set", "load.Q=[-20,20]", "--out", "results/mm-map")
    assert "holds map mm with other settings: load.P = 200 N/mm, load.Q = [-30, 30] N/mm: name another" in said


def test_a_file_that_needs_an_option_has_no_usual_folder(capsys):
    """The file alone is no scene."""
    text = (Path(partialslip.__file__).parent / "scene/shipped/hertz-shear.toml").read_text("utf-8")
    Path("mine.toml").write_text(text.replace("f = 0.5", ""), "utf-8")
    assert main(["run", "mine.toml", "--with", "exact", "--set", "friction.f=0.5"]) == 0
    (name,) = folders()
    assert re.fullmatch("hertz-shear-[0-9a-f]{8}", name)
    assert capsys.readouterr().out.endswith(f"; files in {Path('results', name)}\n")


@pytest.mark.slow
def test_scores_of_another_content_or_factor():
    """The folder of the file does not count, its content does."""
    rows = [f"{x},{4e8 * (1 - (x / 1e-3) ** 2) ** 0.5},{3e8 * x**2 * 1e6}" for x in np.linspace(-1e-3, 1e-3, 41)]
    Path("other").mkdir()
    for path in (Path("mine.csv"), Path("other", "mine.csv")):
        path.write_text("\n".join(["x,p,dq", *rows]), "utf-8")
    for arguments in (["other/mine.csv", "--factors", "1.0,1,1"], ["mine.csv"], ["mine.csv", "--with", "exact"]):
        assert main(["score", "hertz-shear", *arguments]) == 0
    assert folders() == ["hertz-shear-mine"]
    assert main(["score", "hertz-shear", "mine.csv", "--factors", "1,2,1"]) == 0
    assert len(folders()) == 2
    Path("mine.csv").write_text("\n".join(["x,p,dq", *rows[:-1]]), "utf-8")
    assert main(["score", "hertz-shear", "mine.csv"]) == 0
    assert len(folders()) == 3


@pytest.mark.slow
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
def test_a_working_folder_that_has_been_deleted(tmp_path, monkeypatch, refused, out):
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    assert "cannot be written: the working folder has been deleted" in refused(*EXACT, *out)
    monkeypatch.chdir(tmp_path)
