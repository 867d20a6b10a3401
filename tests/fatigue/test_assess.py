"""Assessments of solved scenes: places, averages, load points around the cycle, the upper body and what is missing."""

from dataclasses import replace

import numpy as np
import pytest
from refusing import line_of

import partialslip
from partialslip.result.fields import StressAt
from partialslip.study.fatigue.cycle import phases_of
from partialslip.study.fatigue.places import averaged, largest_at
from partialslip.tools.errors import InputError

CONSTANTS = {
    "k_findley": 0.3, "k_fatemi_socie": 1.0, "sigma_y": 330e6, "alpha_dang_van": 0.3, "alpha_crossland": 0.3,
    "distance": 50e-6,
}  # fmt: skip
SCENE = partialslip.load_scene("fretting-aluminium").replace(fatigue=CONSTANTS)
RESULT = partialslip.run(SCENE, "exact", subsurface=True)["exact"]
CRITERIA = ("principal", "swt", "fatemi-socie", "findley", "dang-van", "crossland")


@pytest.fixture(scope="module")
def assessed():
    return partialslip.assess(SCENE, RESULT)


def test_the_trailing_edge_is_the_hot_spot(assessed):
    """All criteria find the end of the contact; sigma_xx there ranges over twice its largest value, Q and sigma being
    fully reversed."""
    assert set(assessed.ratings) == set(CRITERIA)
    for rating in assessed.ratings.values():
        assert (rating.surface.x, rating.surface.depth) == (RESULT.a, 0.0)
        assert rating.peak == rating.surface
        assert rating.change < 1e-10  # the extremes are those of the load points
    largest = RESULT.surface.largest[1]
    assert assessed.ratings["principal"].surface.value == pytest.approx(2 * largest, rel=1e-9)
    swt = largest**2 * (1 - SCENE.material.nu**2) / SCENE.material.E  # plane strain
    assert assessed.ratings["swt"].surface.value == pytest.approx(swt, rel=1e-9)


@pytest.mark.parametrize("name", CRITERIA)
def test_no_point_of_the_body_is_worse(name, assessed):
    rng = np.random.default_rng(1)
    x, depth = RESULT.a * rng.uniform(-3, 3, 1000), 2 * RESULT.a * rng.uniform(0, 1, 1000) ** 3
    assert assessed.at(name, x, depth).value.max() <= assessed.ratings[name].peak.value


def test_averages_of_a_linear_stress():
    """Stresses that vary linearly have averages at the centroids: half the distance, and 4 L/(3 pi) of a half disc."""
    distance = 0.3

    def stress(x, depth):
        return np.stack([1.0 + 2.0 * depth + 0.0 * x] * 4)[None]

    for over, depth in (("point", distance), ("line", distance / 2), ("area", 4 * distance / (3 * np.pi))):
        assert averaged(stress, 0.7, distance, over) == pytest.approx(np.full((1, 4), 1 + 2 * depth), rel=1e-13)


def test_averages_lie_between_the_peak_and_the_depth(assessed):
    for rating in assessed.ratings.values():
        point, line, area = (rating.averages[over].value for over in ("point", "line", "area"))
        assert point < area < line < rating.surface.value


def test_the_largest_is_found_between_the_points():
    x, depth = np.linspace(-1, 1, 8), np.linspace(0, 1, 6)

    def hill(x, depth):
        return -((x - 0.123) ** 2) - (depth - 0.456) ** 2 - (x - 0.123) * (depth - 0.456)

    assert largest_at(hill, x, depth, hill(x[:, None], depth)) == pytest.approx((0.123, 0.456), abs=1e-4)


def test_load_points_are_added_until_the_criterion_settles():
    """A stress that is largest between the load points."""

    def pulse(x, _, phases):
        sigma = 1e8 * np.sin(np.pi * (phases - 0.13)) ** 2
        return sigma[:, None, None] * np.stack([1 + 0 * x, 0 * x, 0 * x])

    found = partialslip.assess(SCENE, replace(RESULT, stress_at=StressAt(pulse)), ["principal"])
    rating = found.ratings["principal"]
    assert len(found.phases) == 64
    assert 1e-6 < rating.change < 1e-2
    assert rating.surface.value == pytest.approx(1e8, rel=4 * rating.change)


def test_where_only_the_load_points_are_known_it_says_so():
    def unknown(x, _, phases):
        if not np.isin(phases, (0, 0.5)).all():
            raise InputError("phases: 0.25 is between load points 1 and 2, where nobody knows; use march")
        return np.ones((len(phases), 3, len(x)))

    found = partialslip.assess(SCENE, replace(RESULT, stress_at=StressAt(unknown)), ["swt"])
    assert found.phases.tolist() == [0, 0.5]
    assert found.notes == ("load points 1 and 2 only: phases: 0.25 is between load points 1 and 2, where nobody knows; "
                           "use march",)  # fmt: skip


def test_the_upper_body_mirrors_the_lower_one_without_tension():
    scene = SCENE.replace(load={"sigma": [0, 0]})
    result = partialslip.run(scene, "exact", subsurface=True)["exact"]
    lower, upper = (partialslip.assess(scene, result, ["swt"], body=body) for body in ("lower", "upper"))
    assert upper.ratings["swt"].surface.value == pytest.approx(lower.ratings["swt"].surface.value, rel=1e-12)


def test_the_tension_of_the_upper_body_adds_to_both():
    scene = SCENE.replace(fatigue={"sigma_upper": [-1e7, 2e7]})
    for body in ("lower", "upper"):
        one, other = (partialslip.assess(each, RESULT, ["principal"], body=body) for each in (SCENE, scene))
        x, depth = np.array([2 * RESULT.a]), np.array([RESULT.a])
        difference = other.stress(x, depth) - one.stress(x, depth)
        assert difference[:, 0, 0] == pytest.approx(2e7 - 3e7 * np.abs(1 - 2 * other.phases))
        assert difference[:, 3, 0] == pytest.approx(SCENE.material.nu * difference[:, 0, 0])


def test_ruiz(assessed):
    """F2 is at most F1, and both scale with the slip."""
    found = assessed.ruiz
    assert found.F2 > 0
    assert found.F1 > found.F2
    assert abs(found.x2) < RESULT.a
    x = np.array([found.x2])
    tension = RESULT.stress_at(x, 0 * x)[:, 0, 0].max()
    slip = np.interp(found.x2, RESULT.slip.x, RESULT.slip.slip)
    work = SCENE.friction.f * RESULT.traction.at(found.x2).p * abs(slip) / 2  # q = f p where it slips
    assert tension * work == pytest.approx(found.F2, rel=1e-9)


def test_the_errors_of_ruiz_tell_how_far_methods_are_apart(assessed):
    """Those of exact come from its few points alone. Without an estimate of the stresses there is none."""
    scene = SCENE.replace({"fem.accuracy": 1e-3})
    march, fem = (partialslip.run(scene, method, subsurface=True)[method] for method in ("march", "fem"))
    true = partialslip.assess(scene, march, ["ruiz"]).ruiz
    for ruiz in (assessed.ruiz, partialslip.assess(scene, fem, ["ruiz"]).ruiz):
        for found, best, *errors in zip(ruiz[:2], true[:2], ruiz.errors, true.errors, strict=True):
            assert abs(found - best) < sum(errors) * best
            assert max(errors) < 0.1
    assert partialslip.assess(scene, fem, ["ruiz"], body="upper").ruiz.errors is None


PULLED = SCENE.replace(bodies={"lower": {"width": 40e-3, "height": 4e-3, "support": "roller"}})


@pytest.mark.parametrize(("scene", "said"), [
    (PULLED.replace({"fatigue.distance": 5e-3}),
     "fatigue.distance = 0.005 m: must not leave the lower body below the hot spot; the body is 0.004 m high"),
    (PULLED.replace({"fatigue.distance": 5e-3, "shown_in": "N-mm"}),
     "fatigue.distance = 5 mm: must not leave the lower body below the hot spot; the body is 4 mm high"),
    (PULLED.replace({"fatigue.distance": 7e-3, "bodies.lower.holder": {"width": 40e-3, "height": 2e-3}}),
     "fatigue.distance = 0.007 m: must not leave the lower body below the hot spot; the body is 0.006 m high"),
])  # fmt: skip
def test_a_distance_beyond_the_body_is_refused_before_anything_is_solved(scene, said, monkeypatch):
    monkeypatch.setattr("partialslip.study.fatigue.assessment.solved_with_stresses", None)
    assert line_of(partialslip.assess, scene) == said


@pytest.mark.parametrize("outside", [lambda at: at[1] < -20e-6, lambda at: at[0] > RESULT.a + 20e-6])
def test_averages_that_leave_the_body_are_refused_and_never_nan(outside):
    """Where the height of a body is not known, as that of a mesh; or beside it."""

    def cut(x, y, phases):
        return np.where(outside((x, y)), np.nan, RESULT.stress_at.function(x, y, phases))

    with pytest.raises(InputError, match=r"fatigue.distance = 5e-05 m: must not leave the lower body"):
        partialslip.assess(SCENE, replace(RESULT, stress_at=StressAt(cut)), ["swt"])


def test_criteria_without_constants_are_left_out():
    found = partialslip.assess(SCENE.replace(fatigue=dict.fromkeys(CONSTANTS)), RESULT)
    assert list(found.ratings) == ["principal", "swt"]
    assert not found.ratings["swt"].averages


def test_a_result_without_stresses_is_refused():
    with pytest.raises(InputError, match="exact: stresses are not known"):
        partialslip.assess(SCENE, replace(RESULT, stress_at=None))
    slides = SCENE.replace(friction={"f": 0.2})
    with pytest.raises(InputError, match="exact: stresses are not known; q1 and q2 are not known"):
        partialslip.assess(slides, partialslip.run(slides, "exact", subsurface=True)["exact"])
    with pytest.raises(InputError, match="body 'left': must be of lower, upper"):
        partialslip.assess(SCENE, RESULT, body="left")


def test_mirrored_scenes_have_mirrored_hot_spots(assessed):
    scene = SCENE.replace(load={"sigma": [-each for each in SCENE.load.sigma]})
    result = partialslip.run(scene, "exact", subsurface=True)["exact"]
    found = partialslip.assess(scene, result, ["swt", "findley", "dang-van"])
    for name, rating in found.ratings.items():
        assert rating.surface.value == pytest.approx(assessed.ratings[name].surface.value, rel=1e-9)
        assert rating.surface.x == pytest.approx(-assessed.ratings[name].surface.x)
        assert rating.averages["area"].value == pytest.approx(assessed.ratings[name].averages["area"].value, rel=1e-9)


def test_other_units_change_nothing(assessed):
    """The same mechanics a thousand times as large in stress and length."""
    size = {"material": {"E": 72.1e12}, "load": {"P": SCENE.P * 1e3, "Q": [-38.75e6, 38.75e6], "sigma": [-1e11, 1e11]}}
    constants = {"sigma_y": 330e9}
    scene = SCENE.replace(**size, fatigue=constants)
    result = partialslip.run(scene, "exact", subsurface=True)["exact"]
    found = partialslip.assess(scene, result, ["swt", "fatemi-socie", "crossland"])
    for name, rating in found.ratings.items():
        factor = 1.0 if name == "fatemi-socie" else 1e3
        assert rating.surface.value == pytest.approx(factor * assessed.ratings[name].surface.value, rel=1e-9)


def test_all_load_points_of_the_scene_count():
    """A path of four load points, of which the third is passed at a phase that no doubling would hit."""
    scene = SCENE.replace(load={"Q": [-1e4, 0, 3e4, 2e4, 1e4], "sigma": [0, 1e7, 0, 2e7, 0]})
    first, second = scene.load.ends
    for parts in (1, 4):
        phases = phases_of(scene.load, parts)
        assert len(phases) == 5 * parts
        at_points = [phases[(number - first) * parts] for number in range(5)]
        assert (at_points[first], at_points[second]) == (0.0, 0.5)
        passed, share = scene.load.stations(np.array(at_points))
        assert (passed + share) % 5 == pytest.approx(np.arange(5), abs=1e-12)
