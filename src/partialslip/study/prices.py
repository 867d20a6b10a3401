"""The price list: what finite elements of some accuracy will cost, fitted to a ledger of measured cases.

CPU seconds are taken as exp(start) + points exp(each + growth log10(1/accuracy)): elements crowd about ``points``, in
each body the ends of the contact and of the stick zone and the kinks of the profile. That is for few load steps; long
paths, and bodies that are not mirror images, cost more in the contact itself.
"""

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from importlib import resources
from typing import Any

import msgspec
import numpy as np
from scipy.optimize import least_squares

from partialslip.errors import InputError
from partialslip.plan import plan
from partialslip.reading import parse_scene
from partialslip.result import Array
from partialslip.scene import Scene

_FINEST, _COARSEST = 1e-7, 1e-2


@dataclass(frozen=True)
class Price:
    """What finite elements of ``order`` at ``accuracy`` (of a) are expected to cost: ``cpu_s``, of the method."""

    order: int
    accuracy: float
    cpu_s: float

    @property
    def overrides(self) -> list[str]:
        """The setting, as :func:`partialslip.load_scene` takes it."""
        return [f"fem.order={self.order}", f"fem.accuracy={self.accuracy!r}"]

    def __str__(self) -> str:
        return f"P{self.order} at {self.accuracy:.1e} a: {self.cpu_s:.2g} CPU s"


class Prices(msgspec.Struct, frozen=True, kw_only=True):
    """A fitted cost model.

    ``orders`` holds start, each and growth by element order, and ``finest`` the finest accuracy that each was measured
    at: it is not offered beyond, unless none is. ``spread`` is the factor within which nine of ten cases of
    the fit are; ``machine`` what it was measured on.
    """

    orders: dict[str, tuple[float, float, float]]
    finest: dict[str, float]
    spread: float
    machine: str

    def price(self, scene: Scene, accuracy: float, order: int) -> Price:
        """The CPU seconds of ``order`` at ``accuracy`` for ``scene``, of the method fem."""
        seconds = _seconds(*self.orders[str(order)], _points(scene), math.log10(1 / accuracy))
        return Price(order, accuracy, float(seconds))

    def cheapest(self, scene: Scene, accuracy: float) -> Price:
        """The least price of ``accuracy`` for ``scene``."""
        least = min(self.finest.values())
        offered = [order for order, finest in self.finest.items() if finest <= max(accuracy, least) * 1.01]
        return min((self.price(scene, accuracy, int(order)) for order in offered), key=lambda price: price.cpu_s)

    def best(self, scene: Scene, budget: float) -> Price:
        """The best accuracy to be had of ``scene`` for ``budget`` CPU seconds.

        Raises
        ------
        InputError
            If even 1e-2 costs more.
        """
        least = self.cheapest(scene, _COARSEST)
        if least.cpu_s > budget:
            raise InputError(
                f"--budget {budget:g}s: finite elements take {least.cpu_s:.2g} s for {_COARSEST:g}, "
                "which is the least; the exact method alone (--with exact) takes hundredths of a second"
            )
        accuracies = np.geomspace(_COARSEST, _FINEST, 101)
        return min(
            (price for asked in accuracies.tolist() if (price := self.cheapest(scene, asked)).cpu_s <= budget),
            key=lambda price: price.accuracy,
        )


def load_prices() -> Prices:
    """The shipped price list."""
    text = (resources.files("partialslip") / "study" / "prices.json").read_text("utf-8")
    return msgspec.json.decode(text, type=Prices)


def fit(entries: Iterable[Mapping[str, Any]], machine: str) -> Prices:
    """The price list of the adapted finite elements in the ``entries`` of a ledger, measured on ``machine``.

    Raises
    ------
    InputError
        If there are fewer than ten.
    """
    cases = []
    for entry in entries:
        if "error" not in entry and "fem" in entry["methods"] and entry["scene"]["fem"].get("size") is None:
            scene = parse_scene(entry["scene"])
            found = entry["methods"]["fem"]["cost"]["cpu_s"]
            cases.append((scene.fem.order, _points(scene), math.log10(1 / scene.fem.accuracy), found))
    if len(cases) < 10:
        raise InputError(f"a price list needs at least 10 measured cases of adapted finite elements, not {len(cases)}")
    order, sizes, digits, seconds = (np.array(column) for column in zip(*cases, strict=True))
    orders, number = np.unique(order, return_inverse=True)

    def off(parameters: Array) -> Array:
        start, each, growth = (column[number] for column in parameters.reshape(3, -1))
        ratio: Array = np.log(_seconds(start, each, growth, sizes, digits) / seconds)
        return ratio

    guess = np.repeat([math.log(0.3), math.log(0.02), 0.5], len(orders))
    found = least_squares(off, guess, loss="soft_l1", f_scale=0.3).x
    rows = found.reshape(3, -1).T.tolist()
    return Prices(
        orders={str(each): tuple(row) for each, row in zip(orders.tolist(), rows, strict=True)},
        finest={str(each): float(10.0 ** -digits[order == each].max()) for each in orders.tolist()},
        spread=float(np.exp(np.quantile(np.abs(off(found)), 0.9))),
        machine=machine,
    )


def to_json(prices: Prices) -> str:
    """``prices`` as :func:`load_prices` reads them."""
    return json.dumps(msgspec.to_builtins(prices), indent=1) + "\n"


def _seconds(start: Any, each: Any, growth: Any, points: Any, digits: Any) -> Any:
    return np.exp(start) + points * np.exp(each + growth * digits)


def _points(scene: Scene) -> float:
    """Points that elements crowd about, in all bodies."""
    effects = plan(scene)
    bodies = 2 if effects.needs("coupling") else 1
    return float(bodies * (2 + 2 * effects.needs("friction") + len(scene.profile.kinks)))
