"""The targets as a data set, and as gold files: complete, as described, with tolerances that hold."""

import csv
import datetime
import hashlib
import io
import json
import zipfile

import msgspec
import pytest

from partialslip.cli import main
from partialslip.verify.benchmark import read_problems
from partialslip.verify.benchmark.data import ProblemData, data_files, schema
from partialslip.verify.benchmark.gold import GROUPS, gold_files
from partialslip.verify.benchmark.grade import LIMITS
from partialslip.verify.benchmark.problem import EDITION, read_frozen

PROBLEMS = read_problems()
FILES = data_files(PROBLEMS, datetime.date(2026, 1, 2))
TARGETS = {(number, key): target for number, each in PROBLEMS.items() for key, target in each.targets.items()}


def table(name):
    """Rows of a CSV file of the data set."""
    return list(csv.DictReader(io.StringIO(FILES[name].decode())))


def test_every_target_is_there_to_its_last_digit():
    rows = table("targets.csv")
    assert {(row["problem"], row["key"]) for row in rows} == TARGETS.keys()
    for row in rows:
        target = TARGETS[row["problem"], row["key"]]
        assert (float(row["value"]), row["unit"]) == (target.value, target.unit)
        assert (float(row["scale"]), float(row["uncertainty"])) == (target.scale, target.uncertainty)
        assert row["known"] == target.known
        place, a = row["key"].partition("@")[2], TARGETS[row["problem"], "a"].value
        assert row["x"] == (str(float(place) * a) if place else "")


@pytest.mark.parametrize("number", PROBLEMS)
def test_json_and_csv_of_a_problem_say_the_same(number):
    data = msgspec.json.decode(FILES[f"{number}.json"], type=ProblemData, strict=True)
    assert (data.number, data.edition, data.checksum) == (number, EDITION, read_frozen().checksums[number])
    assert data.statement == PROBLEMS[number].statement
    assert {row["key"]: float(row["value"]) for row in table(f"{number}.csv")} == {
        key: target.value for key, target in data.targets.items()
    }


def test_the_schema_names_every_field_and_the_units():
    definitions = schema()["$defs"]
    assert json.loads(FILES["problem.schema.json"]) == schema()
    found = json.loads(FILES["PS-02.json"])
    assert definitions["ProblemData"]["properties"].keys() == found.keys()
    assert definitions["PlacedTarget"]["properties"].keys() == found["targets"]["p@0.5"].keys()
    assert {target.unit for target in TARGETS.values()} <= {*definitions["PlacedTarget"]["properties"]["unit"]["enum"]}


@pytest.mark.fault
def test_a_unit_that_is_not_si_is_not_valid():
    changed = FILES["PS-02.json"].replace(b'"unit": "m"', b'"unit": "mm"', 1)
    with pytest.raises(msgspec.ValidationError, match="mm"):
        msgspec.json.decode(changed, type=ProblemData)


def test_the_crate_describes_each_file_and_refers_to_nothing_else():
    crate = json.loads(FILES["ro-crate-metadata.json"])["@graph"]
    known = {entity["@id"]: entity for entity in crate}
    assert len(known) == len(crate)
    parts = [each["@id"] for each in known["./"]["hasPart"]]
    assert sorted([*parts, "ro-crate-metadata.json"]) == sorted(FILES)
    for name in parts:
        assert known[name]["sha256"] == hashlib.sha256(FILES[name]).hexdigest()
        assert known[name]["contentSize"] == str(len(FILES[name]))
    named = {each["@id"] for entity in crate for value in entity.values() if isinstance(value, list) for each in value}
    assert named <= known.keys()
    assert known["./"]["license"]["@id"] in known
    assert known["./"]["datePublished"] == "2026-01-02"


def test_a_zip_has_the_same_files_as_a_folder(tmp_path, capsys):
    for place in ("data", "data.zip"):
        assert main(["benchmark", "data", "--out", str(tmp_path / place)]) == 0
        assert f"{len(FILES)} files in " in capsys.readouterr().out
    with zipfile.ZipFile(tmp_path / "data.zip") as archive:
        assert {name: archive.read(name) for name in archive.namelist()} == {
            path.name: path.read_bytes() for path in (tmp_path / "data").iterdir()
        }


def csvdiff(gold, comparison, row):
    """Columns of ``row`` that differ from the gold file, by the rule of MOOSE's CSVDiff."""
    wanted, wrong = next(csv.DictReader(io.StringIO(gold))), []
    for line in comparison.splitlines():
        if not line.startswith(" "):
            continue
        key, _, relative, _, floor = line.split()
        one, other = (0.0 if abs(each) < float(floor) else each for each in (float(wanted[key]), row[key]))
        if one != other and abs(one - other) / max(abs(one), abs(other)) > float(relative):
            wrong.append(key)
    return wrong


@pytest.mark.parametrize("number", PROBLEMS)
@pytest.mark.parametrize("grade", ["B", "D"])
def test_gold_accepts_what_is_within_the_tolerance_and_nothing_else(number, grade):
    targets = {key: target for key, target in PROBLEMS[number].targets.items() if target.group in GROUPS}
    gold = json.loads(gold_files(PROBLEMS[number], "json", grade)[f"{number}.json"])["gold"]
    made = gold_files(PROBLEMS[number], "csvdiff", grade)
    files = made[f"{number}.csv"], made[f"{number}.cmp"]
    assert gold.keys() == targets.keys()
    known = {key: target.value for key, target in targets.items()}
    assert csvdiff(*files, known) == []
    for key, target in targets.items():
        tolerance = (LIMITS[grade] + target.uncertainty) * target.scale
        assert gold[key]["tolerance"] == pytest.approx(tolerance)
        least = tolerance * max(abs(target.value) / (abs(target.value) + tolerance), 0.26)  # CSVDiff is stricter
        for sign in (1, -1):
            assert csvdiff(*files, known | {key: target.value + sign * 0.999 * least}) == []
            assert csvdiff(*files, known | {key: target.value + sign * 1.001 * tolerance}) == [key]


def test_the_test_of_pytest_holds_the_targets_and_fails_beyond_them():
    namespace = {}
    exec(gold_files(PROBLEMS["PS-02"], "pytest")["test_ps_02.py"], namespace)
    for key, (value, tolerance) in namespace["GOLD"].items():
        assert value == PROBLEMS["PS-02"].targets[key].value
        namespace["test_ps_02"](key, lambda _, k=key, v=value, t=tolerance: {k: v - 0.99 * t})
        with pytest.raises(AssertionError):
            namespace["test_ps_02"](key, lambda _, k=key, v=value, t=tolerance: {k: v + 1.01 * t})


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["PS-02", "--for", "ctest"], "--for ctest: must be one of pytest, csvdiff, json"),
        (["PS-02", "--for", "json", "--grade", "E"], "--grade E: must be one of A, B, C, D"),
        (["PS-99", "--for", "json"], "PROBLEM 'PS-99': must be one of PS-01"),
    ],
)
def test_gold_refuses_in_a_line(arguments, line, refused):
    assert line in refused("benchmark", "gold", *arguments)
