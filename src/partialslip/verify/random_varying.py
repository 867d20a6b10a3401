"""Random scenes whose normal force, moment or both vary: a share of the random scenes.

Profile, material and the loads along x are those of :mod:`partialslip.verify.random_scenes`, Q in proportion to P. A
stream of random numbers of its own chooses these scenes, and what varies in them: all other scenes stay as they are.
"""

import numpy as np

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.halfplane.contact import contact
from partialslip.scene import Scene
from partialslip.verify.random_scenes import RandomScene, draw

WAYS = ("P", "M", "e", "P and M", "P and e")
SHARE = 1 / 3  # limit: of the scenes, in which the pressure varies
_STREAM = 1  # fixed: beside that of the other random numbers of a scene
_LEAST = 0.4  # limit: of the larger P, above which dQ = f dP is possible without sliding
_HALVINGS = 50  # limit: of the loads, until a scene has a stick zone
_CYCLES = 100  # limit: most: the steady state is compared, and methods end with the first cycle that repeats


def varies(seed: int, number: int) -> bool:
    """Return whether the pressure varies in the random scene of ``seed`` and ``number``."""
    return bool(_random(seed, number).random() < SHARE)


def draw_varying(seed: int, number: int) -> RandomScene:
    """Return the random scene of ``seed`` and ``number`` with varying pressure; the kind tells what varies."""
    random = _random(seed, number)
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


def _random(seed: int, number: int) -> np.random.Generator:
    return np.random.default_rng([seed, number, _STREAM])


def _forces(random: np.random.Generator, count: int) -> Array:
    """P at the load points, in the largest one: from nearly constant to nearly zero at the others."""
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
