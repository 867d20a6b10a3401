"""Files against accident: a changed number is said, the file is still read, and outcomes follow from the numbers."""

import json
import re
import shutil
import warnings

import msgspec
import numpy as np
import pytest

from partialslip import Outcome, load_result, load_scene, run
from partialslip.report import write_run
from partialslip.report.record import record
from partialslip.tools.seal import edited, sealed_text

NUMBER = re.compile(r"(?<=[ \[])-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?=[,\n\]}])")


@pytest.fixture(scope="module")
def found():
    return run(load_scene("hertz-large-tension", ["fem.accuracy=1e-2"]), ["exact", "march"], subsurface=True)


@pytest.fixture(scope="module")
def written(found, tmp_path_factory):
    folder = tmp_path_factory.mktemp("written")
    write_run(found, folder)
    return folder


@pytest.fixture
def file(written, tmp_path):
    shutil.copytree(written, tmp_path, dirs_exist_ok=True)
    return tmp_path / "results.json"


def changed(path, change):
    data = json.loads(path.read_text("utf-8"))
    change(data)
    path.write_text(json.dumps(data), "utf-8")


def verdicts(data, key):
    return [each for each in data["comparison"]["march"]["verdicts"] if each["quantity"] == key]


def load(path):
    with pytest.warns(UserWarning, match=r"results.json: edited since partialslip wrote it$"):
        return load_result(path)


@pytest.mark.slow
@pytest.mark.fault
def test_a_changed_digit_is_seen(file):
    """In 200 of all numbers of a file, the last digit but one of the mantissa."""
    text = file.read_text("utf-8")
    spots = [spot for spot in NUMBER.finditer(text) if spot.start() < text.index('"sum"')]
    assert len(spots) > 1000
    for number in np.random.default_rng(7).choice(len(spots), 200, replace=False):
        spot = spots[number]
        mantissa = re.match(r"-?\d+(?:\.\d+)?", spot[0])[0]
        digit = mantissa[-1]
        other = text[: spot.start()] + mantissa[:-1] + str((int(digit) + 5) % 10) + text[spot.start() + len(mantissa) :]
        if float(spot[0]) != float(other[spot.start() : spot.end()]):
            assert edited(other, json.loads(other)), spot


def test_a_file_written_anew_by_another_program_is_not_edited(file, found):
    """Other order of keys, other white space, other forms of the same numbers."""

    def plain(value):
        if isinstance(value, dict):
            return {key: plain(value[key]) for key in sorted(value)}
        if isinstance(value, list):
            return [plain(each) for each in value]
        return int(value) if isinstance(value, float) and value.is_integer() and abs(value) < 2**53 and value else value

    data = plain(json.loads(file.read_text("utf-8")))
    file.write_text(json.dumps(data, indent=7, ensure_ascii=True), "utf-8")
    kept = load_result(file)
    assert kept.edited is False
    assert kept.outcome is found.outcome


def test_an_edited_length_is_said_and_missed(file, found):
    """a = 999 m was read as "passed"."""
    assert found.passed
    changed(file, lambda data: data["methods"]["march"].update(a=999.0))
    kept = load(file)
    assert kept.edited
    assert kept.methods["march"].a == 999.0
    assert kept.outcome is kept.comparison["march"].outcome is Outcome.MISSED
    assert kept.missed[0].startswith("march: a: error ")
    assert repr(kept) == "Record of hertz-large-tension, edited since it was written: missed; exact, march"
    changed(file, lambda data: data["methods"]["march"].update(a=found["march"].a))  # the change is taken back
    assert load_result(file) == record(found, made=kept.made)


def every_outcome(data, outcome):
    data["outcome"] = outcome
    data["missed"] = []
    for each in data["comparison"].values():
        each.update(outcome=outcome, missed=[])
        for verdict in (*each["verdicts"], *each["conditions"]):
            verdict["outcome"] = outcome


def each_of(key, **values):
    return lambda data: [each.update(values) for each in verdicts(data, key)]


def in_method(name, *path, value):
    def change(data):
        *parents, last = path
        place = data["methods"][name]
        for key in parents:
            place = place[key]
        place[last] = value

    return change


def without_m(data):
    found = data["comparison"]["march"]
    found["verdicts"] = [each for each in found["verdicts"] if each["quantity"] != "m"]


CHANGES = {
    "error over the bar": (each_of("q", error=9.0), "missed", "march: q: error 9 > "),
    "no error": (each_of("q", error=None, reason="not a number"), "missed", "march: q: not a number"),
    "m": (in_method("march", "m", value=0.0), "missed", "march: m: error "),
    "an end": (in_method("march", "contact_ends", 1, 0, value=-9.0), "missed", "march: left: error "),
    "regime": (in_method("march", "regime", value="sliding"), "missed", "march: regime: sliding, not "),
    "residual": (in_method("exact", "certificate", "here", value=1.0), "missed", "exact: certificate here: error 1"),
    "no residual": (in_method("march", "certificate", "here", value=None), "missed", "march: certificate here: not a"),
    "no p": (in_method("exact", "traction", "p", 3, value=None), "missed", "exact: finite: error 1 > 0"),
    "no verdict": (without_m, "not judged", ""),
    "no bar": (each_of("m", bar=None), "not judged", ""),
    "nothing": (dict, "passed", ""),
}


@pytest.mark.parametrize("said", ["passed", "missed", "not judged"])
@pytest.mark.parametrize("what", CHANGES)
def test_outcomes_follow_from_the_numbers(file, what, said):
    """Whatever the file says of outcomes."""
    change, outcome, missed = CHANGES[what]
    changed(file, lambda data: (change(data), every_outcome(data, said)))
    with warnings.catch_warnings(action="ignore"):
        kept = load_result(file)
    assert kept.outcome == outcome
    assert bool(kept.missed) == (outcome == "missed")
    assert not missed or kept.missed[-1].startswith(missed)  # a residual that is null is also a lost number
    if not missed.startswith("exact"):
        own = kept.comparison["march"]
        assert own.outcome == outcome
        assert tuple(f"march: {each}" for each in own.missed) == kept.missed


@pytest.mark.fault
def test_outcomes_that_are_believed_are_seen(file, monkeypatch):
    monkeypatch.setattr("partialslip.report.record.Record.judged_again", property(lambda record: record))
    changed(file, lambda data: (each_of("q", error=9.0)(data), every_outcome(data, "passed")))
    assert load(file).outcome == "passed"  # which the test above would not accept


SCENES = {
    "no friction": ("hertz-shear", "friction.f=0", "load.Q=[0,0]"), "sliding": ("hertz-shear", "load.Q=[-3e5,3e5]"),
    "no stick zone judged": ("hertz-shear", "load={a=2e-3,Q=[-202151.086544,202151.086544],sigma=[-8.67e8,8.67e8]}"),
    "mean loads": ("hertz-shear", "load.Q=[-1e4,9e4]"), "uneven": ("hertz-shear", "load.M=[0,20]"),
    "varying P": ("hertz-shear", "load={P=[1.5e5,2e5],Q=[-1e4,1e4],sigma=[0,0]}"),
    "forced off": ("hertz-large-tension", "effects.tension=false"), "no bars": ("hertz-shear", "fem.size=0.1"),
}  # fmt: skip


@pytest.mark.parametrize("what", SCENES)
def test_outcomes_of_all_kinds_of_runs_stay_as_they_are(what, tmp_path):
    name, *settings = SCENES[what]
    kept = record(run(load_scene(name, ["fem.accuracy=1e-2", *settings]), ["exact", "march"]))
    (tmp_path / "results.json").write_text(kept.json, "utf-8")
    assert load_result(tmp_path / "results.json") == kept


def test_a_reference_that_is_none_makes_no_run_pass(file):
    """Earlier versions took solutions for a reference that do not hold."""
    changed(
        file,
        lambda data: (data.update(reference="march"), data["comparison"].update(exact=data["comparison"]["march"])),
    )
    assert load(file).outcome is not Outcome.PASSED


def test_an_edited_record_stays_edited(file, tmp_path):
    changed(file, lambda data: data["methods"]["march"].update(p0=1.0))
    again = tmp_path / "again-results.json"
    again.write_text(load(file).json, "utf-8")
    assert load(again).edited


def test_a_file_of_an_earlier_version_is_read(file):
    """Without checksum, and without the keys that came later."""
    changed(file, lambda data: [data.pop(key) for key in ("sum", "edited")])
    kept = load_result(file)
    assert kept.edited is None
    assert "without a checksum" in repr(kept)


def test_seals_are_of_the_content():
    text = sealed_text({"b": 1.0, "a": [1, 2.5, None, True, "é"]})
    assert text.rstrip().endswith("}")
    assert edited(text, json.loads(text)) is False
    tree = json.loads(text)
    edited(text, tree)
    assert tree == {"b": 1.0, "a": [1, 2.5, None, True, "é"]}
    for other in ("1.5", "[]", "null", "false", '"1"'):
        spoilt = text.replace("2.5", other)
        assert edited(spoilt, json.loads(spoilt))
    assert edited(msgspec.json.encode({"a": 1}), {"a": 1}) is None
