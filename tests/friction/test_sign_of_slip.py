"""The sign of slip beside the stick zone, where the outermost node does not change its shear."""

import numpy as np
import pytest

from partialslip.friction.zone_ends import read_stick_zone


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_an_outermost_node_without_shear_decides_nothing(sign):
    """q = f p less the same of a narrower contact; the nodes at both ends of the line are open."""
    vertices = np.sin(np.linspace(-1, 1, 401) * np.pi / 2)
    x = (vertices[1:] + vertices[:-1]) / 2
    bound = np.sqrt(1 - x**2) * np.diff(vertices)
    change = 2 * sign * (bound - np.sqrt(np.maximum(0.3**2 - x**2, 0)) * np.diff(vertices))
    bound[[0, -1]] = change[[0, -1]] = 0.0
    found = read_stick_zone(x, bound, change, vertices, lambda forces: forces)
    assert found.signs == (sign, sign)
    assert (found.left, found.right) == pytest.approx((-0.3, 0.3), abs=1e-3)  # a cell is 7e-3 wide
