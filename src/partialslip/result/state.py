"""The state of the contact at the end of a load path, from which a later run continues. SI units."""

import tokenize
import zipfile
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from partialslip.scene import Scene
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import read_bytes
from partialslip.tools.shown import Short

if TYPE_CHECKING:
    from scipy.interpolate import PPoly

_ARRAYS = ("loads", "cells", "p", "q")
_ERROR = "q_error"  # files of earlier versions do not have it
# an encrypted or unknown kind of compression is a RuntimeError
_SPOILED = (OSError, KeyError, ValueError, EOFError, AttributeError, TypeError, MemoryError, RuntimeError,
            SyntaxError, tokenize.TokenError, zipfile.BadZipFile, zlib.error)  # fmt: skip
_LARGEST = 100_000_000  # limit: bytes of a file, and of the arrays in it
_HELD = 1e-6  # limit: tolerance of equilibrium, relative to P
# limit: tolerance of the moment, relative to P sqrt(A R P): cells of constant pressure have no better one
_TURNED = 1e-3
_SAME = 1e-9  # limit: relative difference of P and A allowed as rounding


@dataclass(frozen=True, repr=False)
class State(Short):
    """Loads and tractions at one moment.

    At given P and M, the shear traction holds the whole effect of earlier loads.

    Parameters
    ----------
    P, A : float
        Normal force, N/m, and compliance of the pair, 1/Pa, of the scene that was solved.
    Q, sigma : float
        Tangential force, N/m, and differential bulk tension, Pa.
    p, q : PPoly
        Tractions, Pa, over the cells of the contact line, m.
    sigma_slope : float
        Slope of the bulk tension along x, Pa/m.
    q_error : float or None
        Estimated error of q: its L2 norm, relative to that of p. None where it is not known.
    """

    P: float
    A: float
    Q: float
    sigma: float
    p: "PPoly"
    q: "PPoly"
    sigma_slope: float = 0.0
    q_error: float | None = None

    def check(self, scene: Scene) -> None:
        """Raise InputError if ``scene`` cannot continue from this state: P or M at the last load point, with which the
        path begins, or the materials differ."""

        def check(name: str, mine: float, its: float, shown: Callable[[float], str], off: float = 0.0) -> None:
            if not abs(mine - its) <= max(_SAME * abs(its), off):
                raise InputError(
                    f"state: is of {name} = {shown(mine)}; the scene has {shown(its)}; the two must be equal"
                )

        check("P", self.P, scene.pressing[-1].P, lambda P: scene.units.labelled(P, "N/m", 10))
        M = scene.pressing[-1].M
        # bodies that do not turn carry a moment where shear or bending moves their pressure
        pin = scene.pin
        if M is not None and (not scene.even or pin is not None or (scene.material.alike and not scene.finite)):
            moment = _moment(self.p) + (pin or 0.0) * self.Q
            check("M", moment, M, lambda M: scene.units.labelled(M, "N", 10), _TURNED * self.P * scene.length)
        check("A", self.A, scene.material.A, lambda A: f"{A:.10g} 1/Pa")

    def save(self, path: Path) -> None:
        """Write the state to ``path`` as an .npz file."""
        slope = [self.sigma_slope] if self.sigma_slope else []
        loads = np.array([self.P, self.A, self.Q, self.sigma, *slope])
        with path.open("wb") as file:
            arrays: dict[str, Any] = {"loads": loads, "cells": self.q.x, "p": self.p.c, "q": self.q.c}
            np.savez(file, **arrays if self.q_error is None else arrays | {_ERROR: self.q_error})


def load_state(path: str | Path) -> State:
    """Read a state from ``path``, a file written by :meth:`State.save`.

    Raises
    ------
    InputError
        If the file cannot be read, holds no state, or holds tractions that are not in equilibrium with the loads.
    """
    content = read_bytes(path, _LARGEST)
    try:
        with np.load(BytesIO(content), allow_pickle=False) as file:
            if sum(part.file_size for part in file.zip.infolist()) > _LARGEST:
                raise ValueError
            there = [*_ARRAYS, *([_ERROR] if _ERROR in file else [])]
            arrays = {name: file[name].astype(float, casting="safe") for name in there}
    except _SPOILED:
        raise InputError(f"{path}: not a state that partialslip has saved") from None
    loads, cells, p, q = (arrays[name] for name in _ARRAYS)
    known = arrays.get(_ERROR)
    if not _sound(loads, cells, p, q) or not (known is None or (known.shape == () and 0 <= known < np.inf)):
        raise InputError(f"{path}: not a state that partialslip has saved")
    from scipy.interpolate import PPoly  # takes long to import

    P, A, Q, sigma, slope = [*loads.tolist(), 0.0][:5]
    state = State(P, A, Q, sigma, PPoly(p, cells), PPoly(q, cells), slope, None if known is None else float(known))
    held = [float(traction.integrate(cells[0], cells[-1])) for traction in (state.p, state.q)]
    if not np.allclose(held, (P, Q), rtol=0.0, atol=_HELD * abs(P)):
        raise InputError(
            f"{path}: tractions sum to P = {held[0]:g} and Q = {held[1]:g}; must equal the loads, {P:g} and {Q:g}"
        )
    return state


def _moment(p: "PPoly") -> float:
    """Moment int x p dx of the pressure ``p``."""
    from scipy.interpolate import PPoly  # takes long to import

    left = p.x[:-1]
    arm = np.zeros((len(p.c) + 1, len(left)))
    arm[:-1] += p.c
    arm[1:] += left * p.c
    return float(PPoly(arm, p.x).integrate(p.x[0], p.x[-1]))


def _sound(loads: Array, cells: Array, *coefficients: Array) -> bool:
    if not all(np.isfinite(array).all() for array in (loads, cells, *coefficients)):
        return False
    line = cells.ndim == 1 and len(cells) > 1 and cells[0] < 0 < cells[-1] and bool((np.diff(cells) > 0).all())
    shapes = line and all(c.ndim == 2 and len(c) >= 1 and c.shape[1] == len(cells) - 1 for c in coefficients)
    return loads.shape in ((4,), (5,)) and shapes
