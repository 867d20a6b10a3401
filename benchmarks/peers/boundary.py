"""Boundary elements that share no code with partialslip: boundary.py [PROBLEM ...] [--cells N ...].

The script needs numpy alone. It reads the problems' files and the frozen targets as plain data, and has its own
kernels, contact and friction. It appends a line of JSON for every run to boundary.jsonl, of which docs/verification.md
has a table (``--show`` prints it): problem, cells per half-width, the error of each target in its scale, iterations,
and CPU seconds. What is there already is not run again: delete the lines after a change of this file.

Kernels. A pressure p and a shear traction q on the surface of a half-plane, z into the body, strain and tilt it by
(K. L. Johnson, Contact Mechanics, 1985, section 2.2; plane strain)

    du_x/dx = -b p - (k/pi) int q(s)/(x - s) ds,    du_z/dx = b q - (k/pi) int p(s)/(x - s) ds,

k = 2 (1 - nu^2)/E and b = (1 - 2 nu)(1 + nu)/E. The shear on the lower body is -q. With the sums K = k_u + k_l and the
coupling g = (b_u - b_l)/K, lengths in a and tractions in p0 = a/(R K), gap and slip are

    gap = x^2/2 - (1/pi) int p ln|x - s| ds + g int q dx + const,
    slip = u_x of the lower body less that of the upper one = (1/pi) int q ln|x - s| ds + g int p dx + e x + const,

where e is the strain by the bulk tension. p and q are linear between equally spaced nodes, for which both integrals are
exact. Gap and slip are prescribed at the nodes. What the shape of a body of a size adds to gap and slip comes from
boundary_bodies.py.

Contact and friction. In each load increment all nodes are open, sticking, or slipping one way. One linear system has p
and q of all nodes in contact, and both constants. Its solution tells which nodes change: p < 0 opens, gap < 0 closes,
|q| > f p slips, and slip against q sticks. This repeats until no node changes. Slip counts from the end of the last
increment.
"""

import argparse
import itertools
import json
import time
import tomllib
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from boundary_bodies import added

Array = np.ndarray[Any, np.dtype[Any]]

OUT = Path(__file__).parent / "boundary.jsonl"
DATA = Path(__file__).parents[2] / "src" / "partialslip" / "verify" / "benchmark"
PROBLEMS = (
    "PS-02",
    "PS-18",
    "PS-22",
    "PS-23",
    "PS-24",
    "PS-25",
)  # the first has an exact solution, and checks this script
CELLS = (50, 100, 200)
HALF = 1.05  # a: half-width of the line of nodes
INCREMENTS = 128  # of a cycle
ROUNDED = 1e-11  # of p0 and of a^2/R: smaller tractions, gaps and slips change no node
TOGETHER, MOST = 30, 2000  # iterations in which all wrong nodes change, and in which one changes at a time
OPEN, STICK = 2, 0  # states of nodes, beside 1 and -1, which slip that way


class Increment(NamedTuple):
    """End of a load increment: ``p`` and ``q`` of the nodes, how far those in contact ``slid`` in it, and what this
    ``dissipated``."""

    p: Array
    q: Array
    slid: Array
    dissipated: float


class Line:
    """Nodes on the contact line of two half-planes, in a, p0 and a^2/R.

    Parameters
    ----------
    cells : int
        Per half-width.
    coupling, f : float
        g of the module, and the coefficient of friction.
    arc : float
        a/R if the profile is an arc; 0 for a parabola.
    """

    def __init__(self, cells: int, coupling: float, f: float, arc: float = 0.0) -> None:
        self.h, self.f, count = 1 / cells, f, round(HALF * cells)
        self.x = np.arange(-count, count + 1) * self.h
        self.apart = self.x**2 / (1 + np.sqrt(1 - (arc * self.x) ** 2))
        nodes = np.subtract.outer(self.x, self.x) / self.h
        log = self.h * (_twice(nodes + 1) - 2 * _twice(nodes) + _twice(nodes - 1) + np.log(self.h)) / np.pi
        below = coupling * self.h * (np.tri(len(self.x)) - np.eye(len(self.x)) / 2)
        self.gap_of, self.slip_of = (-log, below), (below, log)
        self.state = np.where(np.abs(self.x) < 1.5 * self.h, STICK, OPEN)
        self.slip, self.iterations = np.zeros_like(self.x), 0

    def add(self, upper: float, lower: float, shapes: list[tuple[Array, Array]]) -> None:
        """Add what the shapes of the upper and the lower body do (:func:`boundary_bodies.added`), whose shares of K are
        ``upper`` and ``lower``."""
        (xx_u, xz_u, zx_u, zz_u), (xx_l, xz_l, zx_l, zz_l) = (
            [share * self._at_nodes(places, found[:, of, :, by]) for of in (0, 1) for by in (0, 1)]
            for share, (places, found) in zip((upper, lower), shapes, strict=True)
        )
        self.gap_of = self.gap_of[0] + zz_u + zz_l, self.gap_of[1] + zx_u - zx_l
        self.slip_of = self.slip_of[0] + xz_l - xz_u, self.slip_of[1] - xx_u - xx_l

    def _at_nodes(self, places: Array, found: Array) -> Array:
        """Displacements at the nodes by tractions at the nodes, from those at a few places."""
        powers = len(places) - 1
        fitted = np.polynomial.chebyshev.chebvander(self.x / HALF, powers)
        fitted = fitted @ np.linalg.inv(np.polynomial.chebyshev.chebvander(places / HALF, powers))
        result: Array = self.h * fitted @ found @ fitted.T
        return result

    def load(self, P: float, Q: float, strain: float) -> Increment:
        """Go to these loads in one increment. Raises ArithmeticError if nodes go on to change."""
        for count in range(MOST):
            self.iterations += 1
            p, q, gap, slip = self._solve(P, Q, strain)
            state = self._next(p, q, gap, slip - self.slip)
            wrong = np.flatnonzero(state != self.state)
            if not wrong.size:
                slid = np.where(self.state != OPEN, slip - self.slip, 0.0)
                self.slip = slip
                return Increment(p, q, slid, self.h * float(q @ slid))
            # friction first: whether a node at the end of the contact is open depends on it
            rubbing = wrong[(self.state[wrong] != OPEN) & (state[wrong] != OPEN)]
            wrong = rubbing if rubbing.size else wrong
            if count > TOGETHER:  # together, nodes can change to and fro for ever
                wrong = wrong[:1]
            self.state[wrong] = state[wrong]
        raise ArithmeticError(f"P = {P:g}, Q = {Q:g}, strain = {strain:g}: nodes go on to change")

    def _solve(self, P: float, Q: float, strain: float) -> tuple[Array, Array, Array, Array]:
        """p, q, gap and slip of all nodes in the present states."""
        at = np.flatnonzero(self.state != OPEN)
        count, state = len(at), self.state[at]
        sticks, both = (state == STICK)[:, None], np.ix_(at, at)
        matrix, right = np.zeros((2 * count + 2, 2 * count + 2)), np.zeros(2 * count + 2)
        matrix[:count, : 2 * count] = np.hstack([part[both] for part in self.gap_of])
        matrix[:count, -2], right[:count] = 1, -self.apart[at]
        friction = np.hstack([np.diag(-self.f * state), np.eye(count)])
        stuck = np.hstack([part[both] for part in self.slip_of])
        matrix[count:-2, : 2 * count] = np.where(sticks, stuck, friction)
        matrix[count:-2, -1] = sticks[:, 0]
        right[count:-2] = np.where(sticks[:, 0], self.slip[at] - strain * self.x[at], 0.0)
        matrix[-2, :count] = matrix[-1, count:-2] = self.h
        right[-2:] = P, Q
        found = np.linalg.solve(matrix, right)
        p, q = np.zeros((2, len(self.x)))
        p[at], q[at] = found[:count], found[count:-2]
        gap = self.apart + self.gap_of[0] @ p + self.gap_of[1] @ q + found[-2]
        slip = strain * self.x + self.slip_of[0] @ p + self.slip_of[1] @ q + found[-1]
        return p, q, gap, slip

    def _next(self, p: Array, q: Array, gap: Array, moved: Array) -> Array:
        """States that the solution asks for. ``moved`` is the slip of the increment."""
        over = np.abs(q) > self.f * np.maximum(p, 0) + ROUNDED
        sticking = np.where(over, np.sign(q).astype(int), STICK)
        slipping = np.where(self.state * moved < -ROUNDED, STICK, self.state)
        touching = np.where(self.state == STICK, sticking, slipping)
        # a node that closes goes on as its neighbour does: if it stuck, its shear could lift it again
        left, right = np.roll(self.state, 1), np.roll(self.state, -1)
        lifted = np.where(gap < -ROUNDED, np.where(left != OPEN, left, np.where(right != OPEN, right, STICK)), OPEN)
        return np.where(self.state == OPEN, lifted, np.where(p < -ROUNDED, OPEN, touching))


def _twice(t: Array) -> Array:
    """ln|t|, integrated twice."""
    return t * t * (np.log(np.abs(t), where=t != 0, out=np.zeros_like(t)) / 2 - 0.75)


class Task(NamedTuple):
    """Problem in the units of the line. ``a``, ``p0`` and ``R`` of Hertz have SI units. ``points`` are load points
    (Q, e), and ``pressed`` is the number of increments of P."""

    line: Line
    a: float
    p0: float
    R: float
    points: list[tuple[float, float]]
    cycles: int
    pressed: int


def task(number: str, cells: int) -> Task:
    """Read a problem, and make its line."""
    scene = tomllib.loads((DATA / "problems" / f"{number}.toml").read_text("utf-8"))["scene"]
    both, load, R = scene["material"], scene["load"], scene["profile"]["R"]
    (k_u, b_u), (k_l, b_l) = (_compliances(both.get(name, both)) for name in ("upper", "lower"))
    K = k_u + k_l
    a = float(np.sqrt(2 * R * K * load["P"] / np.pi))
    p0 = a / (R * K)
    Q = np.array(load.get("Q", [])) / (p0 * a)
    strain = np.array(load.get("sigma", 0 * Q)) * k_l / (2 * K * p0)
    bodies = scene.get("bodies", {})
    pad = any(body["kind"] == "pad" for body in bodies.values())
    line = Line(cells, (b_u - b_l) / K, scene["friction"]["f"], a / R if pad else 0.0)
    if bodies:
        line.add(k_u / K, k_l / K, [added(bodies[name], both["nu"], HALF, a, R) for name in ("upper", "lower")])
    # pressing makes unlike bodies slip: the contact then grows by one node an increment
    pressed = 1 if b_u == b_l and not pad else cells
    return Task(line, a, p0, R, list(zip(Q.tolist(), strain.tolist(), strict=True)), load.get("cycles", 2), pressed)


def _compliances(material: dict[str, float]) -> tuple[float, float]:
    E, nu = material["E"], material["nu"]
    return 2 * (1 - nu**2) / E, (1 - 2 * nu) * (1 + nu) / E


def solve(given: Task) -> list[list[Increment]]:
    """All increments of the last cycle, by the load point to which they go; of pressing, if there is nothing else."""
    line, full, points = given.line, np.pi / 2, given.points
    pressing = [line.load(full * (step / given.pressed) ** 2, 0.0, 0.0) for step in range(1, given.pressed + 1)]
    if not points:
        return [pressing]
    # two load points are 1 and 2, and the cycle goes from 2 to 1 and back. More are gone through in turn
    path = [(0.0, 0.0), points[-1], *points * given.cycles]
    shares = np.arange(1, INCREMENTS // len(points) + 1)[:, None] * len(points) / INCREMENTS
    ways = []
    for before, after in itertools.pairwise(path):
        ways.append([line.load(full, *loads) for loads in before + shares * np.subtract(after, before)])
    return ways[-len(points) :]


def values(number: str, given: Task) -> dict[str, float]:
    """Targets of a problem as these elements find them, SI units."""
    line, ways = given.line, solve(given)
    ends, x, f = [way[-1] for way in ways], line.x, line.f
    forces = [Q for Q, _ in given.points] or [0.0]
    least, largest = int(np.argmin(forces)), int(np.argmax(forces))
    first, last = ends[least], ends[largest]
    slid = sum(each.slid for way in ways[least + 1 : largest + 1] for each in way) + np.zeros_like(x)
    low, high = (choose([end.q for end in ends], axis=0) for choose in (np.min, np.max))
    if len(ends) == 2:
        low, high = first.q, last.q
    room = f * (first.p + last.p) - np.abs(high - low)
    power = 2.0
    if not given.points:  # the end of a zone that has grown leaves the friction bound more gently than by a square root
        room, power = f * last.p - np.abs(last.q), 2 / 3
    edges = np.array([_edges(x, each.p) for each in (first, last)])
    left, right = _ends(x, room, power)
    found = {
        "a": given.a * float(np.diff(edges).mean()) / 2,
        **dict(zip(("left_1", "right_1", "left_2", "right_2"), (given.a * edges).ravel().tolist(), strict=True)),
        "m": -given.a * left,
        "n": given.a * right,
        "p_max": given.p0 * float(last.p.max()),
        "slip": given.a**2 / given.R * float(np.abs(slid).max()),
        "dissipated": given.p0 * given.a**3 / given.R * sum(each.dissipated for way in ways for each in way),
    }
    wanted = targets(number)
    nodal = {"p": last.p, "dq": high - low, "q1": low, "q2": high}
    for key in wanted:
        name, _, place = key.partition("@")
        if place:
            found[key] = given.p0 * float(np.interp(float(place) * wanted["a"]["value"] / given.a, x, nodal[name]))
    return {key: value for key, value in found.items() if key in wanted}


def _edges(x: Array, p: Array) -> tuple[float, float]:
    """Ends of the contact: p^2 is nearly a parabola, and is extended to zero from the nodes next but one."""
    inside = np.flatnonzero(p > ROUNDED)
    left, right = (np.polyfit(p[some] ** 2, x[some], 2)[-1] for some in (inside[2:8], inside[-8:-2]))
    return float(left), float(right)


def _ends(x: Array, room: Array, power: float) -> tuple[float, float]:
    """Ends of the stick zone: ``room``, how far q is from the bound, to this ``power`` is extended to zero by a line
    from the nodes next but one."""
    inside = np.flatnonzero(room > ROUNDED)
    left, right = (np.polyfit(room[some] ** power, x[some], 1)[-1] for some in (inside[1:4], inside[-4:-1]))
    return float(left), float(right)


def targets(number: str) -> dict[str, dict[str, float]]:
    """Targets of a problem: value, scale and uncertainty by key."""
    found: dict[str, dict[str, float]] = json.loads((DATA / "targets.json").read_text("utf-8"))["targets"][number]
    return found


def measured(number: str, cells: int) -> dict[str, Any]:
    """Errors of one run, in the scales of the targets."""
    start, given = time.process_time(), task(number, cells)
    found, wanted = values(number, given), targets(number)
    errors = {key: (value - wanted[key]["value"]) / wanted[key]["scale"] for key, value in found.items()}
    spent = round(time.process_time() - start, 2)
    return {"problem": number, "cells": cells, "errors": errors, "iterations": given.line.iterations, "cpu_s": spent}


def table(lines: list[dict[str, Any]]) -> str:
    """Markdown table: largest error of each kind of target on the most cells, and uncertainties of the targets."""
    kinds = {"a": "a, ends", "m": "m, n", "p": "p", "dq": "dq", "q1": "q1, q2", "slip": "slip", "dissipated": "energy"}
    rows = [f"| problem | cells | {' | '.join(kinds.values())} | CPU s |", "|" + "---|" * (len(kinds) + 3)]
    for number in dict.fromkeys(line["problem"] for line in lines):
        finest = max((line for line in lines if line["problem"] == number), key=lambda line: int(line["cells"]))
        rows.append(_row(number, finest["cells"], finest["errors"], kinds, f"{finest['cpu_s']:.2g}"))
        rows.append(_row("", "targets", {key: each["uncertainty"] for key, each in targets(number).items()}, kinds, ""))
    return "\n".join(rows)


def _row(number: str, cells: object, errors: dict[str, float], kinds: dict[str, str], spent: str) -> str:
    cells_of = []
    for kind in kinds:
        some = [abs(error) for key, error in errors.items() if _kind(key) == kind]
        cells_of.append(f"{max(some):.0e}" if some else "–")
    return f"| {number} | {cells} | {' | '.join(cells_of)} | {spent} |"


def _kind(key: str) -> str:
    """Kind of a target, by its first name in the table."""
    name = key.partition("@")[0]
    same = {"left_1": "a", "right_1": "a", "left_2": "a", "right_2": "a", "n": "m", "p_max": "p", "q2": "q1"}
    return same.get(name, name)


def main() -> None:
    """Run the chosen problems, or print the table."""
    options = argparse.ArgumentParser(description=__doc__.partition(":")[0])
    options.add_argument("problems", nargs="*", default=PROBLEMS, metavar="PROBLEM")
    options.add_argument("--cells", nargs="+", type=int, default=CELLS)
    options.add_argument("--show", action="store_true", help="print the table of what is there")
    chosen = options.parse_args()
    lines = [json.loads(line) for line in OUT.read_text("utf-8").splitlines()] if OUT.exists() else []
    if chosen.show:
        print(table(lines))
        return
    done = {(line["problem"], line["cells"]) for line in lines}
    for number, cells in itertools.product(chosen.problems, chosen.cells):
        if (number, cells) not in done:
            line = json.dumps(measured(number, cells))
            with OUT.open("a", encoding="utf-8") as file:
                file.write(line + "\n")
            print(line, flush=True)


if __name__ == "__main__":
    main()
