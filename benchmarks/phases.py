"""Where the time goes on one mesh of 10,000 to 1,000,000 unknowns: python benchmarks/phases.py [--repeats 3].

Meshes of ``hertz-large-tension`` by P4, graded to the ends of the zones and growing at different rates beyond; CHOLMOD.
Prints CPU seconds by phase (medians), their exponents against the unknowns, and peak memory; ``--figure`` draws them.
The floor is the time that CHOLMOD takes for the numbers alone of one factor of that stiffness, in its own best order,
with no compliance asked for. The largest mesh takes 7 GB.
"""

import argparse
import resource
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from itertools import cycle
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Any, NamedTuple
from unittest import mock

import cvxopt
import numpy as np
from cvxopt import cholmod
from scipy import sparse

from partialslip import load_scene, plan
from partialslip.result import Clock
from partialslip.tools.convergence import power
from partialslip.tools.output.svg import svg
from partialslip.tools.threads import one_thread
from partialslip_fem import factor
from partialslip_fem.elasticity import body
from partialslip_fem.mesh_solution import Adapted
from partialslip_fem.problem import scaled
from partialslip_fem.result import to_result
from partialslip_fem.solving import solve_on_meshes
from partialslip_meshes import Mesh, block

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WIDTH, SIZE = 16.0, 1e-5
GROWTHS = {10_000: 1.0, 30_000: 0.47, 100_000: 0.21, 250_000: 0.134, 500_000: 0.088, 1_000_000: 0.0632}
PHASES = ("mesh", "assembly", "ordering", "factorisation", "copies", "inverse", "contact", "results")
APART = (  # parts of the factorisation; the rest of it is copies: matrices in the new order, and rows of the factor
    ("ordering", factor._Cholmod, "_minimum_degree"),
    ("numbers", cholmod, "symbolic"),
    ("numbers", cholmod, "numeric"),
    ("inverse", factor, "_inverse"),
)
MERGED = {"far field": "assembly", "condensation": "contact"}  # small ones, and where they are counted
LARGE = 90_000  # unknowns from which exponents are fitted
MARKS, GREYS = ("o", "s", "^", "v", "D", "<", ">", "p"), ("0.0", "0.45", "0.65")
HATCHES = ("", "////", "....", "xxxx", "----", "\\\\\\\\", "oooo", "++++")


class Row(NamedTuple):
    """Unknowns, nodes of the contact line, CPU seconds by phase, the floor, and peak memory so far, MB."""

    unknowns: int
    nodes: int
    seconds: dict[str, float]
    floor: float
    memory_mb: float


@one_thread
def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--repeats", type=int, default=3)
    options.add_argument("--largest", type=int, default=max(GROWTHS), help="unknowns of the largest mesh, about")
    options.add_argument("--figure", type=Path, help="SVG file to write")
    chosen = options.parse_args()

    rows = []
    print("unknowns", "nodes", *PHASES, "sum", "floor", "MB", sep=" | ")
    for growth in (growth for unknowns, growth in GROWTHS.items() if unknowns <= chosen.largest):
        rows.append(measured(growth, chosen.repeats))
        *shown, memory = [
            *rows[-1].seconds.values(),
            sum(rows[-1].seconds.values()),
            rows[-1].floor,
            rows[-1].memory_mb,
        ]
        figures = [f"{value:.2f}" for value in shown]
        print(f"{rows[-1].unknowns:,}", rows[-1].nodes, *figures, f"{memory:.0f}", sep=" | ", flush=True)
    found = exponents(rows)
    print(f"exponents from {LARGE:,}", "", *(f"{value:.2f}" for value in found.values()), sep=" | ")
    if chosen.figure:
        chosen.figure.write_text(figure(rows), "utf-8")


def measured(growth: float, repeats: int) -> Row:
    """Medians of the solutions on the mesh of this ``growth``."""
    scene = load_scene("hertz-large-tension", ["fem.factor='cholmod'"])
    effects = plan(scene)
    problem = scaled(scene, effects)
    a, (part,) = np.sqrt(2 / np.pi), problem.parts
    ends = {a * end: a * SIZE for end in (-1, -0.803853, 0.294929, 1)}
    spent, floors = [], []
    for _ in range(repeats):
        clock = Clock()
        with clock.phase("mesh"):
            mesh = block(WIDTH * a, (-1.1 * a, 1.1 * a), ends, growth)
        clock.add_meshing(mesh.cpu_s)
        with ExitStack() as patches:
            for phase, owner, name in APART:
                patches.enter_context(mock.patch.object(owner, name, timed(clock, phase, getattr(owner, name))))
            solution = solve_on_meshes([mesh], problem, WIDTH * a, clock)
        nodes = len(solution.lower.x)
        with clock.phase("results"):
            adapted = Adapted(solution, {}, 1, solution.factored, solution.iterations, WIDTH)
            to_result(scene, effects, problem, adapted, clock)
        within = sum(clock.phases[phase] for phase in {phase for phase, _, _ in APART})
        clock.phases["copies"] = clock.phases["factorisation"] - within
        clock.phases["factorisation"] = clock.phases.pop("numbers")
        for name, other in MERGED.items():
            clock.phases[other] += clock.phases.pop(name)
        spent.append(clock.phases)
        del solution, adapted
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        unknowns, floor = alone(mesh, part.kappa, problem.order)
        floors.append(floor)
    return Row(
        unknowns, nodes, {name: median(phases[name] for phases in spent) for name in PHASES}, median(floors), memory
    )


def timed(clock: Clock, phase: str, function: Callable[..., Any]) -> Callable[..., Any]:
    """``function``, whose CPU seconds count for ``phase``."""

    def counted(*arguments: Any, **named: Any) -> Any:
        with clock.phase(phase):
            return function(*arguments, **named)

    return counted


def alone(mesh: Mesh, kappa: float, order: int) -> tuple[int, float]:
    """Unknowns, and CPU seconds of the numeric factorisation in CHOLMOD's own order."""
    half = body(mesh, kappa, order)
    free = np.setdiff1d(np.arange(half.stiffness.shape[0]), half.held)
    lower = sparse.tril(half.stiffness[free][:, free], format="coo")
    matrix = cvxopt.spmatrix(lower.data, lower.row.astype(np.int64), lower.col.astype(np.int64), lower.shape)
    factored, clock = cholmod.symbolic(matrix), Clock()
    with clock.phase("numbers"):
        cholmod.numeric(matrix, factored)
    return half.unknowns, clock.phases["numbers"]


def exponents(rows: Sequence[Row]) -> dict[str, float]:
    """Exponents of the phases, of the sum and of the floor against the unknowns, by least squares in logarithms."""
    large = [row for row in rows if row.unknowns >= LARGE]
    of = [row.unknowns for row in large]
    return {
        **{name: power(of, [row.seconds[name] for row in large]) for name in PHASES},
        "sum": power(of, [sum(row.seconds.values()) for row in large]),
        "floor": power(of, [row.floor for row in large]),
    }


def figure(rows: Sequence[Row]) -> str:
    """Shares of the phases, and CPU seconds by phase against unknowns, as SVG."""
    totals, found = np.array([sum(row.seconds.values()) for row in rows]), exponents(rows)

    def draw(figure: "Figure") -> None:
        shares, growth = figure.subplots(1, 2)
        place, bottom = np.arange(len(rows)), np.zeros(len(rows))
        for number, name in enumerate(PHASES):
            share = 100 * np.array([row.seconds[name] for row in rows]) / totals
            shares.bar(
                place, share, bottom=bottom, label=name, color=str(0.95 - 0.09 * number), ec="black", lw=0.6,
                hatch=HATCHES[number], width=0.75,
            )  # fmt: skip
            bottom += share
        labels = [f"{row.unknowns:,}\n{total:.2g} s" for row, total in zip(rows, totals, strict=True)]
        shares.set_xticks(place, labels, fontsize=7)
        shares.set(xlabel="unknowns; CPU s", ylabel="share of the CPU seconds, %", ylim=(0, 100))
        marks = cycle(MARKS)
        unknowns = [row.unknowns for row in rows]
        for number, name in enumerate([*PHASES, "sum"]):
            whole = name == "sum"
            values = totals if whole else [row.seconds[name] for row in rows]
            growth.loglog(
                unknowns, values, next(marks), ls="-" if whole else ("-", "--", ":")[number % 3], ms=5,
                lw=2 if whole else 1, color="black" if whole else GREYS[number % 3], mfc="black" if whole else "white",
                label=f"{name}: {found[name]:.1f}",
            )  # fmt: skip
        growth.set(xlabel="unknowns", ylabel="CPU s")
        growth.grid(which="major", color="0.92", lw=0.6)
        growth.legend(
            frameon=False, fontsize=8, title="phase: exponent\nfrom 100,000 on", title_fontsize=8,
            loc="upper left", bbox_to_anchor=(1.0, 1.0),
        )  # fmt: skip
        bars, names = shares.get_legend_handles_labels()
        shares.legend(bars[::-1], names[::-1], frameon=False, fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))
        figure.suptitle("One mesh of P4, graded to 1e-5 a at the ends: CPU seconds by phase", x=0.01, ha="left")

    return svg(draw, (10.5, 4.4))


if __name__ == "__main__":
    main()
