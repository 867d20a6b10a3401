"""The stick-zone map: data, files, figures and a scene's point; and the figures of the documents."""

import csv
import math
import re
import runpy
from pathlib import Path

import numpy as np
import pytest
from outline import texts

from partialslip.cli import consoles, main
from partialslip.halfplane import contact
from partialslip.halfplane.gradual_path.half_cycle import steady
from partialslip.halfplane.gradual_path.stage import Loads
from partialslip.halfplane.hertz import HertzShape
from partialslip.halfplane.loading import one_step
from partialslip.halfplane.punch import Punch
from partialslip.halfplane.steady import steady_stick_zone, stick_zones, transition
from partialslip.result import StickZone
from partialslip.scene.gradual import turns_round
from partialslip.scene.reading import load_scene
from partialslip.study.map import files as map_files
from partialslip.study.map import grid, place, stick_map
from partialslip.tools.output.place import REQUEST_NAME

FILES = ["ends.svg", "map.csv", "map.svg"]
DOCS = Path(__file__).parents[2] / "docs"
FIGURES = [
    "adhered.svg",
    "cycle.svg",
    "ends.svg",
    "large-tension.svg",
    "loop.svg",
    "regions.svg",
    "signs.svg",
    "small-tension.svg",
    "turning.svg",
]


def names(folder):
    return sorted(path.name for path in folder.iterdir() if path.name != REQUEST_NAME)


def rows(folder):
    return list(csv.DictReader((folder / "map.csv").read_text("utf-8").splitlines()))


def column(table, key):
    return np.array([float(row[key]) for row in table])


def drawn(path):
    return texts(path.read_text("utf-8"))


def scene(*overrides):
    """dQ/(2 f P) = 0.4 and dsigma/(f p0) = 4.03, with f p0 = 200 MPa and f P = 314 kN/m."""
    return load_scene("hertz-large-tension", overrides)


@pytest.fixture
def coarse(monkeypatch):
    """Coarse maps, for tests independent of the resolution; without progress, also on a slow machine."""
    monkeypatch.setattr(consoles, "EVERY", math.inf)
    monkeypatch.setattr(grid, "_COUNT", 4)
    monkeypatch.setattr(grid, "_COUNT_KINKED", 4)
    monkeypatch.setattr(grid, "_RATIOS", np.linspace(0, 8, 5))


@pytest.fixture(scope="module")
def hertz(tmp_path_factory):
    folder = tmp_path_factory.mktemp("map")
    assert main(["map", "--out", str(folder)]) == 0
    return folder


@pytest.mark.slow
def test_table_against_one_zone_at_a_time(hertz):
    table = rows(hertz)
    assert list(table[0]) == ["Qf", "sf", "m_over_a", "n_over_a", "half_width_over_a", "regime", "loads"]
    for row in table[::37]:
        Qf, sf = float(row["Qf"]), float(row["sf"])
        zone, turns = steady_stick_zone(Qf, sf, HertzShape()), one_step(Qf, sf, HertzShape()).turns_round
        if turns and row["loads"] == "gradual":
            left, right = steady(Loads(sf, np.pi * Qf), HertzShape()).last.zone
            zone = StickZone((left + right) / 2, (right - left) / 2, 0)
        else:
            assert (row["loads"] == "one step") == turns
        found = [float(row[key]) for key in ("m_over_a", "n_over_a", "half_width_over_a")]
        ends = [zone.half_width - zone.centre, zone.half_width + zone.centre, zone.half_width]
        np.testing.assert_allclose(found, ends, rtol=0, atol=1e-6 if turns else 1e-12)
    assert {(row["Qf"], row["sf"]) for row in table if row["regime"] == "stuck"} == {("0.0", "0.0")}


def test_table_against_closed_forms(hertz):
    table = rows(hertz)
    Qf, sf, m, n = (column(table, key) for key in ("Qf", "sf", "m_over_a", "n_over_a"))
    assert (len(table), Qf.max(), sf.max()) == (50 * 51, 0.98, 10.0)
    once = stick_zones(Qf, sf, HertzShape())
    plain = ~turns_round(Qf, sf, once.s, once.centre, once.half_width)  # others are in the test above
    table, Qf, sf, m, n = (
        [row for row, kept in zip(table, plain, strict=True) if kept],
        *(values[plain] for values in (Qf, sf, m, n)),
    )
    large = np.array([row["regime"] == "large tension" for row in table])
    above = sf - 8 * (1 - np.sqrt(1 - Qf))  # zero except for rounding at (0, 0) and where sqrt(1 - Qf) is round
    np.testing.assert_array_equal(large[abs(above) > 1e-12], above[abs(above) > 1e-12] > 0)
    np.testing.assert_allclose(((n - m) / 2)[~large], (-sf / 8)[~large], rtol=0, atol=1e-14)  # eq. (21)
    np.testing.assert_allclose(((n + m) / 2)[~large], np.sqrt(1 - Qf)[~large], rtol=0, atol=1e-14)  # eq. (22)
    either = (Qf == 0) | (sf == 0)  # one load alone leaves the zone in the middle
    np.testing.assert_allclose(m[either], n[either], rtol=0, atol=1e-12)
    assert (n[~either] < m[~either]).all()


@pytest.mark.parametrize("shape", [HertzShape(), Punch(0.6)], ids=["hertz", "punch"])
@pytest.mark.usefixtures("coarse")
def test_lines_lead_through_their_stick_zones(shape):
    data = grid._mapped(shape, 10.0, lambda _: None)
    for lines, way in ((data.m_lines, -1), (data.n_lines, 1)):
        for line in lines:
            some = (line.Qf >= 0) & (line.Qf < 1 - 1e-6) & (line.sf >= 0) & (line.sf < 20)
            Qf, sf = line.Qf[some][::9], line.sf[some][::9]
            if not len(Qf):
                continue
            zones = grid._zones(Qf, sf, shape)
            there = (
                grid._tabled(grid.MapLine(0.0, Qf, sf), shape)
                if isinstance(shape, HertzShape)
                else np.zeros(len(Qf), bool)
            )
            found = zones.zone.half_width + way * zones.zone.centre
            np.testing.assert_allclose(found[~there], line.at, rtol=0, atol=1e-9)
            np.testing.assert_allclose(found[there], line.at, rtol=0, atol=1e-3)  # lines through a grid
    assert {line.at for line in data.n_lines} == set(grid.N_LEVELS)


@pytest.mark.parametrize("shape", [HertzShape(), Punch(0.6)], ids=["hertz", "punch"])
@pytest.mark.usefixtures("coarse")
def test_border_is_where_the_regime_turns(shape):
    data = grid._mapped(shape, 10.0, lambda _: None)
    Qf, sf = data.border.Qf[20:-1], data.border.sf[20:-1]
    np.testing.assert_allclose(sf, transition(Qf, shape), rtol=1e-9)
    for way, s in ((1 - 1e-6, 1), (1 + 1e-6, -1)):
        assert (stick_zones(Qf, sf * way, shape)[2] == s).all()
    np.testing.assert_allclose(stick_zones(data.turns.Qf, data.turns.sf, shape).m, 1, rtol=0, atol=1e-9)
    for number, turn in enumerate(data.turns.sf):  # the curves have a maximum
        assert turn in data.curves.sf[number]
    curves = stick_zones(data.curves.Qf, data.curves.sf, shape)  # of one step
    assert (curves.m.max(axis=1) > 1 - 1e-9).all()


def test_progress_is_told():
    told = []
    stick_map(progress=told.append)
    assert told[0] == "map 0%"
    assert told[-1].startswith("ends ")


def test_pictures_without_a_scene(hertz):
    words = drawn(hertz / "map.svg")
    assert {"ΔQ/(2 f P)", "Δσ/(f p0)", "sliding", "hertz"} < set(words)
    labels = [word for word in words if re.fullmatch(r"[mn] −?0\.\d", word)]
    assert labels.count("m 0.8") >= 2  # below the border and above; lines end where the map is dotted
    assert len(set(labels)) >= 12
    assert not any("scene" in word for word in words)
    assert {f"ΔQ/(2 f P) = {Qf}" for Qf in (0.2, 0.4, 0.6, 0.8)} < set(drawn(hertz / "ends.svg"))


def test_labels_keep_apart(hertz):
    svg = (hertz / "map.svg").read_text("utf-8")
    found = re.findall(r"translate\(([\d.]+) ([\d.]+)\)[^>]*>[mn] ", svg)
    places = np.array([(float(x), float(y)) for x, y in found])
    assert len(places) > 12
    apart = np.hypot(*(places[:, None] - places).transpose(2, 0, 1))
    assert apart[~np.eye(len(places), dtype=bool)].min() > 12  # points; the text is 8 high


@pytest.mark.slow
def test_a_scene_on_the_map(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["map", "hertz-large-tension"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "hertz-large-tension: large tension, m = 0.8038533 a, n = 0.2949287 a"
    transition, bound = 8 * (1 - 0.6**0.5) * 200, one_step(0.4, 4.03, HertzShape()).mean_load_bound
    assert f"{transition:.4g} MPa" in lines[1]
    assert f"{bound * np.pi * 100:.4g} kN/m" in lines[1]
    assert len(lines) == 3
    folder = tmp_path / "results" / "hertz-large-tension-map"
    assert names(folder) == FILES
    table, pressed = rows(folder), contact(scene())
    np.testing.assert_allclose(column(table, "dQ"), column(table, "Qf") * 2 * 0.5 * pressed.P, rtol=1e-14)
    np.testing.assert_allclose(column(table, "dsigma"), column(table, "sf") * 0.5 * pressed.p0, rtol=1e-14)
    assert {"the scene's loads", "hertz-large-tension"} < set(drawn(folder / "map.svg"))


@pytest.mark.slow
@pytest.mark.usefixtures("coarse")
def test_a_punch_on_the_map(tmp_path, capsys):
    assert main(["map", "flat-rounded", "--out", str(tmp_path)]) == 0
    assert capsys.readouterr().out.startswith("flat-rounded: large tension, m = 0.9743951 a, n = 0.4245292 a\n")
    shape = contact(load_scene("flat-rounded")).shape
    for row in rows(tmp_path)[::3]:
        zone = steady_stick_zone(float(row["Qf"]), float(row["sf"]), shape)
        assert float(row["m_over_a"]) == pytest.approx(zone.half_width - zone.centre, abs=1e-9)


@pytest.mark.usefixtures("coarse")
def test_other_signs_are_mirrored():
    lines = place(stick_map(scene("load.Q=[125663.70614359174, -125663.70614359174]")))
    assert lines[0].endswith(
        "m = 0.2949287 a, n = 0.8038533 a (dQ and dsigma differ in sign: on the map m and n change places)"
    )
    assert "change places" not in place(stick_map(scene("load.Q=[1e5, -1e5]", "load.sigma=[4e8, -4e8]")))[0]


@pytest.mark.usefixtures("coarse")
def test_finite_bodies_are_said_to_be_left_out():
    lines = place(stick_map(scene("bodies.lower={width=1, height=1}")))
    assert lines[-1] == "the map shows half-planes: bodies.lower left out"


@pytest.mark.parametrize(
    ("overrides", "expected"),
    [
        (["load.Q=[-1e6, 1e6]"], "not on the map: the contact slides"),
        (["load.Q=[3e5, 3.2e5]"], "not on the map: the contact slides"),
        (["load.Q=[-1e5, 0.0, 1e5]", "load.sigma=[0.0, 1e8, 0.0]"], "not on the map: Q and sigma are out of phase"),
        (["load.sigma=[-1e10, 1e10]"], "not on the map: dsigma = 2e+10 Pa is more than 40 f p0"),
        (
            ["load.Q=[56712, 245208]", "load.sigma=[-4e8, 4e8]"],
            ": ratchets, the contact ratchets: there is no steady state",
        ),
        (["load.Q=[-1e5, 3.1e5]", "load.sigma=[-6e8, 6e8]"], ": ratchets, the contact ratchets: there is no steady"),
        (["load.Q=[1e5, 1e5]", "load.sigma=[0, 0]"], ": stuck, m = 1.0000000 a, n = 1.0000000 a"),
        (["load.Q=[0, 0]"], "large tension, m = "),
    ],
)
@pytest.mark.usefixtures("coarse")
def test_words_on_a_scene(overrides, expected):
    data = stick_map(scene(*overrides))
    lines = place(data)
    assert expected in lines[0]
    assert (data.point is None) == ("not on the map" in lines[0])
    assert "\n" not in "".join(lines)
    assert (data.point is None) != ("the scene's loads" in map_files.map_svg(data))


def stop(*_, **__):
    raise KeyboardInterrupt


@pytest.mark.slow
def test_figures_of_the_documents_are_made(tmp_path, monkeypatch, hertz):
    monkeypatch.setattr("sys.argv", ["figures.py", str(tmp_path / "figures")])
    runpy.run_path(str(DOCS / "figures.py"), run_name="__main__")
    assert names(tmp_path / "figures") == FIGURES == names(DOCS / "figures")
    for name in FIGURES:
        words = drawn(tmp_path / "figures" / name)
        scaled = {word for word in words if word.isascii() and word.startswith(("x/", "q/", "Q/", "m/"))}
        assert scaled or name == "signs.svg"  # which is drawn to no scale
        assert words == drawn(DOCS / "figures" / name)
    assert (tmp_path / "figures" / "ends.svg").read_bytes() == (hertz / "ends.svg").read_bytes()


def test_figures_are_shown_in_the_theory():
    shown = re.findall(r"^!\[[^\]]+\]\(figures/([^)]+)\)$", (DOCS / "theory.md").read_text("utf-8"), re.MULTILINE)
    assert sorted(shown) == FIGURES
