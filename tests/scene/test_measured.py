"""Profiles from files of points: smoothed, convex, in any unit, with noise that carries over to m and n."""

from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace
from refusing import line_of

from partialslip import InputError, load_result, load_scene, run
from partialslip.cli import main
from partialslip.halfplane import contact, stick_zone
from partialslip.halfplane.noise import noise_of
from partialslip.report.figure import profile_svg
from partialslip.report.record import record
from partialslip.scene.measured import refitted, smoothest

SCENE = """
name = "measured"
material = {E = 72.1e9, nu = 0.33}
friction.f = 0.3
[profile]
kind = "tabulated"
file = "pad.csv"
unit = [1e-3, 1e-6]
smooth = 200e-6
[load]
P = 400e3
Q = [-40e3, 40e3]
sigma = [-60e6, 60e6]
"""


def gap(x):
    """Gap of a cylinder on the left and of a barrel on the right, m."""
    return np.where(x < 0, x**2 / 0.02, x**2 / 0.04 + np.maximum(x, 0) ** 4 * 3e4)


def points(noise, seed=0, count=400):
    random = np.random.default_rng(seed)
    x = np.sort(random.uniform(-2e-3, 2.5e-3, count))
    return x, gap(x) + noise * random.standard_normal(count)


def scene_of(folder, x, values, text=SCENE, lines=("x [mm], gap [um]",)):
    rows = [f"{a * 1e3!r},{b * 1e6!r}" for a, b in zip(x.tolist(), values.tolist(), strict=True)]
    (folder / "pad.csv").write_text("\n".join([*lines, *rows]), "utf-8")
    (folder / "job.toml").write_text(text, "utf-8")
    return load_scene(folder / "job.toml")


def test_a_parabola_is_followed_exactly(tmp_path):
    """Offset, tilt of the points and unit do not matter: the bodies turn, and the gap is smooth already."""
    x, _ = points(0.0)
    scene = scene_of(tmp_path, x, x**2 / 0.02 + 3e-6 + 1e-3 * x)
    exact = run(scene, "exact")["exact"]
    hertz = run(scene.replace(profile={"kind": "hertz", "R": 0.01}), "exact")["exact"]
    assert exact.a == pytest.approx(hertz.a, rel=1e-9)
    assert (exact.m, exact.n) == pytest.approx((hertz.m, hertz.n), rel=1e-7)
    assert scene.profile.measured.misfit < 1e-15


def test_a_tilt_that_is_fixed_stays(tmp_path):
    """A parabola x^2/(2R) + t x has its lowest point at -t R, where bodies that do not turn touch."""
    x, _ = points(0.0)
    scene = scene_of(tmp_path, x, x**2 / 0.02 + 1e-2 * x, SCENE.replace("smooth", 'tilt = "fixed"\nsmooth'))
    assert contact(scene).centre == pytest.approx(-1e-4, rel=1e-8)


def test_what_was_changed_is_kept(tmp_path):
    scene = scene_of(tmp_path, *points(2e-7))
    known = scene.profile.measured
    assert known.points == 400
    assert known.noise == pytest.approx(2e-7, rel=0.1)
    assert known.misfit == pytest.approx(2e-7, rel=0.1)
    x = np.linspace(-1.9e-3, 2.4e-3, 50)
    off = scene.profile.gap_at(x) - gap(x)
    assert np.ptp(off) < 6e-7
    assert load_scene(tmp_path / "job.toml") == scene


def test_units_of_the_scene(tmp_path):
    """In N, mm and MPa the unit and the smoothing length are in mm."""
    own = scene_of(tmp_path, *points(2e-7))
    text = (
        SCENE.replace("72.1e9", "72.1e3").replace("[1e-3, 1e-6]", "[1, 1e-3]").replace("200e-6", "0.2")
        .replace("400e3", "400").replace("[-40e3, 40e3]", "[-40, 40]").replace("[-60e6, 60e6]", "[-60, 60]")
    )  # fmt: skip
    other = scene_of(tmp_path, *points(2e-7), 'units = "N-mm"\n' + text)
    np.testing.assert_allclose(other.profile.gap, own.profile.gap, rtol=1e-12, atol=1e-18)
    assert other.profile.measured.unit == pytest.approx((1e-3, 1e-6))
    assert other.profile.measured.noise == pytest.approx(own.profile.measured.noise, rel=1e-12)


WITHOUT = SCENE.replace("unit = [1e-3, 1e-6]\n", "")
IN_MM = WITHOUT
for si, own in {"72.1e9": "72.1e3", "200e-6": "0.2", "400e3": "400", "40e3": "40", "60e6": "60"}.items():
    IN_MM = IN_MM.replace(si, own)
IN_MM = f'units = "N-mm"\n{IN_MM}'


BEFORE = "# trace 3, stylus of 2 um at 0.5 mm/s"
HEADINGS = [
    ("# Profile of a pad (second measurement)", "# x [ mm ]; gap [\N{MICRO SIGN}m]"),
    ("# x (mm) gap (\N{GREEK SMALL LETTER MU}m)", "", "# made (by hand) with (care)"),
    ("x [m], gap [m]", "X [MM], GAP [UM]"),
    *((BEFORE, line) for line in (
        "x [mm], gap [um]", "Length mm,Depth um", "Length mm;Depth um", "Length mm\tDepth um", "Length mm  Depth um",
        "Length mm Depth um", "x_mm,gap_um", "x_mm gap_um", "x/mm, gap/um", "x in mm; gap in um", "mm,um",
        "# x mm, gap \N{MICRO SIGN}m", "Distance [mm], Depth um", "Distance mm, Depth (um)", '"Length mm","Depth um"',
        "X (MM), Z (UM)", "x {mm}, z {um}",
    )),
]  # fmt: skip


@pytest.mark.parametrize("lines", HEADINGS)
def test_units_in_the_heading_are_read(tmp_path, lines):
    given = scene_of(tmp_path, *points(2e-7)).profile
    for text in (WITHOUT, IN_MM):
        found = scene_of(tmp_path, *points(2e-7), text, lines).profile
        assert found.measured.unit == pytest.approx((1e-3, 1e-6))
        assert found.x == pytest.approx(given.x, rel=1e-12)
        assert found.gap == pytest.approx(given.gap, rel=1e-9, abs=1e-18)


@pytest.mark.parametrize("line", ["x (millimetres), gap (microns)", "X_(mm);Z_(microns)", "mm,um", "x/mm, gap/um"])
def test_units_in_words_are_read(tmp_path, line):
    found = scene_of(tmp_path, *points(2e-7), WITHOUT, ("# trace 3, stylus of 2 um at 0.5 mm/s", line)).profile
    assert found.measured.unit == pytest.approx((1e-3, 1e-6))


@pytest.mark.parametrize(("line", "word"), [
    ("Unit: mm", "mm"), ("Length mm, Depth", "mm"), ("Length, Depth um", "um"), ("Length, Depth [um]", "um"),
    ("x [mm], gap", "mm"), ("Length mm, Depth um, raw", "mm"),
    ("x [mm], gap (um, raw)", "mm"), ("Length mil,Depth mil", "mil"),
    ("lengths in micrometers", "micrometers"), ("x inch gap inch", "inch"),
])  # fmt: skip
def test_units_that_cannot_be_read_are_refused(tmp_path, monkeypatch, line, word):
    monkeypatch.chdir(tmp_path)
    told = line_of(scene_of, Path(), *points(2e-7), WITHOUT, (line,))
    assert told.endswith(
        f"pad.csv: unit {word!r} in the heading: must stand behind the name of each column, as in x [mm], gap [um], or "
        "give profile.unit"
    )
    scene_of(Path(), *points(2e-7), SCENE, (line,))  # the scene says what the heading does not


@pytest.mark.parametrize(
    ("lines", "unit"), [(("# all in [mm]",), 1e-3), (("# x, gap (scan [3])",), 1.0), (("x,gap",), 1.0)]
)
def test_one_unit_stands_for_both_columns_and_none_for_that_of_the_scene(tmp_path, lines, unit):
    x, values = points(2e-7)
    found = scene_of(tmp_path, x / unit / 1e3, values / unit / 1e6, WITHOUT, lines).profile
    assert found.measured.unit == pytest.approx((unit, unit))
    assert found.x[-1] == pytest.approx(2.5e-3, rel=1e-2)


@pytest.mark.parametrize(("text", "lines", "message"), [
    (SCENE, ("x [mm], gap [mm]",),
     "profile.unit = [0.001, 1e-06]: must be that of the heading of pad.csv, [mm] and [mm], or be left out"),
    (SCENE, ("[um]",), "must be that of the heading of pad.csv, [um], or be left out"),
    (WITHOUT, ("x [mm], gap [mil]",), "pad.csv: units [mm] and [mil] in the heading: must be of m, mm, um"),
])  # fmt: skip
def test_units_that_contradict_or_are_unknown_are_refused(tmp_path, monkeypatch, text, lines, message):
    monkeypatch.chdir(tmp_path)
    assert message in line_of(scene_of, Path(), *points(2e-7), text, lines)
    scene_of(Path(), *points(2e-7), SCENE, ("x [mm], gap [mil]",))  # the scene says what the heading does not


def test_columns_in_the_wrong_order_are_refused(tmp_path):
    told = line_of(scene_of, tmp_path, *points(2e-7), WITHOUT, ("gap [um], x [mm]",))
    assert told.endswith("pad.csv: heading 'gap [um], x [mm]': the columns must be x, then gap")


HALF = SCENE.replace("sigma = [-60e6, 60e6]", "")
GIVEN = HALF.replace("smooth", 'centre = "given"\nsmooth')


def half(apart, noise=2e-8, count=200, seed=0):
    """One half of a cylinder of R = 10 mm, from ``apart`` right of its lowest point on."""
    x = np.linspace(0.0, 2e-3, count)
    return x, (x + apart) ** 2 / 0.02 + 1e-6 + noise * np.random.default_rng(seed).standard_normal(count)


@pytest.mark.parametrize("noise", [0.0, 2e-8, 2e-7])
def test_one_half_of_an_even_gap_is_followed(tmp_path, noise):
    """The slope at x = 0 is zero: a is that of the cylinder, and the load points are mirror images."""
    scene = scene_of(tmp_path, *half(0.0, noise), HALF)
    found = run(scene, "exact")["exact"]
    hertz = run(scene.replace(profile={"kind": "hertz", "R": 0.01}), "exact")["exact"]
    assert scene.profile.even
    assert found.a == pytest.approx(hertz.a, rel=1e-9 + 2e5 * noise)
    assert found.m == found.n


@pytest.mark.parametrize("apart", [-60e-6, -30e-6, -100e-6, 30e-6, 60e-6])
@pytest.mark.parametrize("noise", [0.0, 2e-8])
def test_a_half_that_begins_beside_its_lowest_point_is_refused(tmp_path, apart, noise):
    """Mirrored at x = 0 it would be another profile: at 60 um before its lowest point a was 19 % too large."""
    told = line_of(scene_of, tmp_path, *half(apart, noise), GIVEN)
    place = float(told.partition("the lowest point is at about ")[2].split()[0])
    assert place == pytest.approx(-apart, abs=1e-8 + 200 * noise)
    assert "must be at 0 for one half of an even gap" in told


def test_a_whole_trace_that_begins_at_zero_is_refused(tmp_path):
    told = line_of(scene_of, tmp_path, *half(-1e-3), GIVEN)
    assert "lowest point is at about 0.001 m" in told


@pytest.mark.parametrize(("apart", "accuracy"), [(-60e-6, 2e-2), (-30e-6, 2e-2), (-200e-6, 2e-2), (-1e-3, 3e-3)])
def test_a_trace_that_begins_at_zero_is_centred_at_its_lowest_point(tmp_path, apart, accuracy):
    """By default: a short side belongs to an even gap, a long one is the other side of the trace. Noise of 20 nm moves
    the lowest point by some um, as its copies tell."""
    scene = scene_of(tmp_path, *half(apart), HALF)
    known, found = scene.profile.measured, run(scene, "exact")["exact"]
    hertz = run(scene.replace(profile={"kind": "hertz", "R": 0.01}), "exact")["exact"]
    assert known.centre == pytest.approx(-apart, abs=1e-5)
    assert scene.profile.even == (apart > -1e-3)
    assert found.a == pytest.approx(hertz.a, rel=accuracy)
    assert abs(found.a - hertz.a) < 4 * noise_of(scene).a * hertz.a
    assert load_scene(tmp_path / "job.toml") == scene
    exact = scene_of(tmp_path, *half(apart, 0.0), HALF)
    assert run(exact, "exact")["exact"].a == pytest.approx(hertz.a, rel=1e-3)
    (told,) = (line_of(scene_of, tmp_path, *half(30e-6), HALF),)  # its lowest point is not in the file
    assert "must be at 0 for one half of an even gap" in told


def trace_of(folder, data):
    (folder / "pad.csv").write_bytes(data)
    (folder / "job.toml").write_text(WITHOUT, "utf-8")
    return load_scene(folder / "job.toml").profile


def test_traces_as_instruments_write_them(tmp_path):
    """Decimal commas, UTF-16, Latin-1, an index and values that are none, heights, a line of units."""
    x, values = points(2e-7)
    given = scene_of(tmp_path, x, values).profile
    rows = [(f"{a * 1e3:.12g}", f"{b * 1e6:.12g}", f"{-b * 1e6:.12g}") for a, b in zip(x, values, strict=True)]

    def text(head, *columns, separator=","):
        return "\n".join([*head, *(separator.join(row[k] for k in columns) for row in rows)])

    texts = {
        "decimal commas": text(["x [mm];gap [µm]"], 0, 1, separator=";").replace(".", ",").encode("latin-1"),
        "UTF-16": text(["x [mm]\tgap [um]"], 0, 1, separator="\t").encode("utf-16"),
        "heights": text(["x [mm],z [um]"], 0, 2).encode(),
        "units below": text(["Instrument 7, 0.5 mm/s", "", "x,depth", "mm,um"], 0, 1).encode(),
        "index": ("no,x [mm],gap [um]\n400,0.1,NaN\n" + "\n".join(
            f"{k},{row}" for k, row in enumerate(text([], 0, 1).split("\n")))).encode(),
        "quotes": text(['"x [mm]","gap [um]"'], 0, 1).encode(),
    }  # fmt: skip
    for name, data in texts.items():
        found = trace_of(tmp_path, data)
        assert np.allclose(found.gap, given.gap, rtol=1e-6, atol=1e-12), name
        assert found.measured.points == 400, name
        assert np.sign(found.measured.unit[1]) == (-1 if name == "heights" else 1), name
    three = text(["a [mm],b [um],c [um]"], 0, 1, 2).encode()
    told = line_of(trace_of, tmp_path, three)
    assert "3 columns, 'a [mm]', 'b [um]', 'c [um]': must have two, x and gap; or name both by profile.columns" in told
    for columns in ([1, 2], ["a", "b"]):
        (tmp_path / "job.toml").write_text(WITHOUT.replace("smooth", f"columns = {columns}\nsmooth"), "utf-8")
        assert np.allclose(load_scene(tmp_path / "job.toml").profile.gap, given.gap, rtol=1e-6, atol=1e-12)
    (tmp_path / "job.toml").write_text(WITHOUT.replace("smooth", "columns = [1, 9]\nsmooth"), "utf-8")
    assert "profile.columns: 9: must be one of 'a [mm]'" in line_of(load_scene, tmp_path / "job.toml")


@pytest.mark.fault
def test_a_mirror_image_that_is_not_checked(tmp_path, monkeypatch):
    """Without the comparison of both fits the trace is taken, and a is wrong by a tenth and more."""
    monkeypatch.setattr("partialslip.scene.measured._refuse_mirror", lambda *_: None)
    scene = scene_of(tmp_path, *half(-60e-6), GIVEN)
    found = run(scene, "exact")["exact"]
    hertz = run(scene.replace(profile={"kind": "hertz", "R": 0.01}), "exact")["exact"]
    assert found.a > 1.1 * hertz.a


def test_the_units_are_told(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    scene_of(tmp_path, *points(2e-7), WITHOUT, ("Length mm,Depth um",))
    assert main(["run", "job.toml", "--with", "exact"]) == 0
    assert "points of the profile 400 of pad.csv, x in mm, gap in um" in " ".join(capsys.readouterr().out.split())


def test_exponents_of_fortran(tmp_path):
    x, values = points(2e-7)
    plain = scene_of(tmp_path, x, values)
    text = (tmp_path / "pad.csv").read_text("utf-8")
    (tmp_path / "pad.csv").write_text("\n".join(line.replace(",", "D0,", 1) for line in text.splitlines()), "utf-8")
    np.testing.assert_allclose(load_scene(tmp_path / "job.toml").profile.gap, plain.profile.gap, rtol=1e-12)


def test_noise_carries_over(tmp_path):
    """Refitted noisy copies scatter as refitted noisy measurements do."""

    def ends(scene):
        zone = stick_zone(contact(scene), 0.3, 80e3, 120e6)
        return zone.m, zone.n

    measured = np.array([ends(scene_of(tmp_path, *points(2e-7, seed))) for seed in range(12)])
    copies = np.array([ends(copy) for copy in refitted(scene_of(tmp_path, *points(2e-7)), 12, seed=1)])
    ratio = copies.std(axis=0, ddof=1) / measured.std(axis=0, ddof=1)
    assert (ratio > 0.4).all()
    assert (ratio < 2.5).all()


def flat_of(folder, seed, smooth):
    """A cylinder of 50 mm, 601 points over 8 mm with noise of 1 um."""
    x = np.linspace(-4e-3, 4e-3, 601)
    text = WITHOUT.replace("200e-6", repr(smooth))
    return scene_of(folder, x, x**2 / 0.1 + 1e-6 * np.random.default_rng(seed).standard_normal(601), text)


def in_closed_form(scene):
    pressed, load = contact(scene), scene.load
    zone = stick_zone(pressed, scene.friction.f, load.dQ, load.dsigma)
    return np.array([pressed.a, float(zone.m), float(zone.n)])


@pytest.mark.parametrize("smooth", [pytest.param(5e-4, marks=pytest.mark.slow), 1e-3])
def test_the_scatter_that_is_told_is_that_of_the_results(tmp_path, smooth):
    """Other measurements of the same body differ by as much from the body as the noisy copies do among themselves."""
    given = flat_of(tmp_path, 0, smooth)
    noise, true = noise_of(given), in_closed_form(given.replace(profile={"kind": "hertz", "R": 0.05}))
    found = np.array([in_closed_form(flat_of(tmp_path, seed, smooth)) for seed in range(12)])
    ratio = np.sqrt(np.mean((found - true) ** 2, axis=0)) / true[0] / [noise.a, noise.m, noise.n]
    assert np.all(ratio < 2.5)
    assert np.all(ratio > 0.4)


def test_a_longer_smoothing_length_is_advised_where_it_scatters_less(tmp_path):
    """The points of a cylinder fit a table of three intervals; those of a body with a hollow do not."""
    noise = noise_of(flat_of(tmp_path, 0, 1e-4))
    assert noise.smooth == pytest.approx(8e-4)
    assert noise.m_then < noise.m / 2
    assert noise_of(flat_of(tmp_path, 0, 8e-4)).smooth is None
    assert smoothest(flat_of(tmp_path, 0, 1e-4).profile.measured) == pytest.approx(1.6e-3)
    x, values = points(2e-7)
    kinked = scene_of(tmp_path, x, values + 0.02 * np.abs(x), SCENE.replace("200e-6", "50e-6"))
    assert smoothest(kinked.profile.measured) <= 4e-4


@pytest.mark.slow
def test_noise_is_told_and_judges_nothing(tmp_path, capsys):
    flat_of(tmp_path, 0, 4e-4)
    out = tmp_path / "out"
    assert main(["run", str(tmp_path / "job.toml"), "--with", "exact", "--out", str(out)]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    noise = load_result(out / "results.json").noise
    assert f"noise of the profile a +- {noise.a:.1e} a, m +- {noise.m:.1e} a, n +- {noise.n:.1e} a" in printed
    assert "with a longer smooth 0.8 mm" in printed
    scene = load_scene(tmp_path / "job.toml")
    assert run(scene, "exact").noise == noise
    plain = run(replace(scene, profile=replace(scene.profile, measured=None)), "exact")
    assert plain.noise is None
    told = load_result(out / "results.json")
    assert (told.outcome, told.missed) == (plain.outcome, plain.missed)
    assert told.methods["exact"].estimate == plain["exact"].estimate
    again = run(scene, "exact")
    assert record(again, curves=False).noise is None
    (tmp_path / "pad.csv").unlink()
    assert again.noise is None


def test_only_measured_profiles_have_noise_and_some_loads_no_closed_form(tmp_path):
    assert noise_of(load_scene("hertz-shear")) is None
    given = flat_of(tmp_path, 0, 5e-4)
    noise = noise_of(given.replace(load={"P": [4e5, 3e5]}))
    assert noise.a > 0
    assert (noise.m, noise.n) == (None, None)


def hollow(x):
    return gap(x) - 2e-6 * np.exp(-(((x - 6e-4) / 2e-4) ** 2)) + 6e-6 * np.exp(-(((x - 1e-3) / 1e-4) ** 2))


@pytest.mark.parametrize(("change", "message"), [
    (lambda text: text.replace("200e-6", "200"), "profile.smooth = 200.0: must be from"),
    (lambda text: text.replace('"pad.csv"', '"none.csv"'), "none.csv: cannot be read"),
    (lambda text: text.replace("tabulated", "hertz"), "profile.kind = 'hertz': must be 'tabulated' for a profile.file"),
    (lambda text: text.replace("smooth", "x = [0, 1, 2]\nsmooth"), "profile.x: must not be given together with"),
    (lambda text: text.replace("smooth = 200e-6", ""), "profile.smooth: missing"),
    (lambda text: text.replace("[1e-3, 1e-6]", "[1e-3, -1e-6]"), "profile.unit[1] = -1e-06: must be > 0.0"),
])  # fmt: skip
def test_bad_keys_are_named(tmp_path, change, message):
    assert message in line_of(scene_of, tmp_path, *points(2e-7), change(SCENE))


@pytest.mark.parametrize(("lines", "message"), [
    (("1,2,3",), "pad.csv: line 1: must have 2 numbers, like line 2, or names"),
    (("1,2", "x"), "pad.csv: line 2: must have 2 fields, like line 1"),
    (("1,2", "1e200,2"), "pad.csv: line 2: 1e200: must be zero or of a size from 1e-100 to 1e+100"),
    (("1,2", "2,1e400"), "pad.csv: line 2: 1e400: must be zero or of a size"),
    (("1,1e-98", "2,1"), "pad.csv: line 1: 1e-98: must be zero or of a size"),
])  # fmt: skip
def test_bad_files_are_named(tmp_path, lines, message):
    assert message in line_of(scene_of, tmp_path, *points(2e-7), lines=lines)


def test_points_that_are_not_convex_are_refused_with_the_place(tmp_path):
    x, values = points(1e-7)
    refusal = line_of(scene_of, tmp_path, x, values - gap(x) + hollow(x))
    assert "the points are off any convex gap by" in refusal
    place = float(refusal.split("at x = ")[1].split(" m ")[0])
    assert 5e-4 < place < 1.3e-3


def test_the_report_draws_points_and_gap(tmp_path):
    scene = scene_of(tmp_path, *points(2e-7))
    drawn = profile_svg(scene)
    assert "convex gap" in drawn
    assert "points - gap, mm" in drawn
    (tmp_path / "pad.csv").unlink()
    assert profile_svg(scene) == ""  # nothing to draw without the file


@pytest.mark.fault
def test_points_taken_as_a_table_would_be_seen(tmp_path):
    """Without smoothing, noise makes slopes decrease."""
    x, values = points(2e-7)
    with pytest.raises(InputError, match="must be convex; its slope decreases"):
        scene_of(tmp_path, x, values).replace(profile={"x": x, "gap": values})
