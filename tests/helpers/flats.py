"""Flat and rounded punches under loads that follow from the stick zone."""

import math

import numpy as np
import pytest

from partialslip import parse_scene
from partialslip.halfplane import contact


def beside_the_flat(share, end, other, accuracy=2e-5):
    """Punch whose flat part is a ``share`` of the contact, under loads for which the stick zone is [-other, end] a."""
    flat = {"kind": "flat-rounded", "R": 0.01, "b": share * 1e-3}
    given = {"name": "flat", "material": {"E": 72.1e9, "nu": 0.33}, "friction": {"f": 0.3}, "profile": flat}
    # P presses the contact to the half-width 1e-3 m: the closed form of a in alpha = b/a
    angle = math.acos(share)
    trial = parse_scene({**given, "load": {"P": 1e5}})
    P = (2 * angle - math.sin(2 * angle)) * 1e-6 / (2 * 0.01 * trial.material.A)
    pressed = contact(parse_scene({**given, "load": {"P": P}}))
    assert pressed.a == pytest.approx(1e-3, rel=1e-9)
    found = pressed.shape.conditions(np.array([1 - other]), np.array([(other + end) / 2]), np.array([1.0]))
    dQ, dsigma = float(found.Qf[0]) * 0.6 * P, float(found.sf[0]) * 0.3 * pressed.p0
    load = {"P": P, "Q": [-dQ / 2, dQ / 2], "sigma": [-dsigma / 2, dsigma / 2]}
    return parse_scene({**given, "load": load, "fem": {"accuracy": accuracy}})
