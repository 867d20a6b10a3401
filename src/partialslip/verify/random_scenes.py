"""Random scenes of every profile, regime, sign and unit, and near the transitions; determined by seed and number."""

import math
from typing import Any, NamedTuple

import numpy as np

from partialslip.arrays import Array
from partialslip.halfplane.contact import contact
from partialslip.halfplane.loading import one_step
from partialslip.halfplane.shape import Shape
from partialslip.halfplane.steady import transition
from partialslip.scene import Material, Scene, Tabulated
from partialslip.scene.reading import parse_scene

PROFILES = ("hertz", "flat-rounded", "tabulated")
KINDS = (
    "any", "small", "large", "stuck", "near-stuck", "near-sliding", "lost digits", "sliding", "ratchets", "narrow",
    "late", "transition", "no dQ", "no dsigma", "mean loads", "out of phase",
)  # fmt: skip
SHORT = 1 - 1e-12  # limit: largest |Q| in f P without sliding, with room for rounding


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
