"""The exact method: published cases, regimes, signs and mean loads."""

import numpy as np
import pytest

import partialslip
from partialslip import load_scene, plan
from partialslip.halfplane import solve
from partialslip.run.judge import Outcome


def exact(name, *overrides):
    scene = load_scene(name, overrides)
    return solve(scene, plan(scene))


def test_fretting_aluminium():
    result = exact("fretting-aluminium")
    assert result.regime == "small tension"
    assert result.a * 1e3 == pytest.approx(0.206698, abs=5e-7)
    assert result.p0 / 1e6 == pytest.approx(418.104, abs=5e-4)
    assert (result.m / result.a, result.n / result.a) == pytest.approx((0.419531, 0.020906), abs=5e-7)
    assert result.traction.q2.max() / 1e6 == pytest.approx(125.40, abs=5e-3)


def test_yang_laursen():
    result = exact("yang-laursen")
    assert (result.m / result.a, result.n / result.a) == pytest.approx((0.729308, 0.729308), abs=5e-7)
    assert result.traction.at(np.array([result.n])).dq[0] / 2e6 == pytest.approx(1.279612, abs=5e-7)


@pytest.mark.parametrize(
    ("overrides", "regime"),
    [
        (["load.Q=[0, 0]", "load.sigma=[0, 0]"], "stuck"),
        (["load.Q=[5e4, 5e4]", "load.sigma=[1e8, 1e8]"], "stuck"),
        (["load.sigma=[0, 0]"], "small tension"),
        (["load.Q=[0, 0]"], "large tension"),
        (["load.Q=[-314159.26535897935, 314159.26535897935]"], "sliding"),
        (["load.Q=[-4e5, 4e5]"], "sliding"),
        (["load.Q=[2e5, 4e5]"], "sliding"),
        (["load.Q=[62831.85, 251327.4]", "load.sigma=[2e8, 1e9]"], "ratchets"),
        (["friction.f=0"], "sliding"),
    ],
)
def test_regimes(overrides, regime):
    result = exact("hertz-large-tension", *overrides)
    assert result.regime == regime
    assert (result.m is None) == (regime == "sliding")
    assert np.isfinite(result.traction.p).all()
    assert np.isfinite(result.traction.dq).all()


def test_mean_loads_leave_the_levels_open():
    """The range depends on the changes only; q1 and q2 themselves on the path."""
    base = exact("hertz-small-tension")
    shifted = exact("hertz-small-tension", "load.Q=[-200000, 271238.898038469]", "load.sigma=[0, 480e6]")
    assert (shifted.m, shifted.n) == pytest.approx((base.m, base.n), rel=1e-12)
    assert shifted.traction.q1 is None
    assert shifted.traction.q2 is None
    assert "mean loads" in shifted.notes[0]


def test_flat_and_rounded_contact():
    """P = a^2/(A R) [(pi - 2 phi0)/2 - sin phi0 cos phi0] with b = a sin phi0, down to a bare flat and up to Hertz."""
    scene = load_scene("flat-rounded")
    A, R = scene.material.A, scene.profile.R
    for P, b in ((scene.P, 1e-3), (scene.P, 1e-9), (1.0, 1e-3)):
        result = exact("flat-rounded", f"load.P={P}", f"profile.b={b}", "load.Q=[0, 0]", "load.sigma=[0, 0]")
        phi0 = np.arcsin(b / result.a)
        if b / result.a < 0.999:
            force = result.a**2 / (A * R) * ((np.pi - 2 * phi0) / 2 - np.sin(phi0) * np.cos(phi0))
            assert force == pytest.approx(P, rel=1e-10)
        assert result.a >= b


def test_limits_are_where_something_else_begins():
    base = exact("hertz-large-tension")
    sliding, transition, mean = (base.limits[key] for key in ("Q_sliding", "dsigma_transition", "Q_mean"))
    load = load_scene("hertz-large-tension").load
    assert transition > 0  # that of a single step; under gradual loads small tension goes on beyond
    for factor, regime in ((1 - 1e-6, "small tension"), (1 + 1e-6, "sliding")):
        assert exact("hertz-large-tension", f"load.Q=[{-sliding * factor}, {sliding * factor}]").regime == regime
    for factor, regime in ((1 - 1e-6, "large tension"), (1 + 1e-6, "ratchets")):
        Q = [factor * mean - load.dQ / 2, factor * mean + load.dQ / 2]
        assert exact("hertz-large-tension", f"load.Q={Q}").regime == regime
    still = exact("hertz-large-tension", "load.Q=[1e4, 1e4]", "load.sigma=[1e7, 1e7]")
    assert still.regime == "stuck"
    assert still.limits["Q_mean"] == pytest.approx(still.limits["Q_sliding"])
    assert exact("hertz-large-tension", "friction.f=0").limits == {}


@pytest.mark.parametrize("sigma", ["[0, 0]", "[-1e8, 1e8]"])
def test_frictionless_contact_without_shear_force_neither_sticks_nor_slides(sigma):
    scene = load_scene("hertz-shear", ["friction.f=0", "load.Q=[0, 0]", f"load.sigma={sigma}"])
    run = partialslip.run(scene, ["exact", "march", "fem"])
    for result in run.results.values():
        assert result.regime == "frictionless"
        assert not any("slides" in note for note in result.notes)
        assert "nothing sticks" in result.notes[0]
        assert result.m is None
        assert not result.traction.dq.any()
    for comparison in run.comparisons.values():
        verdicts = {verdict.quantity: verdict for verdict in comparison.verdicts}
        assert {verdicts[key].reason for key in ("m", "n")} == {"there is no friction"}
        assert verdicts["q"].outcome == "passed"  # q = 0
        assert verdicts["regime"].outcome is verdicts["a"].outcome is Outcome.PASSED
