"""The main job: every shipped scene, exactly and by finite elements, within its bars at the default settings."""

import pytest

import partialslip

BARS = {"a": 2e-5, "m": 2e-5, "n": 2e-5, "p": 2e-4, "q": 3e-4}


def errors(name, *overrides):
    outcome = partialslip.run(partialslip.load_scene(name, overrides))
    comparison = outcome.comparisons["fem"]
    return outcome, {key: getattr(comparison, key) for key in BARS}


@pytest.mark.parametrize("name", partialslip.shipped_scenes())
def test_shipped_scene(name):
    outcome, found = errors(name)
    assert outcome.passed
    assert {key: outcome.comparisons["fem"].bars[key] for key in BARS} == pytest.approx(BARS)
    for key, bar in BARS.items():
        assert found[key] <= bar
    fem = outcome.results["fem"]
    assert fem.settings["far_field"] == "half-plane"
    # the method's own estimate is of the size of the true error, or above it
    for key, estimate in fem.estimate.items():
        assert outcome.comparisons["fem"].errors[key] <= max(3 * estimate, 2e-6)


def test_plain_wide_box_borrows_nothing_from_half_plane_theory():
    outcome, found = errors("fretting-aluminium", "fem.far_field=box")
    assert max(found[key] for key in ("a", "m", "n")) <= 5e-5
    assert found["p"] <= BARS["p"]
    assert found["q"] <= BARS["q"]
    assert outcome.results["fem"].settings["far_field"] == "box"
    assert "far-field" in outcome.plan.left_out


@pytest.mark.parametrize(("order", "accuracy"), [pytest.param(2, 1e-4, marks=pytest.mark.slow), (3, 2e-5), (4, 1e-6)])
def test_accuracy_asked_for_is_reached(order, accuracy):
    _, found = errors("hertz-large-tension", f"fem.order={order}", f"fem.accuracy={accuracy}")
    assert max(found[key] for key in ("a", "m", "n")) <= accuracy
    assert found["p"] <= 10 * accuracy
    assert found["q"] <= 15 * accuracy
