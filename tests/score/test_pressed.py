"""Unlike bodies that were pressed only: the stick zone is seen in the shear traction of pressing."""

import numpy as np
import pytest
from tables import written

from partialslip import load_scene
from partialslip.codes.score.method import scored
from partialslip.codes.score.read import read_tractions

UNLIKE = ["material.upper={E=2e11, nu=0.3}", "load={p0=400e6}", "friction.f=0.1"]


@pytest.mark.parametrize("count", [41, 401])
def test_ends_where_shear_leaves_the_bound_smoothly(count, tmp_path):
    """|q| = f p for |x| > c; within, f p less a part that grows with the power 3/2 of the distance from c."""
    scene, c, f = load_scene("hertz-shear", UNLIKE), 0.4, 0.1
    assert scene.only_pressed
    x = np.linspace(-1.1, 1.1, count)
    p = np.sqrt(np.maximum(1 - x**2, 0.0))
    room = np.maximum(1 - (x / c) ** 2, 0.0) ** 1.5
    table = x * 1e-3, p * 4e8, *[-np.sign(x) * f * p * (1 - room) * 4e8] * 2
    path = written(tmp_path / "made.csv", table, "x,p,q1,q2")
    found = scored(scene, read_tractions(path, scene), "made", "made.csv")
    assert found.regime == "pressing"
    assert (found.m / 1e-3, found.n / 1e-3) == pytest.approx((c, c), abs=0.5 / count)
