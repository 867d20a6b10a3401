"""Profiles given by a table: finite elements press the gap itself, the exact solution its inversion."""

import msgspec
import numpy as np
import pytest

import partialslip
from partialslip.verify.random_scenes import draw


def tabulated(x, gap):
    data = msgspec.to_builtins(partialslip.load_scene("fretting-aluminium", ["fem.accuracy=1e-4"]))
    return partialslip.parse_scene({**data, "profile": {"kind": "tabulated", "x": x, "gap": gap}})


def gaps():
    x = np.linspace(0, 4e-4, 25)
    yield "parabola and quartic", x, x**4 / 4e-9 + x**2 / 0.04
    yield "flat and rounded", x, np.maximum(x - 1e-4, 0) ** 2 / 0.02
    uneven = np.concatenate([[0], np.cumsum(np.random.default_rng(1).uniform(0.1, 1, 12))])
    uneven *= 4e-4 / uneven[-1]
    yield "uneven", uneven, uneven**2 / 0.02 * (1 + 0.3 * (uneven / 4e-4) ** 2)


ON_DEMAND = ("parabola and quartic", "flat and rounded")
CASES = [pytest.param(*case, id=name, marks=[pytest.mark.slow] if name in ON_DEMAND else []) for name, *case in gaps()]


@pytest.mark.parametrize(("x", "gap"), CASES)
def test_a_table_by_all_methods(x, gap):
    outcome = partialslip.run(tabulated(x, gap), ["exact", "march", "fem"])
    assert outcome.passed
    exact, fem = outcome.results["exact"], outcome.results["fem"]
    assert fem.slip.dissipated == pytest.approx(exact.slip.dissipated, rel=1e-4)


def test_a_table_goes_on_far_beyond_the_contact():
    """A corner of it lies outside the block that is meshed while the contact is still known roughly."""
    _, scene = draw(0, 333)
    fem = partialslip.run(scene, ["fem"]).results["fem"]
    assert max(scene.profile.kinks) > 13 * fem.a
    assert max(fem.certificate.values()) < 1e-10
