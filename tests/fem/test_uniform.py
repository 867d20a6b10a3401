"""One mesh of a given element size: of the order that the ends allow, and kept while only the loads change."""

import numpy as np
from spying import spied

import partialslip
from partialslip import load_scene
from partialslip.friction import active_set, coulomb_constant_pressure
from partialslip_fem import Kept, condensation


def solved(*overrides, name="hertz-large-tension", keep=None):
    outcome = partialslip.run(load_scene(name, overrides), keep=keep)
    return outcome.results["fem"], outcome.comparisons["fem"]


def test_elements_are_of_that_size():
    fem, _ = solved("fem.size=0.05")
    widths = np.diff(fem.traction.cells) / fem.a
    assert 0.03 < widths.min() < widths.max() < 0.06
    assert fem.estimate == {}
    assert fem.settings["element_size_over_a"] == 0.05


def test_factored_once_for_all_loads(monkeypatch):
    calls = spied(monkeypatch, condensation, "factor")
    scenes = [("fem.size=0.04", f"friction.f={f}", f"load.Q=[{-Q}, {Q}]") for f in (0.4, 0.6) for Q in (5e4, 9e4)]
    keep = Kept()
    results = [solved(*scene, keep=keep)[0] for scene in scenes]
    assert len(calls) == 2  # the rough mesh, and the uniform one
    assert [result.counts["factorizations"] for result in results] == [2, 0, 0, 0]
    assert [result.counts["normal_iterations"] > 0 for result in results] == [True, False, False, False]
    afresh = solved(*scenes[-1])[0]
    assert afresh.counts["factorizations"] == 2
    assert (afresh.a, afresh.m, afresh.n) == (results[-1].a, results[-1].m, results[-1].n)


def test_inverted_once_for_all_loads(monkeypatch):
    """The dense inverse of what is in contact serves all loads, and friction is solved on the uniform mesh only."""
    inverted = spied(monkeypatch, active_set, "inverse")
    marched = spied(monkeypatch, coulomb_constant_pressure, "march")
    keep, settings = Kept(), ("fem.size=0.04", "load.sigma=[-2e8, 2e8]")
    for share in np.linspace(0.1, 1.0, 16).tolist():
        fem, _ = solved(*settings, f"load.Q=[{-9e4 * share}, {9e4 * share}]", keep=keep)
    assert {len(C) for C, *_ in marched} == {fem.counts["contact_nodes"]}
    assert len(marched) == 16
    assert [len(C) for (C,) in inverted].count(fem.counts["contact_nodes"]) == 1


def test_adapted_meshes_share_the_first_one():
    """To the last digit, as meshes are refined by what is found on it."""
    keep = Kept()
    loads = [("fem.accuracy=1e-3", f"load.Q=[{-Q}, {Q}]") for Q in (5e4, 9e4)]
    first, kept = (solved(*each, keep=keep)[0] for each in loads)
    afresh = solved(*loads[1])[0]
    assert kept.counts["factorizations"] == afresh.counts["factorizations"] - 1
    assert (kept.a, kept.m, kept.n, kept.estimate) == (afresh.a, afresh.m, afresh.n, afresh.estimate)
    assert first.m != kept.m


def test_no_bars_and_no_verdict():
    _, found = solved("fem.size=0.2", "fem.order=1")
    assert found.bars == {}
    assert not found.passed
    assert found.missed == ()
