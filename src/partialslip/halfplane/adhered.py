"""The fully adhered contact (paper, eq. (1))."""

import numpy as np
import numpy.typing as npt

from partialslip.arrays import Array


def adhered(x: npt.ArrayLike, a: float, dQ: float, dsigma: float) -> Array:
    """Change of shear traction without slip, Pa, at ``x`` (m, |x| < a, of any shape); singular at both ends.

    dq = (dQ/pi + x dsigma/4)/sqrt(a^2 - x^2): paper, eq. (1). ``a`` in m, ``dQ`` in N/m, ``dsigma`` in Pa.
    """
    x = np.asarray(x, float)
    result: Array = (dQ / np.pi + x * dsigma / 4) / np.sqrt((a - x) * (a + x))
    return result
