"""Profiles as measured: a file of points, smoothed to a convex gap.

The gap is the integral of a slope that is linear between points one smoothing length apart, as in a tabulated profile.
The slope must not decrease. Of all such gaps the nearest one to the points is taken, by least squares.
"""

from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, NoReturn

import msgspec
import numpy as np

from partialslip.scene.pointfile import columns_of, is_named_gap, line_of_gap, read_points
from partialslip.scene.table import Positive, Table
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

if TYPE_CHECKING:
    from partialslip.scene import Scene
    from partialslip.scene.reading import AnyScene

_COARSEST, _MOST = 3, 1000  # limit: intervals and points of a table
_SURE = 5.0  # accuracy: standard deviations of a mean over a smoothing length that are not taken for noise
_ROUGHEST = 1e-2  # limit: of the range of the gaps: scatter of the points that is taken for noise unless it is given
_FOLDED = 0.2  # limit: of one side of a trace: largest other side that is taken for a part of an even gap
_ROUNDING = 1e-12  # accuracy: misfit in the largest gap that is taken for rounding
# msgspec 0.20 fails on a union of a number and a tuple of fixed length
ColumnUnit = Positive | Annotated[tuple[Positive, ...], msgspec.Meta(min_length=2, max_length=2)]


class ProfileFile(Table, frozen=True, kw_only=True):
    """Keys of a profile from a file.

    ``file`` has the columns x and gap, or heights, of one half of an even gap if x begins at 0; ``columns`` names them
    or numbers them from 1 where there are more. ``unit`` (m) is that of its numbers, or of each column (default: the
    units in the heading of the file, such as ``x [mm], gap [um]``, else the scene's unit of length); ``smooth`` (m) is
    the smoothing length, and ``noise`` (m) the standard deviation of the gaps (default: estimated). With ``centre`` =
    "auto", x of a trace that begins at 0 is from its lowest point on, wherever that is; less than a fifth beside it is
    of an even gap, too.
    """

    file: Annotated[str, msgspec.Meta(min_length=1)]
    smooth: Positive
    unit: ColumnUnit | None = None
    noise: Positive | None = None
    columns: Annotated[tuple[int | str, ...], msgspec.Meta(min_length=2, max_length=2)] | None = None
    centre: Literal["auto", "given"] = "auto"


class Measured(Table, frozen=True, kw_only=True):
    """How a table was made from a file: number of ``points``, ``unit`` of the columns x and gap (m; below zero for
    heights), smoothing length ``smooth`` (m), standard deviation ``noise`` of the gaps (m), ``offset`` of the gaps (m),
    which has no effect, ``misfit``, the root mean square difference between points and table (m), numbers of the
    ``columns``, from 1, and the place in the file that is x = 0, ``centre`` (m)."""

    file: str
    points: int
    unit: tuple[float, float]
    smooth: float
    noise: float
    offset: float
    misfit: float
    columns: tuple[int, int] = (1, 2)
    centre: float = 0.0

    def read(self) -> tuple[Array, Array]:
        """Return x and gap of the points (n,) each, m; on one side where they are of an even gap.

        Raises
        ------
        InputError
            If the file cannot be read.
        """
        return _folded(*read_points(self.file, self.unit, self.columns, self.centre))


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
        If the file is no table of one trace, its heading has other units than ``keys`` or names units that cannot be
        read, points lie far off, no convex gap follows them within the noise, or x begins at 0 away from the lowest
        point.
    """
    columns, unit = columns_of(keys.file, keys.unit, length, keys.columns)
    x, gap = read_points(
        keys.file, unit, columns, back=keys.smooth
    )  # within it the order of the points is of no effect
    # full: no warning where few of the points tell the curvature
    if np.polyfit((x - x.mean()) / np.ptp(x), gap, 2, full=True)[0][0] < 0 and not is_named_gap(keys.file, columns[1]):
        unit = (unit[0], -unit[1])  # heights
        x, gap = read_points(keys.file, unit, columns)
    centre = _lowest(x, gap, keys.smooth) if keys.centre == "auto" and x[0] == 0 else 0.0
    x, gap = _folded(*read_points(keys.file, unit, columns, centre))
    # the slope at x = 0 is free: the points tell whether it is that of an even gap
    free, turning = (_fitted(x, gap, keys.smooth, convex, even=False) for convex in (False, True))
    fit = _fitted(x, gap, keys.smooth, True) if x[0] == 0 else turning
    spare = max(len(x) - len(fit.x) - 1, 1)
    scatter = float(np.sqrt(np.sum((gap - free.at) ** 2) / spare))
    if not keys.noise and scatter > _ROUGHEST * (span := float(np.ptp(free.at))):
        worst = line_of_gap(keys.file, unit, columns, float(gap[np.abs(gap - turning.at).argmax()]))
        _refuse_outliers(worst, scatter / span, keys)
    noise = keys.noise or scatter
    sure = max(noise, _ROUNDING * float(np.ptp(gap)))
    _require_convex_within_noise(x, gap - turning.at, keys, sure)
    more = float(np.sum((gap - fit.at) ** 2) - np.sum((gap - turning.at) ** 2))
    if more > (_SURE * sure) ** 2:
        _refuse_mirror(turning, keys)
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
            "columns": list(columns),
            "centre": centre,
        },
    }


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
    x, _ = read_points(known.file, known.unit, known.columns)
    true, random = scene.profile.gap_at(x - known.centre), np.random.default_rng(seed)
    smooth, mirrored = smooth or known.smooth, scene.profile.even and known.centre > 0
    found = []
    for _ in range(count):
        noisy = true + known.noise * random.standard_normal(len(x))
        centre = _mirror(x, noisy, smooth, known.centre) if mirrored else known.centre
        fit = _fitted(*_folded(x - centre, noisy), smooth, True)
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
    x, gap = known.read()
    noise, smooth = max(known.noise, _ROUNDING * float(np.ptp(gap))), known.smooth
    while round((x[-1] - x[0]) / (2 * smooth)) >= _COARSEST:
        if _largest_mean_residual(x, gap - _fitted(x, gap, 2 * smooth, True).at, 2 * smooth)[1] > _SURE * noise:
            break
        smooth *= 2
    return smooth


def _folded(x: Array, gap: Array) -> tuple[Array, Array]:
    """Points of one side of an even gap, of which less than a fifth are beside x = 0 on the other side; other points as
    they are."""
    if not -_FOLDED * x[-1] < x[0] < 0:
        return x, gap
    order = np.argsort(np.abs(x), kind="stable")
    folded = np.abs(x)[order]
    folded[0] = 0.0  # where the even gap begins
    return folded, gap[order]


def _lowest(x: Array, gap: Array, smooth: float) -> float:
    """Place of the lowest point of a trace that begins at 0, m; 0 if it is there, or beside the trace.

    The points tell whether one slope more, at x = 0, follows them better than an even gap.
    """
    free, even = (_fitted(x, gap, smooth, True, each) for each in (False, True))
    spare = max(len(x) - len(free.x) - 1, 1)
    scatter = max(float(np.sqrt(np.sum((gap - free.at) ** 2) / spare)), _ROUNDING * float(np.ptp(gap)))
    more = float(np.sum((gap - even.at) ** 2) - np.sum((gap - free.at) ** 2))
    lowest = _turning(free)
    if more <= (_SURE * scatter) ** 2 or not x[0] < lowest < x[-1]:
        return 0.0
    return _mirror(x, gap, smooth, lowest) if lowest < _FOLDED * (x[-1] - lowest) else lowest


def _mirror(x: Array, gap: Array, smooth: float, lowest: float) -> float:
    """Place near ``lowest`` at which points of both sides follow one even gap best, m."""

    def misfit(centre: float) -> float:
        folded, of = _folded(x - centre, gap)
        return float(np.sum((of - _fitted(folded, of, smooth, True, True).at) ** 2))

    from scipy.optimize import minimize_scalar  # imports slowly

    bounds = (max(lowest - smooth, x[1]), min(lowest + smooth, _FOLDED * x[-1] / (1 + _FOLDED)))
    return float(minimize_scalar(misfit, bounds=bounds, method="bounded", options={"xatol": 1e-5 * smooth}).x)


def _turning(fit: _Fit) -> float:
    """Place of the lowest point of a ``fit``, m: where its slope, linear between middles of intervals, is zero."""
    step, slopes = fit.x[1] - fit.x[0], np.diff(fit.gap) / np.diff(fit.x)
    bent = slopes[1:] - slopes[:-1]
    at = int(np.clip(np.searchsorted(slopes, 0.0), 1, len(bent)))
    return float(fit.x[at] + step / 2 - slopes[at] * step / bent[at - 1] if bent[at - 1] > 0 else fit.x[at])


def _fitted(x: Array, gap: Array, smooth: float, convex: bool, even: bool | None = None) -> _Fit:
    """Fit a table with a spacing of about ``smooth`` to the points, ``convex`` or not, and ``even`` or not (default:
    even if x begins at 0).

    Unknowns are the gap, its slope in the middle, and the curvatures between the middles of the table's intervals. Of
    an even gap the slope at 0 is zero, and the curvature up to the first middle is one more unknown.
    """
    span = x[-1] - x[0]
    count = round(span / smooth)
    if not _COARSEST <= count < _MOST:
        allowed = f"from {span / (_MOST - 1):.3g} to {span / _COARSEST:.3g}"
        raise InputError(f"profile.smooth = {smooth}: must be {allowed} for a profile that is {span:.6g} long")
    even = bool(x[0] == 0) if even is None else even
    step, origin = span / count, 0.0 if even else (x[0] + x[-1]) / 2
    at, middles = (x - origin) / step, np.arange(count) + 0.5 + (x[0] - origin) / step  # in steps, from the origin
    knots = np.append(0.0, middles) if even else middles
    straight = [np.ones_like(at)] if even else [np.ones_like(at), at]
    design = np.column_stack([*straight, _integrated(at, knots, 2)])
    q, r = np.linalg.qr(design)
    unit = float(np.ptp(gap)) or 1.0
    if convex:
        from scipy.optimize import lsq_linear  # imports slowly

        low = np.append(np.full(len(straight), -np.inf), np.zeros(len(knots) - 1))
        solved = unit * lsq_linear(r, q.T @ (gap / unit), (low, np.inf), method="bvls", tol=1e-14).x
    else:
        solved = np.linalg.lstsq(r, q.T @ gap, rcond=None)[0]
    slopes = (0.0 if even else solved[1]) + _integrated(middles, knots, 1) @ solved[len(straight) :]
    return _Fit(x[0] + step * np.arange(count + 1), np.append(0.0, np.cumsum(slopes)), design @ solved)


def _integrated(at: Array, knots: Array, times: int) -> Array:
    """Unit curvatures of the intervals between ``knots``, integrated once or twice (``times``) from 0, at ``at``:
    (n, intervals). The first and the last interval go on outwards."""
    whole = at[:, None] ** times
    beyond = np.maximum(at[:, None] - knots[1:-1], 0.0) ** times
    steps = np.concatenate([whole, beyond], axis=1) / times
    return np.column_stack([steps[:, :-1] - steps[:, 1:], steps[:, -1]])


def _refuse_outliers(worst: str, scatter: float, keys: ProfileFile) -> NoReturn:
    """Raise InputError: the points scatter more than noise does; the ``worst`` is farthest off."""
    raise InputError(
        f"profile.file: {keys.file}: {worst}: no data? take these rows out; the points scatter by {scatter:.2g} of the "
        "smoothed range: if the surface is that rough, give profile.noise"
    )


def _refuse_mirror(fit: _Fit, keys: ProfileFile) -> NoReturn:
    """Raise InputError: the ``fit``, whose slope at x = 0 is free, follows the points better than an even one."""
    lowest = _turning(fit)
    raise InputError(
        f"profile.file: {keys.file}: x begins at 0, and the lowest point is at about {lowest:.3g} m: must be at 0 for "
        "one half of an even gap; begin the file there, or let x begin below 0 for a gap of both sides, or, if it is "
        "at 0, take a shorter smoothing length"
    )


def _require_convex_within_noise(x: Array, residuals: Array, keys: ProfileFile, noise: float) -> None:
    """Raise InputError where the mean residual over a smoothing length is larger than noise can make it."""
    mean, deviation, at = _largest_mean_residual(x, residuals, keys.smooth)
    if deviation > _SURE * noise:
        raise InputError(
            f"profile.file: {keys.file}: at x = {at:.6g} m the points are off any convex gap by "
            f"{abs(mean):.2g} m on average over profile.smooth, where noise of {noise:.2g} m a point leaves at most "
            f"{_SURE * noise * abs(mean) / deviation:.2g} m; "
            "correct the points, or take a shorter smoothing length"
        )


def _largest_mean_residual(x: Array, residuals: Array, smooth: float) -> tuple[float, float, float]:
    r"""Mean residual r of n points, r sqrt(n), and x, of the window of one smoothing length with the largest \|r\|
    sqrt(n): under noise s, r has the standard deviation s/sqrt(n)."""
    window = np.floor((x - x[0]) / smooth).astype(int)
    count = np.bincount(window)
    sums, places = np.bincount(window, residuals), np.bincount(window, x)
    known = count > 0
    mean, at, count = sums[known] / count[known], places[known] / count[known], count[known]
    worst = int(np.argmax(np.abs(mean) * np.sqrt(count)))
    return float(mean[worst]), float(abs(mean[worst]) * np.sqrt(count[worst])), float(at[worst])
