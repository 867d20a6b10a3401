"""Load steps of coupled bodies: their error is estimated from other steps."""

import pytest
from plain import plain

import partialslip
from partialslip.friction import step_errors


def solved(steps, **more):
    load = {"P": 2e4, "Q": [-2500, 2500], "steps": steps, "cycles": 1, **more}
    steel_on_aluminium = {"E": 70e9, "nu": 0.1, "upper": {"E": 200e9, "nu": 0.3}}
    return partialslip.run(plain(load, 0.25, steel_on_aluminium, fem={"accuracy": 1e-2}), "fem")["fem"]


def told(result):
    return [note for note in result.notes if "too few" in note]


TURNING = {"sigma": [-1e8, 1e8]}  # slip turns round on the way from load point to load point


@pytest.fixture(scope="module")
def few():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(step_errors, "_MOST_STEPS", 1)
        return solved(1, **TURNING)


@pytest.mark.slow
def test_steps_in_which_slip_turns_round_are_known_to_be_too_few(few):
    fine = solved(12, **TURNING)
    off = abs(fine.m / fine.a - few.m / few.a)
    assert off > 0.1
    assert few.shares["steps"]["m"] > off
    assert fine.shares["steps"]["m"] < few.shares["steps"]["m"] / 4
    assert len(told(few)) == 1
    assert sum(note.startswith("path-dependent: slip reverses between the load points") for note in fine.notes) == 1


@pytest.mark.slow
def test_steps_become_more_until_they_suffice_or_up_to_a_limit(few, monkeypatch):
    """One step is refined like 8 that are asked for, and is known as well."""
    monkeypatch.setattr(step_errors, "_MOST_STEPS", 8)
    found, asked = solved(1, **TURNING), solved(8, **TURNING)
    assert found.shares["steps"]["m"] < few.shares["steps"]["m"] / 2
    assert found.m == pytest.approx(asked.m, abs=(found.estimate["m"] + asked.estimate["m"]) * found.a)
    assert "8 steps" in told(found)[0]


@pytest.mark.slow
def test_steps_that_suffice_are_not_told():
    result = solved(1)
    # what pressing leaves unknown of the contact's ends, and nothing of the load steps
    assert 0 < result.shares["steps"]["m"] == pytest.approx(result.shares["steps"]["a"], abs=1e-6)
    assert not told(result)
    assert not any("path-dependent" in note for note in result.notes)


@pytest.mark.slow
@pytest.mark.fault
def test_halves_alone_see_too_little(few, monkeypatch):
    """Deliberate fault: a step and its halves end with the same stick zone, which moves past both in between, so that
    one step seems to suffice."""
    monkeypatch.setattr(step_errors.Path, "with_steps", lambda self, _: self)
    blind = solved(1, **TURNING)
    assert blind.shares["steps"]["m"] < 1e-3
    assert few.shares["steps"]["m"] > 0.1
