"""Your code in CI: a test that fails when the tractions of problem PS-02 get worse than grade C.

pytest examples/grade_in_ci
"""

import numpy as np

from partialslip.benchmark import grade


def my_code():
    """x, p, q1 and q2 of PS-02 in SI units. Here Cattaneo's formula at 401 points stands for a run of your code."""
    a, c, fp0 = 2.066977e-4, 1.060727e-4, 0.3 * 418.1041e6
    x = np.linspace(-1.1, 1.1, 401) * a
    outer, inner = (np.sqrt(np.clip(1 - (x / end) ** 2, 0, None)) for end in (a, c))
    q2 = fp0 * (outer - c / a * inner)
    return x, fp0 / 0.3 * outer, -q2, q2


def test_ps_02():
    found = grade("PS-02", *my_code())
    assert found.grade <= "C", found
    assert found.errors["m"] < 1e-3
