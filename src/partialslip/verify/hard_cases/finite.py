"""Hard cases: finite bodies whose plates are moved, turn on a pin, or share Q."""

from collections.abc import Iterator, Mapping
from typing import Any

from partialslip.scene import Scene
from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import MANY_CYCLES, family, hard_scene

_BLOCK: Mapping[str, Any] = {"width": 4.0, "height": 2.0}  # limit: its size moves no end by more than 1e-4 a
_SOFT, _RIGID = 1.0, 1e22  # limit: stiffness of a spring in N/m per m and unit depth; the rig has 1e10
_FORCE = 1.25664e5  # limit: Q in N/m of a soft spring: 0.4 f P
# limit:
_MOVED = {"near-stuck": 1e-9, "near-sliding": 5.285e-5}  # m, to either side; Q is 2.0e-5 and 0.9992 of f P


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
