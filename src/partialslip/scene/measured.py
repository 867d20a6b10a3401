"""Profiles as measured: a file of points, smoothed to a convex gap.

The gap is the integral of a slope that is linear between points one smoothing length apart, as in a tabulated profile.
The slope must not decrease. Of all such gaps the nearest one to the points is taken, by least squares.
"""

import re
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, NoReturn

import msgspec
import numpy as np

from partialslip.scene.columns import LENGTH_WORDS, place_of
from partialslip.scene.table import LARGEST, SMALLEST, Positive, Table
from partialslip.scene.texttable import TextTable, decoded, read_table
from partialslip.scene.units import LENGTHS
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import read_bytes

if TYPE_CHECKING:
    from partialslip.scene import Scene
    from partialslip.scene.reading import AnyScene

_LARGEST = 20_000_000  # limit: bytes of a file of points
_FEWEST = 10  # limit: points
_COLUMNS = 2  # fixed: x and gap
# fixed: first words of the names of columns
_ALONG = {"x", "length", "distance", "position", "pos", "lateral", "way"}
_GAPS = {"gap", "depth", "z", "height", "profile", "h"}
_BRACKETS = re.compile(r"\[([^\[\]]*)\]|\(([^()]*)\)")
_WORD = re.compile(r"[^\W\d_]+")
_CELLS = re.compile(r"[,;\t]|\s{2,}")
_AMOUNT = re.compile(r"\d\s*[^\W\d_]+(?:/\w+)?")  # fixed: such as 0.5 mm/s: the unit of no column
_ENGLISH = {"m", "in"}  # fixed: units that are also names or words
_IN_FULL = re.compile(
    r"(?:milli|micro|nano|centi|kilo)?met(?:er|re)s?|microns?|inch(?:es)?|mils?|thou|foot|feet|ft|\N{ANGSTROM SIGN}|"
    r"\N{LATIN CAPITAL LETTER A WITH RING ABOVE}|angstroms?|pm|km|dm",
    re.IGNORECASE,
)
_COARSEST, _MOST = 3, 1000  # limit: intervals and points of a table
_SURE = 5.0  # accuracy: standard deviations of a mean over a smoothing length that are not taken for noise
_FOLDED = 0.2  # limit: of one side of a trace: largest other side that is taken for a part of an even gap
_ROUNDING = 1e-12  # accuracy: relative: difference of units, and misfit in the largest gap, that is taken for rounding
# msgspec 0.20 fails on a union of a number and a tuple of fixed length
ColumnUnit = Positive | Annotated[tuple[Positive, ...], msgspec.Meta(min_length=2, max_length=2)]


class PointColumns(NamedTuple):
    """Columns of a file of points: their numbers from 1, x first, and their units, m; that of heights is negative."""

    numbers: tuple[int, int]
    unit: tuple[float, float]


def columns_of(
    file: str, given: float | tuple[float, ...] | None, length: float, chosen: tuple[int | str, ...] | None = None
) -> PointColumns:
    """Return the columns x and gap of ``file``, and their units in ``length`` (m).

    Parameters
    ----------
    file : str
    given : float or tuple of float or None
        ``profile.unit``, of both columns or of each, in ``length``.
    length : float
    chosen : (int or str, int or str), optional
        ``profile.columns``, names or numbers from 1; by default those of a file of two, or those that are named so.

    Raises
    ------
    InputError
        If columns are not found, ``given`` is not that of the heading, nothing is given and the heading names units
        that cannot be read, or the heading names x as the second column.
    """
    table = _table(file)
    x, gap = _places(table, file, chosen)
    lines = table.before
    if len(table.names) > _COLUMNS:
        lines = [f"{table.names[x]}; {table.names[gap]}"] if table.head else []
    elif not chosen and (swapped := next((line for line in lines if _is_swapped(line)), "")):
        raise InputError(f"profile.file: {file}: heading {swapped.strip()!r:.60}: the columns must be x, then gap")
    units = _units(file, lines, given, length)
    return PointColumns((x + 1, gap + 1), units)


def is_named_gap(file: str, column: int) -> bool:
    """Whether ``column`` of ``file``, from 1, has a name that says that it is no height."""
    table = _table(file)
    return table.head > 0 and "gap" in table.names[column - 1].lower()


def _table(file: str) -> TextTable:
    origin = f"profile.file: {file}"
    return read_table(decoded(read_bytes(file, _LARGEST), origin)[0], origin, loose=True)


def _places(table: TextTable, file: str, chosen: tuple[int | str, ...] | None) -> tuple[int, int]:
    """Indices of the columns x and gap."""
    names, shown = table.names, ", ".join(map(repr, table.names))[:100]
    if chosen:
        places = [place_of(str(each), names) for each in chosen]
        for each, place in zip(chosen, places, strict=True):
            if place is None:
                raise InputError(f"profile.columns: {each!r}: must be one of {shown}, once, or a number from 1")
        return tuple(places)  # type: ignore[return-value]
    filled = [k for k, column in enumerate(table.columns) if any(column)]
    if len(filled) == _COLUMNS:
        return filled[0], filled[1]
    first = [(_WORD.findall(name) or [""])[0].lower() for name in names]
    x, gap = ([k for k in filled if first[k] in words] for words in (_ALONG, _GAPS))
    if not (table.head and len(x) == len(gap) == 1):
        raise InputError(
            f"profile.file: {file}: {len(names)} columns, {shown}: must have two, x and gap; or name both by "
            "profile.columns, for example [2, 3]"
        )
    return x[0], gap[0]


def _units(file: str, lines: list[str], given: float | tuple[float, ...] | None, length: float) -> tuple[float, float]:
    """Units of x and gap in ``length``: those ``given`` or those in the ``lines`` of a heading."""
    words = next(filter(None, map(_stated, reversed(lines))), [])
    known = [LENGTH_WORDS.get(word.strip().lower()) for word in words]
    shown = " and ".join(f"[{word}]" for word in words)
    stated = None if None in known else [factor / length for factor in known if factor]
    if given is None:
        if stated is None:
            allowed = ", ".join(dict.fromkeys(LENGTHS))
            raise InputError(
                f"profile.file: {file}: units {shown} in the heading: must be of {allowed}, or give profile.unit"
            )
        if not stated and (unread := next(filter(None, map(_unread, lines)), "")):
            raise InputError(
                f"profile.file: {file}: unit {unread!r} in the heading: must stand behind the name of each column, as "
                "in x [mm], gap [um], or give profile.unit"
            )
        return (stated[0], stated[-1]) if stated else (1.0, 1.0)
    x, gap = given if isinstance(given, tuple) else (given, given)
    if stated and not np.allclose((x, gap), stated, rtol=_ROUNDING, atol=0.0):
        raise InputError(f"profile.unit = {[x, gap]}: must be that of the heading of {file}, {shown}, or be left out")
    return x, gap


def _stated(line: str) -> list[str]:
    """Words for the units of both columns in a ``line`` of the heading, or one that stands for both; empty if there are
    none.

    They are in brackets, in round ones only if they are units, or the last words of the columns' names.
    """
    words = ["".join(pair) for pair in _BRACKETS.findall(line)]
    known = all(word.strip().lower() in LENGTH_WORDS for word in words)
    if len(words) == _COLUMNS and (known or all(square for square, _ in _BRACKETS.findall(line))):
        return words
    cells = _column_words(line)
    last = [names[-1] for names in cells]
    if len(cells) == 1:
        last = [word for word in cells[0] if word.lower() in LENGTH_WORDS.keys() - _ENGLISH]
    if len(last) == _COLUMNS and all(word.lower() in LENGTH_WORDS for word in last):
        return last
    alone = len(words) == 1 and len(cells) == 1 and known and not _unread(line.replace(words[0], "", 1))
    return words if alone else []


def _column_words(line: str) -> list[list[str]]:
    """Words of each column in a ``line`` of the heading."""
    return [words for cell in _CELLS.split(line) if (words := _WORD.findall(cell))]


def _is_swapped(line: str) -> bool:
    """Whether a ``line`` of the heading names x as the second of two columns."""
    first = [words[0].lower() for words in _column_words(line)]
    return len(first) == _COLUMNS and first[1] == "x" != first[0]


def _unread(line: str) -> str:
    """First word of a ``line`` that is a unit of length, but not of an amount; empty if there is none."""
    words = _WORD.findall(_AMOUNT.sub("", line))
    return next((each for each in words if each.lower() in LENGTHS.keys() - _ENGLISH or _IN_FULL.fullmatch(each)), "")


def read_points(
    file: str, unit: tuple[float, float], columns: tuple[int, int] = (1, 2), centre: float = 0.0
) -> tuple[Array, Array]:
    """Read x and gap, (n,) each, times their ``unit``, sorted by x, from ``columns`` (from 1) of a table; x from
    ``centre`` (m) on. Rows without values are left out.

    Raises
    ------
    InputError
        If the file is no table with these columns and at least ten different x, or a number is neither zero nor of a
        size that a scene allows.
    """
    table = _table(file)
    if max(columns) > len(table.names):
        raise InputError(f"profile.file: {file}: {len(table.names)} columns: must have a column {max(columns)}")
    numbers = [table.numbers(k - 1, f"profile.file: {file}") for k in columns]
    for k, column, each in zip(columns, numbers, unit, strict=True):
        size = np.abs(column * each)
        if (wrong := (size > 0) & ((size < SMALLEST) | (size > LARGEST))).any():
            row, sizes = int(wrong.argmax()), f"zero or of a size from {SMALLEST} to {LARGEST}"
            field = table.columns[k - 1][row]
            raise InputError(f"profile.file: {file}: line {table.lines[row]}: {field}: must be {sizes}")
    known = np.isfinite(numbers[0]) & np.isfinite(numbers[1])
    x, gap = (column[known] * each for column, each in zip(numbers, unit, strict=True))
    order = np.lexsort((gap, x))
    if len(np.unique(x)) < _FEWEST:
        raise InputError(f"profile.file: {file}: must have at least {_FEWEST} different x, not {len(np.unique(x))}")
    return x[order] - centre, gap[order]


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
        If the file is no table of two columns, its heading has other units than ``keys`` or names units that cannot be
        read, no convex gap follows the points within the noise, or x begins at 0 away from the lowest point.
    """
    columns, unit = columns_of(keys.file, keys.unit, length, keys.columns)
    x, gap = read_points(keys.file, unit, columns)
    if np.polyfit((x - x.mean()) / np.ptp(x), gap, 2)[0] < 0 and not is_named_gap(keys.file, columns[1]):
        unit = (unit[0], -unit[1])  # heights
        x, gap = read_points(keys.file, unit, columns)
    centre = _lowest(x, gap, keys.smooth) if keys.centre == "auto" and x[0] == 0 else 0.0
    x, gap = _folded(*read_points(keys.file, unit, columns, centre))
    # the slope at x = 0 is free: the points tell whether it is that of an even gap
    free, turning = (_fitted(x, gap, keys.smooth, convex, even=False) for convex in (False, True))
    fit = _fitted(x, gap, keys.smooth, True) if x[0] == 0 else turning
    spare = max(len(x) - len(fit.x) - 1, 1)
    scatter = float(np.sqrt(np.sum((gap - free.at) ** 2) / spare))
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
