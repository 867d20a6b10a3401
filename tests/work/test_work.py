"""Counts of work, and estimates, are those of the table: a change of speed or accuracy is seen when it is made."""

import pytest
from counting import CASES, RENEW, changes, counted, read, text

from partialslip_fem import estimate, goals

ON_DEMAND = (  # more than two CPU seconds
    "beside-small", "flat-rounded", "huge-tension-1e-5", "sharp-0.99", "transition-at", "varying-near-zero",
)  # fmt: skip

EXPECTED = read()


def changed(name):
    """What has changed, in lines."""
    rows = counted(name).items()
    lines = [f"{' '.join(names)}: {line}" for names, found in rows for line in changes(EXPECTED[names], found)]
    return "\n".join([*lines, f"if this is meant to be so: {RENEW}"]) if lines else ""


@pytest.mark.parametrize("name", [pytest.param(n, marks=[pytest.mark.slow] * (n in ON_DEMAND)) for n in CASES])
def test_work_is_as_before(name):
    message = changed(name)
    assert not message, message


def test_the_table_has_all_cases():
    assert list(dict.fromkeys(case for case, _ in EXPECTED)) == list(CASES)
    assert len(CASES) == 16


def test_a_table_is_read_as_it_was_written(tmp_path, monkeypatch):
    monkeypatch.setattr("counting.TABLE", tmp_path / "work.txt")
    (tmp_path / "work.txt").write_text(text(EXPECTED), "utf-8")
    assert read() == EXPECTED


def test_what_has_changed_is_told():
    counts = EXPECTED["hertz-shear", "fem"]
    assert changes(counts, counts) == []
    more = {**counts, "meshes": counts["meshes"] + 1, "unknowns": round(1.1 * counts["unknowns"])}
    unknowns, meshes = changes(counts, more)
    assert unknowns.startswith(f"unknowns: {counts['unknowns']} -> {more['unknowns']} (allowed: ")
    assert meshes.startswith(f"meshes: {counts['meshes']} -> {more['meshes']} ")


@pytest.mark.fault
def test_meshes_finer_than_need_be_are_seen(monkeypatch):
    """Results are as right as before: no bar can tell."""
    monkeypatch.setattr(goals, "_AWAY_SHARE", 0.1)
    monkeypatch.setattr(goals, "_EASED_SHARE", {4: 0.02, 6: 0.01})
    assert "hertz-shear fem: unknowns: " in changed("hertz-shear")


@pytest.mark.fault
def test_estimates_of_half_the_size_are_seen(monkeypatch):
    """Errors are below them all the same, and no mesh changes: nothing else can tell."""
    true = estimate.combined
    monkeypatch.setattr(estimate, "combined", lambda *args: {key: each / 2 for key, each in true(*args).items()})
    assert all(f"hertz-shear fem: {key}: " in changed("hertz-shear") for key in ("ends", "q"))
