"""What slips, and with which coefficient of friction, from tractions alone.

Where it slips, |dq| = 2 f p, whatever f the tractions were made with: next to the contact's ends |dq|/(2 p) is flat.
"""

from typing import NamedTuple

import numpy as np

from partialslip.arrays import Array

_POINTS = (3, 4, 5, 6, 8, 11, 16, 24, 36, 54, 80, 120, 180, 270, 400, 600, 900)
_FLAT = 0.02  # relative uncertainty of f, above which |dq|/(2 p) is not flat
_OWN = 2e-3  # likewise, up to which each side may have its own
_APART = 3.0  # times the uncertainty: then two values differ
_ROUNDING = 1e-12
_PRESSED = 0.2  # of the largest p: less of it, at the ends, tells nothing of f
_TOP = 3  # points with the largest |dq|/(2 p)


class Friction(NamedTuple):
    """Coefficient of friction in a slip zone: ``f``, how far it may be off, the ``sign`` of dq there, and the standard
    deviation of 2 f p - |dq| in it, Pa. ``seen`` says whether |dq|/(2 p) is flat there."""

    f: float
    uncertainty: float
    sign: int
    scatter: float
    seen: bool


def frictions(p: Array, dq: Array, asked: float) -> tuple[Friction, Friction]:
    """Friction at the left and right ends of the contact, from the points (n,) in it.

    Where no side shows one, it is the one ``asked`` for, to within what the largest |dq|/(2 p) leaves open; where one
    side does, it is the other's, too.
    """
    sides = _outer(p, dq), _outer(p[::-1], dq[::-1])
    seen = [side for side in sides if side.seen]
    if not seen:
        pressed = p > _PRESSED * p.max()
        shares = np.sort(np.abs(dq[pressed]) / (2 * p[pressed]))
        top = float(np.median(shares[-_TOP:]))
        left, right = (side._replace(f=asked, uncertainty=abs(asked - top)) for side in sides)
        return left, right
    known = min(seen, key=lambda side: side.uncertainty)
    left, right = (_shared(side, known) for side in sides)
    return left, right


def _shared(side: Friction, known: Friction) -> Friction:
    """The friction of a side: its own where that is certain, or the one that is known best."""
    apart = abs(side.f - known.f)
    if side.seen and side.uncertainty <= _OWN * side.f and apart > _APART * side.uncertainty:
        return side._replace(uncertainty=float(np.hypot(side.uncertainty, apart / _APART)))
    return known._replace(sign=side.sign, scatter=side.scatter if side.seen else known.scatter, seen=side.seen)


def _outer(p: Array, dq: Array) -> Friction:
    """Friction from the first points, as many of them as make it certain: of fewer the noise tells more, of too many
    some stick."""
    best = None
    for count in (count for count in _POINTS if count <= len(p)):
        P, Q = 2 * p[:count], dq[:count]
        f = float(Q.sum() / P.sum())
        scatter = float(np.linalg.norm(Q - f * P)) / np.sqrt(count - 1)
        half = (count + 1) // 2
        drift = abs(float(Q[:half].sum() / P[:half].sum() - Q[count - half :].sum() / P[count - half :].sum()))
        error = (1 + 2 / (count - 2)) * scatter * np.sqrt(count) / P.sum()
        uncertainty = float(np.hypot(error, drift)) + _ROUNDING * abs(f)
        if best is None or uncertainty < best.uncertainty:
            seen = uncertainty <= _FLAT * abs(f)
            best = Friction(abs(f), uncertainty, 1 if f >= 0 else -1, scatter, seen)
    assert best is not None
    return best
