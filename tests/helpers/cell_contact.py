"""A contact of a half-plane on graded cells, and its loads, scaled: a = f = A = 1, forces in f P."""

import numpy as np

from partialslip.friction.load_path import Path
from partialslip.halfplane.hertz import HertzShape
from partialslip.march.cells import compliance, forces, graded_cells


def cells(shape=None, points=(-1, 1), size=1e-2, growth=0.1):
    """Compliance, displacements under tension and bound on graded cells: a = f = A = 1, forces in f P."""
    vertices = graded_cells(np.array(points, float), size, growth)
    x = (vertices[1:] + vertices[:-1]) / 2
    return vertices, compliance(vertices / 2), np.array([x, x**2 / 2]), forces(shape or HertzShape(), vertices)


def loads(Qf, sf, **more):
    """Fully reversed loads (Q_f, s_f), scaled as :func:`cells` is: p0 = 2 P/(pi a)."""
    Q, strain = Qf, sf / (2 * np.pi)
    return Path(((-Q, -strain / 2, 0.0), (Q, strain / 2, 0.0)), (0, 1), True, 60, 1, settled=1e-7, **more)
