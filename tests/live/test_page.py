"""The live page in a browser: mechanics compared with Python, controls moved by mouse and keyboard."""

import json

import numpy as np
import pytest
from msgspec.structs import replace
from opening import LARGE, answer, opened

import partialslip
from partialslip import halfplane
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.loading import one_step
from partialslip.halfplane.steady import steady_stick_zone, stick_zones, transition
from partialslip.halfplane.traction import half_range
from partialslip.scene.reading import load_scene
from partialslip.scene.units import engineering

SIGNS = [
    (["load.Q=[-1e5, 1e5]", "load.sigma=[-3e8, 3e8]"], "large tension"),
    (["load.Q=[1e5, -1e5]", "load.sigma=[-3e8, 3e8]"], "large tension"),
    (["load.Q=[-1e5, 1e5]", "load.sigma=[2e7, -2e7]"], "small tension"),
    (["load.Q=[1e5, -1e5]", "load.sigma=[2e7, -2e7]"], "small tension"),
    (["load.Q=[0, 0]", "load.sigma=[4e8, -4e8]"], "large tension"),
    (["load.Q=[0, 0]", "load.sigma=[0, 0]"], "stuck"),
    (["load.Q=[-4e5, 4e5]", "load.sigma=[0, 0]"], "sliding"),
    (["load.Q=[0, 2.4e5]", "load.sigma=[0, 8e8]"], "large tension"),
    (["load.Q=[5e4, 3.01e5]", "load.sigma=[0, 8.06e8]"], "ratchets"),
    (["load.Q=[2.8e5, 3.2e5]", "load.sigma=[0, 0]"], "sliding"),
]


def zones(page, Qf, sf):
    """Return centres, half-widths, s and steps of stick zones from the page."""
    pairs = json.dumps(np.column_stack([Qf, sf]).tolist())
    found = page.run(
        f"{pairs}.map(([Qf, sf]) => {{ const z = hertz.stickZone(Qf, sf); return [z.centre, z.c, z.s, z.steps]; }})"
    )
    return np.array(found).T


def all_loads():
    """Return a grid and hard cases: near the transition, near sliding, near zero loads, and tiny stick zones."""
    Qf, sf = (values.ravel() for values in np.meshgrid(np.linspace(0, 0.98, 50), np.linspace(0, 20, 81)))
    near = np.concatenate([1 - np.logspace(-1, -8, 15), np.logspace(-8, -1, 15)])
    some = np.linspace(0.02, 0.98, 17)
    off = np.concatenate([way * np.logspace(-15, -1, 15) for way in (-1, 1)])
    parts = [
        (Qf, sf),
        np.meshgrid(near, [0, 1e-9, 1e-3, 0.5, 3, 7.9, 8.1, 12, 50]),
        (some[:, None], transition(some, HertzShape())[:, None] * (1 + off)),
        np.meshgrid([0, 1e-6, 0.1, 0.5, 0.9, 0.99], np.logspace(1.5, 5, 15)),
        (0.5, [1e5, 1e6, 1e9]),
    ]
    pairs = (np.broadcast_arrays(*(np.asarray(part, float) for part in pair)) for pair in parts)
    return np.concatenate([np.column_stack([Qf.ravel(), sf.ravel()]) for Qf, sf in pairs]).T


def worst(page, Qf, sf):
    """Return the largest error of m and n, as a fraction of a."""
    centre, half_width, _, _ = zones(page, Qf, sf)
    true_centre, true_half_width, _ = stick_zones(Qf, sf, HertzShape())
    return max(np.abs(half_width + way * centre - true_half_width - way * true_centre).max() for way in (-1, 1))


def test_stick_zones(page):
    Qf, sf = all_loads()
    assert len(Qf) > 4800
    assert worst(page, Qf, sf) < 1e-9
    _, half_width, s, steps = zones(page, Qf, sf)
    _, true, true_s = stick_zones(Qf, sf, HertzShape())
    conditioned = Qf < 1 - 1e-5  # beyond, the rounding of Qf affects c
    np.testing.assert_allclose(half_width[conditioned], true[conditioned], rtol=1e-9)
    assert true.min() == 1e-100
    clear = np.abs(sf - transition(Qf, HertzShape())) > 1e-12
    np.testing.assert_array_equal(s[clear], true_s[clear])
    assert steps.max() <= 20  # Newton always converges


@pytest.mark.parametrize(
    ("true", "fault"),
    [
        ("4 * fromLeft * K - 8 * centre * X", "4 * fromLeft * K + 8 * centre * X"),
        ("elliptic(k, 2 / (2 - edge), 0, 1)", "elliptic(k, 1, 0, 1)"),
        ("k = 2 * Math.sqrt(c / square)", "k = 4 * c / square"),  # modulus and parameter
        ("let c = Math.sqrt(1 - Qf)", "let c = 1 - Qf"),
    ],
)
def test_a_wrong_formula_shows(browser, folder, true, fault):
    def change(text):
        assert text.count(true) == 1
        return text.replace(true, fault)

    page = opened(browser, folder, change=change)
    assert worst(page, *all_loads()[:, 5:3000:37]) > 1e-3


@pytest.mark.parametrize(
    "loads", [(0.19, 0.4), (0.75, 2.4), (0.3, 4.0), (0.4, 4.03), (0.3, 8.0), (0.9, 9.0), (0.0, 3.0)]
)
def test_tractions(page, loads):
    zone = steady_stick_zone(*loads, HertzShape())
    scripts = "hertz.tractions(hertz.stickZone({0}, {1}))", "hertz.meanLoadBound(hertz.stickZone({0}, {1}), {0}, {1})"
    points, bound = (page.run(script.format(*loads)) for script in scripts)
    x, p, q = (np.array([point[key] for point in points]) for key in ("x", "p", "q"))
    assert (np.diff(x) >= -1e-15).all()
    np.testing.assert_allclose((x[0], x[-1]), (-1, 1), rtol=0, atol=1e-15)
    np.testing.assert_allclose(p, HertzShape().pressure(x), rtol=0, atol=1e-12)
    ends = zone.centre + zone.half_width * np.array([-1, 1])
    inside = np.abs(x[:, None] - ends).min(axis=1) > 1e-9  # q has its steepest slope at the ends
    np.testing.assert_allclose(q[inside], half_range(x[inside], zone, HertzShape()), rtol=0, atol=1e-9)
    assert bound == pytest.approx(one_step(*loads, HertzShape()).mean_load_bound, abs=1e-9)
    peak = np.abs(half_range(np.union1d(x[inside], [0.0, *np.clip(ends, -1, 1)]), zone, HertzShape())).max()
    assert page.run("hertz.largest(hertz.stickZone({}, {}))".format(*loads)) == pytest.approx(peak, abs=1e-9)
    assert page.run(f"hertz.transition({loads[0]})") == pytest.approx(
        float(transition(loads[0], HertzShape())), abs=1e-12
    )


@pytest.mark.parametrize(("overrides", "regime"), SIGNS, ids=[f"{' '.join(loads)}" for loads, _ in SIGNS])
def test_it_starts_with_the_loads_of_the_scene(browser, folder, overrides, regime):
    scene = load_scene(LARGE, overrides)
    page = opened(browser, folder, scene)
    exact, found = partialslip.run(scene, ["exact"]).results["exact"], answer(page)
    assert found.regime == exact.regime == regime
    assert page.run("document.getElementById('regime').textContent") == f"{regime}:"
    shown = page.run("[...document.querySelectorAll('[data-sets=dQ], [data-sets=dsigma]')].map((i) => i.valueAsNumber)")
    assert shown == pytest.approx([scene.load.dQ / 1e3, scene.load.dsigma / 1e6], rel=1e-4)
    assert bool(page.run("document.getElementById('note').textContent")) == any(
        "gradual" in note for note in exact.notes
    )
    if exact.m is None:
        assert found.m is found.n is found.q is None
        return
    assert (found.m, found.n) == pytest.approx((exact.m / exact.a, exact.n / exact.a), abs=1e-9)
    limit = scene.friction.f * exact.p0
    assert found.q * limit == pytest.approx(np.abs(exact.traction.dq).max() / 2, abs=1e-9 * limit)
    if regime != "stuck":
        assert found.means[1] * scene.friction.f * scene.P == pytest.approx(exact.limits["Q_mean"], rel=1e-9)
        near_ends = exact.traction.at(np.array([-1, 1]) * exact.a * (1 - 1e-3)).dq
        assert [np.sign(height) for height in drawn_ends(page)] == np.sign(near_ends).tolist()


def drawn_ends(page):
    """Return q as drawn, in pixels above the axis, next to the ends of the contact."""
    path = "document.querySelector('#tractions .{}').getAttribute('d')"
    points, zero = (
        [[float(at) for at in point.split()] for point in page.run(path.format(of)).strip("M").split("L")]
        for of in ("shear", "zero")
    )
    points.sort()
    return [zero[0][1] - points[next_to][1] for next_to in (1, -2)]


def pressed_by(P, scene):
    """Return the contact of the scene under another normal force."""
    return halfplane.contact(replace(scene, load=replace(scene.load, P=P, a=None, p0=None)))


def python_zone(page, scene):
    """Return m and n by Python for the loads shown on the page, in SI units."""
    loads = page.run("page.loads()")
    pressed = pressed_by(loads["P"], scene)
    signs = loads["turn"], loads["turn"] * loads["mirror"]
    found = halfplane.stick_zone(pressed, loads["f"], signs[0] * loads["dQ"], signs[1] * loads["dsigma"])
    return float(found.m) / pressed.a, float(found.n) / pressed.a


@pytest.mark.parametrize("key", ["ArrowRight", "ArrowLeft"])
@pytest.mark.parametrize("control", ["Qf", "sf", "f"])
def test_sliders_by_keyboard(page, control, key):
    scene, before = load_scene(LARGE), answer(page)
    loads = page.run("page.loads()")
    page.run(f"document.getElementById('{control}').focus()")
    page.press(key, times=7)
    after = answer(page)
    way = 1 if key == "ArrowRight" else -1
    step = 0.01 if control == "sf" else 0.001
    assert getattr(after, control) == pytest.approx(getattr(before, control) + 7 * way * step, abs=1e-12)
    assert (after.m, after.n) == pytest.approx(python_zone(page, scene), abs=1e-9)
    assert abs(after.m - before.m) > 1e-4
    shown = page.run("['m-0', 'n-0'].map((id) => document.getElementById(id).textContent)")
    assert shown == [f"{after.m:.7f} a", f"{after.n:.7f} a".replace("-", "\u2212")]
    if control == "f":  # the loads in SI units do not change
        assert page.run("page.loads()") == {**loads, "f": after.f}
        assert (after.Qf, after.sf) == pytest.approx((before.Qf * 0.5 / after.f, before.sf * 0.5 / after.f), rel=1e-12)


def test_a_number_is_typed(page):
    page.run("const field = document.querySelector('[type=number][data-sets=dsigma]'); field.focus(); field.select()")
    page.send("Input.insertText", text="-123.456")
    assert answer(page).mirror == -1
    assert page.run("page.loads()")["dsigma"] == pytest.approx(123.456e6, rel=1e-15)
    assert page.run("document.getElementById('opposite').checked")
    assert (answer(page).m, answer(page).n) == pytest.approx(python_zone(page, load_scene(LARGE)), abs=1e-9)


@pytest.mark.parametrize(("control", "text"), [("Qf", "-0.1"), ("f", "0"), ("f", "1e-9"), ("sf", "1e400"), ("dQ", "")])
def test_what_is_no_load_is_marked_and_left_out(page, control, text):
    before = answer(page)
    page.run(
        f"const field = document.querySelector('[type=number][data-sets={control}]'); field.focus(); field.select()"
    )
    page.send("Input.insertText", text=text) if text else page.run(
        "field.value = ''; field.dispatchEvent(new Event('input'))"
    )
    assert page.run("field.getAttribute('aria-invalid')") == "true"
    assert answer(page) == before
    page.run("field.blur()")
    assert page.run("[field.getAttribute('aria-invalid'), field.value !== '']") == [None, True]


def test_a_normal_force_is_typed(page):
    """P changes a and p0; dQ, dsigma and f stay, in SI units."""
    before, scene = page.run("page.loads()"), load_scene(LARGE)
    page.run("const force = document.querySelector('[type=number][data-sets=P]'); force.focus(); force.select()")
    page.send("Input.insertText", text="700")
    found, pressed = answer(page), pressed_by(7e5, scene)
    assert page.run("page.loads()") == {**before, "P": 7e5}
    assert (found.a, found.p0) == pytest.approx((pressed.a, pressed.p0), rel=1e-12)
    assert found.Qf == pytest.approx(scene.load.dQ / (2 * scene.friction.f * 7e5), rel=1e-12)
    assert found.sf == pytest.approx(scene.load.dsigma / (scene.friction.f * pressed.p0), rel=1e-12)
    assert (found.m, found.n) == pytest.approx(python_zone(page, scene), abs=1e-9)
    shown = page.run("['a-1', 'p0-1'].map((id) => document.getElementById(id).textContent)")
    assert shown == [engineering(pressed.a, "m", 6), engineering(pressed.p0, "Pa", 6)]
    assert engineering(pressed.a, "m", 5) in page.run("document.querySelector('#tractions').textContent")


def test_the_slider_of_P_by_keyboard(page):
    slider = page.run("(() => { const { min, max, step, value } = document.getElementById('P');"
                      "return [min, max, step, value].map(Number); })()")  # fmt: skip
    low, high, step, value = slider
    assert 0 < low < value < high
    assert abs(value * 1e3 - load_scene(LARGE).P) <= step * 1e3 / 2
    page.run("document.getElementById('P').focus()")
    page.press("ArrowRight", times=3)
    assert page.run("page.loads().P") == pytest.approx((value + 3 * step) * 1e3, rel=1e-12)


SETTINGS = "document.getElementById('opposite').click();" + "".join(
    f"for (const field of document.querySelectorAll('[type=number][data-sets={name}]')) {{ field.value = '{value}';"
    "field.dispatchEvent(new Event('input')); }"
    for name, value in (("P", "701.5"), ("f", "0.4321"), ("sf", "1.2345"), ("Qf", "0"))
)


@pytest.mark.slow
def test_a_link_holds_the_settings(browser, folder):
    page = opened(browser, folder)
    page.run(SETTINGS)
    before, loads, link = answer(page), page.run("page.loads()"), page.run("document.getElementById('link').hash")
    assert page.run("new Promise((done) => setTimeout(() => done(location.hash), 600))") == link
    page = opened(browser, folder, link=link)
    assert page.run("page.loads()") == pytest.approx(loads, rel=1e-11)
    after = answer(page)
    assert [after.m, after.n, after.a] == pytest.approx([before.m, before.n, before.a], rel=1e-9)
    assert page.run("document.getElementById('opposite').checked")
    page.run("document.getElementById('reset').click()")
    assert page.run("new Promise((done) => setTimeout(() => done(location.href), 600))").endswith("page.html")
    page.run(f"location.hash = {json.dumps(link)}")  # pasted into the address of the open page
    pasted = page.run("new Promise((done) => setTimeout(() => done(page.loads()), 50))")
    assert pasted == pytest.approx(loads, rel=1e-11)


@pytest.mark.parametrize(
    "link",
    ["#", "#nonsense", "#P1=0&P2=-1&e1=1e9&e2=NaN",
     "#P=&f=&dQ=&dsigma=", "#P=-1&f=0&dQ=1e400&dsigma=NaN",
     "#P=0&f=1e-9&dQ=0x10&dsigma=Infinity",
     "#P=1e99&f=%ff&dQ=%3Cscript%3E&other=1", "#__proto__=1&P=1,2&f=0.3a", "#f=0.25&P=none"],
)  # fmt: skip
def test_what_is_no_setting_in_a_link_is_left_out(browser, folder, link):
    page = opened(browser, folder, link=link)
    loads = page.run("page.loads()")
    scene = load_scene(LARGE)
    f = 0.25 if "0.25" in link else scene.friction.f
    assert loads == {"P": scene.P, "f": f, "dQ": scene.load.dQ, "dsigma": scene.load.dsigma, "turn": 1, "mirror": 1}
    assert page.errors == []


def handle(page):
    """Return the position of the map's point on the page."""
    return page.run("(() => { const { left, right, top, bottom } = document.querySelector('.handle .dot')"
                    ".getBoundingClientRect(); return [(left + right) / 2, (top + bottom) / 2]; })()")  # fmt: skip


def test_the_point_is_dragged(page):
    start, before = handle(page), answer(page)
    page.drag(start, [start[0] + 120, start[1] - 40])
    after = answer(page)
    assert handle(page) == pytest.approx([start[0] + 120, start[1] - 40], abs=1)
    assert after.Qf > before.Qf + 0.1
    assert after.sf > before.sf + 0.5
    assert after.gradual  # the page's table has fewer digits than Python's
    assert (after.m, after.n) == pytest.approx(python_zone(page, load_scene(LARGE)), abs=1e-5)
    page.drag(handle(page), [5000, start[1]])
    assert answer(page).regime == "sliding"
    page.run("document.getElementById('reset').click()")
    assert answer(page) == before
    assert handle(page) == pytest.approx(start, abs=0.1)


def test_the_point_is_dragged_with_a_finger(browser, folder):
    page = opened(browser, folder, width=390, mobile=True)
    page.send("Emulation.setTouchEmulationEnabled", enabled=True)
    page.run("document.querySelector('#map').scrollIntoView({ block: 'center' })")
    start, before, scrolled = handle(page), answer(page), page.run("scrollY")
    finger = [{"x": start[0] + share * 80, "y": start[1] - share * 40} for share in np.linspace(0, 1, 6)]
    for way, points in (("touchStart", finger[:1]), *(("touchMove", [at]) for at in finger[1:]), ("touchEnd", [])):
        page.send("Input.dispatchTouchEvent", type=way, touchPoints=points)
    page.send("Emulation.setTouchEmulationEnabled", enabled=False)
    assert handle(page) == pytest.approx([start[0] + 80, start[1] - 40], abs=1)
    assert page.run("scrollY") == scrolled
    assert answer(page).Qf > before.Qf + 0.1


def test_the_point_is_moved_by_keys(page):
    before = answer(page)
    page.run("document.querySelector('.handle').focus()")
    page.press("ArrowRight", times=3)
    page.press("ArrowDown", times=2)
    after = answer(page)
    assert (after.Qf - before.Qf, after.sf - before.sf) == pytest.approx((0.03, -0.2), abs=1e-12)


def test_mirrored_contact(page):
    before = answer(page)
    page.run("document.getElementById('opposite').focus()")
    page.press(" ")
    after = answer(page)
    assert (after.m, after.n) == (before.n, before.m)
    assert page.run("[...document.querySelectorAll('[data-end=m]')].map((e) => e.textContent)") == ["n", "n"]


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize(("width", "mobile"), [(320, True), (390, True), (820, True), (1024, False), (1440, False)])
def test_it_fits_the_window(browser, folder, width, mobile, scheme):
    browser.send("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
    page = opened(browser, folder, width=width, height=900, mobile=mobile)
    width_shown = page.run("document.documentElement.clientWidth")  # less a scroll bar
    assert page.run("document.documentElement.scrollWidth") == width_shown
    assert width_shown >= width - 20
    if width == 1440:
        assert page.run("document.documentElement.scrollHeight") <= 900
    assert page.run("document.querySelector('#map').getBoundingClientRect().width") > 280
    ink, paper = page.run("['color', 'backgroundColor'].map((key) => getComputedStyle(document.body)[key])")
    assert ("22, 22, 22" in paper, "17, 17, 17" in ink) == ((True, False) if scheme == "dark" else (False, True))
    assert (page.errors, [url for url in page.asked if not url.startswith("file:")]) == ([], [])


def test_every_control_has_a_name(page):
    nodes = page.send("Accessibility.getFullAXTree")["nodes"]
    named = [
        (node["role"]["value"], node["name"]["value"])
        for node in nodes
        if node.get("role", {}).get("value") in ("slider", "spinbutton", "checkbox", "button", "image", "img")
    ]
    assert [role for role, name in named if not name] == []
    assert [role for role, _ in named].count("slider") == 5  # four and the map's point
    assert len({name for role, name in named if role == "spinbutton"}) == 6
