"""Each requirement, R1 to R10, sees a deliberate fault. Nothing is solved."""

from dataclasses import replace

import msgspec
import numpy as np
import pytest
from known import EXACT, SCENE, A, result, traction

from partialslip.run import Run
from partialslip.run.judge import Bar, Outcome
from partialslip.tools.bars import BARS
from partialslip.verify import REQUIREMENTS, Case, CaseVerdict, judge_case, number_of, requirement_of, run_case
from partialslip.verify import case as module
from partialslip.verify.case import Failure, conclusions, solve_case, whole
from partialslip.verify.verdicts import bar_left, nearest, print_verdicts
from partialslip_fem import method as fem_method

NAN = float("nan")
CASE = Case("made", SCENE, ("fem",))
SOUND = result()


def wavy(number):
    """Return tractions whose pressure (0) or shear (1) oscillates by a tenth; the resultant is right."""

    def at(x):
        found, key = traction().at(x), ("p", "dq")[number]
        return found._replace(**{key: getattr(found, key) * (1 + 0.1 * np.cos(9 * np.pi * x / A))})

    return replace(traction(), at=at)


FAULTS = {
    "R1": ("finishes", Failure("ZeroDivisionError: none", 2.0)),
    "R2": ("finite", replace(SOUND, limits={"Q_mean": NAN})),
    "R3": ("certificate", replace(SOUND, certificate={"kkt": 1e-12, "equilibrium": 1e-3})),
    "R4": ("regime", replace(SOUND, regime="large tension")),
    "R5": ("a", result(a=1.01, contact_ends=((-A, A), (-A, A)), estimate={})),
    "R6": ("m", result(centre=-0.005, half_width=EXACT.stick_half_width / A + 0.005, estimate={})),
    "R7": ("n", result(centre=0.005, half_width=EXACT.stick_half_width / A + 0.005, estimate={})),
    "R8": ("p", result(of=wavy(0))),
    "R9": ("q", result(of=wavy(1))),
    # m is off by 3e-4 a: less than the bar, 1e-3 a, and three times the estimate
    "R10": ("estimate of m", result(centre=-1.5e-4, half_width=EXACT.stick_half_width / A + 1.5e-4)),
}


def found(fem, case=CASE, exact=EXACT):
    return judge_case(case, {"exact": exact, "fem": fem})


def missed(verdicts):
    return {each.quantity for each in verdicts if each.outcome is Outcome.MISSED}


@pytest.mark.fault
@pytest.mark.parametrize("number", FAULTS)
def test_each_requirement_sees_its_fault(number):
    """Deliberate fault: this requirement is missed, and no other."""
    quantity, wrong = FAULTS[number]
    verdicts = found(wrong)
    (seen,) = (each for each in verdicts if each.outcome is Outcome.MISSED)
    assert (seen.quantity, number_of(seen.quantity), seen.requirement) == (
        quantity, number, f"{number}: {REQUIREMENTS[requirement_of(quantity)]}",
    )  # fmt: skip
    assert (seen.case, seen.method) == ("made", "fem")
    assert min(verdicts, key=bar_left) is seen
    assert nearest({"made": verdicts}) == [seen]


def test_a_sound_result_answers_all_requirements():
    verdicts = found(SOUND)
    assert missed(verdicts) == set()
    assert {number_of(each.quantity) for each in verdicts} == set(FAULTS) == {f"R{n}" for n in range(1, 11)}
    assert list(REQUIREMENTS) == [requirement_of(quantity) for quantity, _ in FAULTS.values()]
    assert {each.outcome for each in verdicts} == {Outcome.PASSED}
    assert not {"p_max", "q_max"} & {each.quantity for each in verdicts}
    kept = {"left": "a", "right_2": "a", "P": "p", "p_1": "p", "dQ": "q", "q1": "q", "m": "m", "finite": "finite"}
    assert {key: requirement_of(key) for key in kept} == kept


def test_every_quantity_with_a_bar_belongs_to_a_requirement():
    assert {requirement_of(quantity) for quantity in BARS} < set(REQUIREMENTS)
    assert {number_of(quantity) for quantity in BARS} == {"R5", "R6", "R7", "R8", "R9"}


def test_work_and_words_go_with_a_verdict():
    counted = replace(SOUND, counts={"iterations": 7})
    assert {(each.iterations, each.cpu_s) for each in found(counted)} == {(7, 1.0)}
    assert {each.iterations for each in found(SOUND)} == {0}
    (failed,) = found(FAULTS["R1"][1])
    assert (failed.iterations, failed.cpu_s, failed.reason) == (0, 2.0, "ZeroDivisionError: none")


def test_the_worst_residual_is_shown_whatever_the_order():
    for certificate in ({"one": 1e-9, "two": 5e-9}, {"two": 5e-9, "one": 1e-9}):
        (worst,) = (v for v in found(replace(SOUND, certificate=certificate)) if v.quantity == "certificate")
        assert (worst.error, worst.outcome) == (5e-9, Outcome.PASSED)
    for certificate in ({"one": 1e-9, "two": NAN}, {"two": NAN, "one": 1e-9}):
        assert "certificate" in missed(found(replace(SOUND, certificate=certificate)))
    assert "certificate" not in {v.quantity for v in found(replace(SOUND, certificate={}, last_cycle_change=1.0))}


def test_bars_are_the_accuracy_asked_for_unless_a_case_or_its_mesh_says_otherwise():
    bars = {each.quantity: each.bar for each in found(SOUND)}
    assert (bars["a"], bars["p"], bars["q"]) == pytest.approx((1e-3, 1e-2, 1.5e-2))
    own = replace(CASE, bars={"fem.a": Bar(0.5, "coarse"), "march.m": Bar(9.0, "no"), "fem.n": Bar(None, "one node")})
    bars = {each.quantity: (each.bar, each.reason) for each in found(SOUND, own)}
    assert (bars["a"], bars["m"][0], bars["n"]) == ((0.5, "coarse"), pytest.approx(1e-3), (None, "one node"))
    fixed = msgspec.structs.replace(SCENE, fem=msgspec.structs.replace(SCENE.fem, size=0.1))
    for case in (replace(CASE, scene=fixed), replace(CASE, meshes=lambda _: [])):
        verdicts = {each.quantity: each.outcome for each in found(result(a=2.0), case)}
        assert (verdicts["a"], verdicts["regime"]) == (Outcome.NOT_JUDGED, Outcome.NOT_JUDGED)
        own = replace(case, bars={"fem.a": Bar(0.5, "coarse")})
        assert missed(found(result(a=2.0, contact_ends=((-A, A),) * 2, estimate={}), own)) == {"a"}


@pytest.mark.parametrize(
    ("estimate", "own", "outcome"),
    [
        (1.4e-4, {}, Outcome.MISSED),  # m is off by 3e-4 a
        (1.6e-4, {}, Outcome.PASSED),
        (1.4e-4, {"m": 5e-5}, Outcome.PASSED),  # the reference may be off by as much as is missing
        (1e-4, {"m": 5e-4}, Outcome.NOT_JUDGED),  # the reference is known less well than the method claims to be
        (0.0, {}, Outcome.MISSED),
        (None, {}, None),
    ],
)
def test_an_estimate_of_less_than_half_of_the_error_is_missed(estimate, own, outcome):
    off = result(centre=-1.5e-4, half_width=EXACT.stick_half_width / A + 1.5e-4)
    off = replace(off, estimate={} if estimate is None else {"m": estimate})
    verdicts = {each.quantity: each for each in found(off, exact=replace(EXACT, estimate=own))}
    assert "estimate of n" not in verdicts
    verdict = verdicts.get("estimate of m")
    assert outcome is (verdict and verdict.outcome)
    if outcome is Outcome.MISSED:
        assert verdict.text.startswith("estimate of m: error 0.0003 > ")
        assert verdict.reason == f"estimated to be {estimate:.1e}"


def test_an_estimate_of_what_is_not_judged_has_no_verdict():
    loose = result(centre=None, regime="ratchets")
    verdicts = {each.quantity for each in found(loose)}
    assert "estimate of a" in verdicts
    assert "estimate of m" not in verdicts


def test_rounding_needs_no_estimate():
    tiny = result(centre=-2e-10, half_width=EXACT.stick_half_width / A + 2e-10, estimate={"m": 0.0})
    assert missed(found(tiny)) == set()


@pytest.mark.fault
def test_an_exact_solution_that_is_missing_is_missed():
    """Deliberate fault: the exact method raises and is not one of the case's methods: nothing is compared."""
    verdicts = found(SOUND, exact=Failure("ValueError: no", 1.0))
    assert [(v.method, v.quantity) for v in verdicts if v.outcome is Outcome.MISSED] == [("exact", "finishes")]
    assert {v.quantity for v in verdicts if v.method == "fem"} == {"finishes", "finite", "certificate"}
    both = judge_case(replace(CASE, methods=("exact", "fem")), {"exact": EXACT, "fem": SOUND})
    assert {v.quantity for v in both if v.method == "exact"} == {"finishes", "finite"} | {"certificate"}
    for results in ({"fem": SOUND}, {"exact": EXACT, "fem": SOUND}):  # not compared, with any results
        alone = judge_case(replace(CASE, reference=""), results)
        assert {v.quantity for v in alone} == {"finishes", "finite", "certificate"}


def test_verdicts_come_back_from_their_data():
    for wrong in (SOUND, *(each for _, each in FAULTS.values())):
        for verdict in found(wrong):
            back = msgspec.json.decode(msgspec.json.encode(verdict), type=CaseVerdict)
            assert back.outcome is verdict.outcome
            assert back == verdict.finite


def test_a_case_is_solved_by_what_it_needs(monkeypatch):
    asked = []

    def solved(_, method):
        asked.append(method)
        return EXACT if method == "exact" else SOUND

    monkeypatch.setattr(module, "_result_or_failure", solved)
    assert missed(run_case(CASE)) == set()
    assert asked == ["exact", "fem"]
    assert list(solve_case(replace(CASE, reference=""))) == ["fem"]


def test_finite_elements_are_solved_on_the_meshes_of_a_case(monkeypatch):
    """Given meshes are for finite elements only; without given meshes the finite elements make meshes."""
    meshed = replace(CASE, methods=("exact", "march", "fem"), meshes=lambda scene: [scene.name])
    monkeypatch.setattr(fem_method, "solve_meshed", lambda scene, _, meshes: (scene, meshes))
    monkeypatch.setattr(module, "run", lambda scene, methods: Run(scene, None, {methods[0]: methods[0]}, {}))
    own = {"exact": "exact", "march": "march", "fem": "fem"}
    assert solve_case(meshed) == own | {"fem": (SCENE, [SCENE.name])}
    assert solve_case(replace(meshed, meshes=None)) == own


def test_what_a_method_raises_is_kept_with_its_time(monkeypatch):
    def raises(*_):
        raise ZeroDivisionError("none")

    monkeypatch.setattr(module, "run", raises)
    times = iter([100.0, 102.5])
    monkeypatch.setattr(module.time, "process_time", lambda: next(times))
    assert solve_case(replace(CASE, reference="")) == {"fem": Failure("ZeroDivisionError: none", 2.5)}


def test_a_verdict_without_work_has_none():
    verdict = CaseVerdict("a", Outcome.PASSED, case="made", method="fem", requirement="R5")
    assert (verdict.iterations, verdict.cpu_s) == (0, 0.0)


def test_what_is_not_judged_is_nearer_to_no_bar_than_what_is():
    verdicts = found(SOUND, replace(CASE, bars={"fem.a": Bar(None, "none")}))
    by_quantity = {each.quantity: each for each in verdicts}
    assert bar_left(by_quantity["a"]) == (True, float("inf"))
    assert bar_left(by_quantity["finishes"]) == (True, float("inf"))
    assert bar_left(by_quantity["m"]) == (True, 1.0)
    half = next(each for each in found(result(a=1.0005)) if each.quantity == "a")
    assert half.share == pytest.approx(0.5)
    assert bar_left(half) == (True, pytest.approx(0.5))


# what the verdicts amount to


def test_a_case_passes_if_every_headline_quantity_was_judged():
    assert (whole(found(SOUND)).outcome, whole(found(SOUND)).code) == (Outcome.PASSED, 0)
    unsure = replace(SOUND, undetermined={"m": "why", "n": "why"})
    left = whole(found(unsure))
    assert (left.outcome, left.unjudged, left.code) == (Outcome.NOT_JUDGED, ("m", "n"), 4)
    assert conclusions([*found(SOUND), *found(unsure, replace(CASE, name="other"))]).keys() == {
        ("made", "fem"), ("other", "fem"),
    }  # fmt: skip
    both = whole([*found(SOUND), *found(unsure, replace(CASE, name="other"))])
    assert (both.outcome, both.unjudged) == (Outcome.NOT_JUDGED, ("m", "n"))


def test_what_a_case_has_no_bar_for_need_not_be_judged():
    free = replace(CASE, bars={"fem.m": Bar(None, "one node"), "fem.n": Bar(None, "one node")})
    assert whole(found(SOUND, free)).outcome is Outcome.PASSED
    assert {each.quantity for each in found(SOUND, free) if each.waived} == {"m", "n"}
    assert not any(each.waived for each in found(SOUND, replace(CASE, bars={"fem.m": Bar(0.5, "coarse")})))
    turning = replace(SOUND, path_dependent=True, undetermined={"m": "one step"})
    assert all(each.waived for each in found(turning))


def test_without_a_reference_the_conditions_decide():
    alone = replace(CASE, reference="")
    assert whole(found(SOUND, alone)).outcome is Outcome.PASSED
    assert whole(found(replace(SOUND, certificate={"kkt": 1.0}), alone)).outcome is Outcome.MISSED
    assert whole([]).outcome is Outcome.NOT_JUDGED
    assert (
        whole([*found(SOUND, alone), *found(replace(SOUND, undetermined={"m": "why"}))]).outcome is Outcome.NOT_JUDGED
    )


def test_what_was_not_judged_is_printed(capsys):
    from rich.console import Console

    print_verdicts({"made": found(replace(SOUND, undetermined={"m": "why"}))}, Console())
    assert "made, fem: not judged: m" in capsys.readouterr().out
