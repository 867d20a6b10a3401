"""What the values of a table are: values at points, means over cells, or nodal forces over the nodes' weights."""

from typing import Literal, NamedTuple

import numpy as np

from partialslip.tools.arrays import Array, Indices

Kind = Literal["sampled", "mean", "nodal"]
#: Kinds of values, in words.
KINDS: dict[Kind, str] = {
    "sampled": "values at points",
    "mean": "means over cells",
    "nodal": "nodal forces of linear elements over the nodes' weights",
}
_FAR = 1e40  # limit: of the fitted window: farther points are as far, as powers of their distance overflow
_INTEGRALS: dict[Kind, int] = {"sampled": 0, "mean": 1, "nodal": 2}  # fixed: of a power under its average


class Average(NamedTuple):
    """How a table's values are made from tractions: values of a ``kind``, averaged over ``points`` neighbours."""

    kind: Kind
    points: int = 1

    @property
    def rises(self) -> int:
        """Most points beside the end of a square root at which secants from the first zero grow steeper inward.

        One of values at points; those of an average over w spacings grow over at most five quarters of w more.
        """
        width = self.points - 1 + _INTEGRALS[self.kind]
        return 1 + width + width // 4

    def begins(self, x: Array, at: int) -> float:
        """Left end, m, of the piece of the contact line that tells in the value at point ``at`` of ``x`` (n,), m."""
        points = _points(x, np.array([at - self.points // 2]))
        return float({"sampled": points[1], "mean": (points[0] + points[1]) / 2, "nodal": points[0]}[self.kind][0])

    def hidden(self, least: float, spacing: float) -> float:
        """Length, m, beside an end over which (end - x)^(1/2) has averages of at most ``least``, at points that are a
        ``spacing`` (m) apart."""
        times = _INTEGRALS[self.kind]
        factor = self.points * spacing**times * np.prod([1.5 + k for k in range(times)])
        return float((least * factor) ** (1 / (times + 0.5)))

    def powers(self, x: Array, at: Indices, ends: Array, powers: Array) -> Array:
        """Averages (e, n, k) of max(end - x, 0)^power at the points ``at`` (n,) of ``x``, for the ``ends`` (e,), m, and
        the ``powers`` (k,): in closed form, as divided differences of integrals of the power."""
        neighbours = at[:, None] + np.arange(-(self.points // 2), self.points // 2 + 1)
        every, places = np.unique(neighbours, return_inverse=True)
        values = self._powers(x, every, ends, powers)
        return np.asarray(values[:, places.reshape(neighbours.shape)].mean(axis=2))

    def _powers(self, x: Array, at: Indices, ends: Array, powers: Array) -> Array:
        before, here, after = (points[None, :, None] for points in _points(x, at))
        times = _INTEGRALS[self.kind]
        factor = np.prod([powers + 1 + k for k in range(times)], axis=0)

        def integral(points: Array) -> Array:
            return np.clip(ends[:, None, None] - points, 0.0, _FAR) ** (powers + times) / factor

        if self.kind == "sampled":
            return integral(here)
        if self.kind == "mean":
            left, right = (before + here) / 2, (here + after) / 2
            return (integral(left) - integral(right)) / (right - left)
        left_slope = (integral(before) - integral(here)) / (here - before)
        right_slope = (integral(here) - integral(after)) / (after - here)
        return 2 * (left_slope - right_slope) / (after - before)


RUNNING = (3, 5, 7, 9)  # accuracy: numbers of points that values may be averaged over
#: What values may be where no kind is given.
EVERY = (*(Average(kind) for kind in KINDS), *(Average("sampled", count) for count in RUNNING))


def note(averages: tuple[Average, ...], usual: Kind) -> str:
    """What the values were guessed to be, any of ``averages``; empty if they are surely the ``usual`` kind."""
    if averages == (Average(usual),):
        return ""
    kinds = " or ".join(dict.fromkeys(KINDS[each.kind] for each in averages))
    if len(averages) > 1:
        return f"p does not show whether it is {kinds}: ends are known to a spacing or so; tell the kind with --kind"
    points = f" averaged over {averages[0].points} points" if averages[0].points > 1 else ""
    return f"read as {kinds}{points}, as the ends of p show: if it is another kind, tell it with --kind"


def _points(x: Array, at: Indices) -> tuple[Array, Array, Array]:
    """Points before, at and after ``at`` (n,), m; beyond the ends of ``x`` they go on evenly."""
    last = len(x) - 1

    def point(i: Indices) -> Array:
        beyond = np.where(i < 0, i * (x[1] - x[0]), np.where(i > last, (i - last) * (x[-1] - x[-2]), 0.0))
        return np.asarray(x[np.clip(i, 0, last)] + beyond)

    return point(at - 1), point(at), point(at + 1)


def cells_around(x: Array) -> Array:
    """Ends of the cells around the points ``x`` (n,), (n + 1,), m: halfway between the points; the outermost cells lie
    evenly about their points."""
    inner = (x[1:] + x[:-1]) / 2
    return np.concatenate([[2 * x[0] - inner[0]], inner, [2 * x[-1] - inner[-1]]])


def cells_of_nodes(x: Array) -> Array:
    """Ends of the nodes' cells, (n + 1,), m, for nodes at ``x`` (n,): each as wide as the integral of the node's shape
    function, which is linear on the elements between the nodes."""
    return np.concatenate([[x[0]], (x[1:] + x[:-1]) / 2, [x[-1]]])
