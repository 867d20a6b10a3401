"""Bars: the largest allowed error by quantity, used by the judge and by the methods' error estimates."""

#: Bars by quantity, in multiples of the accuracy asked for: ends in a, tractions in relative L2. All other quantities
#: have no bar.
BARS = {
    **dict.fromkeys(("a", "left", "right", "left_1", "right_1", "left_2", "right_2", "m", "n"), 1.0),
    **dict.fromkeys(("P", "P_1", "M", "M_1", "p", "p_1"), 10.0),
    **dict.fromkeys(("dQ", "q", "q1", "q2"), 15.0),
}

# Errors of q are relative to the larger of q's norm and LEAST_SHEAR times f p's norm.
LEAST_SHEAR = 1e-3

# A converged solver leaves residuals at rounding level, which is 1e-9 f p0 on the finest meshes.
CERTIFICATE_BAR = 1e-7
