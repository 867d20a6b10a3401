"""What a run of another code is to be like."""

from typing import NamedTuple


class Setting(NamedTuple):
    """``name`` of what is the same all along a ladder; element ``size`` along the contact and ``fine`` at the ends of
    the zones (None: the same there), in a; their ``growth`` with distance; and what else the code is told."""

    name: str
    size: float
    growth: float
    fine: float | None
    option: object
