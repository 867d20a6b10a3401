"""Stick zones of one pair of bodies under many loads at once are those of the loads one by one."""

import numpy as np
import pytest

from partialslip import InputError, halfplane, load_scene
from partialslip.march.equivalent import stand_ins, stick_zone
from partialslip.result.rig import Rig, Terms, key_of

SCENE = load_scene("hertz-small-tension", ["bodies.upper={width=16e-3, height=8e-3}",
                                           "bodies.lower={width=16e-3, height=8e-3}"])  # fmt: skip
UNIT = 2 * SCENE.friction.f * SCENE.P, SCENE.friction.f * 4e8  # of dQ and dsigma
LOADS = np.array([[0.3, 0.5], [0.5, -1.5], [-0.2, 4.0], [0.95, 0.1], [-0.6, 0.0]]) * UNIT


def rig(**terms):
    arrays = {key: np.zeros((7, 7)) for key in ("xx", "yy", "xy")}
    for key, some in terms.items():
        for (i, j), value in some.items():
            arrays[key][i, j] = arrays[key][j, i] = value
    halves = {f"lower_{key}": arrays[key] / 2 for key in arrays}
    own = Terms(**arrays, pulled=np.zeros((2, 7)), **halves)
    return Rig(key_of(SCENE), 4e-3, own, own)


EVEN = rig(xx={(2, 0): 0.1, (1, 1): 0.04, (4, 0): -5e-3}, yy={(2, 0): 0.06, (1, 1): -0.1})


@pytest.mark.parametrize(("dQ", "dsigma"), LOADS)
def test_many_are_as_one_by_one(dQ, dsigma):
    scene = SCENE.replace(load={"Q": [-dQ / 2, dQ / 2], "sigma": [-dsigma / 2, dsigma / 2]})
    one = stand_ins(scene, EVEN).result
    assert one.method == "exact"
    found = stick_zone(SCENE, EVEN, dQ, dsigma)
    assert (found.m / one.a, found.n / one.a) == pytest.approx((one.m / one.a, one.n / one.a), abs=1e-9)


def test_shapes_follow_numpy_and_what_slides_is_marked():
    dQ = np.array([[0.3], [1.2], [-0.6]]) * UNIT[0]
    found = stick_zone(SCENE, EVEN, dQ, LOADS[:2, 1])
    assert found.m.shape == (3, 2)
    assert np.isnan(found.m[1]).all()
    assert (found.s[1] == 0).all()
    assert np.isfinite(found.m[[0, 2]]).all()
    assert found.m[0, 1] == stick_zone(SCENE, EVEN, dQ[0, 0], LOADS[1, 1]).m
    with pytest.raises(InputError, match="or the contact slides"):
        stick_zone(SCENE, EVEN, 1.2 * UNIT[0], 0.0)
    with pytest.raises(InputError, match="dsigma = nan: must be finite"):
        stick_zone(SCENE, EVEN, 0.0, np.nan)


def test_a_rig_of_nothing_is_half_planes():
    plain = halfplane.contact(load_scene("hertz-small-tension"))
    found = stick_zone(SCENE, rig(), *LOADS.T)
    known = halfplane.stick_zone(plain, SCENE.friction.f, *LOADS.T)
    assert np.allclose(found.m, known.m, rtol=0, atol=1e-13 * plain.a)
    assert np.allclose(found.n, known.n, rtol=0, atol=1e-13 * plain.a)
