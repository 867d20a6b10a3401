"""Propagate the tolerances of a scene's numbers to its results.

The scene is solved at the star of its inputs (:mod:`partialslip.study.tolerance.surface`), and at corners of their
range, at which all inputs add up for some quantity. Where the differences hold at the corners, and no regime changes,
they are the answer. Otherwise draws are solved, and the results between them interpolated. Of the stick zone [-m, n]
the square of the half-width is fitted, which is smooth where the contact begins to slide: c = a sqrt(1 - Q/(f P)).
"""

import dataclasses
import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np
from msgspec.structs import replace

from partialslip.halfplane import contact
from partialslip.result import Result
from partialslip.result.peak import peak_error, pressure_peaks
from partialslip.result.record import number
from partialslip.run import Run, run
from partialslip.run.judge.reference import error_of, reference
from partialslip.run.methods import Progress
from partialslip.run.tolerance import COVERAGE, Interval, Propagation, RegimeChange
from partialslip.scene import Fatigue, Scene
from partialslip.scene.gradual import may_turn_round
from partialslip.scene.tolerance import Input, inputs, moved
from partialslip.scene.units import Dimension
from partialslip.study.fatigue import HotSpot, hot_spots
from partialslip.study.tolerance.surface import Surface, draws, interpolated, quadratic, shares, star
from partialslip.tools.arrays import Array, Indices, Mask
from partialslip.tools.errors import InputError

_DRAWS, _FEW_DRAWS = 48, 16  # cost: solved draws of exact: without and with slip that may reverse, which takes seconds
_CHECKED = 4  # cost: one draw of so many, and the corners, check the surface through the others
_DRAWN = 4  # display: times as many where draws are shown
_ACCURACY = 1e-3  # cost: of march, as fem.accuracy: below what any tolerance changes
_CORNERS = 8  # cost: solved corners of the range
_EVALUATED = 16384  # accuracy: draws of the surfaces; quantiles change by 0.1 % of the interval with twice as many
_ROUGHLY = 1024  # cost: draws of the surfaces that tell the width of an interval, by which a misfit is measured
_MISFIT = 0.03  # accuracy: of differences at a corner, in the width of the interval, below which nothing is drawn
_SEARCHED = 3.0  # display: in reaches, how far from the given value a change of regime is sought
_ROUNDING = 1e-9  # limit: of p0: less is no tension
_SLIDES, _TENSION = "margin of sliding", "margin of the transition"
_SQUARE, _CENTRE = "c^2", "centre"
_SLIDING = ("a", "p0", "p_max", _SLIDES, _TENSION)  # known of a contact that slides, too
_KINDS: Mapping[str, Dimension] = {
    "a": "m", "m": "1", "n": "1", "p0": "Pa", "p_max": "Pa", "sigma_xx": "Pa", "dissipated": "J/m",
}  # fmt: skip


@dataclass
class Solved:
    """Scenes solved around ``scene``: deviations ``t`` (k,) of its ``inputs``, ``values`` by quantity, and results;
    ``spots`` are hot spots of the scene as given."""

    scene: Scene
    inputs: tuple[Input, ...]
    method: str
    tell: Progress
    t: list[Array] = field(default_factory=list)
    values: list[dict[str, float]] = field(default_factory=list)
    results: list[Result | None] = field(default_factory=list)
    refused: Counter[str] = field(default_factory=Counter)
    spots: Mapping[str, HotSpot] = field(default_factory=dict)

    def add(self, points: Array, criteria: bool = False) -> None:
        """Solve the scenes at ``points`` (n, k)."""
        for point in points:
            self.tell(f"tolerances: scene {len(self.t) + 1}")
            scene, result = moved(self.scene, self.inputs, point), None
            values = {_SLIDES: slide_margin(scene)}
            try:
                result = run(scene, self.method, stresses=True)[self.method]
                values |= {key: value for key, (value, _) in _found(result, self.method).items()}
                values |= _margin(scene, result)
                if criteria:
                    spots = hot_spots(scene, result)
                    self.spots = self.spots or spots
                    values |= {key: spot.value for key, spot in spots.items()}
            except InputError as error:
                if not len(self.t):
                    raise
                if values[_SLIDES] > 0:
                    self.refused[str(error)] += 1
            self.t.append(point)
            self.values.append(values)
            self.results.append(result)

    def column(self, key: str) -> Array:
        """Values of a quantity, or of ``c^2`` and ``centre`` of the stick zone in a, (n,), NaN where there is none."""

        def value(values: Mapping[str, float]) -> float:
            if key in (_SQUARE, _CENTRE):
                m, n = values.get("m", math.nan), values.get("n", math.nan)
                return ((m + n) / 2) ** 2 if key == _SQUARE else (n - m) / 2
            return values.get(key, math.nan)

        return np.array([value(each) for each in self.values])

    @property
    def regimes(self) -> list[str]:
        """Regimes of the scenes that were solved."""
        return [each.regime for each in self.results if each]


def slide_margin(scene: Scene) -> float:
    """1 - \\|Q\\|/(f P), the least at a load point: zero where the contact begins to slide; f is the mean over the
    pressure."""
    if scene.free:
        return 1.0
    f = contact(scene).f if scene.friction.varies else scene.friction.f
    pairs = zip(scene.load.points, scene.pressing, strict=True)
    return min(1 - abs(Q) / (f * P) if f else -1.0 for (Q, _), (P, _) in pairs)


def _margin(scene: Scene, result: Result) -> dict[str, float]:
    """1 less dsigma of the ``scene`` over that of the transition: zero where the tension is neither small nor large,
    and an end of the stick zone is at the contact edge."""
    limit, own = result.limits.get("dsigma_transition"), abs(scene.load.dsigma)
    return {_TENSION: 1 - own / limit} if limit and own else {}


def _found(result: Result, method: str) -> dict[str, tuple[float, float]]:
    """Values of ``result`` and their numerical errors, NaN without an estimate, by quantity."""
    off = {key: error_of(result, key, method) for key in "amn"}
    found = {"a": (result.a, off["a"] * result.a), "p0": (result.p0, off["a"] * result.p0)}
    if result.m is not None and result.n is not None and result.steady:
        found |= {"m": (result.m / result.a, off["m"]), "n": (result.n / result.a, off["n"])}
    found["p_max"] = max(pressure_peaks(result, error_of(result, "p", method)))
    if result.surface and result.surface.largest[1] > _ROUNDING * result.p0:
        error = peak_error(result)
        found["sigma_xx"] = result.surface.largest[1], math.nan if error is None else error
    if result.slip:
        error = result.slip.dissipated_error
        found["dissipated"] = result.slip.dissipated, math.nan if error is None else error
    return {key: found[key] for key in _KINDS if key in found}


def method_of(scene: Scene) -> str:
    """Return the method that solves the draws: the reference of ``scene``, or where that is fem, equivalent half-planes
    of finite bodies and march of dissimilar materials; these, too, of strips whose sizes have tolerances: they are
    equal no more."""
    if scene.strips and any(each.key.startswith("bodies.") for each in inputs(scene)):
        return "equivalent"
    best = reference(scene).method
    return best if best != "fem" else "equivalent" if scene.finite else "march"


def with_tolerance(outcome: Run, tell: Progress = lambda _: None) -> Run:
    """Return ``outcome`` with what the tolerances of its scene allow; as it is if the scene has none.

    ``tell`` and errors are as for :func:`propagate`.
    """
    if outcome.scene.tolerance is None:
        return outcome
    return dataclasses.replace(outcome, tolerance=propagate(outcome.scene, tell)[0])


def propagate(scene: Scene, tell: Progress = lambda _: None, *, drawn: bool = False) -> tuple[Propagation, Solved]:
    """Return what the tolerances of ``scene`` allow its results, and the scenes that were solved for it.

    Parameters
    ----------
    scene : Scene
    tell : callable, optional
        Called with a line of progress.
    drawn : bool
        Whether to solve draws even where differences hold (exact only).

    Raises
    ------
    InputError
        If the scene has no tolerance, or cannot be solved.
    """
    own = inputs(scene, scene.units)
    if not own:
        raise InputError('tolerance: missing: must name inputs, such as [tolerance] friction.f = "5 %"')
    method = method_of(scene)
    if method != "exact":
        scene = replace(scene, fem=replace(scene.fem, accuracy=max(scene.fem.accuracy, _ACCURACY)))
    known = Solved(scene, own, method, tell)
    known.add(star(len(own)), criteria=scene.fatigue != Fatigue())
    fitted, evaluated = len(known.t), draws(own, _EVALUATED)
    model = _Model(known, quadratic)
    known.add(_corners(known))
    misfit = model.misfit(known, np.arange(fitted, len(known.t)), evaluated)
    count = 0
    if misfit > _MISFIT or drawn or len({*known.regimes}) > 1 or known.refused or known.column(_SLIDES).min() <= 0:
        if known.method == "exact":
            turns = any(may_turn_round(moved(scene, own, t)) for t in known.t)
            count = _FEW_DRAWS if turns else _DRAWS * (_DRAWN if drawn else 1)
            known.add(draws(own, count))
        corners = len(known.t) - count
        unseen = np.r_[fitted:corners, corners : len(known.t) : _CHECKED]
        misfit = _Model(known, interpolated, unseen).misfit(known, unseen, evaluated) if count else misfit
        model = _Model(known, interpolated)
    return _propagation(known, model, evaluated, count, misfit), known


class _Model:
    """Surfaces of all quantities of ``known``, by ``fit``, without the points ``left_out``."""

    def __init__(
        self, known: Solved, fit: Callable[[Array, Array], Surface], left_out: Indices | tuple[()] = ()
    ) -> None:
        kept = np.setdiff1d(np.arange(len(known.t)), left_out)
        t = np.array(known.t)[kept]
        keys = dict.fromkeys((*(key for each in known.values for key in each), _SQUARE, _CENTRE))
        columns = {key: known.column(key)[kept] for key in keys if key not in ("m", "n")}
        self._keys = [key for key, column in columns.items() if np.isfinite(column[0])]
        self._surface = fit(t, np.stack([columns[key] for key in self._keys], axis=1))

    def at(self, t: Array) -> dict[str, Array]:
        """Quantities at deviations ``t`` (n, k); NaN where the contact slides for those of partial slip."""
        found = dict(zip(self._keys, self._surface(t).T, strict=True))
        if _SQUARE in found:
            c, centre = np.sqrt(np.maximum(found.pop(_SQUARE), 0.0)), found.pop(_CENTRE)
            found |= {"m": c - centre, "n": c + centre}
        slides = found[_SLIDES] <= 0
        return {key: each if key in _SLIDING else np.where(slides, np.nan, each) for key, each in found.items()}

    def misfit(self, known: Solved, places: Indices, evaluated: Array) -> float:
        """Largest error at the solved points ``places``, in the width of the interval; errors of rounding and of the
        method do not count."""
        there, over = self.at(np.array(known.t)[places]), self.at(evaluated[:_ROUGHLY])
        first = known.results[0]
        assert first
        found, worst = _found(first, known.method), 0.0
        for key, values in there.items():
            low, high = _quantiles(over[key])
            error = found.get(key, (0.0, 0.0))[1]
            noise = 2 * (0.0 if math.isnan(error) else error) + 1e-9 * abs(known.column(key)[0])
            off = np.abs(values - known.column(key)[places])
            if np.isfinite(off).any() and high - low > noise:
                worst = max(worst, (float(np.nanmax(off)) - noise) / (high - low))
        return worst


def _quantiles(values: Array) -> tuple[float, float]:
    """Ends of the interval of ``values``; NaN are left out."""
    known = values[np.isfinite(values)]
    if not len(known):
        return math.nan, math.nan
    low, high = np.quantile(known, [(1 - COVERAGE) / 2, (1 + COVERAGE) / 2])
    return float(low), float(high)


def _corners(known: Solved) -> Array:
    """Corners of the range at which all inputs add up for one of the quantities, (n, k), at most _CORNERS."""
    signs: dict[tuple[float, ...], None] = {}
    keys = ("m", "n", *(key for key in known.values[0] if key not in ("m", "n")))
    for key in keys:
        y = known.column(key)[: 2 * len(known.inputs) + 1]
        low, high = (np.where(np.isnan(each), y[0], each) for each in (y[1::2], y[2::2]))
        if np.isfinite(y[0]):
            corner = np.where(high < low, -1.0, 1.0)
            signs |= dict.fromkeys((tuple(corner.tolist()), tuple((-corner).tolist())))
    return np.array([*signs][:_CORNERS])


def _propagation(known: Solved, model: _Model, evaluated: Array, count: int, misfit: float) -> Propagation:
    over = model.at(evaluated)
    return Propagation(
        known.method,
        len(known.t),
        count,
        float(misfit),
        {each.key: each.text for each in known.inputs},
        dict(_intervals(known, over, evaluated)),
        _probabilities(known, over, count),
        tuple(_changes(known, model)),
        dict(known.refused),
    )


def _intervals(known: Solved, over: Mapping[str, Array], evaluated: Array) -> Iterator[tuple[str, Interval]]:
    first, keys = known.results[0], [each.key for each in known.inputs]
    assert first
    found = _found(first, known.method)
    dimensions = {**_KINDS, **{key: spot.of for key, spot in known.spots.items()}}
    found |= {
        key: (spot.value, math.nan if spot.error is None else spot.error * spot.value)
        for key, spot in known.spots.items()
        if key not in found
    }
    for key, (value, error) in found.items():
        low, high = _quantiles(over[key])
        parts = dict(zip(keys, shares(evaluated, over[key]).tolist(), strict=True))
        y = known.column(key)[: 2 * len(keys) + 1]
        yield (
            key,
            Interval(
                dimensions[key],
                value,
                number(low),
                number(high),
                number(error),
                dict(sorted(parts.items(), key=lambda each: -each[1])),
                {each: (number(y[2 * i + 1]), number(y[2 * i + 2])) for i, each in enumerate(keys)},
            ),
        )


def _probabilities(known: Solved, over: Mapping[str, Array], count: int) -> dict[str, float]:
    """Probability of each regime: by the margins of sliding and of the transition from small to large tension; of other
    regimes the share of the solved draws, or of all solved scenes without draws."""
    slides: Mask = over[_SLIDES] <= 0
    seen = {*known.regimes} - {"sliding"}
    if _TENSION in over and seen <= {"small tension", "large tension"}:
        small: Mask = over[_TENSION] > 0
        chances = {"small tension": (small & ~slides).mean(), "large tension": (~small & ~slides).mean()}
    else:
        drawn = [each.regime for each in known.results[-count:] if each and each.regime != "sliding"]
        counted = Counter(drawn or known.regimes[:1])
        chances = {key: (1 - slides.mean()) * number / counted.total() for key, number in counted.items()}
    chances["sliding"] = slides.mean()
    return {key: float(chance) for key, chance in chances.items() if chance > 0}


def _changes(known: Solved, model: _Model) -> Iterator[RegimeChange]:
    """The nearest changes of regime, each along the axis of one input."""
    first = known.regimes[0]
    other = {"small tension": "large tension", "large tension": "small tension"}.get(first, "")
    t = np.linspace(-_SEARCHED, _SEARCHED, 601)
    for margin, regime in ((_SLIDES, "sliding"), (_TENSION, other)):
        crossings = []
        for i in range(len(known.inputs)):
            along = np.zeros((len(t), len(known.inputs)))
            along[:, i] = t
            if (y := model.at(along).get(margin)) is not None:
                k = np.flatnonzero((y[:-1] > 0) != (y[1:] > 0))
                crossings += [(float(t[j] + (t[j + 1] - t[j]) * y[j] / (y[j] - y[j + 1])), i) for j in k]
        if crossings and regime and first != regime:
            at, i = min(crossings, key=lambda each: abs(each[0]))
            each = known.inputs[i]
            if margin == _SLIDES:
                at = _refined(known.scene, each, at)
            if abs(at) <= _SEARCHED:
                value = each.number(at)
                share = float(at * each.reach / each.size) if each.size else None
                yield RegimeChange(regime, each.key, float(value), share)


def _refined(scene: Scene, of: Input, at: float) -> float:
    """Deviation near ``at`` of one input at which the contact begins to slide, by the secant method: no scene is
    solved."""

    def margin(t: float) -> float:
        return slide_margin(moved(scene, [of], [t]))

    one, other = 0.99 * at, at
    try:
        low, high = margin(one), margin(other)
        for _ in range(20):
            if abs(high - low) <= 1e-14:
                break
            one, other = other, other - high * (other - one) / (high - low)
            low, high = high, margin(other)
    except InputError:  # beyond the range of the input
        return at
    return other
