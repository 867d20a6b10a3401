"""Passed, missed and unjudged quantities of artificial results; nothing is solved."""

import math
from dataclasses import replace

import msgspec
import numpy as np
import pytest
from known import EXACT, P0, SCENE, A, C, F, ran, result, root, traction
from msgspec.structs import replace as changed

from partialslip import compare
from partialslip.result import SurfaceStress, TractionAt
from partialslip.run.judge import NO_BAR, Bar, Outcome, Verdict, conditions, judged
from partialslip.scene import Friction
from partialslip.tools.bars import BARS

NAN = float("nan")
PASSED, MISSED, NOT_JUDGED = Outcome.PASSED, Outcome.MISSED, Outcome.NOT_JUDGED


def verdicts(found, reference=EXACT, accuracy=1e-3, bars=None, scene=SCENE):
    return {each.quantity: each for each in compare(found, reference, scene, accuracy, bars).verdicts}


def outcomes(found, *arguments, **named):
    return {key: each.outcome for key, each in verdicts(found, *arguments, **named).items()}


def those(found, outcome, *arguments, **named):
    return {key for key, each in outcomes(found, *arguments, **named).items() if each is outcome}


# one error, one bar


@pytest.mark.parametrize(
    ("error", "outcome"),
    [(0.0, PASSED), (1.0, PASSED), (math.nextafter(1.0, 2), MISSED), (NAN, MISSED), (math.inf, MISSED)],
)
def test_an_error_passes_up_to_its_bar_and_nan_does_not(error, outcome):
    assert judged(error, 1.0) is outcome


def test_a_verdict_in_words_and_as_data():
    over = Verdict("m", MISSED, 0.8, 0.9, 0.1, 0.05, scale="a")
    assert (over.text, over.share) == ("m: error 0.1 > 0.05", 2.0)
    assert replace(over, error=0.02, outcome=PASSED).text == "m: error 0.02 <= 0.05"
    assert replace(over, error=0.05, outcome=PASSED).text == "m: error 0.05 <= 0.05"
    assert replace(over, error=NAN, reason="why").text == "m: why"
    assert replace(over, error=None, reason="why").text == replace(over, bar=None, reason="why").text == "m: why"
    assert replace(over, error=None, outcome=NOT_JUDGED).text == "m: not judged"
    assert replace(over, error=None).share is None
    assert replace(over, bar=0.0).share is None
    lost = replace(over, error=NAN, found=math.inf)
    assert lost.finite == replace(over, error=None, found=None)
    assert msgspec.json.decode(msgspec.json.encode(lost), type=Verdict) == lost.finite
    nothing = Verdict("m", NOT_JUDGED)
    assert not nothing.known
    assert all(replace(nothing, **{key: 0.0}).known for key in ("reference", "found", "error"))


# scales and errors: the difference of the values is the error


SPOILT = {
    "a": (result(a=1.01), 1.0, 1.01, "a"), "left": (result(contact_ends=((-1.02 * A, A),) * 2), -1.0, -1.02, "a"),
    "right": (result(contact_ends=((-A, 0.97 * A),) * 2), 1.0, 0.97, "a"),
    "m": (result(centre=-0.01, half_width=C + 0.01), C, C + 0.02, "a"),
    "n": (result(centre=0.01, half_width=C + 0.01), C, C + 0.02, "a"),
    "P": (result(of=traction(p=1.05)), 1.0, 1.05, "P"), "p_max": (result(of=traction(p=1.05)), 1.0, 1.05, "p0"),
    "dQ": (result(of=traction(q=1.05)), 0.36, 0.36 * 1.05, "2 f P"),
    "q_max": (result(of=traction(q=0.9)), 0.6, 0.6 * 0.9, "f p0"),
}  # fmt: skip


@pytest.mark.parametrize("key", SPOILT)
def test_the_error_is_the_difference_of_the_values(key):
    found, true, value, scale = SPOILT[key]
    verdict = verdicts(found)[key]
    assert (verdict.reference, verdict.found, verdict.scale) == (pytest.approx(true), pytest.approx(value), scale)
    assert verdict.error == pytest.approx(abs(value - true), rel=1e-9)
    for other in verdicts(found).values():
        if other.quantity != "regime" and None not in (other.reference, other.found):
            assert other.error == pytest.approx(abs(other.found - other.reference), abs=1e-15)


@pytest.mark.parametrize(("key", "found", "error"), [
    ("p", result(of=traction(p=1.05)), 0.05), ("q", result(of=traction(q=0.9)), 0.1),
    ("q1", result(of=traction(q=0.9)), 0.1), ("q2", result(of=traction(q=0.9)), 0.1),
    ("p", result(of=traction(p1=1.2)), 0.0), ("p_1", result(of=traction(p1=1.2)), 0.2),
])  # fmt: skip
def test_norms_have_an_error_and_no_values(key, found, error):
    verdict = verdicts(found)[key]
    assert verdict.error == pytest.approx(error, rel=1e-9, abs=1e-15)
    assert (verdict.reference, verdict.found, verdict.scale) == (None, None, "norm")
    assert verdict.known


def test_a_sound_result_passes_in_everything_that_has_a_bar():
    found = verdicts(result())
    assert {key for key, each in found.items() if each.outcome is PASSED} == {
        "a", "left", "right", "m", "n", "P", "p", "dQ", "q", "q1", "q2", "regime",
    }  # fmt: skip
    assert {key: each.reason for key, each in found.items() if each.outcome is not PASSED} == {
        "p_max": NO_BAR, "q_max": NO_BAR,
    }  # fmt: skip
    comparison = compare(result(), EXACT, SCENE, 1e-3)
    assert (comparison.outcome, comparison.passed, comparison.missed) == (PASSED, True, ())
    assert comparison.bars == {key: each.bar for key, each in found.items() if each.bar is not None}
    shares = {"a": 1, "left": 1, "right": 1, "m": 1, "n": 1, "P": 10, "p": 10, "dQ": 15, "q": 15, "q1": 15, "q2": 15}
    assert comparison.bars == pytest.approx({key: 1e-3 * share for key, share in shares.items()})
    assert comparison.errors == {key: each.error for key, each in found.items() if key != "regime"}
    for key in ("a", "m", "n", "p", "q"):
        assert getattr(comparison, key) == comparison.errors[key]


def test_estimates_stand_beside_errors():
    found = verdicts(result(of=traction(p1=1.0), estimate={"a": 2e-4, "left": 3e-4, "p": 1e-2, "q1": 1e-3},
                            contact_ends=((-A, A), (-A, 1.01 * A))))  # fmt: skip
    estimates = {key: each.estimate for key, each in found.items() if each.estimate is not None}
    assert estimates == {"a": 2e-4, "left_1": 3e-4, "left_2": 3e-4, "p": 1e-2, "p_1": 1e-2, "q1": 1e-3}


# deliberate faults


@pytest.mark.fault
@pytest.mark.parametrize(("found", "keys"), [
    (result(a=NAN), {"a", "left_1", "right_1", "left_2", "right_2"}), (result(centre=NAN), {"m", "n"}),
    (result(half_width=NAN), {"m", "n"}), (result(contact_ends=((NAN, A), (-A, A))), {"left_1"}),
    (result(of=traction(p=NAN)), {"P", "p", "p_max"}), (result(of=traction(q=NAN)), {"dQ", "q", "q_max", "q1", "q2"}),
])  # fmt: skip
@pytest.mark.parametrize("accuracy", [1e-3, None])
def test_nan_is_missed(found, keys, accuracy):
    """Deliberate fault: a value is NaN. NaN once passed, because NaN > bar is false."""
    assert those(found, MISSED, accuracy=accuracy) == keys
    run = ran({"exact": EXACT, "fem": found}, accuracy=accuracy)
    assert run.outcome is MISSED
    assert run.missed
    assert "not a number" in " ".join(run.missed)


@pytest.mark.fault
def test_no_stick_zone_where_there_is_one_is_missed():
    """Deliberate fault: a method reports sliding and gives no m and n. This was once ignored."""
    found = result(centre=None, regime="sliding")
    assert those(found, MISSED) == {"m", "n", "regime"}
    assert "no value" in verdicts(found)["m"].reason
    assert verdicts(found)["m"].error is None
    assert those(found, MISSED, accuracy=None) == set()
    assert verdicts(found, accuracy=None)["m"].reason == NO_BAR


@pytest.mark.fault
@pytest.mark.parametrize(("found", "key"), [(traction(p=1.05), "P"), (traction(q=1.05), "dQ")])
def test_sums_that_are_off_are_seen(found, key):
    """Deliberate fault: tractions are not in equilibrium with the loads."""
    assert key in those(result(of=found), MISSED)


@pytest.mark.fault
def test_cells_that_leave_out_what_is_wrong_hide_nothing():
    """Deliberate fault: a method is right in the middle, and has no cells and tractions elsewhere."""
    sound = traction()

    def at(x):
        return TractionAt(*(np.where(np.abs(x) < 0.5 * A, each, 0.0) for each in sound.at(x)[:4]))

    found = result(of=replace(sound, at=at, cells=np.linspace(-0.5, 0.5, 21) * A, breaks=A * np.array([-0.5, 0.5])))
    assert {"p", "q", "P", "dQ"} <= those(found, MISSED)
    for side in (-1, 1):
        cells = np.sort(side * np.linspace(-1, 0, 11)) * A

        def at_one_side(x, side=side):
            return TractionAt(*(each * (side * x < 0) for each in sound.at(x)[:4]))

        half = result(of=replace(sound, at=at_one_side, cells=cells, breaks=np.sort(side * np.array([-1.0, 0.0])) * A))
        assert verdicts(half)["p"].error == pytest.approx(np.sqrt(0.5), rel=0.2)


@pytest.mark.fault
def test_shear_at_both_load_points_alike_is_seen():
    """Deliberate fault: equal additional shear at load points 1 and 2, so that dq is right."""
    sound = traction()

    def at(x):
        q1, q2 = (each + 0.1 * F * P0 * root(x / A) for each in sound.at(x).levels)
        return sound.at(x)._replace(q1=q1, q2=q2)

    found = result(of=replace(sound, at=at))
    assert those(found, MISSED) == {"q1", "q2"}


def test_q_is_judged_by_f_p_where_there_is_hardly_any():
    """Stuck: q is zero, and errors are relative to 1e-3 of f p."""
    none = traction(q=0.0)
    still = changed(SCENE, load=changed(SCENE.load, Q=(0.0, 0.0)))
    exact = replace(EXACT, regime="stuck", stick_half_width=A, traction=none)
    ripple = replace(none, at=lambda x: none.at(x)._replace(dq=2 * 1e-5 * F * none.at(x).p))
    found = replace(exact, method="fem", traction=ripple)
    assert verdicts(found, exact, scene=still)["q"].error == pytest.approx(1e-2, rel=1e-9)
    assert verdicts(found, exact, scene=still)["dQ"].error == pytest.approx(1e-5 * 1, rel=1e-6)
    assert outcomes(exact, exact, scene=still)["q"] is PASSED
    assert verdicts(exact, exact, scene=still)["q"].error == 0


def test_both_pressures_and_all_ends_where_they_differ():
    ends = ((-1.01 * A, 0.99 * A), (-A, A))
    reference = replace(EXACT, contact_ends=ends, traction=traction(p1=1.1))
    found = verdicts(result(), reference)
    assert {"left_1", "right_1", "left_2", "right_2", "P", "P_1", "p", "p_1"} <= found.keys()
    assert not {"left", "right"} & found.keys()
    assert [found[key].error for key in ("left_1", "right_1", "left_2", "right_2")] == pytest.approx([0.01, 0.01, 0, 0])
    assert found["p_1"].error == pytest.approx(0.1 / 1.1, rel=1e-9)
    assert (found["P_1"].found, found["P"].found) == (pytest.approx(1), pytest.approx(1))
    twice = verdicts(result(of=traction(p1=1.1)), reference)
    assert (twice["p_1"].error, twice["P_1"].found) == (pytest.approx(0), pytest.approx(1.1))
    same = ((-1.01 * A, 0.99 * A),) * 2
    assert {"left", "right"} <= verdicts(result(contact_ends=same), replace(EXACT, contact_ends=same)).keys()


# quantities that do not exist are not judged, with the reason


@pytest.mark.parametrize(
    ("reference", "scene", "keys", "reason"),
    [
        (replace(EXACT, regime="sliding", stick_centre=None, stick_half_width=None), SCENE, "m n dQ", "slides"),
        (replace(EXACT, regime="ratchets"), SCENE, "m n dQ q q_max q1 q2", "ratchets"),
        (EXACT, changed(SCENE, friction=Friction(f=0.0)), "m n dQ q_max", "no friction"),
        (EXACT, changed(SCENE, load=changed(SCENE.load, Q=(-1e4, 1e4, 0.0), sigma=(0.0, 1e6, 1e6))), "dQ",
         "out of phase"),
        (replace(EXACT, undetermined={"m": "m: because", "q": "q: because"}), SCENE, "m q q_max", "exact: "),
    ],
)  # fmt: skip
def test_what_the_reference_says_is_not_there_is_not_judged(reference, scene, keys, reason):
    found = verdicts(replace(result(), regime=reference.regime), reference, scene=scene)
    unjudged = {key: each for key, each in found.items() if each.outcome is NOT_JUDGED and each.reason != NO_BAR}
    assert unjudged.keys() == set(keys.split())
    assert all(reason in each.reason for each in unjudged.values())
    assert all(each.bar is None for each in unjudged.values())
    there = reason == "exact: "  # undetermined quantities have values
    assert all((each.error is not None) == there for each in unjudged.values())
    assert {found[key].outcome for key in ("a", "P", "p")} == {PASSED}


def test_a_method_that_calls_its_value_undetermined_is_not_judged_by_it():
    march = replace(EXACT, method="march", estimate=dict.fromkeys("mnq", 1e-6))
    found = replace(result(centre=0.1), method="exact", undetermined={"m": "path-dependent"}, path_dependent=True)
    assert verdicts(found, march)["m"].outcome is NOT_JUDGED
    assert verdicts(found, march)["m"].reason == "exact: path-dependent"
    assert verdicts(found, march)["n"].outcome is MISSED


def test_a_reference_without_a_value_judges_none():
    found = verdicts(result(), replace(EXACT, stick_centre=None, stick_half_width=None))
    assert {found[key].outcome for key in "mn"} == {NOT_JUDGED}
    assert found["m"].reason == "the reference has no value"


def test_levels_are_judged_where_both_know_them():
    assert not {"q1", "q2"} & verdicts(result(of=traction(levels=False))).keys()
    assert not {"q1", "q2"} & verdicts(result(), replace(EXACT, traction=traction(levels=False))).keys()


# bars


def test_without_bars_nothing_is_judged():
    comparison = compare(result(of=traction(q=0.0)), EXACT, SCENE, None)
    assert {each.outcome for each in comparison.verdicts} == {NOT_JUDGED}
    assert {each.reason for each in comparison.verdicts} == {NO_BAR}
    assert (comparison.outcome, comparison.passed, comparison.bars) == (NOT_JUDGED, False, {})


def test_own_bars_take_the_place_of_the_usual_ones():
    found = result(a=1.01)
    wide = verdicts(found, bars={"a": Bar(0.02, "wide"), "q": Bar(None, "none")})
    assert (wide["a"].outcome, wide["a"].bar, wide["a"].reason) == (PASSED, 0.02, "wide")
    assert (wide["q"].outcome, wide["q"].bar, wide["q"].reason) == (NOT_JUDGED, None, "none")
    alone = verdicts(found, accuracy=None, bars={"a": Bar(0.001)})
    assert (alone["a"].outcome, alone["a"].reason) == (MISSED, "")
    assert {alone[key].outcome for key in ("m", "p", "q")} == {NOT_JUDGED}
    assert alone["regime"].outcome is PASSED
    assert set(BARS) >= {"left_1", "right_1", "left_2", "right_2", "P_1", "p_1"}


# the regime


def zone(m, n, regime, method="exact"):
    return result(method, centre=(n - m) / 2, half_width=(n + m) / 2, regime=regime)


@pytest.mark.parametrize(
    ("found", "reference", "outcome", "reason"),
    [
        (zone(0.5, 0.5, "stuck"), zone(0.5, 0.5, "stuck"), PASSED, ""),
        (zone(0.9, 0.5, "large tension"), zone(0.9, 0.5, "small tension"), MISSED, "large tension, not small tension"),
        (zone(0.9995, 0.5, "large tension"), zone(0.9995, 0.5, "small tension"), NOT_JUDGED, "a slip zone"),
        (zone(0.5, 0.9995, "small tension"), zone(0.5, 0.9995, "large tension"), NOT_JUDGED, "a slip zone"),
        (zone(0.99, 0.5, "large tension"), zone(0.9985, 0.5, "small tension"), MISSED, "large tension, not"),
        (zone(0.3, -0.2998, "large tension"), zone(0.3, -0.2998, "small tension"), NOT_JUDGED, "the stick zone"),
        (zone(0.3, -0.29, "large tension"), zone(0.3, -0.29, "small tension"), MISSED, "large tension, not"),
        (zone(1, 1, "stuck"), zone(0.9995, 0.9995, "small tension"), NOT_JUDGED, "both slip zones"),
        (zone(1, 1, "stuck"), zone(0.9995, 0.99, "small tension"), MISSED, "stuck, not"),
        (zone(1, 1, "stuck"), zone(1, 1, "ratchets"), MISSED, "stuck, not"),
        (zone(1, 1, "stuck"), replace(EXACT, regime="sliding", stick_centre=None, stick_half_width=None), MISSED, ""),
        (result(centre=None, regime="sliding"), zone(0.2, -0.1999, "large tension"), NOT_JUDGED, "the stick zone"),
        (result(centre=None, regime="sliding"), zone(0.2, -0.19, "large tension"), MISSED, "sliding, not"),
        (zone(0.2, -0.1999, "stuck"), replace(EXACT, regime="sliding", stick_centre=None, stick_half_width=None),
         NOT_JUDGED, "the stick zone"),
        (zone(0.2, -0.1999, "ratchets"), zone(0.2, -0.1999, "large tension"), MISSED, "ratchets, not"),
        (result(centre=None, regime="sliding"), result(centre=None, regime="stuck"), MISSED, "sliding, not stuck"),
    ],
)  # fmt: skip
def test_the_regimes_name_is_judged_unless_the_bar_is_wider_than_what_tells_it(found, reference, outcome, reason):
    verdict = verdicts(found, reference)["regime"]
    assert verdict.outcome is outcome
    assert reason in verdict.reason
    assert (verdict.reference, verdict.found) == (reference.regime, found.regime)


def test_the_width_that_the_regime_is_told_by_is_the_larger_bar_of_m_and_n():
    found, reference = zone(0.97, 0.5, "large tension"), zone(0.97, 0.5, "small tension")
    assert outcomes(found, reference, bars={"m": Bar(0.04)})["regime"] is NOT_JUDGED
    assert outcomes(found, reference, bars={"n": Bar(0.04)})["regime"] is NOT_JUDGED
    assert outcomes(found, reference, bars={"m": Bar(0.02), "n": Bar(None)})["regime"] is MISSED
    assert outcomes(found, reference, accuracy=None, bars={"a": Bar(0.04)})["regime"] is MISSED
    own = verdicts(found, reference, bars={"regime": Bar(None, "both are right")})["regime"]
    assert (own.outcome, own.reason) == (NOT_JUDGED, "both are right")
    shifted = replace(reference, contact_ends=((-A, A), (-0.9705 * A, A)))
    assert outcomes(found, shifted)["regime"] is NOT_JUDGED


# conditions


def spoiled_traction(key):
    sound = traction(p1=1.0)
    return replace(sound, values=sound.values._replace(**{key: np.array([0.0, NAN])}))


@pytest.mark.fault
@pytest.mark.parametrize(
    "spoil",
    [
        {"a": NAN, "contact_ends": ((-A, A), (-A, A))},
        {"p0": math.inf},
        {"stick_centre": NAN},
        {"stick_half_width": NAN},
        {"certificate": {"kkt": NAN}},
        {"estimate": {"m": math.inf}},
        {"limits": {"Q_mean": NAN}},
        {"contact_ends": ((-A, NAN), (-A, A))},
        {"traction": replace(traction(p1=1.0), x=np.array([0.0, NAN]))},
        *({"traction": spoiled_traction(key)} for key in ("p", "dq", "q1", "q2", "p1")),
    ],
    ids=lambda spoil: next(iter(spoil)),
)  # fmt: skip
def test_a_number_that_is_none_is_counted(spoil):
    """Deliberate fault: one number of a result is not finite."""
    finite, *_ = conditions(replace(EXACT, **spoil))
    assert (finite.quantity, finite.outcome, finite.error, finite.bar) == ("finite", MISSED, 1.0, 0.0)
    assert "NaN or infinite: 1 " in finite.reason


def test_slip_counts_too():
    from partialslip.result import Slip

    slip = Slip(np.array([NAN, 0]), np.array([0, NAN]), NAN)
    assert conditions(replace(EXACT, slip=slip))[0].error == 3
    assert conditions(EXACT)[0] == Verdict("finite", PASSED, error=0.0, bar=0.0, scale="numbers")


@pytest.mark.parametrize(("residual", "outcome"), [(1e-7, PASSED), (2e-7, MISSED), (NAN, MISSED), (0.0, PASSED)])
def test_residuals_have_a_bar(residual, outcome):
    found = conditions(replace(EXACT, certificate={"kkt": residual, "equilibrium": 0.0}, last_cycle_change=1.0))
    by_name = {each.quantity: each for each in found}
    assert by_name.keys() == {"finite", "certificate kkt", "certificate equilibrium"}
    kkt = by_name["certificate kkt"]
    assert (kkt.outcome, kkt.bar) == (outcome, 1e-7)
    assert kkt.reason == ("not a number" if math.isnan(residual) else "")
    assert by_name["certificate equilibrium"].outcome is PASSED
    assert compare(replace(result(), certificate={"kkt": residual}), EXACT, SCENE, 1e-3).passed == (outcome is PASSED)


def test_nodal_errors_stand_beside():
    comparison = compare(result(of=traction(p=1.02, q=1.1)), EXACT, SCENE, 1e-3)
    assert (comparison.p_nodal, comparison.q_nodal) == pytest.approx((0.02, 0.1))
    assert (comparison.p_nodal_max, comparison.q_nodal_max) == pytest.approx((0.02, 0.06), rel=1e-2)
    ratchets = compare(result(), replace(EXACT, regime="ratchets"), SCENE, 1e-3)
    assert (ratchets.q_nodal, ratchets.q_nodal_max) == (None, None)
    none = replace(EXACT, traction=traction(q=0.0))
    assert compare(result(), none, SCENE, 1e-3).q_nodal is None


# runs


@pytest.mark.fault
def test_a_run_is_missed_where_its_reference_alone_is_wrong():
    """Deliberate fault: the reference is not converged or holds NaN; a result that agrees with it does not pass."""
    for wrong in ({"certificate": {"kkt": 1.0}}, {"limits": {"Q_mean": NAN}}):
        run = ran({"exact": replace(EXACT, **wrong), "fem": result()})
        assert (run.outcome, run.passed) == (MISSED, False)
        assert run.missed[0].startswith("exact: ")


def test_a_run_as_a_whole():
    assert ran({"exact": EXACT, "fem": result()}).outcome is PASSED
    assert ran({"exact": EXACT, "fem": result(a=1.01)}).missed == tuple(
        f"fem: {key}: error 0.01 > 0.001" for key in ("a", "left", "right")
    )
    assert ran({"exact": EXACT, "fem": result()}, accuracy=None).outcome is NOT_JUDGED
    assert ran({"exact": EXACT}).outcome is NOT_JUDGED
    two = ran({"exact": EXACT, "march": result("march"), "fem": result(a=1.01)})
    assert (two.outcome, len(two.missed)) == (MISSED, 3)


def test_stresses_have_rows_where_both_know_them():
    x = np.linspace(-4, 4, 401) * A

    def surface(scale):
        def at(x):
            return scale * np.stack([[np.cos(x / A), np.sin(x / A)], [0 * x, 0 * x]])

        return SurfaceStress(x, at(x), at)

    exact, found = replace(EXACT, surface=surface(1.0)), replace(result(), surface=surface(1.02))
    both = verdicts(found, exact)
    assert (both["largest"].reference, both["largest"].found) == (pytest.approx(1), pytest.approx(1.02))
    assert (both["largest"].error, both["surface"].error) == (pytest.approx(0.02), pytest.approx(0.02))
    assert {both[key].outcome for key in ("largest", "surface")} == {NOT_JUDGED}
    for one, other in ((result(), exact), (found, EXACT)):
        assert not {"largest", "surface", "inside"} & verdicts(one, other).keys()
