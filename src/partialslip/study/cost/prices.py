"""The price list: predicted CPU seconds of a finite-element run by accuracy, fitted to a ledger of measured cases.

CPU seconds of the method are modelled as exp(c0 + c1 d + c2 d^2) with d = log10(1/accuracy) and c by element order,
times a factor of the profile's kind and a factor of SuperLU, which grows with d. Bodies that are not mirror images cost
twice as much. Start, report and the other methods are added. All seconds are scaled by the CPU seconds that this
process took to start, because they depend on the machine and on other load. Long load paths cost more than predicted.
"""

import importlib.util
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from importlib import resources
from typing import TYPE_CHECKING

import msgspec
import numpy as np
from scipy.optimize import least_squares

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.plan import plan
from partialslip.scene import Scene

if TYPE_CHECKING:
    from partialslip.batch.job import Solved

_FINEST, _COARSEST = 1e-9, 1e-2  # limit: accuracies that a price is known for
_CHOICES = 141  # cost: number of accuracies from _COARSEST to _FINEST
_SPEEDS = 0.2, 5.0  # limit: the scale factor: a slower start has other reasons than the machine


@dataclass(frozen=True)
class Price:
    """Predicted cost of a finite-element run.

    Parameters
    ----------
    order : int
        Order of the elements.
    accuracy : float
        Accuracy, as a fraction of a.
    cpu_s : float
        CPU seconds of the whole process.
    start_s, closing_s : float
        Parts of ``cpu_s`` for the start, and for report and exit.
    """

    order: int
    accuracy: float
    cpu_s: float
    start_s: float
    closing_s: float

    @property
    def overrides(self) -> list[str]:
        """Settings of order and accuracy for :func:`partialslip.load_scene`."""
        return [f"fem.order={self.order}", f"fem.accuracy={self.accuracy!r}"]

    def __str__(self) -> str:
        return f"P{self.order} at {self.accuracy:.1e} a: {self.cpu_s:.2g} CPU s"


class Prices(msgspec.Struct, frozen=True, kw_only=True):
    """A fitted cost model.

    Parameters
    ----------
    orders : dict
        c0, c1 and c2 by element order, with CHOLMOD and a Hertz contact.
    kinds : dict
        Logarithm of the factor by kind of profile.
    superlu : tuple
        Logarithm of SuperLU's factor, and its increase per digit.
    finest : dict
        Finest measured accuracy by order. An order is not offered beyond, except the order measured finest.
    methods : dict
        CPU seconds of the other methods.
    start, closing : float
        CPU seconds of the start, and of report and exit.
    spread : float
        Factor between predicted and measured cost that nine of ten fitted cases do not exceed.
    machine : str
        Machine of the measurements.
    """

    orders: dict[str, tuple[float, float, float]]
    kinds: dict[str, float]
    superlu: tuple[float, float]
    finest: dict[str, float]
    methods: dict[str, float]
    start: float
    closing: float
    spread: float
    machine: str

    def price(
        self,
        scene: Scene,
        accuracy: float,
        order: int,
        methods: Sequence[str] = ("exact", "fem"),
        start: float | None = None,
    ) -> Price:
        """Return the price of ``scene`` by ``methods``, with finite elements of ``order`` at ``accuracy``.

        Parameters
        ----------
        scene : Scene
        accuracy : float
            Fraction of a.
        order : int
            Order of the elements.
        methods : sequence of str
        start : float, optional
            CPU seconds that this process took to start; default: as on the machine of the measurements.
        """
        speed = float(np.clip(start / self.start, *_SPEEDS)) if start else 1.0
        digits = math.log10(1 / accuracy)
        cost = sum(c * digits**power for power, c in enumerate(self.orders[str(order)]))
        cost += self.kinds.get(_kind(scene), 0.0) + math.log(_bodies(scene))
        if _superlu(scene):
            cost += self.superlu[0] + self.superlu[1] * digits
        others = sum(self.methods.get(method, 0.0) for method in methods)
        begun, closing = start or self.start, speed * self.closing
        return Price(order, accuracy, begun + speed * (others + math.exp(cost)) + closing, begun, closing)

    def cheapest(
        self, scene: Scene, accuracy: float, methods: Sequence[str] = ("exact", "fem"), start: float | None = None
    ) -> Price:
        """Return the lowest price of ``accuracy`` for ``scene``; ``methods`` and ``start`` as for :meth:`price`."""
        least = min(self.finest.values())
        offered = [order for order, finest in self.finest.items() if finest <= max(accuracy, least) * 1.01]
        prices = (self.price(scene, accuracy, int(order), methods, start) for order in offered)
        return min(prices, key=lambda price: price.cpu_s)

    def best(
        self, scene: Scene, budget: float, methods: Sequence[str] = ("exact", "fem"), start: float | None = None
    ) -> Price:
        """Return the price of the finest accuracy of ``scene`` within ``budget`` CPU seconds.

        ``methods`` and ``start`` as for :meth:`price`.

        Raises
        ------
        InputError
            If an accuracy of 1e-2 costs more than the budget.
        """
        least = self.cheapest(scene, _COARSEST, methods, start)
        if least.cpu_s > budget:
            raise InputError(
                f"--budget {budget:g}s: must be at least {math.ceil(10 * least.cpu_s) / 10:g} s on this machine, the "
                f"price of an accuracy of {_COARSEST:g} a; or use the exact method alone (--with exact)"
            )
        accuracies = np.geomspace(_COARSEST, max(_FINEST, min(self.finest.values())), _CHOICES)
        prices = (self.cheapest(scene, asked, methods, start) for asked in accuracies.tolist())
        return min((price for price in prices if price.cpu_s <= budget), key=lambda price: price.accuracy)


def load_prices() -> Prices:
    """Return the shipped price list."""
    text = (resources.files("partialslip.study.cost") / "prices.json").read_text("utf-8")
    return msgspec.json.decode(text, type=Prices)


def fit(entries: "Iterable[Solved]", overheads: Mapping[str, float], machine: str) -> Prices:
    """Fit the price list of adapted finite elements.

    Parameters
    ----------
    entries : iterable of Solved
        Entries of a ledger. Cases from :func:`partialslip.batch.job.solve_apart` are scaled by the start of the
        process, because the machine may have had other load.
    overheads : mapping of str to float
        CPU seconds "start" and "closing", and of other methods by name.
    machine : str
        Machine of the measurements.

    Raises
    ------
    InputError
        If there are fewer than ten cases.
    """
    cases = []
    for entry in entries:
        if entry.run and "fem" in entry.run.methods and entry.run.scene.fem.size is None:
            scene = entry.run.scene
            costs = {name: method.cost.cpu_s for name, method in entry.run.methods.items()}
            start = entry.process.cpu_s - sum(costs.values()) if entry.process else 1.0
            digits = math.log10(1 / scene.fem.accuracy)
            cases.append((scene.fem.elements, _kind(scene), _superlu(scene), digits, _bodies(scene), start, costs))
    if len(cases) < 10:
        raise InputError(f"a price list needs at least 10 measured cases of adapted finite elements, not {len(cases)}")
    orders, kinds = sorted({case[0] for case in cases}), sorted({case[1] for case in cases} - {"hertz"})
    starts = np.array([case[5] for case in cases])
    found = np.log(np.array([case[6]["fem"] / case[4] for case in cases]) * np.median(starts) / starts)
    columns = np.array(
        [
            [(order == each) * digits**power for each in orders for power in range(3)]
            + [float(kind == each) for each in kinds]
            + [float(other), other * digits]
            for order, kind, other, digits, *_ in cases
        ]
    )
    # prices must not decrease with the digits
    lower = np.concatenate([np.tile([-np.inf, 0.0, 0.0], len(orders)), np.full(len(kinds) + 2, -np.inf)])
    guess = np.maximum(lower, np.zeros(columns.shape[1])) + 0.01

    def off(parameters: Array) -> Array:
        difference: Array = columns @ parameters - found
        return difference

    fitted = least_squares(off, guess, bounds=(lower, np.inf), loss="soft_l1", f_scale=0.3).x
    rows, rest = fitted[: 3 * len(orders)].reshape(-1, 3).tolist(), fitted[3 * len(orders) :].tolist()
    exact = [case[6]["exact"] for case in cases if "exact" in case[6]]
    methods = {key: value for key, value in overheads.items() if key not in ("start", "closing")}
    return Prices(
        orders={str(order): tuple(row) for order, row in zip(orders, rows, strict=True)},
        kinds={"hertz": 0.0, **dict(zip(kinds, rest, strict=False))},
        superlu=(rest[-2], rest[-1]),
        finest={str(order): float(10.0 ** -max(case[3] for case in cases if case[0] == order)) for order in orders},
        methods={**({"exact": float(np.median(exact))} if exact else {}), **methods},
        start=overheads["start"],
        closing=overheads["closing"],
        spread=float(np.exp(np.quantile(np.abs(off(fitted)), 0.9))),
        machine=machine,
    )


def to_json(prices: Prices) -> str:
    """Return ``prices`` as JSON for :func:`load_prices`."""
    return json.dumps(msgspec.to_builtins(prices), indent=1) + "\n"


def _bodies(scene: Scene) -> int:
    """Return the number of bodies to mesh and to factor."""
    return 1 if scene.mirrored and scene.fem.lower_size == 1 and not plan(scene).needs("coupling") else 2


def _kind(scene: Scene) -> str:
    """Return the kind of the scene's profile, as named in scene files."""
    return str(type(scene.profile).__struct_config__.tag)


def _superlu(scene: Scene) -> bool:
    if scene.fem.factor is None:
        return importlib.util.find_spec("cvxopt") is None
    return scene.fem.factor == "superlu"
