"""Counts of work are those of the table, so that a change of speed or accuracy is seen when it is made."""

import pytest
from counting import CASES, RENEW, changes, counted, read, text

from partialslip_fem import goals

EXPECTED = read()


def changed(name):
    """What has changed, in lines."""
    lines = [f"{' '.join(key)}: {line}" for key, found in counted(name).items() for line in changes(EXPECTED[key], found)]
    return "\n".join([*lines, f"if this is meant to be so: {RENEW}"]) if lines else ""


@pytest.mark.parametrize("name", CASES)
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
    more = {**counts, "meshes": counts["meshes"] + 1, "unknowns": round(1.05 * counts["unknowns"])}
    unknowns, meshes = changes(counts, more)
    assert unknowns.startswith(f"unknowns: {counts['unknowns']} -> {more['unknowns']} (allowed: ")
    assert meshes.startswith(f"meshes: {counts['meshes']} -> {more['meshes']} ")


@pytest.mark.fault
def test_meshes_finer_than_need_be_are_seen(monkeypatch):
    """Results are as right as before: no bar can tell."""
    monkeypatch.setattr(goals, "_AWAY_SHARE", 0.1)
    monkeypatch.setattr(goals, "_EASED_SHARE", {4: 0.02, 6: 0.01})
    assert "hertz-shear fem: unknowns: " in changed("hertz-shear")
