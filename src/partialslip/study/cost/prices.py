"""The price list: predicted CPU seconds of a run by scene and accuracy, fitted to measured runs.

CPU seconds of the default methods are modelled as exp(c0 + c1 d + c2 d^2) with d = log10(1/accuracy), times factors
that change with d: of the family of the scene (its loads and bodies), of the profile's kind, and of SuperLU. Start and
report are added. Seconds depend on the machine and on other load: they are scaled by a power of the CPU seconds that
this process took to start.

A price is told only where it is known: for families that were measured, and if the predicted seconds of nine of ten
fitted runs of the family leave the price of the process within 1.3 times.

Allowances do without the list (:mod:`partialslip_fem.mesh_cost`): a run measures its own meshes and load steps, which
no list knows.
"""

import importlib.util
import json
import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from importlib import resources

import msgspec
import numpy as np
from scipy.optimize import least_squares

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.halfplane.method import slip_turns_round
from partialslip.run import default_methods
from partialslip.scene import Effects, Fem, Scene

FINEST_ACCURACY = 1e-9  # limit: finest accuracy that a budget is spent on
TRUSTED = 1.3  # accuracy: largest factor between price and cost, in nine of ten runs, with which a price is told
_MIDDLE = 4.0  # fixed: digits at which factors are those of the list
_FEWEST = 5  # accuracy: measured runs of a family, of a profile or of SuperLU, below which no price is told
_ALONE = 0.05  # limit: least share of the variance of a run's error that the fit leaves
_PULL = 1.0  # accuracy: weight of a measured run that says: this factor does not grow with the digits
_POWERS = 0.5, 1.0  # accuracy: bounds of the power of the start: starts jitter more than long runs do


@dataclass(frozen=True)
class Price:
    """Predicted cost of a run.

    Parameters
    ----------
    order : int
        Order of the elements.
    accuracy : float
        Accuracy, as a fraction of a.
    cpu_s : float or None
        CPU seconds of the whole process; None if they are not known.
    start_s, closing_s : float
        CPU seconds of the start, and of report and exit.
    """

    order: int
    accuracy: float
    cpu_s: float | None
    start_s: float
    closing_s: float

    def __str__(self) -> str:
        cost = "price not known" if self.cpu_s is None else f"{self.cpu_s:.2g} CPU s, predicted"
        return f"P{self.order} at {self.accuracy:.1e} a: {cost}"


@dataclass(frozen=True)
class MeasuredRun:
    """A measured run.

    Parameters
    ----------
    scene : Scene
    costs : mapping of str to float
        CPU seconds by method.
    start_s, closing_s : float
        CPU seconds of the start, and of report and exit.
    """

    scene: Scene
    costs: Mapping[str, float]
    start_s: float
    closing_s: float


class PriceFactor(msgspec.Struct, frozen=True):
    """Logarithm of a factor, and its increase per digit of the accuracy."""

    log: float
    per_digit: float

    def at(self, digits: float) -> float:
        """Logarithm of the factor at so many ``digits``."""
        return self.log + self.per_digit * (digits - _MIDDLE)


class FamilyPrices(msgspec.Struct, frozen=True):
    """What the list knows of a family of scenes.

    Parameters
    ----------
    factor : Factor
    spread : float
        Factor between predicted and measured CPU seconds of the methods that nine of ten fitted runs do not exceed.
    range : tuple of float
        Digits of the fitted runs, from and to.
    """

    factor: PriceFactor
    spread: float
    range: tuple[float, float]


class Prices(msgspec.Struct, frozen=True, kw_only=True):
    """A fitted cost model.

    Parameters
    ----------
    curve : tuple of float
        c0, c1 and c2, for Hertz contacts under fully reversed loads and CHOLMOD.
    families : dict
        :class:`Family` by :func:`family`.
    profiles : dict
        :class:`Factor` by kind of profile.
    superlu : Factor or None
    start, closing : float
        CPU seconds of the start, and of report and exit.
    power : float
        All seconds but those of the start go with this power of the start.
    machine : str
        Machine of the measurements.
    """

    curve: tuple[float, float, float]
    families: dict[str, FamilyPrices]
    profiles: dict[str, PriceFactor]
    superlu: PriceFactor | None
    start: float
    closing: float
    power: float
    machine: str

    def price(self, scene: Scene, methods: Collection[str] | None = None, start: float | None = None) -> Price:
        """Return the price of ``scene``.

        Parameters
        ----------
        scene : Scene
        methods : collection of str, optional
            Default: those that :func:`partialslip.run` chooses; a price is known for these alone.
        start : float, optional
            CPU seconds that this process took to start; default: as on the machine of the measurements.
        """
        begun, speed = start or self.start, ((start or self.start) / self.start) ** self.power
        closing, cost = speed * self.closing, None
        work = None if methods and {*methods} != {*default_methods(scene)} else self._work(scene)
        if work:
            seconds, spread = speed * work[0], work[1]
            cost = begun + seconds + closing
            cost = cost if cost + (spread - 1) * seconds <= TRUSTED * cost else None
        return Price(scene.fem.elements, scene.fem.accuracy, cost, begun, closing)

    def _work(self, scene: Scene) -> tuple[float, float] | None:
        """CPU seconds of the methods, and the factor up to which they are known; None if they are not known."""
        digits = math.log10(1 / scene.fem.accuracy)
        known, profile = self.families.get(price_family(scene)), self.profiles.get(_profile(scene))
        superlu = self.superlu if _superlu(scene) else PriceFactor(0.0, 0.0)
        if not known or not profile or not superlu or not known.range[0] <= digits <= known.range[1]:
            return None
        curve = sum(c * digits**power for power, c in enumerate(self.curve))
        return math.exp(curve + sum(each.at(digits) for each in (known.factor, profile, superlu))), known.spread


def load_prices() -> Prices:
    """Return the shipped price list."""
    text = (resources.files("partialslip.study.cost") / "prices.json").read_text("utf-8")
    return msgspec.json.decode(text, type=Prices)


def price_family(scene: Scene) -> str:
    """Return what sets the cost of ``scene`` beside profile, accuracy and factorisation: its bodies, its loads and
    settings that few use; "reversed" for two equal half-planes under fully reversed loads."""
    load, fem = scene.load, scene.fem
    own = [body for body in (scene.bodies.lower, scene.bodies.upper) if body]
    usual = Fem(accuracy=fem.accuracy, factor=fem.factor)
    found = {
        "unlike": not scene.material.alike,
        "finite": scene.finite and scene.pin is None,
        "pivot": scene.pin is not None,
        "gripped": any(body.pulled or body.holder or body.mesh for body in own),
        "varying P": scene.presses_anew,
        "mean loads": load.in_phase and any(sum(each) for each in (load.Q, load.sigma)),
        "out of phase": not load.in_phase,
        "more loads": len(load.driving) > 2 or load.steps > 1 or load.cycles is not None,
        "plates moved": load.displacement is not None,
        "slopes": any(load.sigma_slope),
        "f varies": scene.friction.varies,
        "not even": not scene.even,
        "settings": fem != usual or scene.effects != Effects(),
    }
    names = [name for name, holds in found.items() if holds]
    if {*names} <= {"mean loads"} and slip_turns_round(scene):
        names.append("slip turns round")
    return ", ".join(names) or "reversed"


def fit(runs: Iterable[MeasuredRun], machine: str) -> Prices:
    """Fit the price list to measured ``runs``, measured on ``machine``.

    Raises
    ------
    InputError
        If there are fewer than ten runs.
    """
    cases = [run for run in runs if run.scene.fem.size is None]
    if len(cases) < 10:
        raise InputError(f"a price list needs at least 10 measured runs of adapted finite elements, not {len(cases)}")
    digits = np.array([math.log10(1 / run.scene.fem.accuracy) for run in cases])
    traits = [[price_family(run.scene), _profile(run.scene), *["superlu"] * _superlu(run.scene)] for run in cases]
    names = sorted({trait for each in traits for trait in each} - {"reversed", "hertz"})
    has = np.array([[name in each for name in names] for each in traits], dtype=float)
    starts = np.array([run.start_s for run in cases])
    usual = float(np.median(starts))
    seconds = np.log([sum(run.costs.values()) for run in cases])
    columns = np.hstack(
        [digits[:, None] ** np.arange(3), np.log(starts / usual)[:, None], has, has * (digits - _MIDDLE)[:, None]]
    )
    count = len(names)
    pull = np.hstack([np.zeros((count, 4 + count)), _PULL * np.eye(count)])
    free = np.full(2 * count, np.inf)
    lower = np.concatenate([[-np.inf, 0.0, 0.0, _POWERS[0]], -free])  # prices must not decrease with the digits
    upper = np.concatenate([[np.inf, np.inf, np.inf, _POWERS[1]], free])
    guess = np.concatenate([[0.0, 0.1, 0.1, sum(_POWERS) / 2], 0 * has[0], 0 * has[0]])

    def off(fitted: Array) -> Array:
        return np.concatenate([columns @ fitted - seconds, pull @ fitted])

    fitted = least_squares(off, guess, bounds=(lower, upper), loss="soft_l1", f_scale=0.3).x
    logs, growths = fitted[4 : 4 + count].tolist(), fitted[4 + count :].tolist()
    enough = has.sum(axis=0) >= _FEWEST
    factors = {
        name: PriceFactor(log, growth)
        for name, log, growth, known in zip(names, logs, growths, enough, strict=True)
        if known
    }
    factors |= {"reversed": PriceFactor(0.0, 0.0), "hertz": PriceFactor(0.0, 0.0)}
    # studentised: few runs are fitted better than others are predicted
    rows = np.vstack([columns, pull])
    leverage = np.einsum("ij,ji->i", columns, np.linalg.pinv(rows)[:, : len(cases)])
    errors, families = np.abs(off(fitted)[: len(cases)]) / np.sqrt(np.maximum(1 - leverage, _ALONE)), {}
    for name in sorted({each[0] for each in traits} & {*factors}):
        own = np.array([each[0] == name for each in traits])
        if own.sum() < _FEWEST:
            continue
        spread = float(np.exp(np.quantile(errors[own], 0.9)))
        families[name] = FamilyPrices(factors[name], spread, (float(digits[own].min()), float(digits[own].max())))
    power = float(fitted[3])
    return Prices(
        curve=tuple(fitted[:3].tolist()),
        families=families,
        profiles={name: factors[name] for name in sorted({each[1] for each in traits} & {*factors})},
        superlu=factors.get("superlu"),
        start=usual,
        closing=float(np.median([run.closing_s * (usual / run.start_s) ** power for run in cases])),
        power=power,
        machine=machine,
    )


def to_json(prices: Prices) -> str:
    """Return ``prices`` as JSON for :func:`load_prices`."""
    return json.dumps(msgspec.to_builtins(prices), indent=1) + "\n"


def _profile(scene: Scene) -> str:
    """Return the kind of the scene's profile, as named in scene files."""
    return str(type(scene.profile).__struct_config__.tag)


def _superlu(scene: Scene) -> bool:
    if scene.fem.factor is None:
        return importlib.util.find_spec("cvxopt") is None
    return scene.fem.factor == "superlu"
