"""One strict reader of JSON: whatever is ambiguous is refused in one line, by every command that reads a file."""

import json
import re
from typing import Any

import msgspec
import pytest
from refusing import line_of

from partialslip import InputError, load_result, load_rig
from partialslip.study.batch.ledger import Ledger, _sealed
from partialslip.study.cost import read_peers
from partialslip.tools.strictjson import decoded, parsed
from partialslip.verify.benchmark import read_problems, read_submission
from partialslip.verify.verdicts import was_finished


class Found(msgspec.Struct):
    a: float
    n: int = 0
    of: dict[str, float | None] = {}


GOOD = [
    '{"a": 1}',
    '{"a": 1.5e-300, "n": 3}',
    '{"a": -0.0, "of": {"a": null, "A": 1}}',
    '\ufeff{"a": 0e999}',
    '{"a": 1e+2}',
]
BAD = {
    "a key twice": ('{"a": 1.0, "a": 2.0}', "a: a key that stands twice"),
    "a key twice inside": ('{"a": 1.0, "of": {"b": 1, "c": 2, "b": 1}}', "b: a key that stands twice"),
    "a key twice, escaped": ('{"a": 1.0, "\\u0061": 2.0}', "a: a key that stands twice"),
    "NaN": ('{"a": NaN}', "NaN: must be a number, or null"),
    "Infinity": ('{"a": -Infinity}', "-Infinity: must be a number"),
    "infinite": ('{"a": 1e999}', "1e999: a number out of the range"),
    "lost to zero": ('{"a": -0.01e-999}', "-0.01e-999: a number out of the range"),
    "exponent": ('{"a": 1e99999999999999999999}', "out of the range"),
    "many digits": ('{"a": 1' + 10_000 * "0" + "}", "a whole number of more than 19 digits"),
    "many digits after the point": ('{"a": 0.' + 10_000 * "0" + "1}", "out of the range"),
    "text": ('{"a": "1.0"}', "a: must be a number, not a string"),
    "true": ('{"a": true}', "a: must be a number, not true or false"),
    "a list": ("[1]", "must be an object, not an array"),
    "a fraction": ('{"a": 1, "n": 1.5}', "n: must be a whole number, not a number"),
    "deep": (100_000 * "[", "nested too deep"),
    "surrogate": ('{"a": 1, "\\ud800": 2}', "an unpaired surrogate"),
    "a line in text": ('{"a\n": 1}', "not JSON"),
    "more": ('{"a": 1} {"a": 2}', "not JSON: Extra data"),
    "a comma": ('{"a": 1,}', "not JSON"),
    "wide digits": ('{"a": \uff11}', "not JSON"),
    "empty": ("", "not JSON"),
    "not UTF-8": (b'{"a": "\xff"}', r"not UTF-8 text \(byte 7\)"),
    "UTF-16": ('{"a": 1}'.encode("utf-16"), "not UTF-8"),
}


@pytest.mark.parametrize("text", GOOD)
def test_sound_files_are_read_as_they_are(text):
    assert decoded(text.encode(), Found, "file") == msgspec.json.decode(text.removeprefix("\ufeff"), type=Found)


@pytest.mark.parametrize("what", BAD)
def test_what_is_ambiguous_is_refused_in_one_line(what):
    text, said = BAD[what]
    told = line_of(decoded, text, Found, "file")
    assert re.search(f"^file: .*{said}", told)
    assert len(told) < 400


def test_every_number_that_is_written_is_read():
    """The smallest and the largest of double precision, too."""
    numbers = [5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, -0.0, 2**63 - 1, -(2**63), 0.1]
    assert parsed(msgspec.json.encode(numbers), "file") == numbers


READERS = {
    "results.json": (load_result, '{"schema": "partialslip/result/3", '),
    "rig.json": (load_rig, '{"schema": "partialslip/rig/2", '),
    "PS-01.json": (lambda path: read_submission(path.parent, read_problems()), '{"values": {}, '),
    "peers.jsonl": (lambda path: read_peers(path, "s"), '{"scene": "s", '),
}


@pytest.mark.parametrize(
    "spoilt", ['"x": 1, "x": 2}', '"x": NaN}', '"x": 1e999}', '"\\ud800": 1}', '"x": ' + 50_000 * "["]
)
@pytest.mark.parametrize("name", READERS)
def test_every_reader_is_strict(name, spoilt, tmp_path):
    read, begin = READERS[name]
    (tmp_path / "meta.toml").write_text('code = "mine"\nversion = "1"\n', "utf-8")
    (tmp_path / name).write_text(begin + spoilt, "utf-8")
    assert re.search(f"{name}: .*(stands twice|must be a number|range|surrogate|deep)", line_of(read, tmp_path / name))


def test_a_ledger_is_read_strictly(tmp_path):
    """Also where the checksum of the line is right."""
    for text in ('{"key": "k", "made": {}, "key": "l"}', '{"key": "k", "x": NaN}', '{"made": {}}', "[1]"):
        (tmp_path / "ledger.jsonl").write_bytes(_sealed(text) + b"\n")
        with pytest.raises(InputError, match=r"ledger.jsonl: line 1: must be an entry"):
            Ledger(tmp_path / "ledger.jsonl")


def test_numbers_of_other_codes_are_numbers(tmp_path):
    """float() took text, and "nan" with it."""
    peer: dict[str, Any] = {
        "scene": "s",
        "method": "x",
        "setting": "y",
        "element_size": 0.1,
        "dofs": 10,
        "errors": {"m": 0.1},
    }
    peer |= dict.fromkeys(("cpu_s", "process_cpu_s", "wall_s", "peak_rss_mb"), 1.0)
    path = tmp_path / "peers.jsonl"
    path.write_text(json.dumps(peer) + "\n", "utf-8")
    assert read_peers(path, "s")[0].errors == {"m": 0.1}
    for spoilt in ({"cpu_s": "nan"}, {"errors": {"m": "0.1"}}, {"dofs": 1.5}):
        path.write_text(json.dumps(peer | spoilt) + "\n", "utf-8")
        with pytest.raises(InputError, match=r"line 1: must be a JSON result of another code.*: must be "):
            read_peers(path, "s")


def test_a_verification_is_not_finished_by_a_file_that_says_so_twice(tmp_path):
    (tmp_path / "results.json").write_text('{"schema": "partialslip/verify/2", "finished": true}', "utf-8")
    assert was_finished(tmp_path)
    (tmp_path / "results.json").write_text('{"schema": "partialslip/verify/2", "finished": false, "finished": true}')
    assert not was_finished(tmp_path)
