"""Points near a contact."""

import numpy as np


def places(result, count=1000):
    """Points within 3 a of the middle, and not within 0.01 a of the ends of the contact and of the stick zone."""
    random = np.random.default_rng(0)
    x, y = random.uniform(-3, 3, (2, 2 * count)) * result.a
    ends = [*result.ends[0], *result.ends[1], -result.m, result.n]
    kept = np.all([np.hypot(x - end, y) > 0.01 * result.a for end in ends], axis=0)
    return x[kept][:count], y[kept][:count]
