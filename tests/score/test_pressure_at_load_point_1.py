"""Tables of bodies between which shear changes the pressure: p1, the pressure at load point 1, is another than p."""

from pathlib import Path

import numpy as np
import pytest
from tables import written

import partialslip
from partialslip.codes.score.method import scored
from partialslip.codes.score.read import read_tractions

PAD = Path(__file__).parents[2] / "docs" / "scenes" / "finite-pad.toml"
OFF = 0.04  # of a: how far shear moves the contact, to the left at load point 1, to the right at load point 2


def read_with(names, folder):
    scene = partialslip.load_scene(PAD)
    a, p0 = 2e-4, 4e8
    x = np.linspace(-1.2, 1.2, 241)
    p, p1 = (np.sqrt(np.maximum(1 - (x - at) ** 2, 0)) for at in (OFF, -OFF))
    q = 0.2 * np.minimum(p, p1)
    columns = {"x": x * a, "p": p * p0, "p1": p1 * p0, "q1": -q * p0, "q2": q * p0}
    file = written(folder / "table.csv", [columns[name] for name in names], ",".join(names))
    return scored(scene, read_tractions(file, scene), "table.csv", "table.csv")


def test_the_ends_at_load_point_1_are_those_of_p1(tmp_path):
    found = read_with(("x", "p", "p1", "q1", "q2"), tmp_path)
    for ends, at in zip(found.contact_ends, (-OFF, OFF), strict=True):
        assert np.array(ends) / found.a == pytest.approx([at - 1, at + 1], abs=1e-3)
    assert "p_1" not in found.undetermined


def test_without_p1_nothing_is_told_of_load_point_1(tmp_path):
    found = read_with(("x", "p", "q1", "q2"), tmp_path)
    assert {"left_1", "right_1", "p_1"} <= set(found.undetermined)
