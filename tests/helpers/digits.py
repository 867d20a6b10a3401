"""Pressures in as many digits as mpmath is set to."""

import mpmath as mp


def pressure(flat):
    """p/p0 as in section 2 of the theory, under a profile with a flat of the half-width ``flat``; 0 is Hertz."""
    if not flat:
        return lambda x: mp.sqrt(max((1 - x) * (1 + x), 0))
    b = mp.mpf(flat)
    end = mp.asin(b)
    psi = mp.pi / 2 - end
    scale = 2 * psi - mp.sin(2 * psi)

    def p(x):
        if abs(x) >= 1:
            return mp.mpf(0)
        angle = mp.asin(x)
        plus, minus = angle + end, angle - end
        if plus == 0 or minus == 0:  # the limit of the two logarithms
            logarithms = 2 * b * mp.log(b)
        else:
            logarithms = mp.sin(angle) * mp.log(abs(mp.sin(plus) / mp.sin(minus)))
            logarithms += b * mp.log(abs(mp.tan(plus / 2) * mp.tan(minus / 2)))
        return (2 * psi * mp.cos(angle) + logarithms) / scale

    return p
