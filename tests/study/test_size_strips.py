"""A study of sizes of two equal strips: exact strips beside half-planes."""

import numpy as np
import pytest
from strip_scenes import A, strips

from partialslip import run
from partialslip.halfplane import contact
from partialslip.study.batch.job import Job
from partialslip.study.size import sizes, tables
from partialslip.study.size.axes import axis
from partialslip.study.size.case import STRIPS, compared_methods, solve_sized


def test_half_planes_stay_half_planes_beside_exact_strips():
    scene = strips(4 * A, width=60 * A, accuracy=1e-3)
    found = solve_sized(Job(scene, compared_methods(scene), {"bodies.*.height": 4 * A, "accuracy": 1.0}))
    assert found.run.methods["exact"].a == contact(scene.half_planes).a
    assert found.strips.methods["exact"].a == run(scene, "exact")["exact"].a
    height = axis(f"bodies.*.height={4 * A}")
    study = tables.size_study(scene, height, [found])
    plain, alike, exact = study.models
    assert exact.name == STRIPS
    assert (exact.off["m"] <= exact.mesh["m"]).all()
    assert plain.off["m"] > 10 * alike.off["m"]
    assert [row[0] for row in tables.needed_table(study)[1][:3]] == ["a"] * 3
    heads, rows = sizes.case_table([height], [found], scene.units)
    assert rows[0][heads.index("strips: a")] == exact.change["a"]


def test_the_law_of_the_contact_is_the_closed_one():
    """a/a_hp = 1 - 0.26052 (a/h)^2, and the next term falls with the fourth power."""
    heights = A * np.array([20.0, 40.0])
    plain = contact(strips(A).half_planes).a
    off = np.array([1 - contact(strips(h)).a / plain for h in heights])
    constants = off * (heights / plain) ** 2
    assert constants[1] + (constants[1] - constants[0]) / 3 == pytest.approx(0.26052, abs=2e-5)
    assert np.log2(off[0] / off[1]) == pytest.approx(2.0, abs=5e-3)
