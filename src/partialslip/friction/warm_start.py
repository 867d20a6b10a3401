"""Which nodes touch, and which slip, in the steps of one mesh: where the same steps of another mesh begin."""

from collections.abc import Hashable

import numpy as np

from partialslip.friction.active_set import Sides, Solution
from partialslip.tools.arrays import Array, Mask

Pair = tuple[Solution, Solution]


class Trail:
    """Partitions of the steps at nodes ``x`` (n,), ascending, by the key of each step; ``earlier`` is the trail of the
    same steps at other nodes."""

    def __init__(self, x: Array, earlier: "Trail | None" = None) -> None:
        self._x = x
        self._known: dict[Hashable, tuple[Mask, Sides]] = {}
        self._guessed: dict[Hashable, tuple[Mask, Sides]] = {}
        if earlier:
            nearest = np.searchsorted((earlier._x[1:] + earlier._x[:-1]) / 2, x)
            self._guessed = {key: (touch[nearest], slip[nearest]) for key, (touch, slip) in earlier._known.items()}

    def starts(self, key: Hashable) -> list[Pair]:
        """Forces along y and x with the partition that the step had at the other nodes; none if it is not known."""
        if key not in self._guessed:
            return []
        (touch, slip), zero = self._guessed[key], np.zeros(len(self._x))
        return [
            (Solution(touch.astype(float), zero, zero, 0.0, 0), Solution(zero, -slip.astype(float), zero, 0.0, 0)),
        ]

    def sides(self, key: Hashable, otherwise: Sides) -> Sides:
        """Sides of the nodes in the step at the other nodes; ``otherwise`` if they are not known."""
        return self._guessed[key][1] if key in self._guessed else otherwise

    def keep(self, key: Hashable, found: Pair) -> None:
        """Remember the partition of the step."""
        p, q = found
        self._known[key] = p.x > 0, q.sides
