"""What is shown of an assessment: values with their errors, places, and what the method says."""

from dataclasses import replace

import pytest

import partialslip
from partialslip.report.answer import with_error
from partialslip.study.fatigue import assess, hot_spots, tables

SCENE = partialslip.load_scene("fretting-aluminium", ["shown_in=N-mm"]).replace(
    {"fatigue.distance": 50e-6, "fem.accuracy": 1e-2}
)


@pytest.fixture(scope="module")
def fem():
    return partialslip.run(SCENE, "fem", subsurface=True)["fem"]


def column(table, heading):
    head, rows = table
    return [row[head.index(heading)] for row in rows]


def test_values_have_the_errors_that_a_study_of_sizes_tells(fem):
    found, spots = assess(SCENE, fem, ["swt"]), hot_spots(SCENE, fem)
    for text, key in (
        (column(tables.rating_table(found), "surface"), "swt"),
        *((column(tables.average_table(found), over), f"swt.{over}") for over in ("point", "line", "area")),
    ):
        spot = spots[key]
        assert text == [with_error(spot.value, spot.error * spot.value, 6)]  # MPa
        assert "+-" in text[0]


def test_without_an_estimate_few_digits_stand_and_a_line_says_so(fem):
    for result, body, why in (
        (replace(fem, estimate={}), "lower", "fem has no estimate of q"),
        (replace(fem, path_dependent=True), "lower", "slip reverses where the result does not follow"),
        (fem, "upper", "they are estimated in the lower body alone"),
    ):
        found = assess(SCENE, result, ["swt"], body=body)
        (text,) = column(tables.rating_table(found), "surface")
        assert "+-" not in text
        assert len(text.replace(".", "").lstrip("0")) <= 4
        assert f"errors of the criteria are not known: {why}" in tables.assessment_notes(found)


def test_the_method_has_its_say(fem):
    """Regime, ends with their errors, and its notes."""
    found = assess(SCENE, replace(fem, notes=("accuracy 0.01 not reached",)), ["swt"])
    assert tables.assessment_answer(found).startswith("fem: small tension; m, n 0.4")
    assert tables.assessment_answer(found).count("+-") == 3
    assert "fem: accuracy 0.01 not reached" in tables.assessment_notes(found)


def test_the_heading_tells_whether_there_are_load_points_enough(fem):
    found = assess(SCENE, fem, ["swt"])
    for change, told in (
        (0.0, "; half as many give the same"),
        (2e-5, "; half as many change the criteria by 2.0e-05"),
        (float("nan"), ""),
    ):
        rating = replace(found.ratings["swt"], change=change)
        heading = tables.assessment_heading(replace(found, ratings={"swt": rating}))
        assert heading == f"fretting-aluminium, lower body, by fem: {len(found.phases)} load points{told}"


def test_the_largest_inside_has_columns_only_where_it_is_larger(fem):
    found = assess(SCENE, fem, ["swt"])
    assert "largest" not in tables.rating_table(found)[0]
    rating = found.ratings["swt"]
    inside = replace(rating, peak=replace(rating.surface, depth=fem.a / 2, value=2 * rating.surface.value))
    table = tables.rating_table(replace(found, ratings={"swt": inside}))
    assert column(table, "depth/a") == ["0.5000"]
    assert column(table, "largest")[0].startswith(f"{2 * rating.surface.value / 1e6:.1f}")


def test_what_is_not_known_of_the_ends_has_no_column(fem):
    """K_T of finite bodies, whose adhered solution is not known; K_S where nothing sticks."""
    found = assess(SCENE, fem, ["swt"])
    ends = tuple(replace(edge, K_T=None, predicted=None) for edge in found.edges)
    finite = replace(found, edges=ends)
    assert tables.edge_table(finite)[0] == ["end", "K_N", "slip/a", "K_S"]
    assert tables.edge_units(finite) == "K_N and K_S in MPa/mm^0.5"
    slides = replace(found, edges=tuple(replace(edge, K_S=None) for edge in ends))
    assert tables.edge_table(slides)[0] == ["end", "K_N", "slip/a"]
    assert tables.edge_units(slides) == "K_N in MPa/mm^0.5"
