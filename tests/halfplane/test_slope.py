"""Bulk tension that varies along x: sigma + sigma_slope x."""

import math

import boundary_elements
import mpmath
import numpy as np
import pytest
from digits import pressure
from plain import plain as made

import partialslip
from partialslip import halfplane
from partialslip.halfplane import steady
from partialslip.halfplane.contact import Contact
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.loading import one_step
from partialslip.halfplane.proportional import loading
from partialslip.halfplane.punch import Punch
from partialslip.halfplane.shape import Conditions
from partialslip.halfplane.slip import density, slip
from partialslip.halfplane.steady import steady_stick_zone, stick_zones
from partialslip.halfplane.traction import half_range
from partialslip.run import default_methods
from partialslip.tools.errors import InputError

P = math.pi / 2  # of a contact with a = p0 = 1
UNIT = Contact(1.0, P, HertzShape())
LOADS = [(0.3, 0.5, 1.2), (0.3, 4, 1.2), (0.3, 4, -1.2), (-0.2, 0.6, 3), (-0.2, 5, 3), (0.5, 1, -2), (0, 0, 2)]
PLAIN = [(0.3, 4.0), (0.4, 4.03), (0.3, 8.0), (0.471569, 8.888889)]  # large tension


def random_loads(count, seed, largest=8.0):
    """Qf, sf and gf, (count,) each, in the ranges of stick_zones."""
    random = np.random.default_rng(seed)
    gf = random.uniform(-6, largest, count)
    Qf = random.uniform(np.maximum(-gf / 8, -0.9), 0.95)
    return Qf, random.exponential(3.0, count), gf


# --- stick zones


def test_small_tension_of_hertz_is_that_of_another_curvature():
    """c^2 = (1 - Qf)/(1 + gf/8) and e = -sf/(8 + gf)."""
    Qf, sf, gf = random_loads(2000, 1)
    zones = stick_zones(Qf, sf, HertzShape(), gf)
    c, e = np.sqrt((1 - Qf) / (1 + gf / 8)), -sf / (8 + gf)
    small = (c - e < 1) & ((1 + gf / 8) * (1 - Qf) < 3)
    assert small.sum() > 500
    assert zones.half_width[small] == pytest.approx(c[small], rel=1e-12)
    assert zones.centre[small] == pytest.approx(e[small], rel=0, abs=1e-12)
    assert (zones.s[small] == 1).all()


@pytest.mark.parametrize(("shape", "count"), [(HertzShape(), 16), (Punch(0.5), 6)])
def test_the_conditions_hold_in_30_digits(shape, count):
    """The two consistency conditions of docs/theory.md by quadrature, with t = e +- c cosh(theta)."""
    Qf, sf, gf = random_loads(count, 2, largest=4.0)
    zones = stick_zones(Qf, sf, shape, gf)
    known = np.isfinite(zones.half_width)
    assert known.mean() > 0.6
    assert len(set(zones.s[known].tolist())) == 2
    p = pressure(shape.flats[0] if isinstance(shape, Punch) else 0)
    with mpmath.workdps(30):
        for Q, S, G, e, c, s in np.transpose([Qf, sf, gf, *zones])[known].tolist():
            e, c = mpmath.mpf(e), mpmath.mpf(c)
            sums = [mpmath.mpf(0)] * 2
            for side, sign in ((1, 1), (-1, -int(s))):
                end = mpmath.acosh((1 - side * e) / c)
                inner = [mpmath.acosh((side * kink - side * e) / c) for kink in shape.kinks if side * (kink - e) > c]
                points = sorted([0, *(at for at in inner if at < end), end])
                for power in (0, 1):

                    def integrand(y, e=e, c=c, side=side, power=power):
                        arm = side * c * mpmath.cosh(y)
                        return p(e + arm) * arm**power

                    sums[power] += sign * mpmath.quad(integrand, points)
            assert abs(sums[0] - mpmath.pi / 8 * (S + G * e)) < 1e-10 * max(S, 1)
            assert abs(sums[1] - mpmath.pi / 2 * Q - mpmath.pi / 16 * G * c**2) < 1e-10


@pytest.mark.parametrize("shape", [HertzShape(), Punch(0.5)])
@pytest.mark.parametrize("sloped", [True, False])
def test_bracketing_finds_the_same(shape, sloped):
    Qf, sf, gf = random_loads(50, 3)
    Qf, gf = (Qf, gf) if sloped else (np.abs(Qf), 0 * gf)
    with np.errstate(divide="ignore", invalid="ignore"):
        (edge, c), (other_edge, other_c) = (
            way(Qf, sf, shape, gf) for way in (steady._edge_and_centre, steady._bracketed)
        )
    known = np.isfinite(c)
    assert known.sum() > 20
    assert min((edge > 0).sum(), (edge < 0).sum()) > 5  # small and large tension
    assert (np.sign(edge) == np.sign(other_edge))[known].all()
    assert edge[known] == pytest.approx(other_edge[known], rel=0, abs=1e-11)
    assert c[known] == pytest.approx(other_c[known], rel=1e-11)


def test_without_a_slope_nothing_changes_bit_for_bit():
    random = np.random.default_rng(4)
    Qf, sf = random.random(300), 12 * random.random(300)
    gf = np.where(random.random(300) < 0.5, 0.0, 0.1)
    plain, mixed = stick_zones(Qf, sf, HertzShape()), stick_zones(Qf, sf, HertzShape(), gf)
    for one, other in zip(plain, mixed, strict=True):
        assert (one == other)[gf == 0].all()
    assert (plain.half_width != mixed.half_width)[gf != 0].all()
    dQ, dsigma = 2 * P * (2 * Qf - 1), sf * np.sign(random.random(300) - 0.5)
    one, other = (halfplane.one_step_zone(UNIT, 1.0, dQ, dsigma, *slope) for slope in ((), (0 * dQ,)))
    assert all((a == b).all() for a, b in zip(one, other, strict=True))


def test_mirroring_and_turning():
    """Mirrored, dQ and dslope change sign; turned, all loads do."""
    random = np.random.default_rng(6)
    dQ, dsigma = 2 * P * random.uniform(-0.6, 0.6, 200), random.normal(0, 4, 200)
    dslope = 2 * random.normal(0, 1, 200)
    for shape in (HertzShape(), Punch(0.5)):
        pressed = Contact(1.0, P, shape, centre=0.3)
        mirrored = Contact(1.0, P, shape, centre=-0.3)
        one = halfplane.stick_zone(pressed, 1.0, dQ, dsigma, dslope)
        turned = halfplane.stick_zone(pressed, 1.0, -dQ, -dsigma, -dslope)
        other = halfplane.stick_zone(mirrored, 1.0, -dQ, dsigma, -dslope)
        known = np.isfinite(one.half_width)
        assert known.sum() > 150
        for each, sign in ((turned, 1), (other, -1)):
            assert each.half_width[known] == pytest.approx(one.half_width[known], rel=1e-11)
            assert each.centre[known] == pytest.approx(sign * one.centre[known], abs=1e-11)
            assert (each.s == one.s).all()


def test_the_slope_counts_from_the_origin_of_the_scene():
    """A contact beside the middle sees the tension of its place."""
    beside = Contact(1.0, P, HertzShape(), centre=2.0)
    one, other = halfplane.stick_zone(beside, 1.0, 0.4, 0.3, 0.5), halfplane.stick_zone(UNIT, 1.0, 0.4, 1.3, 0.5)
    assert one.centre - 2.0 == pytest.approx(other.centre, abs=1e-14)
    assert one.half_width == other.half_width


def test_points_inside_that_would_slip_first_are_refused():
    """Hertz without tension and shear: in the middle |dq| reaches 2 f p at 1 + gf/8 = 4."""
    held = halfplane.stick_zone(UNIT, 1.0, 0.0, 0.0, np.array([23.999, 24.001]))
    assert np.isfinite(held.half_width).tolist() == [True, False]
    assert held.slides.tolist() == [False, False]
    with pytest.raises(InputError, match=r"^dslope = 30.0: exact does not hold: the tension varies so much along x"):
        halfplane.stick_zone(UNIT, 1.0, 0.0, 0.0, 30.0)
    _, _, p, (q,) = boundary_elements.march(HertzShape(), [(0.0, 0.0, 15.0)], steps=1)
    assert q[len(q) // 2] == -p[len(q) // 2]


# --- tractions and slip


@pytest.mark.parametrize("shape", [HertzShape(), Punch(0.5)])
@pytest.mark.parametrize(("Qf", "sf", "gf"), LOADS)
def test_tractions_are_those_of_boundary_elements(shape, Qf, sf, gf):
    """From nothing, under the bound f p: Qf = Q/(f P), sf = 2 sigma/(f p0)."""
    x, widths, _, (q,) = boundary_elements.march(shape, [(Qf, sf / 2, gf / 2)], count=160, steps=1)
    h = half_range(x, steady_stick_zone(Qf, sf, shape, gf), shape, gf)
    assert np.sqrt(((h - q) ** 2 @ widths) / (q**2 @ widths)) < 8e-3


@pytest.mark.parametrize(("Qf", "sf", "gf"), LOADS)
def test_slip_is_the_integral_of_its_density(Qf, sf, gf):
    zone, shape, step = steady_stick_zone(Qf, sf, Punch(0.5), gf), Punch(0.5), 1e-5
    x = np.concatenate([np.linspace(-1, zone.left, 9)[1:-1], np.linspace(zone.right, 1, 9)[1:-1]])
    slopes = (slip(x + step, zone, shape, gf) - slip(x - step, zone, shape, gf)) / (2 * step)
    assert density(x, zone, shape, gf) == pytest.approx(slopes, abs=1e-5)


@pytest.mark.parametrize(("Qf", "sf", "gf", "shape"), [
    *((*loads, HertzShape()) for loads in (*LOADS, (-0.5, 0.3, 6.0))),
    *((*loads, 0, shape) for shape in (HertzShape(), Punch(0.6)) for loads in PLAIN),
])  # fmt: skip
def test_the_bound_of_mean_loads_is_the_room_of_the_stick_zone(Qf, sf, gf, shape):
    """All along the way, not only at the load points; or at these alone where slip reverses."""
    cycle = one_step(Qf, sf, shape, gf)
    angle = (np.arange(4000) + 0.5) / 4000 * np.pi
    x = cycle.zone.centre + cycle.zone.half_width * np.cos(angle)
    q = half_range(x, cycle.zone, shape, gf)
    taken = at_ends = np.abs(q)
    for share in np.arange(1, 100) / 100 if not cycle.turns_round else ():
        so_far = half_range(x, steady_stick_zone(share * Qf, share * sf, shape, share * gf), shape, share * gf)
        taken = np.maximum(taken, np.abs(2 * so_far - q))
    room, loose = (
        2 / np.pi * cycle.zone.half_width * ((shape.pressure(x) - each) @ np.sin(angle)) * np.pi / 4000
        for each in (taken, at_ends)
    )
    assert cycle.mean_load_bound == pytest.approx(room, abs=1e-5)
    assert cycle.mean_load_bound < loose - 1e-4 or cycle.turns_round or gf


@pytest.mark.fault
def test_a_slope_of_the_wrong_sign_is_seen(monkeypatch):
    """A deliberate fault: the slope's part of the conditions with the other sign."""
    true = Conditions.sloped
    monkeypatch.setattr(Conditions, "sloped", lambda self, gf, *rest: true(self, -gf, *rest))
    x, widths, _, (q,) = boundary_elements.march(HertzShape(), [(0.3, 2.0, 0.6)], count=160, steps=1)
    h = half_range(x, steady_stick_zone(0.3, 4.0, HertzShape(), 1.2), HertzShape(), 1.2)
    assert np.sqrt(((h - q) ** 2 @ widths) / (q**2 @ widths)) > 0.03


def test_where_slip_does_not_reverse_steps_do_not_matter():
    """Of loads that turn round, and only of those, many steps give another q than one."""
    plain, sloped = (
        ((0.3, 4, 0, False), (0.75, 4.5, 0, True)),
        ((0.3, 4, 1.2, False), (-0.4, 2, 6, False), (0, 0, 22, True)),
    )
    for Qf, sf, gf, turns in (*plain, *sloped):
        assert loading(UNIT, 1.0, 2 * P * Qf, sf, gf, bound=2).turns_round == turns
        cycle = [(Qf, sf / 2, gf / 2), (-Qf, -sf / 2, -gf / 2), (Qf, sf / 2, gf / 2)]
        one, many = (boundary_elements.march(HertzShape(), cycle, 160, steps)[3] for steps in (1, 24))
        apart = np.abs((one[2] - one[1]) - (many[2] - many[1])).max()
        assert (apart > 1e-3) == turns
        assert gf or turns or apart < 1e-9


# --- scenes


def scene(Q, sigma, slope, profile=None, P=None, **load):
    """A scene with loads in f P, f p0 and f p0/a."""
    profile = profile or {"kind": "hertz", "R": 0.01}
    plain = made({"P": P or 1.27e5, **load}, material=(72e9, 0.33), profile=profile)
    pressed = halfplane.contact(plain)
    unit = 0.3 * pressed.p0
    loads = {"Q": 0.3 * pressed.P * np.array(Q), "sigma": unit * np.array(sigma)}
    return plain.replace(load={**loads, "sigma_slope": unit / pressed.a * np.array(slope)}, fem={"accuracy": 1e-3})


FLAT = {"kind": "flat-rounded", "R": 0.01, "b": 1e-3}
X = np.linspace(-3e-3, 3e-3, 61)
UNEVEN = {"kind": "tabulated", "x": X, "gap": np.where(X < 0, X**2 / 0.01, X**2 / 0.03)}
SCENES = {
    "small tension": scene([-0.4, 0.4], [-0.2, 0.2], [-0.5, 0.5]),
    "large tension": scene([-0.3, 0.3], [-2, 2], [0.6, -0.6]),
    "slope alone": scene([0, 0], [0, 0], [-1, 1]),
    "beside the middle": scene([-0.4, 0.4], [-1.5, 1.5], [-0.5, 0.5], e=1e-4),
    "mean loads": scene([0.1, 0.6], [0.2, 0.5], [0.1, 0.9]),
    "flat": scene([-0.4, 0.4], [-1, 1], [-0.5, 0.5], FLAT, 2e6),
    "hollow flat, turned": scene([-0.3, 0.3], [2, -2], [-0.5, 0.5], {**FLAT, "crown": -0.5}, 2e6, M=150.0),
    "uneven": scene([-0.2, 0.2], [2, -2], [-0.8, 0.8], UNEVEN, 4e6),
    "varying moment": scene([-0.4, 0.4], [-0.3, 0.3], [-0.5, 0.5], e=[-2e-5, 3e-5]),
    "varying pressure": scene([-0.1, 0.5], [-0.1, 0.3], [-0.1, 0.4], P=[1e5, 1.27e5]),
}


@pytest.mark.parametrize("name", SCENES)
def test_exact_and_march_agree(name):
    found = partialslip.run(SCENES[name], ["exact", "march"])
    assert found.passed, found.missed
    assert not found["exact"].path_dependent


@pytest.mark.parametrize("name", ["small tension", "beside the middle", "hollow flat, turned"])
def test_exact_and_finite_elements_agree(name):
    """Stresses along the surfaces, too."""
    found = partialslip.run(SCENES[name], ["exact", "fem"], subsurface=True)
    assert found.passed, found.missed
    x = np.mean(found["exact"].contact_ends or 0.0) + found["exact"].a * np.array([-3.0, -1.7, 0.1, 1.5, 2.6])
    if found["exact"].surface:
        unit = 0.3 * found["exact"].p0
        assert found["fem"].surface.at(x) == pytest.approx(found["exact"].surface.at(x), abs=3e-3 * unit)


def test_a_slope_calls_for_tension():
    effects = partialslip.plan(SCENES["slope alone"])
    assert effects.needs("tension")
    assert "sigma_slope" in effects.called_for["tension"]
    off = SCENES["slope alone"].replace(effects={"tension": False, "shear": False})
    assert partialslip.run(off, "march")["march"].regime == "stuck"


def test_phase_counts_the_slope():
    load = SCENES["small tension"].load
    assert load.fully_reversed
    assert load.in_phase
    changed = SCENES["small tension"].replace(load={"sigma_slope": [0.0, 1e9]}).load
    assert not changed.fully_reversed
    assert changed.in_phase
    three = {"Q": [-1e3, 0, 1e3], "sigma": [0, 0, 0], "sigma_slope": [0, 1e9, 0]}
    assert not SCENES["small tension"].replace(load=three).load.in_phase


def test_slopes_that_are_not_solved_are_refused():
    with pytest.raises(InputError, match=r"^load.sigma_slope: exact does not hold: the tension varies so much along x"):
        partialslip.run(scene([0, 0], [0, 0], [-14, 14]), "exact")
    with pytest.raises(InputError, match="must be 0 or left out with finite bodies"):
        SCENES["small tension"].replace(bodies={"upper": {"width": 0.01, "height": 0.01}})
    with pytest.raises(InputError, match=r"load.sigma_slope: must have as many numbers as load.Q, 2, not 3"):
        SCENES["small tension"].replace(load={"sigma_slope": [1e9, 2e9, 3e9]})
    steep = scene([0, 0], [0, 0], [-14, 14])
    assert default_methods(steep) == ("march", "fem")
