"""Standing and badges: nothing gets better by leaving values out, by empty answers or by a choice of problems."""

import json
import re
from pathlib import Path

import msgspec
import pytest
from outline import texts

from partialslip.cli import main
from partialslip.tools.errors import InputError
from partialslip.verify import benchmark
from partialslip.verify.benchmark import Answer, Meta, Standing, Submission
from partialslip.verify.benchmark.grade import HEADLINE, NOT_OFFERED, best_grade, limit
from partialslip.verify.benchmark.measured import GROUPS
from partialslip.verify.benchmark.scoreboard import _ORDER

KNOWN = benchmark.read_problems()
SUBMISSIONS = Path(__file__).parents[2] / "benchmarks" / "submissions"
GOOD = {number: {key: target.value for key, target in problem.measured.items()} for number, problem in KNOWN.items()}


def submission(values, **meta):
    return Submission(
        Meta(**({"code": "mine", "version": "1"} | meta)),
        {key: Answer(own) for key, own in values.items()},
    )


def test_empty_answers_do_not_count():
    """25 empty answers and a good one gave "26 of 26, contact A, tractions A"."""
    found = texts(benchmark.badge(submission({key: {} for key in KNOWN} | {"PS-01": GOOD["PS-01"]})))
    assert found[1:] == [
        f"mine: 1 of {len(KNOWN)}", "contact A", "stick not offered", "tractions A", "points A",
        "levels not offered", "slip not offered", "stress not offered",
    ]  # fmt: skip


def test_a_group_that_lacks_a_value_everywhere_does_not_vanish():
    """Leaving out n in all problems made the stick grade vanish, and all problems counted."""
    less = {number: {key: value for key, value in own.items() if key != "n"} for number, own in GOOD.items()}
    without = [number for number, problem in KNOWN.items() if "n" not in problem.targets]
    found = benchmark.standing(submission(less))
    assert (found.counted, found.of) == (len(without), len(KNOWN))
    assert found.groups[GROUPS.index("stick")].text == "stick not offered"
    null = {number: own | ({"n": None} if "n" in own else {}) for number, own in GOOD.items()}
    assert benchmark.standing(submission(null)) == found


@pytest.mark.parametrize("key", ["a", "p"])
def test_a_value_that_is_not_finite_is_none(key):
    spoiled = GOOD["PS-02"] | {key: float("nan")}
    found = benchmark.graded(KNOWN["PS-02"], Answer(spoiled))
    assert found.overall.grade == NOT_OFFERED
    assert found.lacks == (key,)
    assert not found.counts


def wrong_left_out(whole, name):
    """Answers without the values of the group ``name`` that miss grade A, and how many these are."""
    answers, count = {}, 0
    for number, answer in whole.answers.items():
        targets = KNOWN[number].measured
        errors = benchmark.graded(KNOWN[number], answer).errors
        wrong = {key for key, error in errors.items() if targets[key].group == name and error > limit(key, "A")}
        kept = {key: value for key, value in answer.values.items() if key not in wrong}
        answers[number] = msgspec.structs.replace(answer, values=kept, ladder=())
        count += bool(wrong)
    return Submission(whole.meta, answers), count


def hides(before, after, name):
    """Whether the standing in a group is better ``after`` something was left out, and does not show it."""
    then, now = (each.groups[GROUPS.index(name)] for each in (before, after))
    order = (*_ORDER, NOT_OFFERED)
    better = now.grade not in order or _ORDER.index(then.grade) > order.index(now.grade)
    counts = after.counted < before.counted or name not in HEADLINE
    return (better and now.lacking <= then.lacking) or not counts


@pytest.mark.parametrize("code", ["fem-P1", "getfem", "fem-1e-3"])
@pytest.mark.parametrize("name", GROUPS)
def test_leaving_out_what_is_wrong_shows(code, name):
    whole = benchmark.read_submission(SUBMISSIONS / code, KNOWN)
    before = benchmark.standing(whole)
    less, count = wrong_left_out(whole, name)
    after = benchmark.standing(less)
    grade = before.groups[GROUPS.index(name)].grade
    if grade == "A":
        assert not count
    elif not count and grade != NOT_OFFERED:  # the targets are not sure enough for an A
        assert any(best_grade(problem) == grade for problem in KNOWN.values())
    elif grade != NOT_OFFERED:
        assert not hides(before, after, name)
        assert after.groups[GROUPS.index(name)].lacking >= count


@pytest.mark.fault
def test_a_grade_of_what_is_left_is_seen():
    """The rule of old: answers count as they are, and a group has the worst grade of those that are whole."""

    def of_old(submission):
        found = benchmark.standing(submission)
        groups = tuple(each._replace(lacking=0) for each in found.groups)
        return Standing(len(submission.answers), found.of, groups)

    for code, name in (("kratos", "contact"), ("fem-1e-3", "stick"), ("fem-1e-3", "slip"), ("fem-P1", "tractions")):
        whole = benchmark.read_submission(SUBMISSIONS / code, KNOWN)
        less, _ = wrong_left_out(whole, name)
        assert not hides(benchmark.standing(whole), benchmark.standing(less), name)
        assert hides(of_old(whole), of_old(less), name)


def test_a_badge_is_one_of_the_whole_edition(tmp_path, monkeypatch):
    """A badge for one chosen problem said "1 of 1"."""
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "mine", {"PS-01": GOOD["PS-01"]})
    assert main(["benchmark", "build", "mine", "--problems", "PS-01", "--out", "book"]) == 0
    assert f"mine: 1 of {len(KNOWN)}" in texts((tmp_path / "book" / "badge-mine.svg").read_text("utf-8"))


def write(folder, values, code="mine", version="1"):
    folder.mkdir()
    (folder / "meta.toml").write_text(f"code = {json.dumps(code)}\nversion = {json.dumps(version)}\n", "utf-8")
    for number, own in values.items():
        (folder / f"{number}.json").write_text(json.dumps({"values": own}), "utf-8")


def test_scoring_says_what_lacks(tmp_path, capsys):
    less = {key: value for key, value in GOOD["PS-02"].items() if key != "n"}
    write(tmp_path / "mine", {"PS-01": GOOD["PS-01"], "PS-02": less, "PS-03": {}})
    assert main(["benchmark", "score", str(tmp_path / "mine")]) == 4
    lines = capsys.readouterr().out.splitlines()
    assert lines[-2].startswith(f"1 of {len(KNOWN)} problems count: contact A; stick not offered; tractions A")
    assert lines[-1] == "not judged: PS-02 (n), PS-03 (no values)"
    assert main(["benchmark", "score", str(tmp_path / "mine"), "--problems", "PS-01"]) == 0


CODES = [
    "My code", "my-code", "my code!", "my-code-1a2b3c4d", "日本", "../..", "code", "badge", "a/b", "a\\b", "a:b",
    "CON", "é", "e", ".", "x" * 60,
]  # fmt: skip


def test_names_of_badges_are_all_different_and_plain():
    every = [submission({}, code=code) for code in CODES]
    every += [submission({}, code="My code", version="2"), submission({}, code="e", machine="another")]
    names = benchmark.badge_names(every)
    assert len({name.lower() for name in names}) == len(every)
    assert all(re.fullmatch(r"badge-[a-z0-9][a-z0-9.-]*\.svg", name) for name in names)
    assert benchmark.badge_names(every[:1]) == ["badge-my-code.svg"]
    assert benchmark.badge_names(every) == names


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("partialslip exact", "p\u0430rtialslip exact"),  # a Cyrillic a
        ("GetFEM", "Get\u200bFEM"),  # a space of no width
        ("\u00e9", "e\u0301"),  # one letter, or a letter and an accent
    ],
)
def test_codes_that_look_alike_are_refused(one, other, tmp_path, capsys):
    with pytest.raises(InputError, match=f"looks like {re.escape(ascii(one))}: names of codes must look different"):
        benchmark.badge_names([submission({}, code=one), submission({}, code=other)])
    write(tmp_path / "one", {"PS-01": {}}, one)
    write(tmp_path / "other", {"PS-01": {}}, other)
    out = tmp_path / "book"
    assert main(["benchmark", "build", *(str(tmp_path / name) for name in ("one", "other")), "--out", str(out)]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not out.exists()


def test_the_same_code_twice_is_refused():
    with pytest.raises(InputError, match="'mine': answers twice, with the same version, settings and machine"):
        benchmark.badge_names([submission({}), submission({"PS-01": {}})])


@pytest.mark.parametrize("text", ["a\nb", "\x07", "\x1b[2J", "\u202egnorw", "\u2066x", "\u2028", "\ud800", "\x9b"])
def test_texts_of_more_than_a_line_are_refused(text, tmp_path):
    said = "must be one line of text without control characters"
    for name in ("code", "version", "settings", "machine"):
        with pytest.raises(InputError, match=f"^{name} = .*{said}") as caught:
            submission({}, **{name: text})
        assert str(caught.value).isprintable()
    with pytest.raises(InputError, match=f"^note = .*{said}"):
        Answer({}, note=text)
    write(tmp_path / "mine", {"PS-01": {}})
    (tmp_path / "mine" / "PS-01.json").write_text(json.dumps({"values": {}, "note": text}), "utf-8")
    with pytest.raises(InputError, match=r"PS-01.json: (note = .*control characters|an unpaired surrogate)"):
        benchmark.read_submission(tmp_path / "mine", KNOWN)
    if text != "\ud800":  # which TOML cannot write
        write(tmp_path / "other", {"PS-01": {}}, f"x{text}")
        with pytest.raises(InputError, match=r"meta.toml: (code = .*control characters|not valid TOML)"):
            benchmark.read_submission(tmp_path / "other", KNOWN)


# grades of one problem

PROBLEM = KNOWN["PS-02"]


def answer(**off):
    """The targets, some of them off by this many scales."""
    shift = {key.replace("_at_", "@"): value for key, value in off.items()}
    return Answer({key: target.value + shift.get(key, 0.0) * target.scale for key, target in PROBLEM.measured.items()})


@pytest.mark.parametrize(
    ("off", "grade"), [(0.0, "A"), (9e-5, "A"), (2e-4, "B"), (-2e-3, "C"), (4e-2, "D"), (-0.06, "E")]
)
def test_the_worst_target_decides(off, grade):
    found = benchmark.graded(PROBLEM, answer(m=off))
    assert found.overall.grade == found.groups["stick"].grade == grade
    assert found.groups["contact"].grade == found.groups["tractions"].grade == "A"
    assert off == 0 or found.overall.worst == "m"
    assert off == 0 or found.overall.error == pytest.approx(abs(off))


def test_no_grade_is_better_than_the_targets_are_known():
    unsure = {
        key: msgspec.structs.replace(target, uncertainty=1e-3) if key == "m" else target
        for key, target in PROBLEM.targets.items()
    }
    problem = msgspec.structs.replace(PROBLEM, targets=unsure)
    assert benchmark.graded(problem, answer()).groups["stick"].grade == "C"
    assert benchmark.graded(problem, answer(m=0.02)).groups["stick"].grade == "D"
    worse = {key: msgspec.structs.replace(target, uncertainty=0.1) for key, target in unsure.items()}
    assert benchmark.graded(msgspec.structs.replace(PROBLEM, targets=worse), answer()).overall.grade == "not graded"
