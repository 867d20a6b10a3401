"""The fully adhered contact (paper, eq. (1))."""

import numpy as np

from partialslip.arrays import Array


def adhered(x: Array, a: float, dQ: float, dsigma: float) -> Array:
    """Change of shear traction at ``x`` (m, |x| < a) if nothing slips, Pa; singular at both ends.

    dq = (dQ/pi + x dsigma/4)/sqrt(a^2 - x^2), with ``dQ`` in N/m and ``dsigma`` in Pa.
    """
    result: Array = (dQ / np.pi + x * dsigma / 4) / np.sqrt((a - x) * (a + x))
    return result
