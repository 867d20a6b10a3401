"""Two equal strips against a solver of their own (helpers/layers.py), equilibrium, and limits."""

import layers
import numpy as np
import pytest
from plain import HERTZ, plain
from quadrature import rule

import partialslip
from partialslip.halfplane import contact, layer
from partialslip.halfplane import method as exact_method
from partialslip.scene.bodies import Strips
from partialslip.tools.errors import InputError

E, NU, R, P, F = 72.1e9, 0.33, 0.01, 135.75e3, 0.3
A = 4 * (1 - NU**2) / E
X = np.linspace(-8e-4, 8e-4, 17)
PROFILES = {
    "hertz": HERTZ,
    "flat": {"kind": "flat-rounded", "R": R, "b": 1e-4},
    "uneven": {"kind": "tabulated", "x": X, "gap": X**2 / 0.02 * (1 + 200 * X), "tilt": "fixed"},
}


def strips(h, Q=30e3, sigma=0.0, profile="hertz", width="infinite", friction=F, **lower):
    body = {"height": h, "width": width, "support": "roller"}
    pulled = {"pulled": True, "right_grip": 0.5} if sigma else {}
    return plain(
        {"P": P, "Q": [-Q, Q], "sigma": [-sigma, sigma]},
        profile=PROFILES[profile],
        friction=friction if isinstance(friction, dict) else {"f": friction},
        bodies={"upper": body, "lower": body | pulled | lower},
    )


def solved(scene):
    exact_method._change.cache_clear()
    return partialslip.run(scene, "exact")["exact"]


def M(w):
    return (np.cosh(2 * w) - 1) / (np.sinh(2 * w) + 2 * w)


def N(w):
    return (np.cosh(2 * w) + 1) / (np.sinh(2 * w) + 2 * w)


@pytest.mark.parametrize("w", [0.1, 1.0, 5.0])
def test_the_kernels_are_those_of_the_equations_of_equilibrium(w):
    across, normal = layers.moved(w, NU, "normal")
    along, other = layers.moved(w, NU, "shear")
    assert (normal, along) == pytest.approx((M(w), N(w)), rel=1e-9)
    G = 2 * w / (np.sinh(2 * w) + 2 * w)
    assert across == pytest.approx(G - (1 - 2 * NU) / (2 - 2 * NU), abs=1e-9)
    assert other == pytest.approx(across, abs=1e-9)


def bonded(w):
    kappa = 3 - 4 * NU
    D = 2 * kappa * np.cosh(2 * w) + 1 + kappa**2 + 4 * w**2
    along = (2 * kappa * np.sinh(2 * w) + np.array([-4, 4])[:, None] * w) / D
    return *along, (kappa**2 - 1 + 4 * w**2) / D


@pytest.mark.parametrize("w", [0.1, 1.0, 5.0])
def test_the_kernels_of_bonded_layers_are_those_of_the_equations_of_equilibrium(w):
    across, normal = layers.moved(w, NU, "normal", bonded=True)
    along, _ = layers.moved(w, NU, "shear", bonded=True)
    found = normal, along, across + (1 - 2 * NU) / (2 - 2 * NU)
    assert found == pytest.approx([each[0] for each in bonded(np.array([w]))], rel=1e-8)
    own = layer.Layer(Strips(1e-3, np.inf, (0.0, 0.0), 0.0, bonded=True), 3 - 4 * NU)
    M, N, G = bonded(layer._W)
    assert np.abs([own._rest["normal"] + 1 - M, own._rest["shear"] + 1 - N, own._across - G]).max() < 1e-14


def test_clamped_blocks_are_bonded_layers():
    body = {"height": 0.5e-3, "width": 10e-3, "support": "clamped"}
    loads = {"P": P, "Q": [-20e3, 20e3], "sigma": [-50e6, 50e6]}
    scene = plain(loads, friction={"f": F}, bodies={"upper": body, "lower": body}, fem={"accuracy": 1e-3})
    run = partialslip.run(scene)
    assert run.passed
    half_planes = partialslip.run(scene.replace(effects={"finite-size": False}), "exact")["exact"]
    off = {name: abs(run[name].m - half_planes.m) / half_planes.a for name in ("exact", "fem")}
    assert off["exact"] > 0.02
    assert run["fem"].m == pytest.approx(run["exact"].m, abs=2e-5 * half_planes.a)


@pytest.mark.parametrize(
    ("h", "sigma", "a", "m", "n", "p"),
    [
        (0.4e-3, 0, 0.195532552, 0.100889349, 0.100889349, 443.2421),
        (1.0e-3, 0, 0.204504772, 0.105143493, 0.105143493, 422.6346),
        (4.0e-3, 0, 0.206554320, 0.106013282, 0.106013282, 418.3944),
        (1.0e-3, 100e6, 0.204504772, 0.145685105, 0.064604050, 422.6346),
    ],
)
def test_the_known_numbers(h, sigma, a, m, n, p):
    found = solved(strips(h, sigma=sigma))
    assert (1e3 * found.a, 1e3 * found.m, 1e3 * found.n) == pytest.approx((a, m, n), abs=6e-10)
    assert 1e-6 * found.traction.at(0.0).p == pytest.approx(p, abs=6e-5)


@pytest.mark.parametrize(
    ("h", "Q", "sigma", "large"),
    [
        (0.06e-3, 30e3, 0.0, 0),
        (0.06e-3, 30e3, 50e6, 0),
        (0.3e-3, 30e3, -100e6, 0),
        (0.3e-3, 10e3, 200e6, -1),
        (1.0e-3, 10e3, -250e6, 1),
    ],
)
def test_direct_collocation(h, Q, sigma, large):
    found = solved(strips(h, Q, sigma))
    a, phi = layers.pressed(A, R, P, h)
    assert found.a == pytest.approx(a, rel=1e-12)
    p = found.traction.at(a * layers.INNER).p
    assert p == pytest.approx(a * np.sin(np.arccos(layers.INNER)) * phi, abs=1e-9 * p.max())
    begin = found.stick_centre / a, 0.99 * found.stick_half_width / a
    m, n = layers.sheared(a, phi, lambda x: F + 0 * x, Q, sigma, h, large, begin)
    assert (found.m, found.n) == pytest.approx((m, n), abs=1e-11 * a)
    assert max(found.certificate.values()) < 1e-12


def test_friction_along_x():
    scene = strips(0.3e-3, 20e3, 30e6, friction={"f": [0.4, 0.2], "x": [-1e-3, 1e-3]})
    found, (a, phi) = solved(scene), layers.pressed(A, R, P, 0.3e-3)
    m, n = layers.sheared(a, phi, scene.friction.at, 20e3, 30e6, 0.3e-3, 0, (-0.1, 0.6))
    assert (found.m, found.n) == pytest.approx((m, n), abs=1e-10 * a)


def strain(kernel, h, x, values, ends, held=0.0):
    """(1/pi) PV int values (K(x - t) + held t) dt, at x (k,), by the tanh-sinh rule between the ends."""
    t, weights = rule(ends)
    at_t, at_x = values(t), values(x)
    step = np.subtract.outer(x, t)
    singular = np.where(step == 0, 0.0, (at_t - at_x[:, None]) / np.where(step == 0, 1.0, step)) @ weights
    singular = singular + at_x * np.log((x - ends[0]) / (ends[-1] - x))
    return (singular + layers.smooth(kernel, h, x, t) @ (weights * at_t)) / np.pi + held * (at_t * t) @ weights


@pytest.mark.parametrize("profile", ["hertz", "flat", pytest.param("uneven", marks=pytest.mark.slow)])
def test_the_gap_closes_and_the_stick_zone_moves_as_one(profile):
    """Both integral equations, of strips held on their sides, too; the slip is the integral of the strain beyond."""
    h, sigma, width = 0.25e-3, 40e6, 10e-3
    scene = strips(h, 20e3, sigma, profile, width, right_grip="stiffness")
    found = solved(scene)
    (left, right), middle = found.ends[1], found.stick_centre
    x = np.linspace(middle - 0.7 * found.stick_half_width, middle + 0.6 * found.stick_half_width, 5)
    kinks = X if profile == "uneven" else scene.profile.kinks
    inner = [kink for kink in kinks if left < kink < right]
    ends = np.unique([left, *inner, right])
    slope = A * strain("M", h, x, lambda t: found.traction.at(t).p, ends)
    step = 1e-8
    wanted = (scene.profile.gap_at(x + step) - scene.profile.gap_at(x - step)) / (2 * step)
    assert slope == pytest.approx(wanted, abs=1e-6 * A * found.p0)
    dq, ends = (lambda t: found.traction.at(t).dq), np.unique([*ends, -found.m, found.n])
    held = 2 / (4 * h * width)
    # change of the strain of the lower strip by tension, 2 sigma (1 - nu^2)/E, is A/2 sigma
    relative = A * (strain("N", h, x, dq, ends, held) + 2 * sigma / 4)
    assert relative == pytest.approx(0 * x, abs=1e-6 * A * F * found.p0)
    pressed, change = exact_method._half_cycle(scene)
    beyond = np.array([0.3, 0.8]) * (right - found.n) + found.n
    t, weights = np.polynomial.legendre.leggauss(30)
    for end in beyond:
        # strain beyond the zone begins as a square root: t = s^2
        s, ds = (1 + t) / 2, weights / 2
        at = found.n + (end - found.n) * s**2
        strains = A * (strain("N", h, at, dq, ends, held) + 2 * sigma / 4)
        slipped = float(strains @ (2 * s * ds)) * (end - found.n)
        slip = A * F * pressed.p0 * pressed.a * change.slip(np.array([(end - pressed.centre) / pressed.a]))
        assert slip == pytest.approx(slipped, rel=1e-6)


def test_far_backs_are_half_planes():
    for sigma in (0.0, 80e6):
        far, half_planes = (
            solved(strips(1e3, sigma=sigma)),
            solved(plain({"P": P, "Q": [-30e3, 30e3], "sigma": [-sigma, sigma]})),
        )
        assert far.a == pytest.approx(half_planes.a, rel=1e-14)
        assert (far.m, far.n) == pytest.approx((half_planes.m, half_planes.n), rel=1e-12)
    near = contact(strips(20e-3))
    assert (1 - near.a / half_planes.a) * (20e-3 / near.a) ** 2 == pytest.approx(0.26052, abs=1e-4)


def test_loads_mirrored_and_scaled():
    one, other = solved(strips(0.3e-3, 20e3, 60e6)), solved(strips(0.3e-3, 20e3, -60e6))
    assert (one.m, one.n) == pytest.approx((other.n, other.m), rel=1e-12)
    scene = strips(0.3e-3, 20e3, 60e6)
    length, stress = 1e3, 1e-6
    tables = {
        "material": {"E": E * stress, "nu": NU},
        "profile": {"R": R * length},
        "load": {"P": P * length * stress, "Q": [-20e3 * length * stress, 20e3 * length * stress],
                 "sigma": [-60e6 * stress, 60e6 * stress]},
        "bodies": {"upper": {"height": 0.3e-3 * length}, "lower": {"height": 0.3e-3 * length}},
    }  # fmt: skip
    scaled = solved(scene.replace(tables))
    assert (scaled.m / length, scaled.n / length) == pytest.approx((one.m, one.n), rel=1e-12)
    energy = one.slip.dissipated
    assert scaled.slip.dissipated / (length**2 * stress) == pytest.approx(energy, rel=1e-9)
    x, slips = one.slip.x, np.abs(one.slip.slip)
    worn = F * one.traction.at(x).p * slips
    assert energy == pytest.approx(2 * np.trapezoid(worn, x), rel=1e-2)


def stresses(scene):
    return partialslip.run(scene, "exact", subsurface=True)["exact"]


def test_stresses_inside():
    """Tractions at the surface; no shear and a uniform stretch at the backs; equilibrium, and harmonic sums of normal
    stresses, by differences; Q and P through sections."""
    h = 0.3e-3
    found = stresses(strips(h, 20e3, 60e6))
    a = found.a
    for way in (-1, 1):
        x = np.linspace(-0.9, 0.9, 7) * a
        at = found.stress_at(x, np.full(7, way * 1e-4 * a))
        traction = found.traction.at(x)
        for k, q in enumerate((traction.q1, traction.q2)):
            assert at[k, 1] == pytest.approx(-traction.p, rel=2e-2, abs=2e-2 * found.p0)
            assert np.abs(np.abs(at[k, 2]) - np.abs(q)).max() < 5e-3 * found.p0
        x, y = np.linspace(-3, 3, 9) * h, np.full(9, way * h)
        assert np.abs(found.stress_at(x, y)[:, 2]).max() < 1e-12 * found.p0
        d = 1e-3 * h
        x, y = np.array([-0.7, 0.1, 0.9]) * h, way * np.array([0.3, 0.5, 0.7]) * h
        east, west, north, south, here = (
            found.stress_at(x + i * d, y + j * d) for i, j in ((1, 0), (-1, 0), (0, 1), (0, -1), (0, 0))
        )
        scale = found.p0 * 2 * d / h
        assert np.abs(east[:, 0] - west[:, 0] + north[:, 2] - south[:, 2]).max() < 1e-4 * scale
        assert np.abs(east[:, 2] - west[:, 2] + north[:, 1] - south[:, 1]).max() < 1e-4 * scale
        mean = sum((each[:, 0] + each[:, 1] for each in (east, west, north, south)), -4 * (here[:, 0] + here[:, 1]))
        assert np.abs(mean).max() < 1e-4 * scale * d / h
        s, w = np.polynomial.legendre.leggauss(40)
        for side in (-6, 6):
            section = found.stress_at(np.full(40, side * h), way * h * (1 + s) / 2)
            pulled = 1 if way < 0 else 0
            Q = np.array([-20e3, 20e3]) * np.sign(side) * -way * 0.5
            assert section[:, 0] @ w / 2 * h == pytest.approx(Q + pulled * np.array([-60e6, 60e6]) * h, abs=1e-4 * 20e3)


def test_what_is_too_thin_is_refused():
    assert contact(strips(30e-6)).a == pytest.approx(layers.pressed(A, R, P, 30e-6)[0], rel=1e-12)
    for h in (20e-6, 1e-9):
        with pytest.raises(InputError, match=r"must be larger, not .* times a, for exact; use fem"):
            contact(strips(h))


def test_extreme_loads():
    """Almost full slip, almost none, and a tension that leaves a point."""
    limit = F * P
    sliding = solved(strips(1e-3, (1 - 1e-6) * limit, 100e6))
    assert 0 < sliding.stick_half_width < 2e-3 * sliding.a
    stuck = solved(strips(1e-3, 1e-6 * limit))
    assert 1 - stuck.stick_half_width / stuck.a == pytest.approx(1e-6 / 2, rel=0.1)
    point = solved(strips(1e-3, sigma=3e10))
    assert point.stick_half_width < 1e-30
    assert np.isfinite(point.slip.dissipated)
    assert np.isfinite(point.traction.at(np.linspace(-1, 1, 21) * point.a).dq).all()


def test_what_far_sides_leave_out_is_told():
    """Nothing of infinite strips; of others the more the nearer the sides are."""
    assert not solved(strips(1e-3)).estimate
    told = [solved(strips(1e-3, width=times * 1e-3)).estimate for times in (6, 8, 12)]
    for key in ("a", "m", "n", "p", "q"):
        near, middle, far = (each[key] for each in told)
        assert 1e-4 > near > 50 * middle > 50 * 1000 * far > 0


@pytest.mark.fault
@pytest.mark.parametrize("fault", ["kernels", pytest.param("held", marks=pytest.mark.slow), "first"])
def test_faults_show(monkeypatch, fault):
    """Faults: M in place of N and the other way round; twice the strain between held sides; no first term."""
    if fault == "kernels":
        rest = layer.Layer._rest.func

        def exchanged(self):
            own = rest(self)
            return {"normal": own["shear"], "shear": own["normal"]}

        monkeypatch.setattr(layer.Layer, "_rest", property(exchanged))
        with pytest.raises(AssertionError):
            test_direct_collocation(0.3e-3, 30e3, -100e6, 0)
        return
    if fault == "held":
        monkeypatch.setattr(layer.Layer, "_share", property(lambda self: sum(self.strips.held) / (2 * self.height)))
        with pytest.raises(AssertionError):
            test_the_gap_closes_and_the_stick_zone_moves_as_one("uneven")
        return
    from partialslip.halfplane import sheared_layers

    real = sheared_layers._solved

    def wrong(pressed, below):
        series, Qf, sf = real(pressed, below)
        return series, Qf, sf + 16 * series[0]

    monkeypatch.setattr(sheared_layers, "_solved", wrong)
    with pytest.raises((AssertionError, InputError)):
        test_direct_collocation(0.3e-3, 30e3, -100e6, 0)
