"""q1 and q2 under mean loads: Mindlin and Deresiewicz's rule, against a small boundary-element march."""

import numpy as np
import pytest
from boundary_elements import march
from plain import plain

import partialslip
from partialslip import halfplane
from partialslip.halfplane.contact import Contact
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.levels import levels
from partialslip.halfplane.proportional import loading
from partialslip.halfplane.punch import Punch
from partialslip.scene import Load

P = np.pi / 2  # of a contact with a = p0 = 1


def scene(**load):
    """Of Mindlin and Deresiewicz: 0.3 and 0.8 f P."""
    load = {"a": 1e-3, "Q": [181245.73001, 483321.94669]} | load
    return plain(load, 0.4, (70e9, 0.3), {"kind": "hertz", "R": 0.02})


def exact(its, **options):
    return halfplane.solve(its, partialslip.plan(its), **options)


def ellipse(x, centre, half_width):
    return np.sqrt(np.maximum(half_width**2 - (x - centre) ** 2, 0.0))


def of(Q, sigma, shape=None):
    """Levels of a contact with a = p0 = f = 1; Q in f P, sigma in f p0."""
    pressed = Contact(1.0, P, shape or HertzShape())
    load = Load(P=P, Q=tuple(P * each for each in Q), sigma=sigma)
    return levels(pressed, 1.0, load, loading(pressed, 1.0, load.dQ, load.dsigma, bound=2))


def test_mindlin_deresiewicz():
    """The reference case: q2 is the traction of the first loading, q1 the traction after the reversal."""
    result = exact(scene())
    x = np.linspace(-1.2, 1.2, 501)
    q1, q2 = (q / (0.4 * result.p0) for q in result.traction.at(x * result.a).levels)
    p = ellipse(x, 0, 1)
    assert q2 == pytest.approx(p - ellipse(x, 0, np.sqrt(0.2)), abs=1e-8)
    assert q1 == pytest.approx(-p + 2 * ellipse(x, 0, np.sqrt(0.75)) - ellipse(x, 0, np.sqrt(0.2)), abs=1e-8)
    assert not result.undetermined
    assert result.notes == ()


def test_kinks_of_the_first_loading_are_breaks_and_points():
    result = exact(scene())
    kinks = np.sqrt(0.2) * np.array([-1, 1])
    for places in (result.traction.breaks, result.traction.x):
        assert np.abs(places[:, None] / result.a - kinks).min(axis=0) == pytest.approx(0, abs=1e-8)
    at = result.traction.at(result.traction.x).levels
    np.testing.assert_array_equal(at, [result.traction.q1, result.traction.q2])


def test_tension_moves_the_ellipse_that_the_first_loading_locks_in():
    """Half-width a sqrt(1 - |Q|/(f P)), centre -sign(Q) A R sigma/(4 f) (scaled: sigma/4)."""
    for Q, sigma in ((0.8, 0.3), (-0.8, 0.3), (0.8, -0.3), (-0.8, -0.3)):
        found = of((Q / 3, Q), (sigma / 2, sigma))
        x = np.linspace(-1, 1, 101)
        corrective = ellipse(x, -np.sign(Q) * sigma / 4, np.sqrt(1 - abs(Q)))
        assert found.at(x)[1] == pytest.approx(np.sign(Q) * (ellipse(x, 0, 1) - corrective), abs=1e-12)


@pytest.mark.parametrize(
    ("Q", "sigma", "shape"),
    [
        ((0.3, 0.8), (0.0, 0.0), HertzShape()),
        ((0.8, 0.3), (0.0, 0.0), HertzShape()),  # the point visited first slips less
        ((0.8, -0.3), (0.0, 0.0), Punch(0.4)),
        ((0.745, 0.216), (0.79, -0.005), HertzShape()),
        ((0.898, -0.441), (-0.577, -0.186), Punch(0.6)),
        ((0.0, -0.826), (-0.795, -0.795), HertzShape()),
        ((-0.06, -0.34), (-0.05, -3.7), HertzShape()),  # large tension
        ((0.299, 0.118), (-0.84, -0.162), HertzShape()),
        ((0.3, 0.3), (0.2, 0.2), HertzShape()),  # a cycle of nothing
    ],
)
def test_boundary_elements_agree(Q, sigma, shape):
    """Relative L2, in p, of q at both load points after the first visits: cells leave up to 1e-2."""
    load_points = list(zip(Q, sigma, strict=True))
    x, widths, p, (_, one, two) = march(shape, [load_points[1], *load_points])
    for mine, its in zip(of(Q, sigma, shape).at(x), (one, two), strict=True):
        assert np.sqrt((mine - its) ** 2 @ widths / (p**2 @ widths)) < 1.3e-2


@pytest.mark.fault
def test_the_first_loading_of_the_wrong_load_point_is_caught():
    """q2 by the first loading of load point 1, which slips less, and the change."""
    pressed, path = Contact(1.0, P, HertzShape()), [(0.8, 0.0), (0.3, 0.0), (0.8, 0.0)]
    x, widths, p, (_, _, two) = march(HertzShape(), path)
    first, cycle = (loading(pressed, 1.0, Q * P, 0.0, bound=bound) for Q, bound in ((0.3, 1), (0.5, 2)))
    wrong = first.traction(x) + cycle.traction(x)
    assert np.sqrt((wrong - two) ** 2 @ widths / (p**2 @ widths)) > 5e-2


def test_symmetries():
    """Reversing q reverses both loads; mirroring x reverses Q and keeps sigma."""
    x = np.linspace(-1, 1, 41)
    base = of((0.2, 0.7), (0.1, 0.4)).at(x)
    turned = of((-0.2, -0.7), (-0.1, -0.4)).at(x)
    mirrored = of((-0.2, -0.7), (0.1, 0.4)).at(-x)
    for its in (turned, mirrored):
        np.testing.assert_allclose(its, -np.array(base), atol=1e-12)


@pytest.mark.parametrize(
    ("Q", "sigma", "reason"),
    [
        ((0.1, -0.4), (-0.95, -1.2), "the cycle slips where the first loading sticks"),
        ((-0.909, -0.337), (0.67, 0.81), "path-dependent"),
    ],
)
def test_where_there_is_no_closed_form_the_reason_says_so(Q, sigma, reason):
    assert reason in of(Q, sigma)


def test_results_say_why_there_are_no_levels():
    base = scene()
    unit, stress = 0.4 * base.P, 0.4 * exact(base).p0
    result = exact(scene(Q=[0.1 * unit, -0.4 * unit], sigma=[-0.95 * stress, -1.2 * stress]))
    assert result.traction.q1 is result.traction.q2 is result.traction.at(0.0).levels is None
    assert set(result.undetermined) == {"q1", "q2"}
    assert result.undetermined["q1"] in result.notes[0]


def test_load_points_in_between():
    """The path may begin at a load point between the extremes."""
    x = np.linspace(-1, 1, 41)
    direct, detour = of((-0.3, 0.8), (0.0, 0.0)), of((-0.3, 0.8, 0.2), (0.0, 0.0, 0.0))
    np.testing.assert_allclose(detour.at(x), direct.at(x), atol=1e-12)


@pytest.mark.parametrize(
    ("Q", "sigma"), [(1.5e-11, (0.0423775937, 0.0423775936535)), (1e-10, (-0.0283544788136, -0.0283544784257))]
)
def test_tractions_are_within_the_bound_in_the_narrowest_slip_zones(Q, sigma):
    """The cycle slips 1e-11 of the contact, the other way than the first loading there. Without the bound, one of q1
    and q2 would be three times f p."""
    found = of((Q, -Q), sigma)
    ends = np.array(found.cycle.ends)
    x = np.array([*ends, *((ends + np.sign(ends)) / 2)])
    p = np.sqrt((1 - x) * (1 + x))
    assert (np.abs(found.unbounded(x)).max(axis=0) > 2.9 * p).any()
    for level, sign in zip(found.at(x), np.sign(found.cycle.traction(x)) * [[-1], [1]], strict=True):
        assert level == pytest.approx(sign * p, rel=1e-12)
