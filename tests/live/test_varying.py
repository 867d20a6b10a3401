"""The live page where P and its line of action vary: spot values, quadrature, limiting cases, controls.

Contacts and loads are those of f = A = R = 1: p = sqrt(a^2 - (x - e)^2), and an increment dQ slides at pi a^2.
"""

import json
import math
from types import SimpleNamespace

import numpy as np
import pytest
from opening import LARGE, answer, opened
from scipy.integrate import quad

from partialslip.scene.reading import load_scene

PI = math.pi
NARROWER, WIDER = math.sqrt(0.6), math.sqrt(0.8)
SPOTS = [  # a1, e1, a2, e2, dQ, dsigma, m, n
    (0.8, 0, 1, 0, 0.32 * PI, 0.4, 0.757106781187, 0.657106781187),
    (NARROWER, 0, WIDER, 0, 0.2 * PI, 4, 0.568347415657, 0.255337911793),
    (NARROWER, 0.05, WIDER, -0.075, 0.2 * PI, 4, 0.582925483848, 0.237115637453),
]
RATCHET = (0.9, 0.1, 0.9, -0.1, 0.723578495, 11.4177666, 0.3, -0.1)  # settles with a mean in [-0.28585, -0.06344] only
ONE_END = [  # no formula: what the left and the right end do
    (0.8, 0, 1, 0, 0.32 * PI, 0.8, "the left end does not slip, the right end slips"),
    (0.8, 0, 1, 0, 0.1 * PI, 0.35, "the left end does not slip, the right end slips during part of the cycle"),
]
SIGNS = [(1, 1), (1, -1), (-1, 1), (-1, -1)]


def settings(a1, e1, a2, e2, dQ, dsigma, turn=1, mirror=1):
    """Return these loads as the settings of a page, in SI units; ``mirror`` turns the contact round, too."""
    scene = load_scene(LARGE)
    length, stress = 1e-3, scene.friction.f * 400e6  # a = 1 mm and p0 = 400 MPa of the scene
    return {
        **{"varies": True, "P1": a1**2 * scene.P, "P2": a2**2 * scene.P, "turn": turn, "mirror": mirror},
        **{"e1": mirror * e1 * length, "e2": mirror * e2 * length},
        **{"dQ": dQ * stress * length, "dsigma": dsigma * stress},
    }


def solved(page, *loads, **signs):
    """Return the page's solution, lengths in the unit of the loads."""
    found = SimpleNamespace(**page.run(f"page.answer({json.dumps(settings(*loads, **signs))})"))
    found.x, found.half = (found.a / 1e-3 * np.array([point[key] for point in found.points]) for key in ("x", "q"))
    ends = [way * at["a"] + at["e"] for at in found.contacts for way in (-1, 1)]
    found.smooth = np.abs(found.x[:, None] - np.multiply(ends, found.a / 1e-3)).min(axis=1, initial=1) > 1e-9
    if found.m is not None:
        found.m, found.n = found.m * found.a / 1e-3, found.n * found.a / 1e-3
    if found.means:
        found.means = [mean * found.P * PI / 2 / load_scene(LARGE).P for mean in found.means]
    return found


def written(settings):
    """Return settings as a link."""
    turn, mirror = settings.pop("turn"), settings.pop("mirror")
    del settings["varies"]
    loads = {"dQ": turn * settings.pop("dQ"), "dsigma": turn * mirror * settings.pop("dsigma")}
    return "#" + "&".join(f"{key}={value:.12g}" for key, value in (settings | loads).items())


def pressure(x, a, e):
    return np.sqrt(np.maximum(a**2 - (x - e) ** 2, 0))


def quadrature(a1, e1, a2, e2, m, n, s):
    """Return dQ, dsigma and dq(x) of a stick zone by quadrature of the mean pressure."""
    centre, c = (n - m) / 2, (n + m) / 2

    def over(side, of):
        ends = sorted(np.arccosh((side * (e - centre) + a) / c) for a, e in ((a1, e1), (a2, e2)))

        def integrand(theta):
            t = centre + side * c * np.cosh(theta)
            return of(t) * (pressure(t, a1, e1) + pressure(t, a2, e2)) / 2

        return sum(quad(integrand, *part, epsabs=1e-12, epsrel=1e-12)[0] for part in ((0, ends[0]), ends))

    dsigma = 8 / PI * (over(1, np.ones_like) - s * over(-1, np.ones_like))
    dQ = 2 * (over(1, lambda t: t) - s * over(-1, lambda t: t) - centre * PI / 8 * dsigma)

    def dq(x):
        return 2 / PI * math.sqrt((n - x) * (x + m)) * over(1, lambda t: 1 / (t - x)) + 2 / PI * s * math.sqrt(
            (n - x) * (x + m)
        ) * over(-1, lambda t: 1 / (x - t))

    return dQ, dsigma, dq


@pytest.mark.parametrize("spot", SPOTS)
def test_spot_values(page, spot):
    *loads, m, n = spot
    for turn, mirror in SIGNS:
        found = solved(page, *loads, turn=turn, mirror=mirror)
        assert (found.m, found.n)[::mirror] == pytest.approx((m, n), abs=1e-11)
        assert not found.reverses
        assert found.ends[::mirror] == [found.zone["s"], 1]
        dq = 2 * turn * found.half
        assert np.trapezoid(dq, found.x) == pytest.approx(mirror * loads[4], rel=2e-3)  # x descends where mirrored
        x, dq = found.x[found.smooth], dq[found.smooth]
        slips = (x > found.n) | (x < -found.m)
        bound = sum(pressure(x, a, mirror * e) for a, e in (loads[:2], loads[2:4]))
        np.testing.assert_allclose(np.abs(dq[slips]), bound[slips], atol=1e-12)
        assert (np.abs(dq) <= bound + 1e-12).all()


def test_loads_and_tractions_by_quadrature(page):
    """Against the conditions themselves, which take the mean pressure and not the mean of two solutions."""
    for contacts, m, n, s in (
        ((0.8, 0, 1, 0), 0.6, 0.3, -1),
        ((1, 0.1, 0.7, 0.3), 0.1, 0.15, -1),
        ((0.9, -0.2, 0.95, 0.1), 0.8, -0.6, -1),
        ((0.8, 0, 1, 0.1), 0.6, 0.5, 1),
    ):
        dQ, dsigma, dq = quadrature(*contacts, m, n, s)
        found = solved(page, *contacts, abs(dQ), abs(dsigma), turn=1 if dQ > 0 else -1, mirror=1)
        assert (found.m, found.n) == pytest.approx((m, n), abs=1e-10)
        inside = np.flatnonzero((found.x > -m) & (found.x < n))[5:-5:12]
        assert len(inside) >= 4
        assert 2 * found.half[inside] == pytest.approx([dq(x) for x in found.x[inside]], abs=1e-9)


ZONES = """(() => {
  let state = 1;
  const random = () => (state = state * 48271 % 2147483647) / 2147483647, found = [];
  while (found.length < 400) {
    const contacts = [{ a: 0.3 + 0.7 * random(), e: random() - 0.5 }, { a: 1, e: random() - 0.5 }];
    const [low, high] = varying.common(contacts), [one, two] = [random(), random()].map((x) => low + (high - low) * x);
    const c = Math.abs(one - two) / 2 * (found.length % 4 ? 1 : 10 ** (-12 * random())), left = Math.min(one, two);
    const { Qf, sf } = varying.conditions(contacts, left, c);
    if (!(low < high && Qf >= 0 && sf >= 0)) continue;
    const zone = varying.stickZone(contacts, Qf, sf);
    found.push([zone.centre - left - c, Math.log(zone.c / c), zone.s, zone.steps]);
  }
  return found;
})()"""


def test_any_two_contacts(page):
    """Zones of random contacts are found again from their loads."""
    move, growth, s, steps = np.array(page.run(ZONES)).T
    assert np.abs(move).max() < 1e-11
    assert np.abs(growth).max() < 1e-9
    assert (s == -1).all()
    assert steps.max() <= 12


EXTREME = """(() => {
  let state = 7;
  const random = () => (state = state * 48271 % 2147483647) / 2147483647;
  const size = (low, high) => 10 ** (low + (high - low) * random()), way = () => Math.sign(random() - 0.5);
  const found = [];
  for (let i = 0; i < 150; i++) {
    const contacts = [{ a: i % 3 ? random() : size(-6, 0), e: way() * size(-6, 1) }, { a: 1, e: way() * size(-6, 0) }];
    if (i % 4 === 0) contacts[0].e = contacts[1].e;
    if (i % 2) contacts.reverse();
    const Qf = (i % 5 && (i % 3 ? random() : size(-9, 0))) * (contacts[0].a ** 2 + contacts[1].a ** 2) / 2;
    const sf = i % 7 && (i % 2 ? 20 * random() : size(-9, 7));
    const { zone, q, means } = varying.solve(contacts, Qf, sf), start = varying.beginning(contacts, Qf);
    if (zone) varying.reverses(contacts, Qf, sf, zone.s);
    if (!q) continue;
    const over = varying.grid(contacts, zone).map((x) => Math.abs(q(x)) - varying.pressure(contacts, x));
    found.push([...means, start ? start.sf : 0, zone && zone.c < 1e-6 ? 0 : Math.max(...over)]);
  }
  return found;
})()"""


def test_extreme_loads(page):
    """Far lines of action, P nearly to zero, loads of many magnitudes: finite, ordered and within the bound."""
    least, most, _, over = np.array(page.run(EXTREME), float).T  # NaN would be None
    assert len(least) > 60
    assert (least <= most + 1e-9).all()
    assert over.max() < 1e-7


CONSTANT = """(() => {
  const contacts = [{ a: 1, e: 0 }, { a: 1, e: 0 }], found = [];
  for (const Qf of [0, 1e-6, 0.1, 0.3, 0.5, 0.77, 0.98]) for (const sf of [0, 0.01, 0.3, 1, 3, 4.03, 7, 12, 40]) {
    if (Qf + sf === 0) continue;
    const zone = hertz.stickZone(Qf, sf), { zone: other, q, means } = varying.solve(contacts, Qf, sf);
    const bound = hertz.meanLoadBound(zone, Qf, sf), points = hertz.tractions(zone, 8).filter(({ x }) => {
      return zone.c > 1e-3 && Math.abs(Math.abs(x - zone.centre) - zone.c) > 1e-9;  // the slope of q is finite
    });
    const reverses = hertz.reverses(zone, Qf, sf);
    found.push([
      means[0] + bound, means[1] - bound, zone.centre - other.centre, zone.c - other.c, zone.s - other.s,
      hertz.largest(zone) - varying.largest(varying.grid(contacts, other), q),
      Math.max(0, ...points.map((point) => Math.abs(point.q - q(point.x)))),
      reverses - varying.reverses(contacts, Qf, sf, zone.s),
    ]);
  }
  return found;
})()"""


def test_constant_P_is_a_special_case(page):
    off = np.abs(page.run(CONSTANT)).max(axis=0)
    assert off[:2] == pytest.approx(np.zeros(2), abs=3e-5)  # bounds between the load points by 16 stages of a way
    assert off[2:] == pytest.approx(np.zeros(6), abs=1e-9)


def test_without_slip(page):
    """|dQ +- pi a dsigma/4| <= f |dP|: dq = (dQ/dP + pi x/4 dsigma/dP) (p2 - p1)."""
    for turn, mirror in SIGNS:
        found = solved(page, 0.8, 0, 1, 0, 0.1 * PI, 0.3, turn=turn, mirror=mirror)
        assert (found.regime, found.m, found.n) == ("no slip", None, None)
        x = found.x[found.smooth]
        rate = (0.1 * PI + mirror * PI / 4 * x * 0.3) / (PI / 2 * (1 - 0.8**2))
        dq = rate * (pressure(x, 1, 0) - pressure(x, 0.8, 0))
        assert 2 * turn * found.half[found.smooth] == pytest.approx(dq, abs=1e-12)
        most = PI / 2 * 0.8**2  # |Q1| <= f P1
        assert sorted(turn * mean for mean in found.means) == pytest.approx([0.05 * PI - most, 0.05 * PI + most])
    assert solved(page, 0.8, 0, 1, 0, 0.1 * PI, 0.3199).regime == "no slip"
    assert solved(page, 0.8, 0, 1, 0, 0.1 * PI, 0.3201).regime == "no closed form"
    moving = solved(page, 0.8, 0, 1, 0.01, 0.01, 0)
    assert (moving.regime, moving.q, moving.points) == ("no slip", None, [])


def test_mean_loads_that_settle(page):
    """A moment that varies excludes fully reversed Q."""
    found = solved(page, *RATCHET[:6])
    assert found.regime == "ratchets"
    assert (found.m, found.n) == pytest.approx(RATCHET[6:], abs=1e-8)
    assert found.means == pytest.approx([-0.28585, -0.06344], abs=1e-5)
    assert solved(page, *RATCHET[:6], turn=-1).means == pytest.approx([-x for x in found.means[::-1]], abs=1e-12)
    assert solved(page, *RATCHET[:6], mirror=-1).means == pytest.approx(found.means, abs=1e-12)
    along = solved(page, 0.9, 0.1, 0.9, -0.1, 0.7, 8.0)  # slip does not reverse: bounds hold all along the ways
    assert along.means == pytest.approx([-0.392038, 0.063494], abs=3e-5)
    for loads in (RATCHET[:6], *(spot[:6] for spot in SPOTS)):
        forth, back = solved(page, *loads), solved(page, *loads[2:4], *loads[:2], *loads[4:], turn=-1)
        assert forth.means == pytest.approx(back.means, abs=1e-10)  # load points 1 and 2 change names
        assert (forth.m, forth.n) == pytest.approx((back.m, back.n), abs=1e-12)


@pytest.mark.parametrize(("case", "turn", "mirror"), [(ONE_END[0], -1, -1), (ONE_END[1], 1, 1)])
def test_an_end_that_does_not_slip(browser, folder, case, turn, mirror):
    *loads, words = case
    if mirror < 0:
        words = words.replace("left", "LEFT").replace("right", "left").replace("LEFT", "right")
        words = ", ".join(reversed(words.split(", ")))
    page = opened(browser, folder, link=written(settings(*loads, turn=turn, mirror=mirror)))
    assert page.run("document.querySelector('.regime').textContent") == f"no closed form: {words}"
    found = answer(page)
    assert (found.zone, found.q, found.points, found.means) == (None, None, [], None)
    assert "march" in page.run("document.getElementById('note').textContent")


def test_slip_that_reverses_is_noted_and_other_regimes(page):
    """The formula's left end is just inside contact 1, and yet the left end sticks at first."""
    assert solved(page, 0.8, 0, 1, 0, 0.32 * PI, 0.74).reverses
    assert solved(page, *RATCHET[:6]).reverses
    for loads, regime in (
        ((0.5, 0, 1, 0, 0.3 * PI, 0), "sliding"),
        ((0.5, -1, 0.5, 1, 0.1, 0), "no stick zone"),
        ((0.9, 0, 1, 0, 0, 0), "stuck"),
    ):
        assert solved(page, *loads).regime == regime


@pytest.mark.fault
@pytest.mark.parametrize(
    ("true", "fault"),
    [("(of(contacts[0]) + of(contacts[1])) / 2", "of(contacts[1])"), ('sum("sf", 1)', 'sum("sf", 0)')],
    ids=["pressure of load point 2 alone", "contacts in one scale"],
)
def test_the_mean_pressure_is_needed(browser, folder, true, fault):
    def change(text):
        assert text.count(true) == 1
        return text.replace(true, fault)

    page = opened(browser, folder, change=change)
    zones = [(solved(page, *loads), m, n) for *loads, m, n in SPOTS]
    assert max(math.inf if found.m is None else abs(found.m - m) + abs(found.n - n) for found, m, n in zones) > 1e-2


def scene_of(spot, **load):
    loads = settings(*spot[:6])
    changes = {"p0": None, "P": [loads["P1"], loads["P2"]], "e": [loads["e1"], loads["e2"]]}
    cycle = {"Q": [-loads["dQ"] / 2, loads["dQ"] / 2], "sigma": [0, loads["dsigma"]]}
    return load_scene(LARGE).replace(load=changes | cycle | load)


def test_it_starts_with_P_and_e_of_the_scene(browser, folder):
    *_, m, n = SPOTS[2]
    page = opened(browser, folder, scene_of(SPOTS[2]))
    found = answer(page)
    assert found.regime == "large tension"
    assert (found.m * found.a, found.n * found.a) == pytest.approx((m * 1e-3, n * 1e-3), abs=1e-14)
    assert page.run("document.getElementById('varies').checked")
    words = "from load point 1 to 2 the left end slips \u2190, the right end slips \u2192"
    assert page.run("document.querySelector('.regime').textContent") == f"large tension: {words}"
    assert page.run("document.querySelector('#map').getBoundingClientRect().width") == 0
    assert "map is hidden" in page.run("document.querySelector('.answer').innerText")
    assert page.run("['P1', 'P2', 'e1', 'e2'].map((id) => Number(document.getElementById(id).value))") == pytest.approx(
        [0.6 * 628.32, 0.8 * 628.32, 50, -75], abs=5
    )
    assert page.run("document.querySelectorAll('#tractions .pressure-1, #tractions .pressure-2').length") == 2
    assert page.errors == []


def test_P_and_e_by_the_controls(browser, folder):
    page = opened(browser, folder)
    before = answer(page)
    page.run("document.getElementById('varies').click()")
    assert (answer(page).m, answer(page).n) == pytest.approx((before.m, before.n), abs=1e-12)
    for name, value in (("P1", "500"), ("e2", "-0.05")):
        page.run(f"const {name} = document.querySelector('[type=number][data-sets={name}]'); {name}.focus();"
                 f"{name}.select()")  # fmt: skip
        page.send("Input.insertText", text=value)
    loads, after = page.run("page.loads()"), answer(page)
    assert (loads["P1"], loads["e2"]) == (5e5, -5e-5)
    assert after.contacts == [
        {"a": pytest.approx(math.sqrt(5e5 / loads["P2"])), "e": 0},
        {"a": 1, "e": pytest.approx(-0.05)},
    ]
    page.run("document.getElementById('e1').focus()")
    page.press("ArrowRight", times=2)
    assert page.run("page.loads().e1") == pytest.approx(2e-5)
    link = page.run("document.getElementById('link').hash")
    loads, after = page.run("page.loads()"), answer(page)

    page = opened(browser, folder, link=link)
    assert page.run("page.loads()") == pytest.approx(loads, rel=1e-11)
    assert (answer(page).m, answer(page).n) == pytest.approx((after.m, after.n), rel=1e-9)
    page.run("document.getElementById('varies').click()")
    assert page.run("page.loads().e1") == 0
    assert (answer(page).m, answer(page).n, answer(page).P) == pytest.approx((before.m, before.n, before.P))
    assert page.run("document.querySelector('#map').getBoundingClientRect().width") > 280


@pytest.mark.parametrize(("width", "mobile"), [(320, True), (1000, False)])
def test_it_fits_the_window(browser, folder, width, mobile):
    page = opened(browser, folder, scene_of(SPOTS[2]), width=width, height=900, mobile=mobile)
    shown = page.run("document.documentElement.clientWidth")
    assert page.run("document.documentElement.scrollWidth") == shown >= width - 20
    beyond = "[...document.querySelectorAll('td, th, input')].filter((e) => e.getBoundingClientRect().right > {} + 1)"
    assert page.run(f"{beyond.format(shown)}.length") == 0
