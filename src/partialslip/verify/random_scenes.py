"""Random scenes of every profile, regime, sign and unit, and near the transitions; determined by seed and number.

In a share of them the normal force, the moment or both vary. Profile, material and the loads along x are those that the
scene has under constant pressure, Q in proportion to P; a stream of random numbers of its own chooses these scenes, and
what varies in them: all other scenes stay as they are.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from partialslip.halfplane.contact import contact
from partialslip.halfplane.loading import one_step
from partialslip.halfplane.shape import Shape
from partialslip.halfplane.steady import transition
from partialslip.scene import Material, Scene, Tabulated
from partialslip.scene.reading import parse_scene
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

PROFILES = ("hertz", "flat-rounded", "tabulated")
KINDS = (
    "any", "small", "large", "stuck", "near-stuck", "near-sliding", "lost digits", "sliding", "ratchets", "narrow",
    "late", "transition", "no dQ", "no dsigma", "mean loads", "out of phase",
)  # fmt: skip
SHORT = 1 - 1e-12  # limit: largest |Q| in f P without sliding, with room for rounding
WAYS = ("P", "M", "e", "P and M", "P and e")
SHARE = 1 / 3  # limit: of the scenes, in which the pressure varies
_STREAM = 1  # fixed: beside that of the other random numbers of a scene
_LEAST = 0.4  # limit: of the larger P, above which dQ = f dP is possible without sliding
_HALVINGS = 50  # limit: of the moments, until the contacts lie within the table of the profile
_CYCLES = 100  # limit: most: the steady state is compared, and methods end with the first cycle that repeats


class RandomScene(NamedTuple):
    """A random ``scene``, and the ``kind`` of the loads, one of ``KINDS``."""

    kind: str
    scene: Scene


def kind_of(number: int) -> str:
    """Return the kind of loads, one of ``KINDS``, of the scene ``number``; independent of the seed."""
    return KINDS[number % len(KINDS)]


def draw(seed: int, number: int) -> RandomScene:
    """Return the random scene of ``seed`` and ``number``."""
    random = np.random.default_rng([seed, number])
    kind, profile = kind_of(number), PROFILES[number // len(KINDS) % len(PROFILES)]
    data = pressed_only(random, profile)
    scene = parse_scene(data)
    pressed = contact(scene)
    Q, sigma = cycle(random, kind, pressed.shape)
    f = scene.friction.f
    data["name"] = f"stress-{seed}-{number}"
    data["load"] |= {"Q": f * pressed.P * Q, "sigma": f * pressed.p0 * sigma}
    data["load"] |= {"cycles": int(random.integers(1, 6)), "steps": int(random.integers(1, 5))}
    data["fem"] = {
        "order": int(random.choice([2, 3, 4])),
        "far_field": "box" if random.random() < 0.25 else "half-plane",
        "accuracy": 10 ** random.uniform(-3, -2),
    }
    return RandomScene(kind, parse_scene(data))


def pressed_only(random: np.random.Generator, profile: str) -> dict[str, Any]:
    """Return the tables of a scene with ``profile``, one of ``PROFILES``, and without tangential loads; SI units."""
    length, stress = 10 ** random.uniform(-9, 6), 10 ** random.uniform(-3, 15)
    material: dict[str, Any] = {
        "E": stress,
        "nu": random.uniform(-0.9, 0.4999),
        "plane": str(random.choice(["strain", "stress"])),
    }
    data: dict[str, Any] = {"name": "random", "material": material, "friction": {"f": 10 ** random.uniform(-3, 1)}}
    A, R = Material(**material).A, length * 10 ** random.uniform(0, 5)
    if profile == "hertz":
        ways = {"P": math.pi * length**2 / (2 * A * R), "a": length, "p0": length / (A * R)}
        way = str(random.choice(list(ways)))
        return data | {"profile": {"kind": "hertz", "R": R}, "load": {way: ways[way]}}
    if profile == "flat-rounded":
        flat = random.uniform(0.01, 0.99)
        psi = math.acos(flat)
        P = length**2 / (A * R) * (psi - math.sin(psi) * flat)
        return data | {"profile": {"kind": "flat-rounded", "R": R, "b": flat * length}, "load": {"P": P}}
    data |= {"profile": random_table(random, length), "load": {"P": 1.0}}
    tabulated = parse_scene(data).profile
    assert isinstance(tabulated, Tabulated)
    at, steps = tabulated.curvature_steps()
    a = at[0] + (tabulated.reach - at[0]) * random.uniform(0.05, 0.999)
    psi = np.arccos(np.minimum(at / a, 1.0))
    return data | {"load": {"P": float(a**2 / (2 * A) * (steps @ (2 * psi - np.sin(2 * psi))))}}


def random_table(random: np.random.Generator, length: float) -> dict[str, Any]:
    """Return a tabulated profile: a convex gap at 6 to 12 points, of ``length`` in m, straight in some intervals."""
    count = int(random.integers(6, 13))
    x = np.concatenate([[0.0], np.cumsum(random.uniform(0.2, 1.0, count - 1))])
    bends = random.exponential(1.0, count - 1) ** random.uniform(0.5, 3) * (random.random(count - 1) > 0.2)
    bends[-1] += 0.1
    gap = np.concatenate([[0.0], np.cumsum(np.cumsum(bends) * np.diff(x))]) * 10 ** random.uniform(-5, -1)
    return {"kind": "tabulated", "x": (x * length).tolist(), "gap": (gap * length).tolist()}


def cycle(random: np.random.Generator, kind: str, shape: Shape) -> tuple[Array, Array]:
    """Return Q in f P and sigma in f p0 at the load points for a ``kind`` of loads and the pressure of ``shape``.

    There are two load points; three to eight for ``out of phase``.
    """
    Qf, sf = changes(random, kind, shape)
    Q, sigma = random_means(random, kind, Qf, sf, shape)
    turned = random.choice([-1.0, 1.0], 4)
    ways = np.array([-1.0, 1.0]), np.array([-1.0, 1.0])
    if kind == "out of phase":
        once = 2 * np.pi * np.arange(random.integers(3, 9))
        ways = np.cos(once / len(once) + random.uniform(0, 6)), np.cos(once / len(once))
    Q_all = turned[0] * Qf * ways[0] + turned[1] * Q
    sigma_all = turned[2] * sf / 2 * ways[1] + turned[3] * sigma
    if kind not in ("sliding", "lost digits"):
        Q_all = Q_all * min(1.0, SHORT / max(float(np.abs(Q_all).max()), SHORT))
    return Q_all, sigma_all


def changes(random: np.random.Generator, kind: str, shape: Shape) -> tuple[float, float]:
    """Return dQ in 2 f P and dsigma in f p0, both >= 0, for a ``kind`` of loads and the pressure of ``shape``."""
    if kind == "stuck":
        return 0.0, 0.0
    if kind == "narrow":  # inverse problem: loads of a given stick zone
        c = 10 ** random.uniform(-8, -1)
        found = shape.conditions(np.array((1 - c) * random.uniform(0.02, 1)), np.array(c), np.array(-1))
        return float(found.Qf), float(found.sf)
    if kind == "near-stuck":
        Qf = 10 ** random.uniform(-11, -2)
        return Qf, Qf * random.uniform(0, 8)
    if kind == "no dQ":
        return 0.0, 10 ** random.uniform(-6, 1.5)
    if kind == "sliding":  # by the change of Q or by the mean of Q
        Qf = float(random.choice([0.0, random.random(), 1 + 10 ** random.uniform(-6, 2)]))
        return Qf, float(random.choice([0.0, 1.0, float(transition(min(Qf, 0.9), shape))]))
    Qf = {
        "late": 1 - 10 ** random.uniform(-6, -1),
        "near-sliding": 1 - 10 ** random.uniform(-9, -3),
        "lost digits": 1 - 10 ** random.uniform(-15.9, -6),
        "ratchets": random.uniform(0.02, 0.8),
    }.get(kind, random.random())
    if kind == "no dsigma":
        return Qf, 0.0
    if kind in ("any", "near-sliding", "out of phase"):
        return Qf, float(random.choice([random.uniform(0, 10), 10 ** random.uniform(-6, 1)]))
    at = float(transition(Qf, shape))
    times: dict[str, float] = {
        "small": random.random(),
        "large": 1 + 10 ** random.uniform(-3, 0.5),
        "transition": 1 + int(random.choice([-1, 0, 1])) * 10 ** random.uniform(-15, -1),
        "mean loads": float(random.choice([random.random(), random.uniform(1.1, 2.5)])),
        "ratchets": random.uniform(1.3, 2.5),
    }
    return Qf, at * times.get(kind, 10 ** random.uniform(-2, 1))


def random_means(random: np.random.Generator, kind: str, Qf: float, sf: float, shape: Shape) -> tuple[float, float]:
    """Return the means of Q in f P and of sigma in f p0, for changes ``Qf`` in 2 f P and ``sf`` in f p0."""
    room = 1 - Qf
    if kind == "sliding":
        over = 10 ** random.uniform(-6, 2)
        return (room + over if room > 0 else 0.0), float(random.choice([0.0, random.normal()]))
    if kind == "ratchets":
        bound = one_step(Qf, sf, shape).mean_load_bound
        return bound + random.uniform(0.2, 0.8) * (room - bound), random.uniform(-1, 1)
    if kind == "mean loads":
        return random.random() * room, float(random.choice([10 ** random.uniform(-3, 1), random.uniform(0, 10)]))
    if random.random() < 0.5 or kind == "lost digits":
        return 0.0, 0.0
    share = random.choice([0.0, random.random(), 1 - 10 ** random.uniform(-9, -1)])
    return float(share) * room, float(random.choice([0.0, 10 ** random.uniform(-2, 1)]))


def varies(seed: int, number: int) -> bool:
    """Return whether the pressure varies in the random scene of ``seed`` and ``number``."""
    return bool(_stream(seed, number).random() < SHARE)


def draw_varying(seed: int, number: int) -> RandomScene:
    """Return the random scene of ``seed`` and ``number`` with varying pressure; the kind tells what varies."""
    random = _stream(seed, number)
    random.random()  # that of varies()
    kind, scene = draw(seed, number)
    way, count = str(random.choice(WAYS)), len(scene.load.Q)
    forces = _forces(random, count) if "P" in way else np.ones(count)
    arms = _arms(random, count) if way != "P" else np.zeros(count)
    Q, sigma = forces * scene.load.Q, np.array(scene.load.sigma)
    if count == 2 and way != "e" and random.random() < 0.1 and forces.min() > _LEAST and np.ptp(forces) > 0:
        kind, Q = "dQ = f dP", scene.friction.f * scene.P * (forces - forces.mean())  # both ends are about to slip
    loads = np.array([scene.P * forces, scene.P * contact(scene).a * forces * arms, Q, sigma])
    if count == 2 and random.random() < 0.25:  # more load points on the way
        shares = np.concatenate([[0.0], np.sort(random.random(random.integers(1, 4))), [1.0]])
        loads = loads[:, :1] + (loads[:, 1:] - loads[:, :1]) * shares
    return RandomScene(f"{kind}, {way} varies", _within_profile(scene, way, loads))


def _stream(seed: int, number: int) -> np.random.Generator:
    return np.random.default_rng([seed, number, _STREAM])


def _forces(random: np.random.Generator, count: int) -> Array:
    """P over its largest value at the ``count`` load points: 1 at one, P_min/P_max (1e-4 to 1 - 1e-9) at another,
    uniform in between at the others."""
    falls = 10 ** -random.uniform(0, 4) if random.random() < 0.3 else 1 - 0.7 * random.random() ** 2
    if random.random() < 0.2:
        falls = 1 - 10 ** -random.uniform(1, 9)
    forces = falls + (1 - falls) * random.random(count)
    least, most = random.permutation(count)[:2]
    forces[least], forces[most] = falls, 1.0
    return forces


def _arms(random: np.random.Generator, count: int) -> Array:
    """Eccentricities at the load points, in the half-width of the contact without a moment."""
    size = 10 ** random.uniform(-6, 0) if random.random() < 0.3 else 0.4 * random.random() ** 2
    arms = random.uniform(-size, size, count)
    return np.full(count, arms[0]) if random.random() < 0.1 else arms


def _within_profile(scene: Scene, way: str, loads: Array) -> Scene:
    """Return the ``scene`` under ``loads`` (4, points), rows P, M, Q and sigma, with moments that keep the contacts
    within the table of the profile."""
    P, M, Q, sigma = loads
    for _ in range(_HALVINGS):
        load = {"a": None, "p0": None, "P": P.tolist(), "Q": Q.tolist(), "sigma": sigma.tolist(), "cycles": _CYCLES}
        load |= {"M": M.tolist()} if "M" in way else {"e": (M / P).tolist()} if "e" in way else {}
        varying = scene.replace(load=load)
        try:
            for pressing in varying.pressing:
                contact(varying, pressing)
        except InputError:
            M = M / 2
            continue
        break
    return varying
