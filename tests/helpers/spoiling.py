"""Tables of tractions whose truth is known, spoiled in the ways in which tables from elsewhere are.

Truth is the contact and the stick zone of the exact state that a table was made from, with its own loads and f.
"""

from dataclasses import dataclass, replace
from functools import cache

import msgspec
import numpy as np

from partialslip.codes.score import _read_as
from partialslip.codes.score.method import scored
from partialslip.codes.score.samples import samples
from partialslip.friction.load_path import load_path
from partialslip.halfplane.contact import contact
from partialslip.halfplane.method import solve
from partialslip.march.cells import compliance, forces, graded_cells
from partialslip.result import Result
from partialslip.scene import Friction
from partialslip.scene.plan import plan
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

ROUNDING = 1e-9  # of a
REACH = 1.1  # half-widths
SHIFTED = 0.003  # of the half-width: points do not lie evenly about the middle
DELTAS = (1e-5, 1e-4, 1e-3, 1e-2, 1e-1)  # of penalty friction, in the largest slip
SAMPLINGS = {"51": 51, "151": 151, "401": 401, "1001": 1001, "graded": 201}


@dataclass(frozen=True)
class Table:
    """Columns by name, the ``order`` of elements that forces are from, and the exact state behind them."""

    columns: dict[str, Array]
    truth: Result
    order: int = 1

    def times(self, **factors):
        """The table with some of its columns multiplied."""
        return replace(self, columns={name: column * factors.get(name, 1.0) for name, column in self.columns.items()})


@cache
def exact(scene):
    """The exact state of ``scene``."""
    return solve(scene, plan(scene))


def sampled(scene, x):
    """The exact tractions at ``x``."""
    state = exact(scene)
    p, dq, *_ = state.traction.at(x)
    return Table({"x": x, "p": p, "dq": dq}, state)


def points(state, sampling):
    """Points over the contact and a little beyond: uniform ones, or as of a mesh graded to the ends of the zones."""
    count = SAMPLINGS[sampling]
    if sampling != "graded":
        return REACH * state.a * (np.linspace(-1, 1, count) + SHIFTED)
    ends = np.unique([-REACH, -1.0, -state.m / state.a, state.n / state.a, 1.0, REACH])
    ends = np.concatenate([ends[:1], ends[1:][np.diff(ends) > 0.02]])
    return graded_cells(ends + 0.0013, 0.004, 0.15) * state.a


def changed(scene, *, P=1.0, Q=1.0, sigma=1.0, f=1.0):
    """``scene`` with some of its loads, or f, multiplied."""
    load = scene.load
    given = {"P": scene.P * P, "a": None, "p0": None}
    given |= {"Q": tuple(Q * value for value in load.Q), "sigma": tuple(sigma * value for value in load.sigma)}
    friction = Friction(f=scene.friction.f * f)
    return msgspec.structs.replace(scene, load=msgspec.structs.replace(load, **given), friction=friction)


@cache
def penalty(scene, softest=DELTAS[-1], stiffest=DELTAS[0]):
    """x/a, and slip over delta there, where friction follows dq = 2 f p tanh(ds/delta), ds being the slip; by delta.

    Cells of constant shear traction on half-planes; delta is in the largest slip of Coulomb friction. Newton's
    method from soft to stiff: the slip is what the tension and a rigid shift make less the compliance times q.
    """
    state, pressed = exact(scene), contact(scene)
    path = load_path(scene, plan(scene))
    (Q1, strain1, _), (Q2, strain2, _) = (path.cycle[end] for end in path.ends)
    ends = np.unique([-1.0, *np.clip([-state.m / state.a, state.n / state.a], -0.999, 0.999), 1.0])
    vertices = graded_cells(ends, 2e-4, 0.06)
    x = (vertices[1:] + vertices[:-1]) / 2
    bound = 2 * scene.friction.f * forces(pressed.shape, vertices)
    K = compliance(vertices / 2)
    stretch = (strain2 - strain1) * x * pressed.a / scene.length
    scale = float(np.abs(state.slip.slip).max()) / (scene.material.A * scene.P)
    total, count = Q2 - Q1, len(x)
    slip, shift = np.full(count, np.arctanh(total / bound.sum())), 0.0  # in delta; and a rigid one
    system = np.zeros((count + 1, count + 1))
    system[:count, count] = -1.0

    def residual(slip, shift, stiff):
        q = bound * np.tanh(slip)
        return np.append(stiff * slip + K @ q - stretch - shift, q.sum() - total)

    found = {}
    steps = 10.0 ** np.arange(1.0, np.log10(stiffest) - 0.01, -0.25)
    for before, step in zip(np.append(steps[0], steps), steps, strict=False):
        stiff = step * scale
        slip = np.where(np.abs(slip) > 1, slip * before / step, slip)
        off = residual(slip, shift, stiff)
        for _ in range(100):
            slope = bound / np.cosh(np.clip(slip, -300, 300)) ** 2
            system[:count, :count] = K * slope
            system[range(count), range(count)] += stiff
            system[count, :count] = slope
            move, length = np.linalg.solve(system, -off), 1.0
            while length > 1e-3:
                tried = residual(slip + length * move[:count], shift + length * move[count], stiff)
                if np.linalg.norm(tried) < (1 - 0.1 * length) * np.linalg.norm(off):
                    break
                length /= 2
            slip, shift, off = slip + length * move[:count], shift + length * move[count], tried
            if np.abs(off).max() < 1e-11 * scale:
                break
        else:
            raise RuntimeError(f"penalty friction: residual {np.abs(off).max() / scale:.1e}")
        found |= {delta: (x, slip) for delta in DELTAS if abs(delta / step - 1) < 1e-6 and delta <= softest}
    return found


def nodal(scene, x, order):
    """Nodal forces: integrals of the tractions times shape functions, by quadrature in an angle."""
    state, count = exact(scene), 40_000
    angle = (np.arange(count) + 0.5) * np.pi / count
    t, weights = -state.a * np.cos(angle), state.a * np.sin(angle) * np.pi / count
    cell = np.clip(np.searchsorted(x[::order], t) - 1, 0, (len(x) - 1) // order - 1)
    s = (t - x[::order][cell]) / np.diff(x[::order])[cell]
    shapes = [1 - s, s] if order == 1 else [(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)]
    columns = {"x": x}
    for name, traction in zip(("Fn", "dFt"), state.traction.at(t)[:2], strict=True):
        columns[name] = sum(
            np.bincount(order * cell + local, shape * traction * weights, len(x)) for local, shape in enumerate(shapes)
        )
    return Table(columns, state, order)


def averaged(table, count):
    kernel = np.ones(count) / count
    smooth = {name: np.convolve(table.columns[name], kernel, "same") for name in ("p", "dq")}
    return replace(table, columns=table.columns | smooth)


def _noisy(table, f, size, seed):
    random, p0 = np.random.default_rng(seed), table.truth.p0
    off = size * p0 * random.standard_normal((2, len(table.columns["x"])))
    return replace(
        table, columns=table.columns | {"p": table.columns["p"] + off[0], "dq": table.columns["dq"] + 2 * f * off[1]}
    )


def _rounded(table, digits):
    return replace(
        table,
        columns={
            name: np.array([float(f"{value:.{digits - 1}e}") for value in column])
            for name, column in table.columns.items()
        },
    )


def spoiled(scene, sampling, seed=0):
    """Ways of spoiling, the size of each, and the table of ``scene`` at that sampling spoiled so."""
    x, f = points(exact(scene), sampling), scene.friction.f
    clean = sampled(scene, x)
    a = clean.truth.a
    yield "clean", "", clean
    for k in range(1, 10):
        yield "dq times 1 - 10^-k", f"{10.0**-k:.0e}", clean.times(dq=1 - 10.0**-k)
    for size in (1e-4, 1e-3, 1e-2, 1e-1):
        for sign in (1, -1):
            off = changed(scene, f=1 + sign * size)
            if not off.slides:
                yield "f off", f"{sign * size:+.0e}", sampled(off, x)
    for name in ("P", "Q", "sigma"):
        for size in (1e-4, 1e-2, 5e-2):
            off = changed(scene, **{name: 1 + size})
            if not off.slides and (name == "P" or any(getattr(scene.load, name))):
                yield f"{name} off", f"{size:.0e}", sampled(off, x)
    if any(scene.load.sigma) and any(scene.load.Q):
        yield "tension left out", "", sampled(changed(scene, sigma=0.0), x)
        yield "tension turned round", "", sampled(changed(scene, sigma=-1.0), x)
    for size in (1e-6, 1e-5, 1e-4, 1e-3, 1e-2):
        yield "noise", f"{size:.0e}", _noisy(clean, f, size, seed)
    for digits in (7, 5, 4, 3):
        yield "rounded to digits", str(digits), _rounded(clean, digits)
    for count in (3, 9):
        yield "moving average", str(count), averaged(clean, count)
    for delta, (at, slip) in penalty(scene).items():
        shear = 2 * f * clean.columns["p"] * np.tanh(np.interp(x / a, at, slip))
        yield "penalty friction", f"{delta:.0e}", replace(clean, columns=clean.columns | {"dq": shear})
    for shift in (1e-3, 1e-2, 1e-1):
        yield "x shifted", f"{shift:.0e}", replace(clean, columns=clean.columns | {"x": x + shift * a})
    yield "other units", "mm, MPa", clean.times(x=1e3, p=1e-6, dq=1e-6)
    yield "other units", "MPa", clean.times(p=1e-6, dq=1e-6)
    yield "other units", "mm", clean.times(x=1e3)
    yield "half a cycle", "dq/2", clean.times(dq=0.5)
    yield "turned round", "dq", clean.times(dq=-1.0)
    yield "nodal forces", "1", nodal(scene, x, 1)
    if len(x) % 2:
        even = x if sampling != "graded" else np.sort(np.concatenate([x[::2], (x[:-2:2] + x[2::2]) / 2]))
        yield "nodal forces", "2", nodal(scene, even, 2)


@dataclass(frozen=True)
class Reading:
    """What was read from a spoiled table: the errors of m and n and their own estimates, in a (None where they are not
    given); the ``spacing`` of the points, in a; and the notes."""

    way: str
    size: str
    errors: tuple[float, float] | None
    estimates: tuple[float, float] | None
    spacing: float
    notes: tuple[str, ...]

    @property
    def honest(self):
        """Whether errors are within three times their estimates, or m and n are not given and a note says why."""
        if self.errors is None or self.estimates is None:
            return bool(self.notes)
        return all(error <= 3 * own + ROUNDING for error, own in zip(self.errors, self.estimates, strict=True))


def readings(scene, sampling, seed=0):
    """Read every table of :func:`spoiled` as ``partialslip score`` does."""
    asked = exact(scene)
    for way, size, table in spoiled(scene, sampling, seed):
        truth, x = table.truth, np.unique(table.columns["x"])
        spacing = float(np.median(np.diff(x))) / truth.a
        try:
            found = _read_as(scene, scored(scene, samples(table.columns, way, (1, 1, 1), table.order), way, way), asked)
        except InputError as error:
            yield Reading(way, size, None, None, spacing, (str(error),))
            continue
        given = found.m is not None and truth.m is not None
        off = tuple(abs(getattr(found, key) - getattr(truth, key)) / truth.a for key in "mn") if given else None
        own = tuple(found.estimate[key] for key in "mn") if given else None
        yield Reading(way, size, off, own, spacing, found.notes)


def counts(read):
    """A table of counts by way and size: tables, those given, within a spacing, withheld, dishonest; and the median of
    estimate over error, both no less than rounding."""
    head = "way and size", "tables", "read", "in a spacing", "withheld", "beyond 3 est.", "median est./error"
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    for key in dict.fromkeys((reading.way, reading.size) for reading in read):
        of = [reading for reading in read if (reading.way, reading.size) == key]
        given = [reading for reading in of if reading.errors and reading.estimates]
        near = [reading for reading in given if max(reading.errors or ()) <= reading.spacing]
        ratios = [(own + ROUNDING) / (error + ROUNDING) for reading in given
                  for error, own in zip(reading.errors or (), reading.estimates or (), strict=True)]  # fmt: skip
        median = f"{np.median(ratios):.2g}" if ratios else "-"
        dishonest = sum(not reading.honest for reading in of)
        row = " ".join(key), len(of), len(given), len(near), len(of) - len(given), dishonest, median
        lines.append("| " + " | ".join(map(str, row)) + " |")
    return lines
