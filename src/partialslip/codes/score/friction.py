"""Coefficient of friction in the slip zones, from tractions alone.

In slip |dq| = 2 f p, whatever f the tractions were computed with. Next to the contact's ends |dq|/(2 p) is therefore
constant.
"""

from typing import NamedTuple

import numpy as np

from partialslip.codes.score.kinds import RUNNING
from partialslip.tools.arrays import Array

# accuracy: points of the windows that are tried
_COUNTS = (3, 4, 5, 6, 8, 11, 16, 24, 36, 54, 80, 120, 180, 270, 400, 600, 900)
_FLAT = 0.02  # accuracy: relative uncertainty of f above which |dq|/(2 p) does not count as constant
_OWN = 2e-3  # accuracy: relative uncertainty of f up to which a side keeps a value different from the other side's
_APART = 3.0  # accuracy: difference of two values of f, in their uncertainty, above which they differ
_F_ROUNDING = 1e-12  # accuracy: least relative uncertainty of f
_PRESSED = 0.2  # accuracy: of the largest p: where p is less, |dq|/(2 p) is too noisy to bound f
_FLATTER = 0.1  # accuracy: of the uncertainty of f: what averaging p, too, must leave of it to be right
_TOP = 3  # accuracy: number of points with the largest |dq|/(2 p) that bound f


class FrictionRead(NamedTuple):
    """Friction read in a slip zone: coefficient ``f`` and its ``uncertainty``, ``sign`` of dq, and the ``scatter``
    (standard deviation) of 2 f p - |dq|, Pa. ``seen`` tells whether |dq|/(2 p) is constant in the zone."""

    f: float
    uncertainty: float
    sign: int
    scatter: float
    seen: bool


def alike(p: Array, dq: Array, inside: slice) -> tuple[Array, Array, int]:
    """``p`` and ``dq``, (n,), at the points in contact (``inside``), and the number of points that they are averaged
    over: p is averaged, too, where dq alone was. It shows in slip: |dq| is then in proportion to the averaged p."""

    def of(count: int) -> Array:
        return np.convolve(p, np.ones(count) / count, "same")[inside] if len(p) >= count else p[inside]

    def unsure(p: Array) -> float:
        return min(side.uncertainty / max(side.f, 1e-300) for side in (_outer(p, q), _outer(p[::-1], q[::-1])))

    q = dq[inside]
    best = min(RUNNING, key=lambda count: unsure(of(count)))
    return (of(best), q, best) if unsure(of(best)) < _FLATTER * unsure(p[inside]) else (p[inside], q, 1)


def frictions(p: Array, dq: Array, asked: float) -> tuple[FrictionRead, FrictionRead]:
    """Return the friction next to the left and to the right end of the contact.

    A side without a slip zone gets the coefficient of the other side. If neither side has one, both get the
    coefficient ``asked`` for; its uncertainty is the difference from the largest |dq|/(2 p).

    Parameters
    ----------
    p, dq : (n,) arrays
        Tractions at the points in contact, Pa.
    asked : float
        The scene's coefficient of friction.
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


def _shared(side: FrictionRead, known: FrictionRead) -> FrictionRead:
    """Return the friction of one ``side``: its own coefficient if certain and different, else the best ``known``."""
    apart = abs(side.f - known.f)
    if side.seen and side.uncertainty <= _OWN * side.f and apart > _APART * side.uncertainty:
        return side._replace(uncertainty=float(np.hypot(side.uncertainty, apart / _APART)))
    return known._replace(sign=side.sign, scatter=side.scatter if side.seen else known.scatter, seen=side.seen)


def _outer(p: Array, dq: Array) -> FrictionRead:
    """Return the friction from the first points; their number minimises the uncertainty.

    With fewer points noise matters more; with more some of them may stick.
    """
    best = None
    for count in (count for count in _COUNTS if count <= len(p)):
        P, Q = 2 * p[:count], dq[:count]
        f = float(Q.sum() / P.sum())
        scatter = float(np.linalg.norm(Q - f * P)) / np.sqrt(count - 1)
        half = (count + 1) // 2
        drift = abs(float(Q[:half].sum() / P[:half].sum() - Q[count - half :].sum() / P[count - half :].sum()))
        error = (1 + 2 / (count - 2)) * scatter * np.sqrt(count) / P.sum()
        uncertainty = float(np.hypot(error, drift)) + _F_ROUNDING * abs(f)
        if best is None or uncertainty < best.uncertainty:
            seen = uncertainty <= _FLAT * abs(f)
            best = FrictionRead(abs(f), uncertainty, 1 if f >= 0 else -1, scatter, seen)
    assert best is not None
    return best
