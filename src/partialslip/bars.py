"""Bars: what may be off by how much. The judge asks them, and the methods when they say how well they know a value."""

#: Bars by quantity, in multiples of the accuracy asked for: ends in a, tractions in relative L2. Quantities that are
#: not listed have no bar.
BARS = {
    **dict.fromkeys(("a", "left", "right", "left_1", "right_1", "left_2", "right_2", "m", "n"), 1.0),
    **dict.fromkeys(("P", "P_1", "p", "p_1"), 10.0),
    **dict.fromkeys(("dQ", "q", "q1", "q2"), 15.0),
}

# Errors of q are relative to q's norm, or to so much of f p's norm where q's is less.
LEAST_SHEAR = 1e-3

# A solver that has closed leaves residuals at rounding; on the finest meshes that is 1e-9 f p0.
CERTIFICATE_BAR = 1e-7
