"""Profiles as measured: a file of points, smoothed to a convex gap.

The gap is the integral of a slope that is linear between points one smoothing length apart, as in a tabulated profile.
The slope must not decrease. Of all such gaps the nearest one to the points is taken, by least squares.
"""

import re
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import msgspec
import numpy as np

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.inputfile import read_text
from partialslip.scene.table import LARGEST, SMALLEST, Positive, Table
from partialslip.units import LENGTHS

if TYPE_CHECKING:
    from partialslip.scene import Scene
    from partialslip.scene.reading import AnyScene

_LARGEST = 20_000_000  # limit: bytes of a file of points
_FEWEST = 10  # limit: points
_COARSEST, _MOST = 3, 1000  # accuracy: intervals and points of a table
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?")
_BRACKETS = re.compile(r"\[([^\[\]]*)\]|\(([^()]*)\)")
_COLUMNS = 2  # fixed: x and gap
_SURE = 5.0  # accuracy: standard deviations of a mean over a smoothing length that are not taken for noise
_ROUNDING = 1e-12  # accuracy: misfit, relative to the largest gap, that is not taken for noise
# msgspec 0.20 fails on a union of a number and a tuple of fixed length
ColumnUnit = Positive | Annotated[tuple[Positive, ...], msgspec.Meta(min_length=2, max_length=2)]


class ProfileFile(Table, frozen=True, kw_only=True):
    """Keys of a profile from a file.

    ``file`` has the columns x and gap; ``unit`` (m) is that of its numbers, or of each column (default: the units in
    the heading of the file, such as ``x [mm], gap [um]``, else the scene's unit of length); ``smooth`` (m) is the
    smoothing length, and ``noise`` (m) the standard deviation of the gaps (default: estimated).
    """

    file: Annotated[str, msgspec.Meta(min_length=1)]
    smooth: Positive
    unit: ColumnUnit | None = None
    noise: Positive | None = None


class Measured(Table, frozen=True, kw_only=True):
    """How a table was made from a file: number of ``points``, ``unit`` of the columns x and gap (m), smoothing length
    ``smooth`` (m), standard deviation ``noise`` of the gaps (m), ``offset`` of the gaps (m), which has no effect, and
    ``misfit``, the root mean square difference between points and table (m)."""

    file: str
    points: int
    unit: tuple[float, float]
    smooth: float
    noise: float
    offset: float
    misfit: float


class _Fit(NamedTuple):
    """Table (k,) nearest to points, and its values ``at`` the points."""

    x: Array
    gap: Array
    at: Array


def tabulated(keys: ProfileFile, length: float = 1.0) -> dict[str, Any]:
    """Return x, gap and ``measured`` of a tabulated profile from a file.

    Parameters
    ----------
    keys : ProfileFile
        Lengths in a unit of ``length``, m.
    length : float

    Raises
    ------
    InputError
        If the file is no table of two columns, its heading has other units than ``keys``, or no convex gap follows the
        points within the noise.
    """
    unit = _unit(keys, length)
    x, gap = read_points(keys.file, unit)
    free, fit = (_fitted(x, gap, keys.smooth, convex) for convex in (False, True))
    spare = max(len(x) - len(fit.x) - 1, 1)
    scatter = float(np.sqrt(np.sum((gap - free.at) ** 2) / spare))
    noise = keys.noise or scatter
    _check(x, gap - fit.at, keys, max(noise, _ROUNDING * float(np.ptp(gap))))
    return {
        "x": fit.x.tolist(),
        "gap": (fit.gap - fit.gap.min()).tolist(),
        "measured": {
            "file": keys.file,
            "points": len(x),
            "unit": list(unit),
            "smooth": keys.smooth,
            "noise": noise,
            "offset": float(fit.at.min()),
            "misfit": float(np.sqrt(np.mean((gap - fit.at) ** 2))),
        },
    }


def _unit(keys: ProfileFile, length: float) -> tuple[float, float]:
    """Units of the columns x and gap, in ``length``."""
    words = _headings(keys.file)
    stated = None
    if words:
        known = [LENGTHS.get(word.strip().lower()) for word in words]
        if keys.unit is None and None in known:
            shown = " and ".join(f"[{word}]" for word in words)
            allowed = ", ".join(dict.fromkeys(LENGTHS))
            raise InputError(
                f"profile.file: {keys.file}: units {shown} in the heading: must be of {allowed}, or give profile.unit"
            )
        stated = None if None in known else [factor / length for factor in known if factor]
    if keys.unit is None:
        return (stated[0], stated[-1]) if stated else (1.0, 1.0)
    given = keys.unit if isinstance(keys.unit, tuple) else (keys.unit, keys.unit)
    if stated and not np.allclose(given, stated, rtol=_ROUNDING, atol=0.0):
        shown = " and ".join(f"[{word}]" for word in words)
        raise InputError(
            f"profile.unit = {list(given)}: must be that of the heading of {keys.file}, {shown}, or be left out"
        )
    return given[0], given[1]


def _headings(file: str) -> list[str]:
    """Words in brackets of the heading of the columns: the last line before the first number with two of them, or with
    one that stands for both; empty if there is none. Words in round brackets count if they are units."""
    found: list[str] = []
    for line in read_text(file, _LARGEST).splitlines():
        if _NUMBER.fullmatch(_words(line)[0]):
            break
        pairs = _BRACKETS.findall(line)
        words = ["".join(pair) for pair in pairs]
        known = all(word.strip().lower() in LENGTHS for word in words)
        if (len(words) == _COLUMNS and (known or all(square for square, _ in pairs))) or (len(words) == 1 and known):
            found = words
    return found


def _words(line: str) -> list[str]:
    return re.split(r"[\s,;]+", line.strip().strip(",;"))


def read_points(file: str, unit: tuple[float, float]) -> tuple[Array, Array]:
    """Read x and gap, (n,) each, times their ``unit``, sorted by x.

    The columns are separated by spaces, tabs, commas or semicolons; lines before the first number, and lines that begin
    with #, are headings.

    Raises
    ------
    InputError
        If the file is no table of two columns with at least ten different x, or a number is neither zero nor of a size
        that a scene allows.
    """
    rows: list[tuple[float, float]] = []
    for number, line in enumerate(read_text(file, _LARGEST).splitlines(), start=1):
        words = _words(line)
        if line.lstrip().startswith("#") or not line.strip() or (not rows and not _NUMBER.fullmatch(words[0])):
            continue
        if len(words) != _COLUMNS or not all(map(_NUMBER.fullmatch, words)):
            raise InputError(f"profile.file: {file}: line {number}: must have two numbers, x and gap")
        place, height = (float(re.sub("[dD]", "e", word)) * each for word, each in zip(words, unit, strict=True))
        for word, value in zip(words, (place, height), strict=True):
            if value and not SMALLEST <= abs(value) <= LARGEST:
                sizes = f"zero or of a size from {SMALLEST} to {LARGEST}"
                raise InputError(f"profile.file: {file}: line {number}: {word}: must be {sizes}")
        rows.append((place, height))
    x, gap = np.array(sorted(rows)).reshape(-1, 2).T
    if len(np.unique(x)) < _FEWEST:
        raise InputError(f"profile.file: {file}: must have at least {_FEWEST} different x, not {len(np.unique(x))}")
    return x, gap


def refitted(scene: "AnyScene", count: int, seed: int = 0, smooth: float | None = None) -> list["Scene"]:
    """Return scenes with profiles refitted to noisy copies of a measured profile, for uncertainties.

    Each copy has the points of the file, on the profile of ``scene``, with normally distributed noise of the standard
    deviation ``scene.profile.measured.noise``. The spread of the results of the copies is that of the measured result.

    Parameters
    ----------
    scene : Scene, str or path
        With a profile from a file, which must still be there.
    count : int
        Number of scenes.
    seed : int
        Seed of the noise.
    smooth : float, optional
        Smoothing length of the copies, m; default: that of the profile.

    Raises
    ------
    InputError
        If the profile is not from a file, or the file cannot be read.
    """
    from partialslip.scene.reading import as_scene  # which reads profiles

    scene = as_scene(scene)
    known: Measured | None = getattr(scene.profile, "measured", None)
    if known is None:
        raise InputError("profile: must be from a file (profile.file) to refit noisy copies")
    x, _ = read_points(known.file, known.unit)
    true, random = scene.profile.gap_at(x), np.random.default_rng(seed)
    found = []
    for _ in range(count):
        noisy = true + known.noise * random.standard_normal(len(x))
        fit = _fitted(x, noisy, smooth or known.smooth, True)
        found.append(scene.replace(profile={"x": fit.x, "gap": fit.gap - fit.gap.min()}))
    return found


def smoothest(known: Measured) -> float:
    """Return the longest smoothing length, m, whose convex gap follows the points of a measured profile within the
    noise: its own one, doubled as often as that holds.

    Raises
    ------
    InputError
        If the file cannot be read.
    """
    x, gap = read_points(known.file, known.unit)
    noise, smooth = max(known.noise, _ROUNDING * float(np.ptp(gap))), known.smooth
    while round((x[-1] - x[0]) / (2 * smooth)) >= _COARSEST:
        if _off(x, gap - _fitted(x, gap, 2 * smooth, True).at, 2 * smooth)[1] > _SURE * noise:
            break
        smooth *= 2
    return smooth


def _fitted(x: Array, gap: Array, smooth: float, convex: bool) -> _Fit:
    """Fit a table with a spacing of about ``smooth`` to the points, ``convex`` or not.

    Unknowns are the gap and its slope in the middle, and the curvatures between the middles of the table's intervals.
    """
    span = x[-1] - x[0]
    count = round(span / smooth)
    if not _COARSEST <= count < _MOST:
        allowed = f"from {span / (_MOST - 1):.3g} to {span / _COARSEST:.3g}"
        raise InputError(f"profile.smooth = {smooth}: must be {allowed} for a profile that is {span:.6g} long")
    step, middle = span / count, (x[0] + x[-1]) / 2
    at, middles = (x - middle) / step, np.arange(count) - (count - 1) / 2  # in steps, from the middle
    design = np.column_stack([np.ones_like(at), at, _integrated(at, middles, 2)])
    q, r = np.linalg.qr(design)
    unit = float(np.ptp(gap)) or 1.0
    if convex:
        from scipy.optimize import lsq_linear  # imports slowly

        low = np.append([-np.inf, -np.inf], np.zeros(count - 1))
        solved = unit * lsq_linear(r, q.T @ (gap / unit), (low, np.inf), method="bvls", tol=1e-14).x
    else:
        solved = np.linalg.lstsq(r, q.T @ gap, rcond=None)[0]
    slopes = solved[1] + _integrated(middles, middles, 1) @ solved[2:]
    return _Fit(x[0] + step * np.arange(count + 1), np.append(0.0, np.cumsum(slopes)), design @ solved)


def _integrated(at: Array, middles: Array, times: int) -> Array:
    """Unit curvatures of the intervals between ``middles``, integrated once or twice (``times``) from 0, at ``at``:
    (n, intervals). The first and the last interval go on outwards."""
    whole = at[:, None] ** times
    beyond = np.maximum(at[:, None] - middles[1:-1], 0.0) ** times
    steps = np.concatenate([whole, beyond], axis=1) / times
    return np.column_stack([steps[:, :-1] - steps[:, 1:], steps[:, -1]])


def _check(x: Array, residuals: Array, keys: ProfileFile, noise: float) -> None:
    """Raise InputError where the mean residual over a smoothing length is larger than noise can make it."""
    mean, deviation, at = _off(x, residuals, keys.smooth)
    if deviation > _SURE * noise:
        raise InputError(
            f"profile.file: {keys.file}: at x = {at:.6g} m the points are off any convex gap by "
            f"{abs(mean):.2g} m on average over profile.smooth, more than noise of {noise:.2g} m explains; "
            "correct the points, or take a shorter smoothing length"
        )


def _off(x: Array, residuals: Array, smooth: float) -> tuple[float, float, float]:
    """Mean residual over the smoothing length where it says most, the noise of which it is a standard deviation, and
    the place x."""
    window = np.floor((x - x[0]) / smooth).astype(int)
    count = np.bincount(window)
    sums, places = np.bincount(window, residuals), np.bincount(window, x)
    known = count > 0
    mean, at, count = sums[known] / count[known], places[known] / count[known], count[known]
    worst = int(np.argmax(np.abs(mean) * np.sqrt(count)))
    return float(mean[worst]), float(abs(mean[worst]) * np.sqrt(count[worst])), float(at[worst])
