"""Bars that mean something: none above a tenth, and the words in which they are told."""

import numpy as np
import pytest
from known import EXACT, SCENE, result, traction

from partialslip import compare
from partialslip.run.judge import Outcome
from partialslip.tools.bars import BARS, LARGEST, Asked, asked
from partialslip.tools.errors import InputError


@pytest.mark.parametrize("one", [1e-9, 2e-5, 1e-3])
def test_one_number_sets_all_bars(one):
    assert asked(one).bars == {key: share * one for key, share in BARS.items()}


def test_norms_and_sums_are_capped():
    bars = asked(0.02).bars
    assert {bars[key] for key in ("a", "left_1", "m", "n")} == {0.02}
    assert {bars[key] for key in ("P", "p", "M", "p_1", "dQ", "q", "q1", "q2")} == {0.1}
    assert max(asked(0.1).bars.values()) == LARGEST == 0.1


def test_one_number_for_each_kind():
    bars = asked((1e-3, 1e-2, 5e-2)).bars
    assert bars == {key: {"m": 1e-2, "n": 1e-2}.get(key, 1e-3 if BARS[key] == 1 else 5e-2) for key in BARS}
    assert asked(None) is None
    assert asked(asked(0.01)) == asked(0.01) == asked((0.01,)) == Asked(0.01, 0.01)


@pytest.mark.parametrize(
    "wrong", [0.0, -1e-3, 0.1000001, 1e9, np.inf, np.nan, (1e-3, 1e-3), (), (1e-3, 1e-3, 0.2), (0.2, 1e-3, 1e-3)]
)
def test_no_bar_is_above_a_tenth(wrong):
    with pytest.raises(InputError, match=r"must be one number, or three .* > 0 and <= 0.1"):
        asked(wrong)
    with pytest.raises(InputError, match=r"<= 0.1"):
        compare(result(), EXACT, SCENE, wrong)


@pytest.mark.parametrize(("accuracy", "text"), [
    (2e-5, "within 2e-05 of a, 2e-04 of p, 3e-04 of q"), (1e-3, "within 0.1 % of a, 1 % of p, 1.5 % of q"),
    (0.02, "within 2 % of a, 10 % of p and q"), ((1e-3, 0.02, 0.05), "within 0.1 % of a, m and n 2 %, 5 % of p and q"),
])  # fmt: skip
def test_what_was_asked_in_words(accuracy, text):
    assert asked(accuracy).text == text


def test_at_the_largest_bar_a_spoiled_table_is_missed():
    """The largest bar passed 5 % of P without any shear."""
    for spoiled in (traction(p=0.05, q=0.0), traction(q=0.0), traction(p=0.85), traction(q=1.15)):
        assert compare(result(of=spoiled), EXACT, SCENE, 0.1).outcome is Outcome.MISSED
    assert compare(result(), EXACT, SCENE, 0.1).outcome is Outcome.PASSED


@pytest.mark.parametrize(
    ("m", "n", "factor"), [(0.3, 0.3, 3.9), (0.5, 0.5, 5.0), (0.8, 0.2, 4.8), (0.8, 0.8, 10.3), (0.95, 0.95, 34)]
)
def test_what_an_end_that_is_off_does_to_norms(m, n, factor):
    """Relative errors of p and q of Hertz and small tension over the error of all ends (docs/measures.md)."""
    d, angle = 2e-5, np.pi * (np.arange(200_000) + 0.5) / 200_000
    x, weight = -1.001 * np.cos(angle), 1.001 * np.sin(angle)

    def tractions(off):
        a, half = 1 + off, (m + n) / 2 + off
        p, stuck = (
            np.sqrt(np.maximum(1 - ((x - at) / c) ** 2, 0)) * c / a**2 for at, c in ((0, a), ((n - m) / 2, half))
        )
        return p, p - stuck

    for before, after, expected in zip(tractions(0.0), tractions(d), (3.0, factor), strict=True):
        off = np.sqrt(np.sum(weight * (after - before) ** 2) / np.sum(weight * before**2))
        assert off / d == pytest.approx(expected, rel=0.03)
