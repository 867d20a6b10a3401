"""The catalogue of hard cases: scenes on which contact codes fail, reasons, and bars for each method.

Cases are grouped in families. The paragraph of a family, :attr:`Family.hard`, is printed in docs/hard-cases.md.
"""

import math
import textwrap
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from partialslip.halfplane.contact import contact
from partialslip.halfplane.hertz import Hertz
from partialslip.halfplane.steady import stick_zone, transition
from partialslip.halfplane.traction import mean_load_bound
from partialslip.judge import Bar
from partialslip.scene import Scene
from partialslip.scene.reading import load_scene, parse_scene, shipped_scenes
from partialslip.verify.case import Case
from partialslip.verify.hard_cases import texts
from partialslip.verify.hard_cases.meshes import flat_triangles, one_node, shifted

_HEAD = """# Hard cases

These scenes make contact codes fail. For each family of scenes this page gives the reason and the requirements.
`partialslip verify --suite full` runs all scenes after the shipped scenes, and `partialslip verify --suite full --only
NAME` runs one scene. The methods in brackets solve the scene.

Unless an entry has other bars, every result must meet these requirements:

- The result is finite and certified.
- The regime is that of the exact solution.
- The ends of the contact and of the stick zone are within the accuracy of the scene (2e-5 of a), however narrow the
  zone is.
- Pressure is within ten times and shear within fifteen times this accuracy (relative L2 of cell averages)."""


@dataclass(frozen=True)
class Family:
    """Cases that are hard for one common reason.

    Parameters
    ----------
    name, title : str
    hard : str
        Why the cases are hard, and how other codes fail.
    cases : tuple of Case
    """

    name: str
    title: str
    hard: str
    cases: tuple[Case, ...]


def shipped() -> list[Case]:
    """Return the shipped scenes as cases, by every method, with the usual bars."""
    return [Case(name, load_scene(name)) for name in shipped_scenes()]


def families() -> list[Family]:
    """Return the whole catalogue."""
    return [
        Family(name, title, hard, tuple(replace(case, hard=hard) for case in _CASES[name]()))
        for name, (title, hard) in texts.FAMILIES.items()
    ]


def hard_cases() -> list[Case]:
    """Return the cases of all families."""
    return [case for family in families() for case in family.cases]


def document() -> str:
    """Return the catalogue as Markdown, the text of docs/hard-cases.md."""
    lines = [_HEAD]
    for family in families():
        lines += [f"## {family.title}", _filled(family.hard)]
        lines += ["\n".join(map(_listed, family.cases))]
    return "\n\n".join(lines) + "\n"


def _listed(case: Case) -> str:
    bars: dict[str, list[str]] = {}
    for key, bar in case.bars.items():
        bars.setdefault(bar.reason, []).append(f"{key} " + ("not judged" if bar.value is None else f"{bar.value:g}"))
    looser = "".join(f" {', '.join(keys)}: {reason}." for reason, keys in bars.items())
    return _filled(f"- `{case.name}` ({', '.join(case.methods)}).{looser}", "  ")


def _filled(text: str, indent: str = "") -> str:
    return textwrap.fill(text, 120, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)


def _scene(
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
) -> Scene:
    """Return a scene with a contact half-width of 1 mm.

    dQ = ``Qf`` 2 f P, dsigma = ``sf`` f p0; the means are in f P and f p0. ``flat`` is b/a, 0 for Hertz.
    """
    a, R = 1e-3, 0.05
    data: dict[str, Any] = {
        "name": name,
        "material": {"E": 72.8e9, "nu": nu},
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
    return parse_scene(data | ({"fem": dict(fem)} if fem else {}))


def _near_sliding() -> Iterator[Case]:
    for power in (3, 6, 9):
        name = f"near-sliding-1e-{power}"
        yield Case(name, _scene(name, 1 - 10.0**-power, 2.0))


# Accuracies of load histories in many steps: errors of steps decrease with their number only, and each step costs.
_MANY_STEPS: Mapping[str, Any] = {"accuracy": 1e-2}
_MANY_CYCLES: Mapping[str, Any] = {"accuracy": 1e-3}

_PEAKS = {
    f"{method}.q": Bar(0.15, "a peak at either end is narrower than an element, and q is as small as the load")
    for method in ("march", "fem")
}


def _near_stuck() -> Iterator[Case]:
    for power in (3, 6, 9):
        name = f"near-stuck-1e-{power}"
        yield Case(name, _scene(name, 10.0**-power, 2 * 10.0**-power), bars=_PEAKS)


def _transition() -> Iterator[Case]:
    at = float(transition(0.5, Hertz()))
    for name, sf in (("below", at * (1 - 1e-9)), ("at", at), ("above", at * (1 + 1e-9))):
        yield Case(f"transition-{name}", _scene(f"transition-{name}", 0.5, sf))


def _huge_tension() -> Iterator[Case]:
    for power in (3, 5, 8):
        name, c = f"huge-tension-1e-{power}", 10.0**-power
        loads = Hertz().conditions(np.array(0.7 - c), np.array(c), np.array(-1))  # centre -0.3 a
        yield Case(name, _scene(name, float(loads.Qf), float(loads.sf), fem=_MANY_STEPS))


def _no_shear() -> Iterator[Case]:
    yield Case("no-shear", _scene("no-shear", 0.0, 4.0))
    yield Case("no-shear-slight", _scene("no-shear-slight", 0.0, 1e-6), bars=_PEAKS)


def _no_tension() -> Iterator[Case]:
    yield Case("no-tension", _scene("no-tension", 0.6, 0.0))


def _beside() -> Iterator[Case]:
    yield Case("beside-small", _scene("beside-small", 0.91, 4.8))
    yield Case("beside-large", _scene("beside-large", 0.6, 10.0))


def _poisson() -> Iterator[Case]:
    for nu in (0.0, 0.49, 0.4999):
        yield Case(f"nu-{nu:g}", _scene(f"nu-{nu:g}", nu=nu))
    yield Case("nu-0.4999-quadratic", _scene("nu-0.4999-quadratic", nu=0.4999, fem={"order": 2, "accuracy": 1e-3}))


def _friction() -> Iterator[Case]:
    for f in (1e-3, 10.0):
        yield Case(f"friction-{f:g}", _scene(f"friction-{f:g}", f=f))


def _sharp() -> Iterator[Case]:
    for flat in (0.9, 0.99, 0.999):
        yield Case(f"sharp-{flat:g}", _scene(f"sharp-{flat:g}", 0.4, 4.0, flat=flat))


def _mean_loads() -> Iterator[Case]:
    bound = mean_load_bound(stick_zone(0.3, 4.0, Hertz()), Hertz())
    for share in (0.5, 0.9, 0.98, 1.02):
        name = f"mean-load-{share:g}"
        yield Case(
            name, _scene(name, 0.3, 4.0, Q_mean=share * bound, sigma_mean=3.0, load={"cycles": 60}, fem=_MANY_CYCLES)
        )


def _cycles() -> Iterator[Case]:
    bound = mean_load_bound(stick_zone(0.3, 4.0, Hertz()), Hertz())
    scene = _scene("cycles-200", 0.3, 4.0, Q_mean=0.995 * bound, sigma_mean=3.0, load={"cycles": 200}, fem=_MANY_CYCLES)
    yield Case("cycles-200", scene)


def _few_nodes() -> Iterator[Case]:
    size = 0.05
    reason = f"one mesh of elements of {size:g} a: what is smaller cannot be seen"
    coarse = {key: Bar(bar, reason) for key, bar in (("fem.a", size / 2), ("fem.m", size), ("fem.n", size))}
    for name, c in (("one-stick-node", size / 2), ("no-stick-node", size / 500)):
        loads = Hertz().conditions(np.array(0.7 - c), np.array(c), np.array(-1))
        scene = _scene(name, float(loads.Qf), float(loads.sf), fem={"size": size, "order": 1})
        yield Case(name, scene, ("fem",), coarse)
    reason = "one node knows no half-width: less than its element is all that can be said"
    one = {"fem.a": Bar(16.0, reason), **{f"fem.{key}": Bar(None, reason) for key in ("m", "n", "p", "q", "regime")}}
    scene = _scene("one-contact-node", 0.4, 0.0, fem={"order": 1})
    yield Case("one-contact-node", scene, ("fem",), one, meshes=one_node)


def _meshes() -> Iterator[Case]:
    reason = "even elements of 0.05 a, fourth order, the ends anywhere in them"
    bars = {f"fem.{key}": Bar(1e-3, reason) for key in "amn"} | {
        f"fem.{key}": Bar(bar, reason) for key, bar in (("p", 1e-2), ("q", 2e-2))
    }
    yield Case("aspect-1e4", _scene("aspect-1e4"), ("fem",), bars, meshes=partial(flat_triangles, aspect=1e4))
    for share in (0.25, 0.5):
        name = f"shifted-{share:g}h"
        yield Case(name, _scene(name), ("fem",), bars, meshes=partial(shifted, share=share))
    for size in (0.7, 1.6):
        name = f"non-matching-{size:g}"
        yield Case(name, _scene(name, fem={"lower_size": size, "accuracy": 1e-4}), ("fem",))


def _mirrored() -> Iterator[Case]:
    for name, Qf, sf in (("mirrored-small", -0.75, 2.4), ("mirrored-large", -0.4, 4.03)):
        yield Case(name, _scene(name, Qf, sf))


_CASES: Mapping[str, Callable[[], Iterator[Case]]] = {
    "near-sliding": _near_sliding,
    "near-stuck": _near_stuck,
    "transition": _transition,
    "huge-tension": _huge_tension,
    "no-shear": _no_shear,
    "no-tension": _no_tension,
    "beside": _beside,
    "poisson": _poisson,
    "friction": _friction,
    "sharp": _sharp,
    "mean-loads": _mean_loads,
    "cycles": _cycles,
    "few-nodes": _few_nodes,
    "meshes": _meshes,
    "mirrored": _mirrored,
}
