"""Saved states: what they hold, and what is refused. To stop and go on is not to stop: see `tests/invariances`."""

import functools
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import PPoly

from partialslip import InputError, load_scene, load_state, run
from partialslip.march import driver as marching
from partialslip.run.judge.measures import measures

PAD = Path(__file__).parents[2] / "docs" / "scenes" / "finite-pad.toml"
MEAN = ("load.Q=[31415.9, 219911.5]", "load.sigma=[2e8, 1e9]", "fem.accuracy=1e-3")


def solved(method, cycles, start=None, extra=()):
    if start is None:
        return from_zero(method, cycles, extra)
    scene = load_scene("hertz-large-tension", [*MEAN, f"load.cycles={cycles}", *extra])
    return run(scene, [method], start=start).results[method]


@functools.cache
def from_zero(method, cycles, extra):
    return run(load_scene("hertz-large-tension", [*MEAN, f"load.cycles={cycles}", *extra]), [method]).results[method]


@pytest.mark.slow
def test_a_state_of_one_method_starts_another():
    start = solved("march", 1).state
    assert solved("fem", 1, start).m == pytest.approx(solved("fem", 2).m, rel=1e-4)


LARGE = ("load.p0=4e8", "fem.accuracy=1e-4")


def after_a_stop(method):
    """From a stop on the first loading, on meshes of its own: result of ``method``, and errors of q1 and q2 of it."""
    scene = load_scene("hertz-large-tension", LARGE)
    exact = run(scene, ["exact"]).results["exact"]
    stop = [f"load.{key}={[0.4 * value] * 2}" for key, (_, value) in (("Q", scene.load.Q), ("sigma", scene.load.sigma))]
    state = run(load_scene("hertz-large-tension", [*LARGE, *stop]), [method]).results[method].state
    found = run(scene, [method], start=state).results[method]
    return found, {
        each.quantity: each.error for each in measures(found, exact, scene, {}) if each.quantity in ("q1", "q2")
    }


@pytest.mark.parametrize("method", ["march", "fem"])
def test_estimates_contain_the_error_of_the_state(method):
    found, errors = after_a_stop(method)
    for key, error in errors.items():
        assert error <= found.estimate[key] <= 2 * 15e-4  # the bar of the state, and that of the cells
        assert found.shares["start"][key] >= found.estimate[key] / 4
        assert found.estimate[key] == pytest.approx(sum(share.get(key, 0.0) for share in found.shares.values()))


@pytest.mark.fault
def test_a_state_of_one_constant_a_cell_is_seen(monkeypatch):
    """Other cells than those it was solved on see steps, of first order in the size of the wide cells."""
    constant = lambda forces, places: PPoly((forces / np.diff(places))[None], places)  # noqa: E731
    monkeypatch.setattr(marching, "off_cells", constant)
    found, errors = after_a_stop("march")
    assert all(error > 1.5 * found.estimate[key] for key, error in errors.items())


@pytest.mark.slow
def test_states_of_earlier_versions_are_read(tmp_path):
    """They had one constant a cell, and no error."""
    path, state = tmp_path / "old.npz", solved("march", 1).state
    means = np.diff(state.q.antiderivative()(state.q.x)) / np.diff(state.q.x)
    pressed = np.diff(state.p.antiderivative()(state.p.x)) / np.diff(state.p.x)
    loads = [state.P, state.A, state.Q, state.sigma]
    np.savez(path, loads=loads, cells=state.q.x, p=pressed[None], q=means[None])
    old = load_state(path)
    assert old.q_error is None
    for method in ("march", "fem"):
        found = solved(method, 1, old)
        assert found.m == pytest.approx(solved("march", 2).m, rel=1e-3)
        assert "start" not in found.shares
        assert any("error of the state at the beginning is not known" in note for note in found.notes)


def test_what_is_saved_is_read(tmp_path):
    state = solved("march", 1).state
    state.save(tmp_path / "s.npz")
    again = load_state(tmp_path / "s.npz")
    assert (again.P, again.A, again.Q, again.sigma) == (state.P, state.A, state.Q, state.sigma)
    assert (again.sigma_slope, again.q_error) == (state.sigma_slope, state.q_error)
    assert 0 < again.q_error < 1e-2
    assert np.array_equal(again.q.c, state.q.c)


@pytest.mark.slow
def test_the_pressure_of_another_contact_is_noted():
    state = solved("march", 1).state
    narrow = replace(state, p=PPoly(state.p.c * 1.5, state.p.x / 1.5))
    for method in ("march", "fem"):
        assert not any("another contact" in note for note in solved(method, 1, state).notes)
        assert any("another contact" in note for note in solved(method, 1, narrow).notes)


@pytest.mark.slow
def test_another_moment_is_refused():
    coarse = ("fem.accuracy=1e-2",)
    moved = ("load.e=2e-4", *coarse)
    with pytest.raises(InputError, match=r"^state: is of M = "):
        solved("march", 1, solved("march", 1, extra=coarse).state, moved)
    for method in ("march", "fem"):
        assert solved(method, 1, solved(method, 1, extra=moved).state, moved).m


def test_steady_cycles_are_not_repeated():
    scene = load_scene("hertz-large-tension", ["load.cycles=200", "effects.history=true", "fem.accuracy=1e-2"])
    for result in run(scene, ["march", "fem"]).results.values():
        assert result.counts["cycles"] == 1
        assert result.counts["load_steps"] == 3


def test_another_load_or_material_is_refused():
    start = solved("march", 1).state
    for other, what in (("load.p0=401e6", "P = "), ("material.E=73e9", "P = ")):
        with pytest.raises(InputError, match=rf"^state: is of {what}"):
            run(load_scene("hertz-large-tension", [other]), ["march"], start=start)
    P = start.P
    harder = load_scene("fretting-aluminium", [f"load.P={P}", "load.Q=[-1e4, 1e4]", "material.E=73e9"])
    with pytest.raises(InputError, match=r"^state: is of A = "):
        run(harder, ["march"], start=start)
    with pytest.raises(InputError, match=r"^state: is of P = nan N/m; the scene has"):
        solved("march", 1, replace(start, P=float("nan")))


@pytest.mark.slow
def test_a_pad_on_a_pulled_specimen_goes_on():
    """Tension bends the specimen, so that p has a moment though the bodies do not turn: the state was refused.

    Both runs have meshes of their own, on which ends of zones differ by about a tenth of their estimates."""
    scene = load_scene(str(PAD), ["fem.accuracy=1e-4"])
    found = run(scene, ["fem"])["fem"]
    again = run(scene, ["fem"], start=found.state)["fem"]
    assert (again.m, again.n) == pytest.approx((found.m, found.n), abs=1e-5 * found.a)
