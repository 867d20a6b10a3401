"""Faults of the exact side and of what compares: a wrong truth must not pass for one, either."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.special

import partialslip
from partialslip.halfplane import contact, loading, proportional, steady
from partialslip.halfplane import traction as exact_traction
from partialslip.halfplane.hertz import HertzShape
from partialslip.run import compared
from partialslip.run.judge import compare
from partialslip.tools.bars import CERTIFICATE_BAR

LARGE = "hertz-large-tension"


def closed_form(scene):
    """Half a cycle in one step; where the zone of a fault lets slip turn round, exact goes another way."""
    load = scene.load
    return proportional.loading(contact(scene), scene.friction.f, load.dQ, load.dsigma, bound=2)


@pytest.mark.fault
def test_sign_of_x_instead_of_the_slip_zones(monkeypatch, sound, red):
    """sgn(x) breaks down where the stick zone lies beside the middle: here it ends at n < 0."""
    scene, true = sound(LARGE, "load.sigma=[-1e9, 1e9]"), exact_traction.half_range

    def by_x(x, zone, shape, _):
        slips = np.abs(x - zone.centre) > zone.half_width
        return np.where(slips, np.sign(x) * np.abs(true(x, zone, shape)), true(x, zone, shape))

    monkeypatch.setattr(loading, "half_range", by_x)
    red.comparison("q", scene)


@pytest.mark.fault
def test_both_ends_taken_to_slip_the_same_way(monkeypatch, sound, red):
    scene, true = sound(LARGE), HertzShape.conditions
    monkeypatch.setattr(HertzShape, "conditions", lambda self, edge, c, s: true(self, edge, c, np.abs(s)))
    red("certificate: shear", closed_form(scene).certificate["shear"], CERTIFICATE_BAR)


@pytest.mark.fault
def test_modulus_for_the_parameter(monkeypatch, sound, red):
    """chi where the library asks for chi^2, in E alone."""
    scene, true = sound(LARGE), scipy.special.ellipe
    monkeypatch.setattr(scipy.special, "ellipe", lambda parameter: true(np.sqrt(parameter)))
    red.comparison("n", scene)


@pytest.mark.fault
def test_moment_about_the_middle_without_its_term(monkeypatch, sound, red):
    """The second condition has moments about the stick zone's centre; about x = 0 a term of dsigma belongs to it."""
    scene, true = sound(LARGE), steady._conditions

    def about_the_middle(shape, edge, c, _=None):
        at = true(shape, edge, c)
        return at._replace(Qf=at.Qf + (np.abs(edge) + c - 1) * at.sf / 4)

    monkeypatch.setattr(steady, "_conditions", about_the_middle)
    red("certificate: shear", closed_form(scene).certificate["shear"], CERTIFICATE_BAR)


@pytest.mark.fault
def test_mean_load_bounded_by_gross_sliding_alone(monkeypatch, red):
    """A mean load beyond what a steady state of large tension can hold: exact and march disagree."""
    scene = partialslip.load_scene(
        LARGE, ["load.Q=[69115, 257610]", "load.sigma=[2e8, 1e9]", "load.cycles=6", "fem.accuracy=1e-2"]
    )
    outcome = partialslip.run(scene, ["exact", "march"])
    assert {result.regime for result in outcome.results.values()} == {"ratchets"}
    assert outcome.conclusion.unjudged == ("m", "n", "q")  # there is no steady state
    red.passes(len(outcome.comparisons["march"].missed), 0)
    monkeypatch.setattr(loading.Loading, "mean_load_bound", property(lambda _: 1 - 0.3))
    results = {**partialslip.run(scene, ["exact"]).results, "march": outcome.results["march"]}
    found = compared(scene, outcome.plan, results, outcome.accuracy).comparisons["march"]
    assert any(what.startswith("regime: ratchets") for what in found.missed)
    red("compare: m", found.m, found.bars["m"])


@pytest.mark.fault
def test_traction_perturbed_with_its_resultant_kept(sound, red):
    """A tenth of f p0 and less moved from one side to the other: Q cannot tell."""
    scene = sound(LARGE)
    results = partialslip.run(scene).results
    fem, exact = results["fem"], results["exact"]
    true = fem.traction.at

    def moved(x):
        off = 0.2 * scene.friction.f * fem.p0 * np.sin(np.pi * x / fem.a) * (np.abs(x) < fem.a)
        found = true(x)
        return found._replace(dq=found.dq + off)

    found = compare(replace(fem, traction=replace(fem.traction, at=moved)), exact, scene, 1e-3)
    assert "q" in {what.split(":")[0] for what in found.missed}
    red("compare: q", found.q, found.bars["q"])
