"""A family of hard cases, their scenes, and settings that several families share."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from partialslip.halfplane.contact import contact
from partialslip.run.judge import Bar
from partialslip.scene import Scene
from partialslip.scene.reading import parse_scene
from partialslip.verify.case import Case


@dataclass(frozen=True)
class Family:
    """Cases that are hard for one common reason.

    Parameters
    ----------
    title : str
    hard : str
        Why the cases are hard, and how other codes may fail.
    make : callable
        Makes the cases.
    """

    title: str
    hard: str
    make: Callable[[], Iterator[Case]]

    @property
    def cases(self) -> tuple[Case, ...]:
        """The cases, with the reason."""
        return tuple(replace(case, hard=self.hard) for case in self.make())


def family(title: str, hard: str) -> Callable[[Callable[[], Iterator[Case]]], Family]:
    """Make a :class:`Family` of the function that makes its cases; line breaks in ``hard`` do not count."""
    return lambda make: Family(title, " ".join(hard.split()), make)


# limit: Accuracies of load histories in many steps: errors of steps decrease with their number only, and each step
# costs.
MANY_STEPS: Mapping[str, Any] = {"accuracy": 1e-2}
MANY_CYCLES: Mapping[str, Any] = {"accuracy": 1e-3}

YOUNG = 72.8e9  # limit: Young's modulus, Pa

PEAKS = {
    f"{method}.q": Bar(0.15, "a peak at either end is narrower than an element, and q is as small as the load")
    for method in ("march", "fem")
}


def hard_scene(
    name: str,
    Qf: float = 0.4,
    sf: float = 1.5,  # less than 4 Qf, so that slip does not reverse on the way
    *,
    Q_mean: float = 0.0,
    sigma_mean: float = 0.0,
    f: float = 0.5,
    nu: float = 0.3,
    flat: float = 0.0,
    load: Mapping[str, Any] | None = None,
    fem: Mapping[str, Any] | None = None,
    bodies: Mapping[str, Any] | None = None,
    material: Mapping[str, Any] | None = None,
) -> Scene:
    """Return a scene with a contact half-width of 1 mm.

    dQ = ``Qf`` 2 f P, dsigma = ``sf`` f p0; the means are in f P and f p0. ``flat`` is b/a, 0 for Hertz. A displacement
    in ``load`` takes the place of Q, and ``material`` that of the bodies to which the loads belong.
    """
    a, R = 1e-3, 0.05
    data: dict[str, Any] = {
        "name": name,
        "material": {"E": YOUNG, "nu": nu},
        "friction": {"f": f},
        "profile": {"kind": "hertz", "R": R},
        "load": {"a": a},
    }
    if flat:
        psi = math.acos(flat)
        A = parse_scene(data).material.A
        data["profile"] = {"kind": "flat-rounded", "R": R, "b": flat * a}
        data["load"] = {"P": a**2 / (A * R) * (psi - math.sin(psi) * flat)}
    pressed = contact(parse_scene(data))
    ways = np.array([-1.0, 1.0])
    data["load"] |= {
        "Q": f * pressed.P * (Q_mean + Qf * ways),
        "sigma": f * pressed.p0 * (sigma_mean + sf / 2 * ways),
        **(load or {}),
    }
    if "displacement" in data["load"]:
        del data["load"]["Q"]
    more = {key: dict(each) for key, each in (("fem", fem), ("bodies", bodies), ("material", material)) if each}
    return parse_scene(data | more)
