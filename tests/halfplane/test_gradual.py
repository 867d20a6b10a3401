"""Reversal of slip during gradual loading: the conditions, before and after solving, against the march."""

import numpy as np
import pytest
from lost import lost_way
from reversed_loads import scene

import partialslip
from partialslip.halfplane.contact import contact
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.method import path_dependent
from partialslip.halfplane.punch import Punch
from partialslip.halfplane.steady import steady_stick_zone, stick_zones
from partialslip.halfplane.turning import Turning, half_cycle
from partialslip.run import default_methods
from partialslip.scene.gradual import _QF, _SF, _SLOPE, may_turn_round, turns_round


def loading_of(its):
    """Half a cycle of a scene."""
    return half_cycle(contact(its), its.friction.f, its.load.dQ, its.load.dsigma)


def test_the_box_known_beforehand_lies_inside_the_exact_domain():
    """For Hertz, slip does not reverse inside the box of `may_turn_round` and on its edge."""
    Qf = np.linspace(1e-3, _QF, 60)
    Qf, share = np.meshgrid(Qf, np.linspace(0, 1, 60), indexing="ij")
    sf = _SLOPE * Qf + share * (_SF - _SLOPE * Qf)
    for load in zip(Qf.ravel(), sf.ravel(), *(each.ravel() for each in stick_zones(Qf, sf, HertzShape())), strict=True):
        Q, tension, centre, half_width, s = map(float, load)
        assert not turns_round(Q, tension, s, centre, half_width)


@pytest.mark.parametrize("shape", [HertzShape(), Punch(0.3), Punch(0.8), Punch([0.0, 0.5], [1.0, 2.0])])
def test_the_condition_is_the_rate_along_the_way(shape):
    """The adhered traction of the stick zone always drives both ends in the direction of slip, and points that slip are
    pushed that way from the beginning: checked along gradual loading, at random loads."""
    random = np.random.default_rng(5)
    for Qf, sf in zip(random.uniform(0.02, 0.95, 40), 10 ** random.uniform(-1, 1.3, 40), strict=True):
        zone = steady_stick_zone(Qf, sf, shape)
        share = np.linspace(0.02, 1, 50)
        _, half_width, s = stick_zones(share * Qf, share * sf, shape)
        left = s * (4 * Qf - half_width * sf) / max(sf, 4 * Qf)  # < 0: against the slip on the left
        zero = -4 * Qf / sf  # where the adhered traction of the whole contact changes sign
        wrong_way = zone.s < 0 and not (zone.centre - zone.half_width <= zero <= zone.centre + zone.half_width)
        one_sign = abs(s.sum()) == len(s)
        turns = bool((left < 0).any()) or wrong_way or not one_sign
        near = np.abs(left).min() < 0.02
        assert near or turns == turns_round(Qf, sf, zone.s, zone.centre, zone.half_width)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("Qf", "sf", "known", "turns"),
    [
        (0.75, 2.4, False, False),  # small tension
        (0.4, 4.03, False, False),  # large tension, within the box
        (0.55, 4.5, True, False),  # large tension, outside
        (0.3, 1.3, True, True),  # around the transition
        (0.55, 7.0, True, True),  # late
    ],
)
def test_methods_and_plan_of_what_may_turn_round(Qf, sf, known, turns):
    its = scene(Qf, sf)
    assert may_turn_round(its) == known
    assert partialslip.plan(its).needs("history") == known
    assert default_methods(its) == ("exact", "fem")
    result = partialslip.run(its, ["exact"]).results["exact"]
    assert isinstance(loading_of(its), Turning) == turns
    assert not result.undetermined
    assert result.m is not None
    assert result.traction.q2 is not None


def test_a_stick_zone_that_drifts_and_is_too_narrow_to_follow_is_refused():
    """Its way is not known: the result is that of one step, and says so."""
    its = scene(0.1, 30.0)
    assert path_dependent(its)
    result = partialslip.run(its, ["exact"]).results["exact"]
    assert set(result.undetermined) == {"m", "n", "q", "q1", "q2"}
    assert all(reason.startswith("path-dependent") for reason in result.undetermined.values())
    assert default_methods(its) == ("march", "fem")


@pytest.mark.slow
def test_exact_is_the_reference_where_gradual_loads_are_solved():
    its = scene(0.3, 1.3, "fem.accuracy=1e-2")
    assert partialslip.run(its, ["exact", "march"]).reference == "exact"
    with lost_way():
        assert path_dependent(its)
        assert partialslip.run(its, ["exact", "march"]).reference == "march"
        assert partialslip.run(scene(0.4, 4.03, "fem.accuracy=1e-2"), ["exact", "march"]).reference == "exact"


def test_other_profiles_are_decided_by_the_exact_method():
    """Nothing is known of them beforehand; the contact is solved once."""
    its = scene(0.4, 3.44, name="flat-rounded")
    assert may_turn_round(its)
    assert not isinstance(loading_of(its), Turning)
    assert path_dependent(scene(0.1, 30.0, name="flat-rounded"))
    assert not may_turn_round(partialslip.load_scene("flat-rounded", ["load.sigma=[0, 0]"]))
