"""The reference of a scene: one choice, and never a solution that is known not to hold."""

import math
from dataclasses import replace

import pytest
from known import EXACT, P0, SCENE, SHARE, A, F, P, ran, result, traction
from lost import lost_way

import partialslip
from partialslip import compare, load_scene
from partialslip.result import RATCHETS
from partialslip.run import default_methods
from partialslip.run.judge import Outcome, verdicts
from partialslip.run.judge.reference import ALL_EFFECTS, error_of, reference, reference_among
from partialslip.run.methods import SOLVERS
from partialslip.tools.methods import METHODS, REFERENCES

KNOWN = {"a": 1e-6, "p": 1e-6, "m": 1e-6, "n": 1e-6, "q": 1e-6}
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
    [(hertz(0.6, 0.0), "exact", ("exact", "fem")), (hertz(0.3, 4.0), "exact", ("exact", "fem")),
     (hertz(0.6, 0.0, "friction.f=0.1"), "exact", ("exact", "fem")), (hertz(0.0, 0.0), "exact", ("exact", "fem")),
     (hertz(0.6, 0.0, "load.Q=[0.0, 3e4, 1e4]", "load.sigma=[0.0, 0.0, 1e7]"), "march", ("march", "fem")),
     (hertz(0.6, 0.0, "load.P=[8e4, 1e5]", "load.Q=[0.0, 4e3]"), "exact", ("exact", "fem")),
     (hertz(0.6, 0.0, "bodies.lower={width=0.02, height=0.01}"), "fem", ("exact", "fem")),
     (hertz(0.6, 0.0, STEEL), "fem", ("fem",)),
     *((hertz(*turning), "exact", ("exact", "fem")) for turning in REVERSING)],
    ids=["shear", "tension", "slides", "nothing", "out of phase", "varying", "finite", "unlike", *map(str, REVERSING)],
)  # fmt: skip
def test_one_choice_for_every_scene(scene, method, usual):
    assert reference(scene) == (method, {})
    assert default_methods(scene) == usual


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

    def among(names, scene=SCENE):
        return reference_among(scene, {name: result(name, estimate=KNOWN) for name in names})

    assert among(METHODS) == "exact"
    assert among(["equivalent", "fem", "march"]) == "march"
    assert among([ALL_EFFECTS, *METHODS]) == ALL_EFFECTS
    assert among(["mine"]) is None
    assert among([]) is None
    assert among(["march"], hertz(0.6, 7)) == "march"
    assert among(METHODS, hertz(0.6, 7)) == "exact"
    assert among(METHODS, hertz(0.6, 0.0, "bodies.lower={width=0.02, height=0.01}")) == "exact"


# A missing estimate is not zero

OUT_OF_PHASE = hertz(0.6, 0.0, "load.Q=[0.0, 3e4, 1e4]", "load.sigma=[0.0, 0.0, 1e7]")


def test_results_that_tell_their_errors_go_before_those_that_do_not():
    def among(march, fem):
        return reference_among(OUT_OF_PHASE, {"march": result("march", **march), "fem": result("fem", **fem)})

    known, none, some = {"estimate": KNOWN}, {"estimate": {}}, {"estimate": {"a": 1e-6, "q": 1e-6, "m": 1e-6}}
    assert [among(*each) for each in ((known, known), (known, none), (none, known), (some, known))] == [
        "march", "march", "fem", "fem",
    ]  # fmt: skip
    assert among(none, none) == "march"
    whole = {ALL_EFFECTS: result("march", estimate={}), "fem": result(estimate=KNOWN)}
    assert reference_among(OUT_OF_PHASE, whole) == ALL_EFFECTS  # the errors measure the effect
    nothing = {"centre": None, "regime": "sliding", "estimate": {"a": 1e-6, "p": 1e-6}}
    assert among(nothing | none, nothing) == "march"  # q = f p, and it knows p to rounding


@pytest.mark.parametrize(("made", "quantity", "error"), [
    (result("exact", estimate={}), "m", 0.0), (result("march", estimate={}), "m", None),
    (result("march", estimate={}), "right_1", 0.0),
    (result("march", estimate={}, counts={"tangential_unknowns": 0}), "q2", 0.0),
    (result("march", estimate={}, counts={"tangential_unknowns": 9}), "q2", None),
    (result("march", estimate={"q": 2e-3}), "q2", 2e-3),
    (result("march", estimate={"q": float("nan"), "q1": 1e-3}), "q", None),
    (result("march", regime="stuck", estimate={}), "n", 0.0), (result(estimate={"a": 1e-4}), "left_2", 1e-4),
    (result(estimate={"a": 1e-4, "left": 2e-4}), "left_2", 2e-4), (result(estimate={"a": 1e-4}), "n", None),
    (result(estimate={"a": 1e-4}, regime="stuck"), "n", 1e-4),
    (result(estimate={"p": 1e-4}, centre=None, regime="sliding"), "q", 1e-4), (result(estimate={}), "p_1", None),
    (result(estimate={}), "dQ", 0.0), (result(estimate={}), "P_1", 0.0), (result("mine", estimate={}), "a", None),
    (result("march", estimate={}), "surface", None),
])  # fmt: skip
def test_what_a_result_tells_of_its_errors(made, quantity, error):
    found = error_of(made, quantity, made.method)
    assert math.isnan(found) if error is None else found == error


@pytest.mark.fault
def test_a_reference_without_an_estimate_judges_nothing(monkeypatch):
    """Deliberate fault: an estimate that is missing is taken for zero, and a right m is missed beside a wrong one."""
    wrong = replace(result("march", centre=-3e-3, half_width=0.803), estimate={})
    right = result(estimate={"a": 1e-6, "left": 1e-6})
    found = compare(right, wrong, OUT_OF_PHASE, 1e-3)
    outcomes = {each.quantity: (each.outcome, each.reason) for each in found.verdicts}
    for key in ("m", "n", "q", "q1", "q2"):
        assert outcomes[key] == (Outcome.NOT_JUDGED, f"march has no error estimate of {key}")
    assert {outcomes[key][0] for key in ("a", "p", "P", "left")} == {Outcome.PASSED}
    assert (found.missed, found.conclusion.code) == ((), 4)
    other = compare(replace(right, regime="small tension"), replace(wrong, regime="large tension"), OUT_OF_PHASE, 1e-3)
    assert {each.quantity: each.reason for each in other.verdicts}["regime"] == "march has no error estimate of m and n"
    monkeypatch.setattr(verdicts, "error_of", lambda result, quantity, _: result.estimate.get(quantity, 0.0))
    assert any(each.startswith("m: ") for each in compare(right, wrong, OUT_OF_PHASE, 1e-3).missed)


def test_a_reference_known_worse_than_the_bar_tells_no_regime():
    """n - m is 0.02 +- 0.05 of a: which of the two tensions it is cannot be told, though m has no bar that it meets."""
    near = {"m": 0.05, "n": 0.05, "q": 1e-3, "a": 1e-6, "p": 1e-6}
    reference_ = replace(result("march", half_width=0.99, regime="large tension"), estimate=near)
    found = compare(result(half_width=0.99), reference_, OUT_OF_PHASE, 1e-3)
    verdicts = {each.quantity: each for each in found.verdicts}
    assert verdicts["regime"].outcome is Outcome.NOT_JUDGED
    assert verdicts["m"].reason == "march itself is known to 5.0e-02 only"
    assert compare(result(half_width=0.7), replace(reference_, stick_half_width=0.7 * A), OUT_OF_PHASE, 1e-3).missed


@pytest.mark.fault
def test_a_contact_that_ratchets_does_not_pass(monkeypatch):
    """Deliberate fault: where there is no steady state, agreement in a and p alone is called a pass."""
    exact, fem = replace(EXACT, regime="ratchets"), result(regime="ratchets")
    run = ran({"exact": exact, "fem": fem})
    assert (run.outcome, run.conclusion.code) == (Outcome.NOT_JUDGED, 4)
    assert run.conclusion.text == "not judged: m, n, q"
    assert {each.quantity: each.reason for each in run.comparisons["fem"].verdicts}["m"] == RATCHETS
    lone = replace(fem, regime="large tension", stick_half_width=0.2 * A)
    assert ran({"exact": exact, "fem": lone}).missed == ("fem: regime: large tension, not ratchets",)
    monkeypatch.setattr(verdicts, "_OTHERS", {"ratchets": ("regime", "a", "p")})
    assert ran({"exact": exact, "fem": fem}).conclusion.code == 0


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
    run = ran({true.method: true, "fem": result(of=equal)}, reverses)
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


def test_every_method_that_has_a_name_solves():
    assert list(SOLVERS) == list(METHODS)
