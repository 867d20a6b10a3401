"""The map over dP and dQ: regions and stick zones against single steady cycles, its files, and what is refused."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from outline import texts
from refusing import line_of

from partialslip.cli import main
from partialslip.halfplane.varying import steady_cycle
from partialslip.scene.reading import load_scene, scene_toml
from partialslip.study.map import place, stick_map, varying, varying_map
from partialslip.study.map.figure import varying_svg
from partialslip.tools.errors import InputError

P, A = 628318.5307179586, 1e-3  # of hertz-small-tension: a = 1 mm, p0 = 400 MPa, f = 0.5
BASE = load_scene("hertz-small-tension")


def scene(smaller=0.64, dQ=0.64, dsigma=0.4, mean=0.0, **tables):
    """Contacts of sqrt(smaller) and 1 mm; dQ and the mean of Q in f P, dsigma in f p0."""
    force, tension = 0.25 * P * dQ, 100e6 * dsigma
    Q = [0.5 * P * mean - force, 0.5 * P * mean + force]
    load = {"p0": None, "P": [smaller * P, P], "Q": Q, "sigma": [-tension, tension]}
    return BASE.replace({**tables, "load": {**load, **tables.get("load", {})}})


@pytest.fixture(autouse=True, scope="module")
def _coarse():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(varying, "_COUNT", 10)
        patch.setattr(varying, "_COUNT_KINKED", 3)
        yield


@pytest.fixture(scope="module")
def data():
    return varying_map(scene())


def test_the_scene_is_where_its_loads_are(data):
    assert data.point.place == pytest.approx((0.36, 0.64))
    assert data.ratio == pytest.approx(0.4 * 0.5 * 400e6 * A / (0.64 * 0.5 * P))
    lines = place(data)
    assert lines[0] == "hertz-small-tension: small tension, m = 0.7571068 a, n = 0.6571068 a"
    assert lines[1].startswith("the mean of Q can be from -")


def test_stick_zones_against_the_closed_form(data):
    """Small tension, Hertz: ((n+m)/2)^2 is the mean of a^2 less dQ/(2 f P), (n-m)/2 = -dsigma/(8 f p0)."""
    small = data.regime == "small tension"
    assert small.sum() > 20
    tension = data.ratio * np.pi / 2 * data.Q_change  # dsigma/(f p0) of the larger P
    half_width = np.sqrt((1 + data.smaller**2 - data.Q_change) / 2, where=small, out=np.ones_like(data.Q_change))
    np.testing.assert_allclose(data.smaller**2, 1 - data.P_change, rtol=1e-12)
    np.testing.assert_allclose(((data.n + data.m) / 2)[small], half_width[small], rtol=1e-9)
    np.testing.assert_allclose(((data.n - data.m) / 2)[small], -tension[small] / 8, rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    "dsigma", [pytest.param(0.4, id="small", marks=pytest.mark.slow), pytest.param(3.0, id="large")]
)
def test_regimes_against_single_steady_cycles(dsigma):
    data = varying_map(scene(dsigma=dsigma))
    seen = set()
    for row, column in [(1, 5), (1, 9), (4, 2), (5, 6), (3, 6), (9, 5)]:
        dP, dQ, regime = data.P_change[row, column], data.Q_change[row, column], data.regime[row, column]
        single = scene(1 - dP, dQ, dsigma / 0.64 * dQ)
        assert single.slides == (regime == "sliding")
        if not single.slides:
            cycle = steady_cycle(single)
            expected = set(cycle.slips) == {"never"}
            assert (regime == "no slip") == expected
            assert (regime == "part of the cycle") == (cycle.change is None and not expected)
            if cycle.change:
                assert regime == f"{'small' if cycle.change.zone.s > 0 else 'large'} tension"
                ends = -data.m[row, column] * A, data.n[row, column] * A
                np.testing.assert_allclose(cycle.stick, ends, rtol=0, atol=1e-9 * A)
        seen.add(regime)
    assert len(seen) == 4


@pytest.mark.fault
def test_stick_zones_of_the_larger_pressure_alone_are_seen(monkeypatch, data):
    monkeypatch.setattr(varying, "Mean", lambda larger, _: larger.shape)
    wrong = varying_map(scene())
    assert np.abs(wrong.m - data.m)[data.regime == "small tension"].max() > 0.01


def test_a_mean_of_Q_brings_sliding_closer(data):
    shifted = replace(data, scene=scene(mean=0.2))
    assert shifted.slides(0.0) == pytest.approx(1 / (0.5 + 0.2 / 0.64))
    for dQ, slides in ((0.99, False), (1.01, True)):
        factor = dQ * float(shifted.slides(0.36)) / 0.64
        assert scene(dQ=0.64 * factor, mean=0.2 * factor).slides is slides


def test_signs_and_the_order_of_load_points(data, monkeypatch):
    monkeypatch.setattr(varying, "_COUNT", 2)
    turned = varying_map(scene(load={"P": [P, 0.64 * P], "sigma": [20e6, -20e6]}))
    assert turned.point.mirrored
    assert not data.point.mirrored
    np.testing.assert_allclose(turned.slides(data.P_change[0]), data.slides(data.P_change[0]))
    assert "change places" in place(turned)[0]


def test_words_where_there_is_no_closed_form():
    part = varying_map(scene(dsigma=0.8))
    assert place(part) == [
        "hertz-small-tension: the left end of the contact slips at most during part of the cycle: no exact solution "
        "is known; must be solved by march"
    ]
    still = varying_map(scene(dQ=0.2, dsigma=0.0))
    assert place(still)[0].startswith("hertz-small-tension: no slip, m = 0.8")
    slides = varying_map(scene(dQ=1.5))
    assert slides.point is None
    assert "not on the map: the contact slides" in place(slides)[0]


@pytest.mark.slow
def test_pictures(data):
    words = set(texts(varying_svg(data)))
    assert {"ΔP/P", "ΔQ/(f P)", "m 0.8", "n 0.6", "no end slips", "sliding at a load point"} < words
    assert {"an end slips in part of the cycle", "the scene's loads", "n/a, stick to n"} < words


@pytest.mark.slow
def test_one_line_for_both_ends_without_tension(monkeypatch):
    monkeypatch.setattr(varying, "_COUNT", 4)
    words = set(texts(varying_svg(varying_map(scene(dsigma=0.0)))))
    assert "m/a = n/a, stick from -m to n" in words
    assert not any(word.startswith("n ") for word in words - {"no end slips"})
    assert "an end slips in part of the cycle" not in words


@pytest.mark.slow
def test_files(tmp_path, capsys):
    (tmp_path / "mine.toml").write_text(
        scene_toml(scene(profile={"kind": "flat-rounded", "b": 5e-4, "R": 0.05})), "utf-8"
    )
    out = tmp_path / "out"
    assert main(["map", str(tmp_path / "mine.toml"), "--out", str(out)]) == 0
    assert f"written: map.svg, map.csv in {out}" in capsys.readouterr().out
    table = list(csv.DictReader((out / "map.csv").read_text("utf-8").splitlines()))
    assert list(table[0]) == [
        "dP_over_P", "dQ_over_fP", "dP", "dQ", "dsigma", "m_over_a", "n_over_a", "regime",
    ]  # fmt: skip
    assert len(table) == 9
    for row in table:
        assert bool(row["m_over_a"]) == bool(row["n_over_a"]) == row["regime"].endswith("tension")
        assert float(row["dQ"]) == pytest.approx(0.5 * P * float(row["dQ_over_fP"]))
        assert float(row["dsigma"]) == pytest.approx(80e6 / (0.32 * P) * float(row["dQ"]))


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"load": {"e": 1e-5}}, "load.e = 1e-05 m: must be 0 or left out for a map over dP and dQ"),
        ({"load": {"P": P}}, "load.P: must vary for a map over dP and dQ"),
        ({"load": {"Q": [0.0, 0.0]}}, "load.Q = [0, 0] N/m: must vary for a map over dP and dQ"),
        (
            {"load": {"P": [P, P, 0.8 * P], "Q": [-1e5, 0.0, 1e5], "sigma": [0.0, 0.0]}},
            "load.Q, load.sigma, load.P: must be in phase for a map over dP and dQ",
        ),
        ({"friction": {"f": 0.0}}, "friction.f = 0: must be > 0 for a map"),
    ],
)
def test_refusals(changes, expected):
    assert expected in line_of(varying_map, scene(**changes))


def test_the_map_over_dQ_and_dsigma_needs_one_pressure():
    with pytest.raises(InputError, match=r"load\.P = .*: must be one number for a map over dQ and dsigma"):
        stick_map(scene())
