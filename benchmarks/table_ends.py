"""Ends of zones read from tables of all kinds, against the exact ends of the tractions that the tables are made from.

python benchmarks/table_ends.py [--seed 1] [--tables 600] [--kinds sampled mean ...] [--given] [--worst]

Each table has 61, 151 or 401 points over the contact and somewhat beyond, at random phase, in random scenes of all
regimes. Kinds: values at points, means over cells, nodal forces of linear elements over the nodes' weights, friction by
a penalty, p and q averaged over three points, dq alone over five, noise, and ends that drifted as slip reversed. By
kind: the number of ends of contact and stick zone, the percentage whose error is beyond the estimate, the largest error
over estimate, the median of estimate over error, the median estimate in spacings of the points, and the number of ends
that are not known. ``--given``: the kind is given where it has a name. ``--worst``: tables with ends beyond.
"""

import argparse
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

import partialslip
from partialslip import Result, Scene
from partialslip.codes.score import _read_as
from partialslip.codes.score.kinds import KINDS
from partialslip.codes.score.method import scored
from partialslip.codes.score.samples import samples
from partialslip.halfplane import contact
from partialslip.halfplane.steady import steady_stick_zone, transition
from partialslip.march.cells import compliance, forces, graded_cells
from partialslip.run.judge.measures import cell_means, means
from partialslip.scene.gradual import turns_round
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

COUNTS = (61, 151, 401)
REGIMES = ("shear", "small tension", "large tension", "flat-rounded", "f(x)", "reversal")
ROUNDING = 1e-9  # of a: differences that count as none
E, R, HALF_WIDTH = 70e9, 0.02, 1e-3


class Drawn(NamedTuple):
    """A random scene, its ``exact`` result and the points ``x`` (n,), m, of its table."""

    regime: str
    scene: Scene
    exact: Result
    x: Array


def drawn(random: np.random.Generator, regime: str) -> Drawn:
    """A scene of the ``regime``, drawn until exact solves it, with a reversal where it asks for one alone."""
    while True:
        scene = _scene(random, regime)
        if scene is None:
            continue
        try:
            exact = partialslip.run(scene, ["exact"])["exact"]
        except InputError:
            continue
        drifted = exact.permanent is not None and abs(exact.permanent[0] + (exact.m or 0.0)) > ROUNDING * exact.a
        drifted |= exact.permanent is not None and abs(exact.permanent[1] - (exact.n or 0.0)) > ROUNDING * exact.a
        if exact.m is None or drifted != (regime == "reversal"):
            continue
        reach, count = random.uniform(1.03, 1.3), int(random.choice(COUNTS))
        spacing = 2 * reach * exact.a / (count - 1)
        x = reach * exact.a * np.linspace(-1, 1, count) + spacing * random.uniform(-0.5, 0.5)
        return Drawn(regime, scene, exact, x)


def _scene(random: np.random.Generator, regime: str) -> Scene | None:
    """A random scene; None where slip reverses in a regime without reversal, or does not in the other."""
    nu, f = float(random.uniform(0.0, 0.45)), float(random.uniform(0.1, 0.9))
    profile: dict[str, Any] = {"kind": "hertz", "R": R}
    A, a = 4 * (1 - nu**2) / E, HALF_WIDTH
    P = math.pi * a**2 / (2 * A * R)
    if regime == "flat-rounded":
        flat = float(random.uniform(0.1, 0.8))
        psi = math.acos(flat)
        profile |= {"kind": regime, "b": flat * a}
        P = a**2 / (A * R) * (psi - math.sin(psi) * flat)
    friction: dict[str, Any] = {"f": f}
    if regime == "f(x)":
        friction = {"f": [f, f * random.uniform(0.7, 1.4)], "x": [-1.5 * a, 1.5 * a]}
    data: dict[str, Any] = {
        "name": regime.replace(" ", "-").replace("(", "-").replace(")", ""), "material": {"E": E, "nu": nu},
        "profile": profile, "friction": friction, "load": {"P": P},
    }  # fmt: skip
    pressed = contact(partialslip.parse_scene(data))
    Qf = float(random.uniform(*{"large tension": (0.1, 0.5), "reversal": (0.3, 0.95)}.get(regime, (0.1, 0.95))))
    if regime == "f(x)":
        Qf *= 0.6
    share = {"small tension": (0.05, 0.95), "large tension": (1.05, 2.5), "flat-rounded": (0.0, 2.0),
             "reversal": (0.5, 2.0)}.get(regime, (0.0, 0.0))  # fmt: skip
    sf = float(random.uniform(*share)) * float(transition(Qf, pressed.shape)) if share[1] else 0.0
    zone = steady_stick_zone(Qf, sf, pressed.shape)
    if bool(turns_round(Qf, sf, zone.s, zone.centre, zone.half_width)) != (regime == "reversal"):
        return None
    signs = random.choice([-1.0, 1.0], 2)
    Q, sigma = signs * f * np.array([pressed.P * Qf, pressed.p0 * sf / 2])
    data["load"] |= {"Q": [-Q, Q], "sigma": [-sigma, sigma]}
    return partialslip.parse_scene(data)


Columns = dict[str, Array]


def sampled(random: np.random.Generator, of: Drawn) -> Columns:
    """Exact tractions at the points."""
    del random
    p, dq, *_ = of.exact.traction.at(of.x)
    return {"x": of.x, "p": p, "dq": dq}


def mean(random: np.random.Generator, of: Drawn) -> Columns:
    """Means over the cells about the points."""
    del random
    spacing = of.x[1] - of.x[0]
    p, dq = cell_means(of.exact.traction, np.append(of.x - spacing / 2, of.x[-1] + spacing / 2))
    return {"x": of.x, "p": p, "dq": dq}


def nodal(random: np.random.Generator, of: Drawn) -> Columns:
    """Nodal forces of linear elements over the nodes' weights: means under hats."""
    del random
    x, traction = of.x, of.exact.traction
    spacing = x[1] - x[0]
    ends = np.concatenate([[x[0] - spacing], x, [x[-1] + spacing]])
    whole = means(lambda t: np.stack(traction.at(t)[:2]), ends, traction.breaks)
    first = means(lambda t: t * np.stack(traction.at(t)[:2]), ends, traction.breaks)
    right = (first - ends[:-1] * whole) / spacing  # of the element's force, at its right node
    p, dq = right[:, :-1] + (whole - right)[:, 1:]
    return {"x": x, "p": p, "dq": dq}


def penalty(random: np.random.Generator, of: Drawn) -> Columns:
    """Values at points; slip is elastic until it reaches 1e-3 to 1e-1 of the largest slip of Coulomb's law."""
    found = sampled(random, of)
    return found | {"dq": of.exact.traction.at(of.x).p * _penalty(of, 10 ** random.uniform(-3, -1))(of.x)}


def _penalty(of: Drawn, share: float) -> Callable[[Array], Array]:
    """dq/p as a function of x: cells of constant shear traction on half-planes, each elastic or at the bound. Where
    slip is elastic, dq = 2 f p ds/delta, ds being the relative slip between the load points."""
    scene, exact = of.scene, of.exact
    pressed, load, f = contact(scene), scene.load, scene.friction
    assert exact.slip is not None
    ends = np.unique([-1.0, *np.clip([-(exact.m or 0) / exact.a, (exact.n or 0) / exact.a], -0.999, 0.999), 1.0])
    vertices = graded_cells(ends, 5e-4, 0.1)
    x = (vertices[1:] + vertices[:-1]) / 2
    bound = 2 * (f.at(x * exact.a) if f.varies else np.full(len(x), f.f)) * forces(pressed.shape, vertices)
    K = compliance(vertices / 2)
    stretch = _stretch(scene, x, pressed.a)
    scale = float(np.abs(exact.slip.slip).max()) / (scene.material.A * scene.P)
    total, delta = load.dQ / scene.P, share * scale
    side = np.zeros(len(x))  # -1 and 1: at the bound
    for _ in range(60):
        elastic = side == 0
        q = side * bound
        rhs = np.append((stretch - K @ q)[elastic], total - q.sum())
        inner = K[np.ix_(elastic, elastic)] + np.diag(delta / bound[elastic])
        ones = np.ones((len(inner), 1))
        solution = np.linalg.solve(np.block([[inner, -ones], [ones.T, np.zeros((1, 1))]]), rhs)
        q[elastic] = solution[:-1]
        slip = (stretch + solution[-1] - K @ q) / delta
        now = np.where(np.abs(slip) >= 1, np.sign(slip), 0.0)
        now = np.where(elastic, np.where(np.abs(q) > bound, np.sign(q), 0.0), np.where(slip * side < 1, 0.0, side))
        if (now == side).all():
            break
        side = now
    ratio = 2 * q / bound
    return lambda at: (f.at(at) if f.varies else f.f) * np.interp(at / exact.a, x, ratio)


def _stretch(scene: Scene, x: Array, a: float) -> Array:
    """Displacement by the change of tension at the cells ``x`` (n,), in a, as slip over A P."""
    from partialslip.friction.load_path import load_path
    from partialslip.scene.plan import plan

    path = load_path(scene, plan(scene))
    assert path is not None
    (_, strain1, _), (_, strain2, _) = (path.cycle[end] for end in path.ends)
    return (strain2 - strain1) * x * a / scene.length


def averaged(columns: Columns, count: int, names: tuple[str, ...]) -> Columns:
    """``columns`` of which those by ``names`` are averaged over ``count`` points."""
    return columns | {name: np.convolve(columns[name], np.ones(count) / count, "same") for name in names}


def p_and_q_averaged(random: np.random.Generator, of: Drawn) -> Columns:
    return averaged(sampled(random, of), 3, ("p", "dq"))


def dq_averaged(random: np.random.Generator, of: Drawn) -> Columns:
    return averaged(sampled(random, of), 5, ("dq",))


def noisy(random: np.random.Generator, of: Drawn) -> Columns:
    """Noise of 1e-4 to 1e-2 of p0, and of 2 f p0."""
    found, size = sampled(random, of), 10 ** random.uniform(-4, -2) * of.exact.p0
    off = size * random.standard_normal((2, len(of.x))) * [[1], [2 * of.scene.friction.f]]
    return found | {"p": found["p"] + off[0], "dq": found["dq"] + off[1]}


TABLES: dict[str, Callable[[np.random.Generator, Drawn], Columns]] = {
    "sampled": sampled, "mean": mean, "nodal": nodal, "penalty": penalty, "p and q averaged": p_and_q_averaged,
    "dq averaged": dq_averaged, "noise": noisy, "drifted": sampled,
}  # fmt: skip


class Read(NamedTuple):
    """Ends read from a table: ``errors`` and ``estimates`` by end, in a; None where an end is not known."""

    kind: str
    regime: str
    number: int
    points: int
    spacing: float
    errors: dict[str, float | None]
    estimates: dict[str, float]
    notes: tuple[str, ...]


def table(seed: int, number: int, kind: str) -> tuple[Drawn, Columns]:
    """The table of that ``seed`` and ``number``."""
    random = np.random.default_rng([seed, number])
    regimes = ("reversal",) if kind == "drifted" else REGIMES[:5]
    of = drawn(random, regimes[number // len(TABLES) % len(regimes)])
    return of, TABLES[kind](random, of)


def read(kind: str, number: int, of: Drawn, columns: Columns, given: bool) -> Read:
    """Read a table as ``partialslip score`` does."""
    exact = of.exact
    named = kind if given and kind in KINDS else None
    spacing, names = float(of.x[1] - of.x[0]) / exact.a, ("left", "right", "m", "n")
    try:
        made = samples(columns, kind, (1, 1, 1), 1, named)  # type: ignore[arg-type]
        found = _read_as(of.scene, scored(of.scene, made, kind, kind), exact)
    except InputError as error:
        return Read(kind, of.regime, number, len(of.x), spacing, dict.fromkeys(names), {}, (str(error),))
    errors: dict[str, float | None] = {
        "left": abs(found.ends[1][0] + exact.a),
        "right": abs(found.ends[1][1] - exact.a),
    }
    for key in "mn":
        value, true = getattr(found, key), getattr(exact, key)
        errors[key] = None if value is None or key not in found.estimate else abs(value - true)
    errors = {key: None if off is None else off / exact.a for key, off in errors.items()}
    return Read(kind, of.regime, number, len(of.x), spacing, errors, found.estimate, found.notes)


def row(kind: str, tables: list[Read]) -> str:
    """Figures of one ``kind``."""
    known = [(off, each.estimates[key], each) for each in tables for key, off in each.errors.items() if off is not None]
    unknown = sum(len(each.errors) for each in tables) - len(known)
    over = np.array([off / (own + ROUNDING) if off > ROUNDING else 0.0 for off, own, _ in known])
    under = np.array([(own + ROUNDING) / (off + ROUNDING) for off, own, _ in known])
    cells = np.array([own / each.spacing for _, own, each in known])
    return (
        f"{kind:18s} {len(known):5d} {100 * np.mean(over > 1):6.1f} {over.max():8.2f} {np.median(under):9.2g} "
        f"{np.median(cells):9.2g} {unknown:6d}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tables", type=int, default=600)
    parser.add_argument("--kinds", nargs="+", choices=TABLES, default=list(TABLES))
    parser.add_argument("--given", action="store_true")
    parser.add_argument("--worst", action="store_true")
    options = parser.parse_args()
    every = [(number, list(TABLES)[number % len(TABLES)]) for number in range(options.tables)]
    found = [
        read(kind, number, *table(options.seed, number, kind), options.given)
        for number, kind in every
        if kind in options.kinds
    ]
    print("kind                ends  beyond    worst  est./err est./cell  unread")
    for kind in options.kinds:
        print(row(kind, [each for each in found if each.kind == kind]))
    if options.worst:
        for each in found:
            for key, off in each.errors.items():
                if off is not None and off > each.estimates[key] + ROUNDING:
                    told = f"{key}: {off:.2g} {each.estimates[key]:.2g}"
                    print(f"{each.number} {each.kind} {each.regime} {each.points} {told}")


if __name__ == "__main__":
    main()
