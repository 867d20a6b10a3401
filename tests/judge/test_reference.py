"""The reference of a scene: one choice, and never a solution that is known not to hold."""

from dataclasses import replace

import pytest
from known import EXACT, P0, SCENE, SHARE, F, P, result, traction
from lost import lost_way

import partialslip
from partialslip import compare, load_scene
from partialslip.judge import Outcome
from partialslip.judge.reference import ALL_EFFECTS, reference, reference_among
from partialslip.methods import METHODS, REFERENCES
from partialslip.plan import plan
from partialslip.run import compared, default_methods

STEEL = "material={lower={E=2.1e11, nu=0.3}, upper={E=0.7e11, nu=0.3}}"


def hertz(Qf, sf, *more):
    """Return a Hertz scene with fully reversed loads dQ/(2 f P) and dsigma/(f p0)."""
    limit, stress = F * P, F * P0 / 2
    loads = [f"load={{P={P}, Q=[{-Qf * limit}, {Qf * limit}], sigma=[{-sf * stress}, {sf * stress}]}}"]
    return load_scene("hertz-shear", [*loads, *more])


REVERSING = [(0.55, 7), (0.6434668934976868, 8.670889385947003), (0.9975, 7.2), (0.75, 6), (0.6, 7)]


@pytest.fixture(name="unknown")
def gradual_loads_are_not_solved():
    with lost_way():
        yield


@pytest.mark.parametrize(
    ("scene", "method", "usual"),
    [
        (hertz(0.6, 0.0), "exact", ("exact", "fem")),
        (hertz(0.3, 4.0), "exact", ("exact", "fem")),
        (hertz(0.6, 0.0, "friction.f=0.1"), "exact", ("exact", "fem")),
        (hertz(0.0, 0.0), "exact", ("exact", "fem")),
        (hertz(0.6, 0.0, "load.Q=[0.0, 3e4, 1e4]", "load.sigma=[0.0, 0.0, 1e7]"), "march", ("march", "fem")),
        (hertz(0.6, 0.0, "load.P=[8e4, 1e5]", "load.Q=[0.0, 4e3]"), "exact", ("exact", "fem")),
        (hertz(0.6, 0.0, "bodies.lower={width=0.02, height=0.01}"), "fem", ("exact", "fem")),
        (hertz(0.6, 0.0, STEEL), "fem", ("fem",)),
    ],
    ids=["shear", "tension", "slides", "nothing", "out of phase", "varying", "finite", "unlike"],
)
def test_one_choice_for_every_scene(scene, method, usual):
    assert reference(scene) == (method, {})
    assert default_methods(scene) == usual


@pytest.mark.parametrize(("Qf", "sf"), REVERSING)
def test_where_slip_turns_round_gradual_loads_are_the_reference(Qf, sf):
    scene = hertz(Qf, sf)
    assert reference(scene) == ("exact", {})
    assert default_methods(scene) == ("exact", "fem")


@pytest.mark.usefixtures("unknown")
@pytest.mark.parametrize(("Qf", "sf"), REVERSING)
def test_where_gradual_loads_are_not_solved_nothing_is_known_to_hold(Qf, sf):
    scene = hertz(Qf, sf)
    best = reference(scene)
    assert best.method == "march"
    assert set(best.unknown) == {"m", "n", "q", "q1", "q2"}
    assert default_methods(scene) == ("march", "fem")


def test_effects_that_are_forced_off_do_not_count():
    assert reference(hertz(0.6, 7, "effects.tension=false")).method == "exact"


def test_the_reference_among_results():
    assert REFERENCES == ("exact", "march", "fem")
    assert reference_among(SCENE, METHODS) == "exact"
    assert reference_among(SCENE, ["equivalent", "fem", "march"]) == "march"
    assert reference_among(SCENE, [ALL_EFFECTS, *METHODS]) == ALL_EFFECTS
    assert reference_among(SCENE, ["mine"]) is None
    assert reference_among(SCENE, []) is None
    assert reference_among(hertz(0.6, 7), ["march"]) == "march"
    assert reference_among(hertz(0.6, 7), METHODS) == "exact"
    assert reference_among(hertz(0.6, 0.0, "bodies.lower={width=0.02, height=0.01}"), METHODS) == "exact"


@pytest.mark.fault
@pytest.mark.usefixtures("unknown")
@pytest.mark.parametrize("wrong", ["one step", "march"])
def test_agreement_with_a_solution_that_does_not_hold_is_no_pass(wrong):
    """Deliberate fault: a result equal to the reference to the last digit, where slip reverses."""
    reverses = hertz(0.55, 7)
    equal = traction(q=0.55 / SHARE)
    true = replace(EXACT, traction=equal, **({"method": "march"} if wrong == "march" else {"path_dependent": True}))
    assert reference(reverses).unknown
    found = compare(result(of=equal), true, reverses, 1e-3)
    outcomes = {each.quantity: each.outcome for each in found.verdicts}
    assert {outcomes[key] for key in ("m", "n", "q", "q1", "q2", "q_max")} == {Outcome.NOT_JUDGED}
    assert (outcomes["a"], outcomes["p"]) == (Outcome.PASSED, Outcome.PASSED)
    assert (found.outcome, found.conclusion.code) == (Outcome.NOT_JUDGED, 4)
    assert found.unjudged == ("m", "n", "q", "q1", "q2")
    run = compared(reverses, plan(reverses), {true.method: true, "fem": result(of=equal)}, 1e-3)
    assert (run.passed, run.conclusion.text) == (False, "not judged: m, n, q, q1, q2")


@pytest.mark.usefixtures("unknown")
def test_a_path_that_turns_is_not_judged_by_one_step():
    """Q_f = 0.643, s_f = 8.67. One step and march differ by 0.19 a in m."""
    scene = hertz(*REVERSING[1], "fem.accuracy=1e-2")
    run = partialslip.run(scene, ["exact", "march"])
    assert run.reference == "march"
    assert (run.outcome, run.conclusion.code) == (Outcome.NOT_JUDGED, 4)
    assert run.conclusion.unjudged == ("m", "n", "q", "q1", "q2")
    assert run.comparisons["exact"].errors["m"] == pytest.approx(0.19, abs=0.01)
