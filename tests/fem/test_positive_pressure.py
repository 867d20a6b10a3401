"""p is never negative beyond rounding, and elements are not smaller than the accuracy requires."""

import numpy as np
import pytest
from numpy.polynomial import Legendre, Polynomial
from plain import plain

import partialslip
from partialslip.tools.bars import CERTIFICATE_BAR
from partialslip_fem.mesh_solution import MeshSolution

PAD = plain(
    {"P": 300.0, "Q": [-90.0, 90.0], "sigma": [20.0, 200.0], "cycles": 4}, 0.55, (116e3, 0.32),
    {"kind": "hertz", "R": 50.0}, units="N-mm", fem={"accuracy": 1e-5}, bodies={
        "upper": {"kind": "pad", "width": 10.0, "height": 10.0},
        "lower": {"width": 40.0, "height": 20.0, "support": "roller", "pulled": True},
    },
)  # fmt: skip
SMALLEST = 5e-5  # in a: ends are known to 1e-5 a with elements of 3e-4 a, with a margin of 3 and neighbours


def solved(scene):
    return partialslip.run(scene, ["fem"]).results["fem"]


@pytest.mark.slow
def test_kinks_of_q_do_not_shrink_the_elements_at_the_ends():
    found = solved(PAD)
    x, p = found.traction.x, found.traction.p
    inside = np.abs(x) < 0.9 * found.a
    assert np.diff(found.traction.cells).min() > SMALLEST * found.a
    assert p.max() == pytest.approx(found.p0, rel=1e-3)
    assert p[inside].min() > 0.3 * found.p0
    assert found.certificate["kkt"] < CERTIFICATE_BAR


@pytest.mark.fault
def test_pressure_that_oscillates_within_cells(monkeypatch):
    """Nodal forces are positive, and nodal p is not: the certificate says so."""
    scene = partialslip.load_scene("hertz-shear", ["fem.accuracy=1e-3"])
    assert solved(scene).certificate["kkt"] < CERTIFICATE_BAR
    true = MeshSolution.pressure

    def oscillating(solution):
        p = true(solution)
        order = len(p.c) - 1
        wave = Legendre.basis(order).convert(kind=Polynomial)(Polynomial([-1, 2])).coef[::-1]  # no force on a cell
        p.c += 4 * wave[:, None] / np.diff(p.x) ** np.arange(order, -1, -1)[:, None] * (np.abs(p.x[:-1]) < 0.5)
        return p

    monkeypatch.setattr(MeshSolution, "pressure", oscillating)
    assert solved(scene).certificate["kkt"] > 0.1
