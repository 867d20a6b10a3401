"""The answer with which a run begins: values in the scene's units, with the digits that are known."""

import re
from dataclasses import replace
from io import StringIO

import numpy as np
import pytest
from known import EXACT, P0, A, C, F, P, ran, result, traction
from rich.console import Console

from partialslip import load_scene, run
from partialslip.report import answer, print_run, rows
from partialslip.result.peak import pressure_peaks
from partialslip.run.judge import Outcome


def printed(found, **options):
    console = Console(file=StringIO(), width=80)
    print_run(found, console, **options)
    return console.file.getvalue()


@pytest.mark.parametrize(("value", "error", "text"), [
    (0.888123, 0.0029, "0.888 +- 0.003"), (0.888123, 0.003, "0.888 +- 0.003"), (0.888123, 0.0031, "0.888 +- 0.004"),
    (0.888123, 0.0096, "0.89 +- 0.01"), (-0.29701, 2.3e-4, "-0.2970 +- 0.0003"), (123.4, 20.0, "120 +- 20"),
    (123.4, 300.0, "100 +- 300"), (0.888123, 0.0, "0.888123"), (0.8881234567, 1e-9, "0.8881235"),
    (0.0, 1e-3, "0.000 +- 0.001"), (1.54321, float("nan"), "1.543"),
])  # fmt: skip
def test_digits_are_those_that_the_error_leaves(value, error, text):
    assert answer.with_error(value, error) == text
    shifted = answer.with_error(value * 1e-3, error * 1e-3, -3)
    assert shifted == text


def test_the_answer_of_the_exact_method():
    found = dict(answer.answers(ran({"exact": EXACT, "fem": result()})))
    mm = A * 1e3
    assert found["stick zone"] == f"[{-C * mm:.7g}, {C * mm:.7g}] mm"
    assert found["m, n"] == f"{C:.7g} a, {C:.7g} a"
    assert found["a"] == f"{mm:.7g} mm"
    assert found["p0"] == f"{P0 / 1e6:.7g} MPa"
    largest = np.abs(EXACT.traction.q2).max() / 1e6
    assert found["largest |q1|"] == found["largest |q2|"] == f"{largest:.7g} MPa"
    assert answer.answer_heading(ran({"exact": EXACT})) == "exact: small tension"


def test_half_planes_in_the_place_of_finite_bodies_are_named():
    body = {"height": 0.5e-3, "width": 8e-3, "support": "roller"}
    thinner = body | {"height": 0.4e-3}
    scene = load_scene("fretting-aluminium")
    equal, unequal = (scene.replace({"bodies.upper": body, "bodies.lower": each}) for each in (body, thinner))
    headings = [answer.answer_heading(run(each.replace({"load.sigma": [0, 0]}), "exact")) for each in (equal, unequal)]
    assert headings == ["exact: small tension", "half-planes (exact): small tension"]


def test_what_the_reference_does_not_know_comes_from_another_method():
    exact = replace(EXACT, traction=traction(levels=False), undetermined={"q1": "why not", "q2": "why not"})
    found = dict(answer.answers(ran({"exact": exact, "fem": result(estimate={"q1": 1e-4})})))
    assert re.fullmatch(r"96 \+- 1 MPa \(fem\)|\d+ \+- \d MPa \(fem\)|\d\d\.\d \+- \d\.\d MPa \(fem\)",
                        found["largest |q1|"])  # fmt: skip
    assert dict(answer.answers(ran({"exact": exact})))["largest |q1|"] == "not known: why not"


def test_the_largest_shear_is_known_to_the_root_of_the_norm():
    """A square-root kink that is smeared over h: height sqrt(h), share of the L2 norm h."""
    x = np.linspace(0, 1, 200001)
    for h in (1e-2, 1e-3, 1e-4):
        off = np.where(np.abs(x - 0.5) < h / 2, np.sqrt(h), 0.0)
        assert np.sqrt(np.mean(off**2)) == pytest.approx(h, rel=0.05)
    found = dict(answer.answers(ran({"fem": result(estimate={"q1": 4e-4, "q2": 0.0})})))
    value, error = map(float, re.match(r"([\d.]+) \+- ([\d.]+) MPa", found["largest |q1|"]).groups())
    assert error == pytest.approx(0.02 * value, rel=0.5)


def test_without_a_stick_zone_or_friction():
    sliding = replace(EXACT, regime="sliding", stick_centre=None, stick_half_width=None)
    assert dict(answer.answers(ran({"exact": sliding})))["stick zone"] == "none"
    scene = load_scene("hertz-shear", ["friction.f=0", "load.Q=[0.0, 0.0]"])
    found = dict(answer.answers(run(scene, "exact", stresses=True)))
    assert not any("q1" in key for key in found)


def test_the_largest_tension_and_its_place():
    """At the trailing end 2 f p0 sqrt(1 - c^2/a^2): full sliding less the corrective ellipse over the stick zone."""
    text = dict(answer.answers(run(load_scene("hertz-shear"), "exact", stresses=True)))
    edge = 2 * 200 * 0.6**0.5
    assert text["largest sigma_xx, 1"] == f"{edge:.7g} MPa at x = -1 mm"
    assert text["largest sigma_xx, 2"] == f"{edge:.7g} MPa at x = 1 mm"


def test_march_alone_and_a_cycle_with_a_mean_give_stresses():
    text = dict(answer.answers(run(load_scene("hertz-shear", ["fem.accuracy=1e-3"]), "march", stresses=True)))
    assert "largest sigma_xx, 1" in text
    # R = 0.1, and the first loading does not settle q: exact knows no stresses, fem does
    scene = load_scene("hertz-large-tension", ["load.Q=[1e4, 9e4]", "fem.accuracy=1e-2"])
    found = run(scene, stresses=True)
    assert found["exact"].surface is None
    assert dict(answer.answers(found))["largest sigma_xx, 2"].endswith("(fem)")


def test_the_answer_comes_first_and_the_verdict_last():
    text = printed(ran({"exact": EXACT, "fem": result()}))
    lines = text.splitlines()
    assert lines[1] == "exact: small tension"
    assert lines[2].split()[:2] == ["stick", "zone"]
    assert lines[-1] == "all bars met: within 0.1 % of a, 1 % of p, 1.5 % of q"
    assert max(len(line.rstrip()) for line in lines) <= 80
    heading = next(line for line in lines if "estimate" in line)
    assert re.search(r"error {2,}estimate", heading)


def test_rows_that_say_nothing_are_left_out():
    comparison = ran({"exact": EXACT, "fem": result()}).comparisons["fem"]
    assert [row[0].split(",")[0] for row in rows.error_rows(comparison)] == ["a", "m", "n", "P", "p", "dQ", "q"]
    assert len(rows.error_rows(comparison, every=True)) == 13


def test_rows_that_say_something_stay():
    def left(found, exact=EXACT):
        return [row[0] for row in rows.error_rows(ran({"exact": exact, "fem": found}).comparisons["fem"])]

    moved = ((-0.9 * A, 1.1 * A),) * 2
    assert {"left end", "right end"} <= set(left(result(contact_ends=moved), replace(EXACT, contact_ends=moved)))
    assert "left end" in left(result(contact_ends=((-1.1 * A, A),) * 2))  # missed
    assert {"q1", "q2"} & set(left(result(of=traction(add=lambda x: 0.1 * (abs(x) < 0.5)))))


@pytest.mark.parametrize(("changes", "text"), [
    (["bodies.lower={width=0.02, height=0.01}"], "no bars: finite bodies"),
    (["material={lower={E=2.1e11, nu=0.3}, upper={E=0.7e11, nu=0.3}}"], "no bars: unlike bodies"),
    (["fem.size=0.05"], "no bars: the element size was given"),
])  # fmt: skip
def test_why_there_are_no_bars(changes, text):
    scene = load_scene("hertz-shear", [f"load={{P={P}, Q=[{-C * F * P}, {C * F * P}]}}", *changes])
    found = ran({"exact": EXACT, "fem": result()}, scene, None)
    assert (rows.verdict(found), found.conclusion.code) == (text, 0)
    assert found.outcome is Outcome.NOT_JUDGED


def test_errors_within_their_bars_with_larger_estimates():
    """The bars are met, and the last line says so; an estimate that is larger is told, not judged."""
    fem = result(estimate={"a": 2e-4, "m": 1e-4, "q1": 18e-3})
    (line,) = rows.verdict_lines(ran({"exact": EXACT, "fem": fem}))
    assert line == "all bars met: within 0.1 % of a, 1 % of p, 1.5 % of q; estimate of q1 above its bar"


def test_a_contact_that_slides_has_no_stick_zone_to_compare():
    slides = load_scene("hertz-shear", ["load.Q=[-1e9, 1e9]"])
    last = printed(run(slides, "exact")).replace("\n", " ").split("  ")[-1]
    assert "no bars: the contact slides as a whole, so there is no stick zone to compare" in last


# A number without an error estimate is marked, and there is no stick zone without a steady state


def test_a_value_without_an_estimate_has_few_digits_and_is_marked():
    march = result("march", estimate={}, counts={"tangential_unknowns": 62})
    text = dict(answer.answers(ran({"march": march})))
    assert text["m, n"] == f"{C:.4g} a, {C:.4g} a, no error estimate"
    assert text["stick zone"].endswith(" mm, no error estimate")
    assert text["largest |q2|"].endswith(" MPa, no error estimate")
    assert text["a"] == f"{A * 1e3:.7g} mm"  # march knows the pressure to rounding
    fem = dict(answer.answers(ran({"fem": result(estimate={})})))
    assert all(fem[key].endswith(", no error estimate") for key in ("a", "p0", "p_max", "m, n"))
    assert rows.value(march, "m") == f"{C:.4g} a, no error estimate"
    assert rows.value(result("march"), "m") == f"{C:.7f} a"
    cells = {row[0]: row[2] for row in answer.amounts({"march": march})[1]}
    assert cells["m, stick from -m"] == f"{C * A * 1e3:.4g}, no error estimate"
    assert cells["a, half-width"] == f"{A * 1e3:.7g}"


def test_a_contact_that_ratchets_has_no_stick_zone_to_print():
    exact = replace(EXACT, regime="ratchets")
    run_ = ran({"exact": exact, "fem": result(regime="ratchets")})
    text = dict(answer.answers(run_))
    assert text["stick zone"] == "none: the contact ratchets: there is no steady state"
    assert "m, n" not in text
    assert "not judged: m, n, q: the contact ratchets: there is no steady state" in printed(run_)
    assert (rows.value(exact, "m"), rows.value(exact, "a")) == ("none", rows.value(EXACT, "a"))
    assert "no steady state" in repr(exact)
    assert " m = " not in repr(exact)


@pytest.mark.parametrize(
    ("name", "overrides", "keys"),
    [
        ("flat-rounded", ["fem.accuracy=1e-2"], ["p_max"]),
        ("fretting-aluminium", ["load.P=[100e3, 135e3]", "fem.accuracy=1e-2"],
         ["p_max, load point 1", "p_max, load point 2"]),
    ],
)  # fmt: skip
def test_the_largest_pressure_stands_beside_its_scale(name, overrides, keys):
    """p0 = 2 P/(pi a) is the largest pressure of Hertz's contact alone; that of a flat and rounded one is 2.2 p0."""
    found = run(load_scene(name, overrides))
    exact, fem = found["exact"], found["fem"]
    text = dict(answer.answers(found))
    assert [key for key in text if key.startswith("p_max")] == keys
    assert exact.p0 == pytest.approx(2 * found.scene.P / (np.pi * exact.a), rel=1e-12)
    peaks, seen = (pressure_peaks(each, error) for each, error in ((exact, 0.0), (fem, fem.estimate["p"])))
    for key, (peak, error), (of_fem, known) in zip(keys, peaks, seen, strict=True):
        x = np.linspace(*exact.ends[1], 100_001)
        pressure = exact.traction.at(x).pressures[0 if key.endswith("1") else 1]
        assert peak == pytest.approx(pressure.max(), rel=2e-7)
        assert float(text[key].split()[0]) == pytest.approx(peak / 1e6, rel=1e-6)
        assert error < 1e-6 * peak
        assert abs(of_fem - peak) < known
