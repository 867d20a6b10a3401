"""Equivalent half-planes of two equal strips: their rig against finite elements, their estimate against the truth."""

from dataclasses import replace

import numpy as np
import pytest
from strip_scenes import A, strips

from partialslip import run
from partialslip.result.rig import write_rig
from partialslip.run import characterise, rig_of
from partialslip.run.judge import compare
from partialslip_fem.characterise import characterise_bodies

PULLED = {"sigma": (-100e6, 100e6)}
KEYS = ("a", "m", "n", "p", "q")


def off_and_estimates(scene):
    exact, found = (run(scene, method)[method] for method in ("exact", "equivalent"))
    errors = compare(found, exact, scene, None).errors
    return np.array([errors[key] for key in KEYS]), np.array([found.estimate[key] for key in KEYS])


@pytest.mark.parametrize(
    ("ratio", "load"),
    [
        (1.5, {}),
        (5.0, PULLED),
        (100.0, {}),
        *(
            pytest.param(ratio, load, marks=pytest.mark.slow)
            for ratio in (1.5, 2.0, 3.0, 10.0, 30.0)
            for load in ({}, PULLED)
        ),
    ],
)
def test_the_estimate_is_the_error(ratio, load):
    off, estimate = off_and_estimates(strips(ratio * A, **load))
    assert (off <= estimate + 1e-12).all()
    assert (estimate[1:] <= 3 * off[1:]).all()


def test_kernels_that_are_exchanged_are_caught(tmp_path):
    scene = strips(5 * A)
    rig = rig_of(scene)
    terms = rig.terms._replace(xx=rig.terms.yy, yy=rig.terms.xx)
    write_rig(replace(rig, terms=terms, rough=terms), tmp_path / "rig.json")
    off, estimate = off_and_estimates(scene.replace(bodies={"equivalent": str(tmp_path / "rig.json")}))
    assert (off > 10 * estimate).all()


@pytest.mark.parametrize("load", [{}, PULLED, PULLED | {"lower": {"right_grip": 0.3}}])
def test_the_rig_is_that_of_finite_elements(load):
    scene = strips(5 * A, width=60 * A, **load)
    closed, meshed = characterise(scene), characterise_bodies(scene)
    x = np.linspace(-0.45, 0.45, 9) * 5 * A
    for key in ("xx", "yy", "xy", "lower_xx", "lower_yy", "lower_xy"):
        own, other = (each.powers(x) @ getattr(each.terms, key) @ each.powers(x).T for each in (closed, meshed))
        assert np.ptp(own - other, axis=0).max() < 3e-6 + 1e-6 * np.ptp(other)  # but for rigid displacements
