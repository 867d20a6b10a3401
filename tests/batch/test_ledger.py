"""A ledger keeps finished cases, however the study ends."""

import io
import json
import os
import re
import signal
import subprocess
import sys
import time

import pytest
from refusing import line_of

import partialslip
from partialslip.study.batch import ledger as module
from partialslip.study.batch.job import Job
from partialslip.study.batch.ledger import Ledger, scene_content
from partialslip.tools import origin
from partialslip.tools.origin import checksum_of, source_checksum


def test_entries_are_there_again(tmp_path):
    ledger = Ledger(tmp_path / "new" / "ledger.jsonl")
    ledger.add("one", {"found": 1.5})
    ledger.add("two", {"found": 2.5})
    again = Ledger(ledger.path)
    assert len(again) == 2
    assert "one" in again
    assert again["two"]["found"] == 2.5
    assert again["two"]["made"]["versions"]["numpy"]


TEXTS = {
    "a line": b"what I want to keep",
    "lines": b"what I want to keep\nand this, too\nand the end",
    "a table": b"x,p,dq\n0,1,2\n1,2,3",
    "an object": b'{"key": "mine", "value": 3}',
    "a list": b"[1, 2]",
    "no text": bytes(range(256)),
}


@pytest.mark.parametrize("name", TEXTS)
def test_a_file_of_the_user_is_left_as_it_is(tmp_path, name):
    path = tmp_path / "own.txt"
    path.write_bytes(TEXTS[name])
    with pytest.raises(partialslip.InputError, match=r"own.txt: line 1: must be an entry of a ledger"):
        partialslip.sweep(partialslip.load_scene("hertz-shear"), {"friction.f": [0.3]}, "exact", ledger=path)
    assert path.read_bytes() == TEXTS[name]


@pytest.mark.parametrize("value", [None, 3, [], "x"])
def test_a_sound_line_of_another_program_is_refused(tmp_path, value):
    """Its checksum is right, but its run is none."""
    path, scene, over = tmp_path / "ledger.jsonl", partialslip.load_scene("hertz-shear"), {"friction.f": [0.6]}
    partialslip.sweep(scene, over, "exact", ledger=path)
    entry = json.loads(path.read_bytes())
    del entry["sum"]
    path.write_bytes(module._sealed(json.dumps(entry | {"labels": value})) + b"\n")
    before = path.read_bytes()
    assert re.search(
        r"ledger.jsonl: entry \w+: .*; remove its line", line_of(partialslip.sweep, scene, over, "exact", ledger=path)
    )
    assert path.read_bytes() == before


@pytest.mark.parametrize("every", [pytest.param(1, marks=pytest.mark.slow), 17])
def test_an_entry_torn_at_any_byte_is_dropped_and_no_other(tmp_path, every):
    path = tmp_path / "ledger.jsonl"
    Ledger(path).add("one", {"found": 1})
    first = path.read_bytes()
    Ledger(path).add("two", {"found": {"a": [1, 2]}})
    whole = path.read_bytes()
    for count in {*range(0, len(whole), every), len(first) - 1, len(first), len(whole) - 1}:
        path.write_bytes(whole[:count])
        kept = [entry["key"] for entry in Ledger(path)]
        assert kept == (["one"] if count >= len(first) - 1 else []) + (["two"] if count == len(whole) - 1 else [])
        Ledger(path).add("three", {})
        assert [entry["key"] for entry in Ledger(path)] == [*kept, "three"]


def test_a_full_disk_leaves_whole_entries(tmp_path, monkeypatch):
    path = tmp_path / "ledger.jsonl"
    ledger = Ledger(path)
    ledger.add("one", {"found": 1})
    whole = path.read_bytes()

    class Full(io.FileIO):
        def write(self, line):
            return super().write(line[:20])

    monkeypatch.setattr(module, "open", lambda path, *_, **__: Full(path, "ab"), raising=False)
    with pytest.raises(partialslip.InputError, match="cannot be written: No space left on device"):
        ledger.add("two", {"found": 2})
    assert path.read_bytes() == whole
    assert "two" not in ledger


@pytest.mark.fault
def test_a_tail_that_is_cut_before_it_is_judged_is_caught(tmp_path, monkeypatch):
    """Deliberate fault: every last line without an end counts as a torn entry."""
    monkeypatch.setattr(module, "_is_torn", bool)
    with pytest.raises(pytest.fail.Exception, match="DID NOT RAISE"):
        test_a_file_of_the_user_is_left_as_it_is(tmp_path, "a line")


def test_a_line_that_was_changed_is_refused(tmp_path):
    """For each byte of an entry: readers rely on the shape and the values of entries."""
    path = tmp_path / "ledger.jsonl"
    Ledger(path).add("one", {"found": 1.5})
    whole = path.read_bytes()
    for place in range(len(whole) - 1):
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1 :])
        with pytest.raises(partialslip.InputError, match=r"line 1: must be an entry.* remove the line"):
            Ledger(path)


def test_a_killed_writer_leaves_whole_lines(tmp_path):
    """kill -9 while many entries are written: every line in the file is an entry, and the study can continue."""
    path = tmp_path / "ledger.jsonl"
    code = (
        "import sys, itertools, pathlib\nfrom partialslip.study.batch.ledger import Ledger\n"
        "ledger = Ledger(pathlib.Path(sys.argv[1]))\n"
        "for n in itertools.count(): ledger.add(str(n), {'text': 'x' * 5000})\n"
    )
    writer = subprocess.Popen([sys.executable, "-c", code, str(path)])
    while not path.exists() or path.stat().st_size < 100_000:
        time.sleep(0.01)
        assert writer.poll() is None
    os.kill(writer.pid, signal.SIGKILL)
    writer.wait()
    ledger = Ledger(path)
    assert [entry["key"] for entry in ledger] == [str(n) for n in range(len(ledger))]
    ledger.add("last", {})
    assert all(json.loads(line) for line in path.read_text("utf-8").splitlines())


def test_the_checksum_knows_names_and_contents_but_not_what_is_compiled(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "one.py").write_text("x = 1\n", "utf-8")
    (tmp_path / "a" / "prices.json").write_text("{}", "utf-8")
    first = checksum_of([tmp_path])
    (tmp_path / "a" / "__pycache__").mkdir()
    (tmp_path / "a" / "__pycache__" / "one.pyc").write_bytes(b"0")
    assert checksum_of([tmp_path]) == first
    seen = {first}
    for name, text in (("one.py", "x = 2\n"), ("prices.json", "[]"), ("two.py", "")):
        (tmp_path / "a" / name).write_text(text, "utf-8")
        seen.add(checksum_of([tmp_path]))
    assert len(seen) == 4


@pytest.mark.fault
@pytest.mark.parametrize("change", ["scene", "mesh", "code"])
def test_a_case_of_a_study_is_another_one(change, tmp_path, monkeypatch):
    """Deliberate fault: a setting, a mesh file or a source file is changed, under the same name."""
    mesh = tmp_path / "lower.msh"
    mesh.write_text("one", "utf-8")
    settings = [f"bodies.lower={{mesh='{mesh}'}}"] if change == "mesh" else []
    scene = partialslip.load_scene("hertz-shear", settings)
    case = Job(scene, ("fem",))
    assert case.key == Job(scene, ("fem",)).key
    ledger = Ledger(tmp_path / "ledger.jsonl")
    ledger.add(case.key, {})
    assert ledger.outdated == 0
    if change == "scene":
        case = Job(partialslip.load_scene("hertz-shear", ["friction.f=0.49"]), ("fem",))
    elif change == "mesh":
        mesh.write_text("two", "utf-8")
        content = scene_content(scene)["mesh files"]
        mesh.unlink()
        assert scene_content(scene)["mesh files"] != content
        mesh.write_text("two", "utf-8")
    else:
        monkeypatch.setattr(module, "source_checksum", lambda: "another")
        assert ledger.outdated == 1
    assert case.key not in ledger


def test_the_source_files_of_all_packages_count():
    assert len(source_checksum()) == 16
    assert list(origin._SOURCES) == ["partialslip", "partialslip_fem", "partialslip_meshes"]
