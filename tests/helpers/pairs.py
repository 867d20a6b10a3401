"""One scene solved twice, the second time in another guise, and how far the two answers are apart.

Units, directions, names of bodies, what stretches both, steps, stops, places and numbering must not matter.
"""

import tempfile
from collections.abc import Callable
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from functools import partial
from itertools import pairwise, product
from pathlib import Path
from typing import NamedTuple
from unittest.mock import Mock, patch

import numpy as np

from partialslip import halfplane, load_scene, load_state, plan
from partialslip.friction import coulomb_constant_pressure as coulomb
from partialslip.friction import steps
from partialslip.march import driver
from partialslip.march import method as marching
from partialslip.run.judge import Q_BAR, cell_means
from partialslip.tools.arrays import Array
from partialslip_fem import bodies, solving
from partialslip_fem import method as fem_method
from partialslip_fem.mesh_solution import Adapted
from partialslip_fem.mortar import transfer
from partialslip_meshes import Mesh, block

METHODS = {"exact": halfplane.solve, "march": marching.solve, "fem": fem_method.solve}
SIZE = "fem.size=0.05"
MEAN = ("load.Q=[31415.9, 219911.5]", "load.sigma=[2e8, 1e9]")  # 0.1 .. 0.7 f P, 1 .. 5 f p0
CIRCLE = ("load.Q=[15e4, 0, -15e4, 0]", "load.sigma=[2e8, 6e8, 2e8, -2e8]")
UNLIKE = (
    "material.upper.E=728e9", "material.upper.nu=0.2", "bodies.upper.width=16e-3", "bodies.upper.height=4e-3",
)  # fmt: skip
SCENES = {
    "small tension": ("hertz-small-tension",), "large tension": ("hertz-large-tension",),
    "flat and rounded": ("flat-rounded",), "mean loads": ("hertz-large-tension", *MEAN, "load.cycles=2"),
    "out of phase": ("hertz-large-tension", *CIRCLE, "load.cycles=2"),
    "unlike bodies": ("hertz-large-tension", *UNLIKE, "load.cycles=2", "load.steps=2"),
}  # fmt: skip
POINTS = np.sin(np.linspace(-1, 1, 202)[1:-1] * np.pi / 2)
CELLS = np.linspace(-1, 1, 41)  # of the contact: means over them are of no mesh


class Answer(NamedTuple):
    """Ends a, m and n; pressure at points x; q at load points 1 and 2, or half of its change where that is all, or its
    ``extremes``."""

    ends: Array
    x: Array
    p: Array
    q: Array
    extremes: bool = False

    def mirrored(self):
        """Of the mirror image: q is turned round as x is."""
        there = self.turned()
        return there._replace(ends=self.ends[[0, 2, 1]], x=-self.x[::-1], p=self.p[::-1], q=there.q[:, ::-1])

    def turned(self):
        """With q turned round."""
        return self._replace(q=-self.q[::-1] if self.extremes else -self.q)

    def scaled(self, length, stress):
        """In units that are so many times larger."""
        return self._replace(ends=self.ends / length, x=self.x / length, p=self.p / stress, q=self.q / stress)

    def moved(self, shift):
        """Moved along x."""
        return self._replace(ends=self.ends + np.array([0, -shift, shift]), x=self.x + shift)


class Apart(NamedTuple):
    """The worst disagreement: of tractions, in p0 (pressure) and f p0 (shear), and of a, m and n, in a."""

    traction: float
    ends: float


def same(answer):
    """As it is."""
    return answer


def answer(result, scene, means=False):
    """A result's, at the nodes or cells in contact; of the exact method at any points; or as means over cells."""
    traction, ends = result.traction, np.array([result.a, result.m, result.n], float)
    if means:
        p, dq = cell_means(traction, CELLS * result.a)
        return Answer(ends, (CELLS[1:] + CELLS[:-1]) / 2 * result.a, p, dq[None] / 2)
    if result.method == "exact":
        p, dq, *_ = traction.at(POINTS * result.a)
        return Answer(ends, POINTS * result.a, p, dq[None] / 2)
    q = [traction.q1, traction.q2] if traction.q1 is not None else [traction.dq / 2]
    return Answer(ends, traction.x, traction.p, np.array(q), not scene.load.in_phase)


def apart(one, other, f):
    a, p0 = one.ends[0], one.p.max()
    assert one.x.shape == other.x.shape
    assert np.abs(other.x - one.x).max() < 1e-3 * a
    tractions = np.abs(other.p - one.p).max() / p0, np.abs(other.q - one.q).max() / (f * p0)
    return Apart(float(max(tractions)), float(np.abs(other.ends - one.ends).max() / a))


def scene_of(kind, *overrides):
    name, *settings = SCENES[kind]
    return load_scene(name, [*settings, *overrides])


def loads(Q, sigma):
    """Settings."""
    return tuple(f"load.{key}={np.asarray(values, float).tolist()}" for key, values in (("Q", Q), ("sigma", sigma)))


def times(scene, Q=1.0, sigma=1.0):
    """Settings of the scene's loads, times so much."""
    return loads(*(np.array(scene.load.points) * [Q, sigma]).T)


def instead(owner, name, called):
    """A patch for :func:`guise`: what is ``called`` in place of the ``owner``'s ``name``."""
    return patch.object(owner, name, Mock(side_effect=called))


@contextmanager
def guise(*patches, own=False):
    """Other meshes, or what else :func:`instead` patches: each of it must be called, as a patch that does not bite
    makes two guises one. Unless every run is to make its ``own`` meshes, march takes its first one only, finite
    elements are to be of :data:`SIZE`, and steps are those that are asked for: steps that are chosen differ in both, as
    meshes do."""
    with ExitStack() as stack:
        if not own:
            stack.enter_context(patch.object(driver, "MESHES", ((1e-3, 0.1),)))
            stack.enter_context(patch.object(steps, "one_step_suffices", lambda _: True))
        called = [stack.enter_context(each) for each in patches]
        yield
        for each in called:
            assert each.called, f"nothing calls {each.side_effect}: the guise changes nothing"


def solved(method, scene, start=None):
    return METHODS[method](scene, plan(scene, start=start is not None), start=start)


def on_one_mesh(method, scene, start=None):
    """Solved in the steps that are asked for, on the one mesh that a :func:`guise` leaves."""
    found = solved(method, scene, start)
    assert found.counts.get("steps", 0) in {0, 1, scene.load.steps}, "steps are chosen"
    assert "accuracy" not in found.settings or found.counts["meshes"] == 1, "meshes are chosen"
    return found


def answered(method, scene, own=False, *patches):
    """The answer to ``scene`` in a :func:`guise`."""
    with guise(*patches, own=own):
        return answer((solved if own else on_one_mesh)(method, scene), scene, own)


def compared(method, scene, other, bring_back=same, *patches, own=False):
    """How far ``other``, solved in a guise and brought back, is from ``scene``."""
    assert patches or scene != other
    one = answered(method, scene, own)
    return apart(one, bring_back(answered(method, other, own, *patches)), scene.friction.f)


# -- scenes in another guise ------------------------------------------------------------------------------------------


def in_units(scene, length, stress):
    """Settings of the same scene in units that are so many times smaller."""
    material, profile, upper, load = scene.material, scene.profile, scene.bodies.upper, scene.load
    given = next(key for key in ("P", "a", "p0") if getattr(load, key) is not None)
    values = {
        "material.E": material.E * stress,
        "profile.R": profile.R * length,
        f"load.{given}": getattr(load, given) * {"P": length * stress, "a": length, "p0": stress}[given],
    }
    if hasattr(profile, "b"):
        values["profile.b"] = profile.b * length
    if material.upper:
        values["material.upper.E"] = material.upper.E * stress
    if upper:
        values |= {"bodies.upper.width": upper.width * length, "bodies.upper.height": upper.height * length}
    return (*(f"{key}={value}" for key, value in values.items()), *times(scene, length * stress, stress))


def units(length, stress, method, kind, *settings, own=False):
    scene = scene_of(kind, *settings)
    other = scene_of(kind, *settings, *in_units(scene, length, stress))
    return compared(method, scene, other, lambda found: found.scaled(length, stress), own=own)


def in_the_mirror(width, contact, sizes, growth, *rest):
    """The mirror image of a block's mesh."""
    mesh = block(width, (-contact[1], -contact[0]), {-x: size for x, size in sizes.items()}, growth, *rest)
    return Mesh(mesh.points * [-1, 1], mesh.triangles[:, ::-1], mesh.lines)


def mirror(method, kind, *settings, own=False):
    """x -> -x: Q is turned round, sigma is not."""
    scene = scene_of(kind, *settings)
    other = scene_of(kind, *settings, *times(scene, Q=-1))
    patches = [instead(bodies, "block", in_the_mirror)] if method == "fem" and not own else []
    return compared(method, scene, other, Answer.mirrored, *patches, own=own)


def swap(method, kind, *settings, own=False):
    """Upside down: the lower body is the upper one, which drags the other the other way. Of bodies that are alike that
    is to turn both loads round.

    The tension stays with the lower body, where it takes so much more of it to strain another material as much.
    """
    scene = scene_of(kind, *settings)
    lower, upper = scene.material.bodies
    other = [*settings, *times(scene, Q=-1, sigma=-lower.A / upper.A)]
    name, *before = SCENES[kind]
    if own_upper := scene.material.upper:
        before = [setting.replace("bodies.upper", "bodies.lower") for setting in before]
        other += [f"material.{key}={getattr(own_upper, key)}" for key in ("E", "nu")]
        other += [f"material.upper.{key}={getattr(scene.material, key)}" for key in ("E", "nu")]
    return compared(method, scene, load_scene(name, [*before, *other]), Answer.turned, own=own)


def substeps(steps, method, kind, *settings):
    """From load point to load point in one step, or in several."""
    scene = scene_of(kind, *settings, "load.steps=1")
    return compared(method, scene, scene_of(kind, *settings, f"load.steps={steps}"))


def the_first_mesh():
    """The finite elements of the first run in all that follow: where unlike bodies touch depends on the loads, too."""
    true_uniform = fem_method.uniform
    first = []

    def uniform(problem, size, width, clock, *rest):
        if not first:
            first.append(true_uniform(problem, size, width, clock, *rest))
        return replace(first[0], solution=solving.solve_contact(problem, first[0].solution.bodies, 0, clock))

    return instead(fem_method, "uniform", uniform)


def restart(method, kind, *settings, own=False):
    """Two cycles in steps of a third; saved to a file at the first load point and after every step of the cycle that
    follows, and read from there. Where each makes its ``own`` meshes, two stops will do: the second in mid-cycle."""
    whole = scene_of(kind, *settings, "load.cycles=2", "load.steps=3")
    corners = [np.array(point) for point in (whole.load.points[-1], *whole.load.points)]
    stops = [before + (after - before) * part / 3 for before, after in pairwise(corners) for part in (1, 2, 3)]
    solve, patches = (solved, []) if own else (on_one_mesh, [the_first_mesh()] if method == "fem" else [])
    with guise(*patches, own=own), tempfile.TemporaryDirectory() as folder:
        one, file = answer(solve(method, whole), whole, own), Path(folder) / "state.npz"
        state, steps = None, 3
        for Q, sigma in [corners[0], *(stops[2:6:3] if own else stops)] if method != "exact" else []:
            there = (*loads([Q] * 2, [sigma] * 2), "load.cycles=1", f"load.steps={steps}")
            solve(method, scene_of(kind, *settings, *there), state).state.save(file)
            state, steps = load_state(file), 3 if own else 1
        rest = solve(method, scene_of(kind, *settings, "load.cycles=1", "load.steps=3"), state)
        return apart(one, answer(rest, whole, own), whole.friction.f)


def restart_of_cycles(method, *settings):
    """Two cycles of a varying pressure, or the second one from a file: only the last load point can be a stop."""
    loads = ("load.P=[9e4, 135750]", "load.Q=[1e4, 3e4]", "load.sigma=[2e7, 1e8]", "load.steps=3")
    first, whole = (load_scene("fretting-aluminium", [*loads, *settings, f"load.cycles={n}"]) for n in (1, 2))
    with guise(), tempfile.TemporaryDirectory() as folder:
        one, file = answer(on_one_mesh(method, whole), whole), Path(folder) / "state.npz"
        on_one_mesh(method, first).state.save(file)
        return apart(one, answer(on_one_mesh(method, first, load_state(file)), first), whole.friction.f)


def little_friction(f, method, kind, *settings):
    """With loads in proportion to f, all is in proportion to it: as f goes to 0 nothing breaks down."""
    scene = scene_of(kind, *settings)
    part = f / scene.friction.f
    other = scene_of(kind, *settings, f"friction.f={f}", *times(scene, part, part))
    return compared(method, scene, other, lambda found: found._replace(q=found.q / part))


def without_friction(f, method, kind, *settings):
    """Contact and pressure with hardly any friction are those without."""
    scene = scene_of(kind, *settings)
    some = scene_of(kind, *settings, f"friction.f={f}", *times(scene, f / scene.friction.f, f / scene.friction.f))
    none = scene_of(kind, *settings, "friction.f=0")
    one, other = answered(method, none), answered(method, some)
    one, other = (found._replace(ends=found.ends[:1], q=0 * found.p) for found in (one, other))
    return apart(one, other, 1.0)


# -- problems in another guise ----------------------------------------------------------------------------------------


def common_tension(tension, kind, *settings):
    """Both bodies stretched alike, by so many times what the scene's tension does to the lower one: what their finite
    elements, whose nodes do not match, say of the way their surfaces move is added to what the surfaces do."""
    scene = scene_of(kind, "fem.lower_size=0.7", *settings)
    true_compliances, true_march = solving.relative_compliances, coulomb.march
    moved = []

    def compliances(halves, *rest):
        if len(halves[0].condensation.compliance) > len(halves[0].body.x):  # bodies that are only pressed do not shear
            lower, upper = (
                stretched(half, part.kappa)
                for half, part in zip(halves, fem_method.scaled(scene, plan(scene)).parts, strict=True)
            )
            moved[:] = [(halves[0].body.x, lower - transfer(halves[0].body, halves[1].body) @ upper)]
        return true_compliances(halves, *rest)

    def march(C, stretch, *rest):
        x, more = moved[0]
        nodes = np.searchsorted(x, stretch[0])  # where a body is stretched by one, it moves by x
        assert np.array_equal(x[nodes], stretch[0])
        return true_march(C, stretch + tension * np.array([[1.0], [0.0]]) * more[nodes], *rest)

    true_scaled = fem_method.scaled

    def solved_back(*given):  # factors are kept for stretched()
        return replace(true_scaled(*given), inside=True)

    patches = (
        instead(solving, "relative_compliances", compliances),
        instead(coulomb, "march", march),
        instead(fem_method, "scaled", solved_back),
    )
    return compared("fem", scene, scene, same, *patches)


def stretched(half, kappa):
    """How the contact line's nodes move along x when the body, held at its sides and back, is stretched by one."""
    held = (half.body.held_points * [[1.0], [-(3 - kappa) / (1 + kappa)]]).reshape(-1, 1)
    moved = half.condensation._displace_free(np.zeros((half.body.contact.size, 1)), held)
    return moved[-half.body.contact.size :, 0][: len(half.body.x)]


def shifted(shift, approach, method, kind, *settings):
    """All that is there moved along x, by so many lengths of the problem, and the bodies apart before they meet. Both
    runs know as little of the contact before they solve on the last meshes."""
    scene = scene_of(kind, *settings)
    true_march, true_uniform = coulomb.march, fem_method.uniform

    def moved(shift, approach):
        def march(C, x, *rest):
            return true_march(C, x + shift, *rest)

        def uniform(problem, size, width, clock, *rest):
            here = true_uniform(problem, size, width, clock, *rest).solution.bodies
            meshes = [replace(half.mesh, points=half.mesh.points + np.array([shift, 0])) for half in here]
            there = replace(
                problem,
                gap=lambda x: problem.gap(x - shift) + approach,
                breaks=tuple(each + shift for each in problem.breaks),
            )
            solution = solving.solve_on_meshes(meshes, there, here[0].mesh.points.max(), clock)
            return Adapted(solution, {}, 1, 1, solution.iterations, width)

        return instead(fem_method, "uniform", uniform) if method == "fem" else instead(coulomb, "march", march)

    one, other = (answered(method, scene, False, moved(*each)) for each in ((0.0, 0.0), (shift, approach)))
    return apart(one, other.moved(-shift * scene.length if method == "fem" else 0.0), scene.friction.f)


def shuffled(seed, *args):
    """A block's mesh, its points, triangles, their corners and the edges of its lines in any order."""
    rng, mesh = np.random.default_rng(seed), block(*args)
    order = rng.permutation(len(mesh.points))
    number = np.argsort(order)
    triangles = rng.permutation(number[mesh.triangles])
    turns = (np.arange(3) + rng.integers(3, size=(len(triangles), 1))) % 3
    lines = {name: rng.permuted(rng.permutation(number[line]), axis=1) for name, line in mesh.lines.items()}
    return Mesh(mesh.points[order], np.take_along_axis(triangles, turns, axis=1), lines)


def reordered(seed, method, kind, *settings):
    """Nodes, elements and cells in any order."""
    true_march = coulomb.march

    def march(C, x, normal, f, path):
        order = np.random.default_rng(seed).permutation(len(normal))
        return true_march(C[np.ix_(order, order)], x[:, order], normal[order], f[order], path).of(np.argsort(order))

    scene = scene_of(kind, *settings)
    nodes, cells = instead(bodies, "block", partial(shuffled, seed)), instead(coulomb, "march", march)
    return compared(method, scene, scene, same, nodes if method == "fem" else cells)


def many_loads(seed):
    """Stick zones of many loads at once, in any order."""
    rng = np.random.default_rng(seed)
    pressed, order = halfplane.contact(scene_of("large tension")), rng.permutation(2000)
    dQ, dsigma = rng.uniform(-1.9, 1.9, 2000) * pressed.P, rng.uniform(-9, 9, 2000) * pressed.p0
    one = halfplane.one_step_zone(pressed, 1.0, dQ, dsigma)
    other = halfplane.one_step_zone(pressed, 1.0, dQ[order], dsigma[order])
    ends = (np.abs(getattr(one, key)[order] - getattr(other, key)).max() / pressed.a for key in ("m", "n"))
    return Apart(0.0, float(max(ends)))


# -- all of them ------------------------------------------------------------------------------------------------------

IN_PHASE = ("small tension", "large tension", "flat and rounded", "mean loads")
ALIKE = (*IN_PHASE, "out of phase")
ROUNDING = {"exact": 1e-12, "march": 1e-11, "fem": 1e-9}  # compliances of fem are known to 1e-12 or so
ACCURACY = 1e-3
_QUICK = {  # of the scenes of a pair of fem's, the one that is no slow test; as a rule the one of mean loads
    **dict.fromkeys(("mirror", "swap of bodies", "order of nodes and elements"), "unlike bodies"),
    **dict.fromkeys(("units: 1e12", "units: 1e-12", "units: 1e12 m, 1e-12 Pa"), "large tension"),
    **dict.fromkeys(("f = 1e-9, no friction", "f = 1e-9, loads in proportion"), "large tension"),
}
_ALL_QUICK = {"restart", "rigid shift"}  # what they find differs
_UNITS = {"mm, MPa": (1e3, 1e-6), "1e12": (1e12, 1e12), "1e-12": (1e-12, 1e-12), "1e12 m, 1e-12 Pa": (1e12, 1e-12)}


class Trial(NamedTuple):
    """A pair to solve, what it may be apart by, and whether it is one for on demand: another like it is not."""

    invariance: str
    method: str
    kind: str
    run: Callable[[], Apart]
    bars: Apart
    slow: bool = False


def trials():
    """Of every method, in scenes for which it is so: on one mesh, where rounding is all that is left; and on meshes
    that each run makes for itself."""
    pairs = {
        **{f"units: {name}": (partial(units, *factors), tuple(SCENES)) for name, factors in _UNITS.items()},
        "mirror": (mirror, tuple(SCENES)), "swap of bodies": (swap, tuple(SCENES)),
        "7 sub-steps": (partial(substeps, 7), IN_PHASE[:3]), "50 sub-steps": (partial(substeps, 50), IN_PHASE[:3]),
        "restart": (restart, tuple(SCENES)), "f = 1e-9, loads in proportion": (partial(little_friction, 1e-9), ALIKE),
        "f = 1e-9, no friction": (partial(without_friction, 1e-9), tuple(SCENES)),
        "rigid shift": (partial(shifted, 0.0123, 0.1), tuple(SCENES)),
        "order of nodes and elements": (partial(reordered, 1), tuple(SCENES)),
    }  # fmt: skip
    for name, (run, kinds) in pairs.items():
        for method, bar in ROUNDING.items():
            # ten times f; nodes of high order that slip and stick again on the way, which a leg in one step leaves out
            bar = 1e-8 if name == "f = 1e-9, no friction" else 2e-6 if (name, method) == ("restart", "fem") else bar
            for kind in kinds:
                if not _has(method, kind) or (
                    method == "exact" and name in ("rigid shift", "order of nodes and elements")
                ):
                    continue
                slow = method == "fem" and name not in _ALL_QUICK and kind != _QUICK.get(name, kinds[:4][-1])
                yield Trial(name, method, kind, partial(run, method, kind, SIZE), Apart(bar, bar), slow)
    for method in ("march", "fem"):
        bar = ROUNDING[method]
        yield Trial("restart", method, "varying pressure", partial(restart_of_cycles, method, SIZE), Apart(bar, bar))
    yield Trial("order of nodes and elements", "exact", "large tension", partial(many_loads, 1), Apart(0.0, 0.0))
    for kind in ALIKE:  # what cancels is ten times as large
        run = partial(common_tension, 10.0, kind, SIZE)
        yield Trial("common tension", "fem", kind, run, Apart(1e-8, 1e-8), kind != "large tension")
    own = {
        "units: mm, MPa": (partial(units, 1e3, 1e-6), ("large tension", "mean loads")),
        "mirror": (mirror, ("large tension", "mean loads")),
        "swap of bodies": (swap, ("unlike bodies",)),
        "restart": (restart, ("large tension", "mean loads")),
    }
    bars = Apart(Q_BAR * ACCURACY, ACCURACY)
    for name, (run, kinds) in own.items():
        for method, kind in product(("march", "fem"), kinds):
            if _has(method, kind):
                asked = partial(run, method, kind, f"fem.accuracy={ACCURACY}", own=True)
                slow = kind != "large tension" or name == "restart"
                yield Trial(f"{name}; own meshes", method, kind, asked, bars, slow)


def _has(method, kind):
    """Half-planes are alike; there is a closed form for loads in phase."""
    return kind in {"exact": IN_PHASE, "march": ALIKE, "fem": tuple(SCENES)}[method]
