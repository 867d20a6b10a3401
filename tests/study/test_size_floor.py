"""What remains of a difference however large the varied sizes are: no law leads below it."""

import math
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from size_entries import X, made_sizes, scene

import partialslip
from partialslip.study.batch.ledger import Ledger
from partialslip.study.size import sizes as size
from partialslip.study.size import tables
from partialslip.study.size.axes import axis as read
from partialslip.study.size.case import Sized
from partialslip.study.size.law import Floor, Kind, PointStatus, trend

FLOOR = 5.5e-3


@pytest.mark.parametrize("sign", [1, -1])
def test_what_remains_at_an_infinite_size_is_no_part_of_the_law(sign):
    """A pad that stays leaves 0.55 % however large the specimen is: levels below it are never reached."""
    found = trend(made_sizes(sign * (FLOOR + 0.3 * X**-1.5), 1e-6, remains=sign * FLOOR, error=1e-6), "m")
    assert found.law.k == pytest.approx(1.5, abs=0.01)
    assert pytest.approx(0.3, rel=0.02) == found.law.C
    assert found.law.at(X) == pytest.approx(FLOOR + 0.3 * X**-1.5, rel=1e-3)
    assert [each.kind for each in found.needed] == [Kind.INTERPOLATED, Kind.NEVER, Kind.NEVER]
    assert str(found.needed[1]) == "never: 0.55 % remains"


def test_without_what_remains_there_is_no_law_and_no_size_beyond():
    found = trend(made_sizes(16 * X**-2.0, 0.0, remains=None), "m")
    assert found.law is None
    assert set(found.points) == {PointStatus.NO_LIMIT}
    assert [str(each) for each in found.needed][1:] == ["126, interpolated", "> 128"]


def test_a_level_just_above_what_remains_takes_a_larger_size():
    """0.1 % + 1.6 / s^2 falls to 0.11 % at 126, to 0.101 % at 1265: nearer to what remains than its error no size is
    known."""
    law = trend(made_sizes(1e-3 + 1.6 * X**-2.0, 0.0, remains=1e-3, error=1e-6), "m").law
    assert law.size_for(1.1e-3) == pytest.approx((math.sqrt(1.6e4),) * 3, rel=0.02)
    assert law.size_for(1.0005e-3)[2] == math.inf


def test_a_size_that_is_solved_below_a_level_which_more_remains_than_is_no_answer():
    """As m of mypad: 0.32 % at 20 mm, on the way through 0 to 0.55 %: signs count, and no law leads there."""
    x = np.array([5.0, 10.0, 20.0])
    found = trend(made_sizes([-1.34e-2, -6.5e-3, -3.2e-3], 1e-6, x, -5.5e-3, 1e-6), "m")
    assert found.law is None
    assert [str(each) for each in found.needed] == ["6.62, interpolated", *["never: 0.55 % remains"] * 2]
    shallow = made_sizes([-1.34e-2, -1.2e-2, 8e-3], 1e-6, x, -1.1e-2, 1e-6)
    assert str(trend(shallow, "m").needed[0]) == "never: 1.1 % remains"


def test_the_answer_says_from_which_size_on():
    """Interpolated, never, bounded from either side."""
    found = trend(made_sizes(FLOOR + 0.3 * X**-1.5, 1e-6, remains=FLOOR, error=1e-6), "m")
    assert tables._from_size(found.needed[0]) == f" from {found.needed[0].short} on"
    assert tables._from_size(found.needed[1]) == ": never (0.55 % remains)"
    unknown = trend(made_sizes(16 * X**-2.0, 0.0, remains=None), "m")
    assert tables._from_size(unknown.needed[2], "mm") == ": not up to 128 mm"
    small = trend(made_sizes(1e-5 * X**-2.0, 0.0, remains=None), "m")
    assert tables._from_size(small.needed[0]) == f" from {X.min():.4g} on at the latest"


def test_a_difference_that_grows_with_the_size_has_no_rest_that_remains():
    """A specimen of constant width that is high as 160 widths bends under Q, and the contact rolls: p differs wholly,
    which is not what remains of the 0.3 % at 16 a."""
    x = np.array([4.0, 8.0, 16.0])
    found = trend(made_sizes([1.4e-2, 6e-3, 3e-3], 1e-6, x, 1.0, 1e-4), "m")
    assert found.floor is None
    assert found.law is None
    assert found.points[-1] is PointStatus.NO_LIMIT
    assert Kind.NEVER not in {each.kind for each in found.needed}


def test_points_on_the_floor_have_no_part_in_the_exponent():
    """The last points of this sweep show an exponent of 0 to the eye."""
    x = np.geomspace(4, 16384, 13)
    found = trend(made_sizes(1e-3 + 0.3 * x**-2.0, 1e-6, x, 1e-3, 1e-6), "m")
    assert found.law.k == pytest.approx(2, abs=0.05)
    assert found.points[-2] is PointStatus.FLOOR
    assert max(found.law.sizes) < 200


@pytest.mark.fault
def test_a_law_without_what_remains_promises_a_size(monkeypatch):
    """m of a specimen under a pad that stays, solved at 2 to 20 mm: with the floor left out, the law promises 0.1 %
    from about 50 mm on, where 0.55 % remains (solved at 54 and 80 mm)."""
    x = np.geomspace(2, 20, 9)
    sizes = made_sizes(-3.2e-3 * (x / 20) ** -1.15, 1e-6, x, -FLOOR, 1e-6)
    assert trend(sizes, "m").needed[1].kind is Kind.NEVER
    monkeypatch.setattr("partialslip.study.size.law._floor", lambda *_: Floor(0.0, 0.0, 0.0))
    promised = trend(sizes, "m").needed[1]
    assert promised.kind is Kind.EXTRAPOLATED
    assert 40 < promised.size < 70


@pytest.mark.slow
def test_a_pad_that_stays_leaves_a_part_however_large_the_specimen_is(tmp_path):
    """Alone at sizes up to 20 mm, m seemed to come within 0.1 % at 53 mm; the pad leaves 0.55 %."""
    pad = partialslip.parse_scene({
        "name": "pad", "units": "N-mm", "material": {"E": 116e3, "nu": 0.32}, "profile": {"kind": "hertz", "R": 60},
        "friction": {"f": 0.6}, "load": {"P": 250, "Q": [-100, 100], "sigma": [30, 300]}, "fem": {"accuracy": 3e-3},
        "bodies": {"upper": {"kind": "pad", "width": 10, "height": 10},
                   "lower": {"width": 40, "height": 5, "support": "roller", "pulled": True}},
    })  # fmt: skip
    axis, ledger = read("bodies.lower.height=5,10,20"), Ledger(tmp_path / "ledger.jsonl")
    with ThreadPoolExecutor(1) as executor:
        found = size.measure(pad, [axis], ledger, executor, control=False)
    study = tables.size_study(pad, axis, found)
    m = next(trend for trend in study.models[0].trends if trend.quantity == "m")
    assert abs(m.floor.value) == pytest.approx(5.5e-3, abs=m.floor.error)
    assert m.needed[1].kind is Kind.NEVER
    assert not any(each.kind is Kind.EXTRAPOLATED for trend in study.models[0].trends for each in trend.needed)
    stays = "bodies.upper.width, bodies.upper.height, bodies.lower.width and the slopes of the profile stay"
    assert f"infinite size: solved at 2000; {stays}" in study.remarks


def test_a_size_that_a_scene_cannot_have_is_told_and_fails_nothing(tmp_path, monkeypatch):
    """A pad no wider than its profile: what remains is not known, and the study says so."""
    monkeypatch.setattr(size, "work_through", lambda *_: None)
    key, pad = "bodies.upper.width", scene().replace({"bodies.upper": {"kind": "pad", "width": 0.01, "height": 0.01}})
    monkeypatch.setattr(Ledger, "read", lambda *_: Sized(labels={key: 4.0, "accuracy": 1.0}, error="too narrow"))
    axis = read(f"{key}=4a,8a")
    assert axis.limit == 800
    assert read("load.P=4,8").limit == math.inf
    (*_, told) = size.measure(pad, [axis], Ledger(tmp_path / "ledger.jsonl"), None, control=False)
    assert told.labels[key] == 800
    assert size.at_limit([axis], told)
    assert "the profile's width" in told.error
    assert "what remains at an infinite size is not known" in tables.size_study(pad, axis, [told]).remarks[-1]
