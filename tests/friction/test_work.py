"""Work of friction over a cycle, under a pressure that varies while the surfaces slip, and its error estimate."""

from dataclasses import replace

import numpy as np
import pytest
from plain import plain

import partialslip
from partialslip.friction import history as following
from partialslip.friction import steps
from partialslip.halfplane import slip
from partialslip.halfplane.method import _half_cycle

TENSE = {"P": [508380.2723, 635475.3404], "Q": [-63547.534, 76257.041], "sigma": [-404556166.5, 404556166.5]}
STEEP = {"P": [571927.8, 635475.3], "Q": [-101676.1, 114385.6], "sigma": [-566378633.0, 566378633.0]}
CONSTANT = TENSE | {"sigma": [1e8, 1e8]}  # one step is known to suffice for q


def scene(load, f=0.4, R=0.05, **more):
    return plain(load, f, **{"profile": {"kind": "hertz", "R": R}, "fem": {"accuracy": 1e-2}} | more)


UNLIKE = {"upper": {"E": 210e9, "nu": 0.3}, "lower": {"E": 70e9, "nu": 0.3}}


def worn(of, method):
    return partialslip.run(of, [method])[method].slip


@pytest.mark.parametrize("load", [TENSE, STEEP, CONSTANT])
@pytest.mark.parametrize("method", ["march", "fem"])
def test_work_is_that_of_loads_that_change_gradually(load, method):
    """int f p |ds| of one step is 1 % to 3.5 % off, though m, n and q are right."""
    exact, found = worn(scene(load), "exact"), worn(scene(load), method)
    off = abs(found.dissipated - exact.dissipated)
    assert off < 1e-3 * exact.dissipated
    assert off + exact.dissipated_error < found.dissipated_error < 0.05 * exact.dissipated


@pytest.mark.fault
def test_work_with_the_pressure_at_the_end_of_a_step_is_seen(monkeypatch):
    """Deliberate fault: friction over a load step is that at its end, and nobody asks what the step misses."""
    right = worn(scene(TENSE), "exact").dissipated

    def at_the_end(*args, **more):
        found = following.follow(*args, **more)
        return replace(found, dissipated=float((np.abs(found.slip) * found.around.bounds).sum()))

    monkeypatch.setattr(steps, "told_missed", lambda history, *_: history)
    monkeypatch.setattr("partialslip.friction.coulomb_varying_pressure.follow", at_the_end)
    wrong = worn(scene(TENSE), "march")
    assert abs(wrong.dissipated / right - 1) > 0.01
    assert wrong.dissipated_error is None


def test_one_path_dependent_step_does_not_tell_its_error():
    turning = {"P": [444832.7, 635475.3], "Q": [-76257.0, 101676.1], "sigma": [-80911233.0, 80911233.0]}
    exact, march = worn(scene(turning), "exact"), worn(scene(turning), "march")
    assert exact.dissipated_error is None
    assert abs(exact.dissipated / march.dissipated - 1) > 3e-3
    assert march.dissipated_error is not None


def test_slip_between_the_nodes_has_no_known_work():
    """Slip zones of 5e-5 a on a mesh of 1e-2: no node slips, and zero is not the work."""
    f, P = 0.4, 5e5
    narrow = scene({"P": P, "Q": [-1e-4 * f * P, 1e-4 * f * P]})
    assert worn(narrow, "exact").dissipated > 0
    found = worn(narrow, "fem")
    assert found.dissipated == 0
    assert found.dissipated_error is None


def test_all_kinks_of_a_rough_profile_count():
    """Gauss points between strong kinks alone leave 1e-3 of the work, and agree with fewer of them on less."""
    random = np.random.default_rng(3)
    x = np.linspace(0, 1.5e-3, 60)
    slopes = np.cumsum(random.uniform(0.2, 1.8, len(x) - 1) * np.diff(x)) / 0.02
    gap = np.concatenate([[0.0], np.cumsum(slopes * np.diff(x))])
    table = {"kind": "tabulated", "x": x.tolist(), "gap": gap.tolist()}
    rough = scene({"P": 4e5, "Q": [-1e5, 1e5], "sigma": [-1e8, 1e8]}, profile=table)
    _, cycle = _half_cycle(rough)
    found = cycle.worn
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(slip, "_NODES", (600, 400))
        patch.setattr(slip, "_FEWEST", (60, 40))
        true = slip.dissipation(cycle.zone, cycle.seen, cycle.gf).dissipated
    assert abs(found.dissipated - true) < found.error < 1e-3 * true


@pytest.mark.slow
def test_coupled_bodies_take_the_difference_of_finer_steps_for_the_error():
    unlike = scene({"P": 2e5, "Q": [-2e4, 3e4]}, 0.3, material=UNLIKE)
    few, more = worn(unlike, "march"), worn(unlike.replace({"load.steps": 8}), "march")
    assert abs(few.dissipated - more.dissipated) < 0.1 * few.dissipated_error
    assert few.dissipated_error < 0.05 * few.dissipated


@pytest.mark.slow
def test_more_steps_where_slip_of_unlike_bodies_turns_round():
    """march of unlike bodies takes more steps by itself: in one step m is off by a tenth of a."""
    turning = scene({"P": 2e5, "Q": [5e4, -2e4], "sigma": [3e8, 0.0]}, 0.3, R=0.02, material=UNLIKE)
    found = partialslip.run(turning, ["march"])["march"]
    assert found.counts["steps"] == 8
    assert found.shares["steps"]["m"] < 1e-3
    assert not any("too few" in note for note in found.notes)


@pytest.mark.slow
def test_steps_of_a_pad_are_more_as_soon_as_pressing_is_known_better():
    """On the first meshes the error of pressing hides that of one step, on the last mesh it does not."""
    bodies = {
        "upper": {"kind": "pad", "width": 12, "height": 12},
        "lower": {"width": 40, "height": 5, "support": "roller", "pulled": True},
    }
    more = {"material": (116e3, 0.32), "bodies": bodies, "fem": {"accuracy": 5e-5}, "units": "N-mm"}
    pad = scene({"P": 250, "Q": [-100, 100], "sigma": [30, 300]}, 0.6, R=60, **more)
    found = partialslip.run(pad, ["fem"])["fem"]
    assert found.counts["steps"] > 1
    assert not any("too few" in note for note in found.notes)
