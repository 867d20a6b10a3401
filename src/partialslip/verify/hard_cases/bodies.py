"""Hard cases: materials, friction, profiles, and finite bodies whose plates are moved, turn on a pin, or share Q."""

from collections.abc import Iterator, Mapping
from typing import Any

from partialslip.scene import Scene
from partialslip.verify.case import Case
from partialslip.verify.hard_cases import MANY_CYCLES, family, hard_scene

# limit: dissimilar bodies with the mean compliance of the other cases, whose Dundurs' constant beta is 0.3
_UNLIKE: Mapping[str, Any] = {"upper": {"E": 210e9, "nu": 0.3}, "lower": {"E": 48e9, "nu": 0.1}}
_BLOCK: Mapping[str, Any] = {"width": 4.0, "height": 2.0}  # limit: its size moves no end by more than 1e-4 a
_SOFT, _RIGID = 1.0, 1e22  # limit: stiffness of a spring in N/m per m and unit depth; the rig has 1e10
_FORCE = 1.25664e5  # limit: Q in N/m of a soft spring: 0.4 f P
# limit:
_MOVED = {"near-stuck": 1e-9, "near-sliding": 5.285e-5}  # m, to either side; Q is 2.0e-5 and 0.9992 of f P


@family(
    "Poisson's ratio from 0 to 0.4999",
    """
Low-order triangles lock as plane strain becomes incompressible: too stiff, with wrong widths and tractions although
everything converges. An error estimate from the neighbouring lower order locks, too. At nu = 0 products with nu vanish,
which hides mistakes in them.
""",
)
def poisson() -> Iterator[Case]:
    for nu in (0.0, 0.49, 0.4999):
        yield Case(f"nu-{nu:g}", hard_scene(f"nu-{nu:g}", nu=nu))
    yield Case("nu-0.4999-quadratic", hard_scene("nu-0.4999-quadratic", nu=0.4999, fem={"order": 2, "accuracy": 1e-3}))


@family(
    "Coefficients of friction of 1e-3 and 10",
    """
Between similar bodies, results scaled by f do not depend on f: a difference between the cases shows a bound or a
tolerance in the wrong units. At 1e-3, shear is not solved if its tolerance has the scale of the pressure. A large f
makes fixed-point iterations between pressure and shear diverge.
""",
)
def friction() -> Iterator[Case]:
    for f in (1e-3, 10.0):
        yield Case(f"friction-{f:g}", hard_scene(f"friction-{f:g}", f=f))


@family(
    "Flat and rounded punches with b/a up to 0.999",
    """
The pressure has two logarithmic kinks, where quadrature must split, and a peak in a corner a thousandth of the contact
wide, where it falls to zero like a square root. A uniform mesh misses the peak, its force and the slip zone in it. The
width of the corner is a difference of nearly equal numbers.
""",
)
def sharp() -> Iterator[Case]:
    for flat in (0.9, 0.99, 0.999):
        yield Case(f"sharp-{flat:g}", hard_scene(f"sharp-{flat:g}", 0.4, 4.0, flat=flat))


@family(
    "Dissimilar bodies that are pressed together from a flat",
    """
Pressing dissimilar bodies moves their surfaces along x, and points lock in shear as they come into contact. A flat with
round corners begins with the whole flat at once, unlike a cylinder, so that q1 depends on the number of load steps
(eight: off by 0.6) and the gap beside the flat on friction (by 6 % in the second case). March is the reference (fem
shares its growth of the contact, no mesh).
""",
)
def unlike_punches() -> Iterator[Case]:
    for f, flat in ((0.1, 0.9), (0.67, 0.5), (0.3, 0.1)):
        name = f"unlike-flat-{flat:g}"
        scene = hard_scene(name, 0.4, 0.5, f=f, flat=flat, fem=MANY_CYCLES, material=_UNLIKE)
        yield Case(name, scene, ("march", "fem"), reference="march")


def _blocks(
    name: str,
    load: Mapping[str, Any] | None = None,
    upper: Mapping[str, Any] | None = None,
    lower: Mapping[str, Any] | None = None,
) -> Scene:
    bodies = {"upper": {**_BLOCK, **(upper or {})}, "lower": {**_BLOCK, **(lower or {})}}
    return hard_scene(name, load=load, bodies=bodies, fem=MANY_CYCLES)


@family(
    "Large blocks whose plates are moved, turn on a pin, or share Q",
    """
Under a displacement Q is a result: near sliding its search leaves the interval that the contact carries, and near the
stuck contact Q is a small difference. Formulas with a spring's stiffness in a denominator fail at the soft or the rigid
limit; a pin in the contact line must not turn; grips with equal shares must leave the contact as between half-planes.
The blocks are 4000 half-widths of the contact wide; where half-planes have an answer, it must come out, and under
displacements only the conditions on the result are judged.
""",
)
def plates() -> Iterator[Case]:
    for what, moved in _MOVED.items():
        name = f"moved-{what}"
        yield Case(name, _blocks(name, {"displacement": [-moved, moved]}), ("fem",), reference="")
    for what, spring, moved in (("soft", _SOFT, _FORCE / _SOFT), ("rigid", _RIGID, 1.13e-5)):
        name = f"spring-{what}"
        yield Case(name, _blocks(name, {"displacement": [-moved, moved], "spring": spring}), ("fem",), reference="")
    pin = {"support": "pivot", "pivot_height": 0.0}
    yield Case("pin-in-the-contact", _blocks("pin-in-the-contact", upper=pin), ("exact", "fem"))
    for what, share in (("alike", 0.5), ("by-stiffness", "stiffness")):
        name, pulled = f"grips-{what}", {"support": "roller", "pulled": True, "right_grip": share}
        yield Case(name, _blocks(name, lower=pulled), ("exact", "fem"))
