"""Plain data for JSON, numbers, strings and lists: the one writer of records, and the record of a result."""

from collections.abc import Mapping
from dataclasses import is_dataclass, replace
from typing import Any, TypeVar

import msgspec
import numpy as np

from partialslip.result.cost import Cost
from partialslip.result.plates import loop_area, stiffness
from partialslip.result.result import EndSlip, Regime, Result
from partialslip.tools.arrays import Array
from partialslip.tools.shown import Short

JsonNumber = float | None  # None: NaN or infinite, which JSON cannot hold
Numbers = tuple[JsonNumber, ...]
R = TypeVar("R", bound=msgspec.Struct)


class SlipRecord(Short, msgspec.Struct, frozen=True):
    """Record of a :class:`partialslip.Slip`: points ``x`` (m), ``slip`` (m), work ``dissipated`` in a cycle (J/m) and
    its estimated error ``dissipated_error`` (J/m), None if it is not known."""

    x: Numbers
    slip: Numbers
    dissipated: JsonNumber
    dissipated_error: JsonNumber = None


class SurfaceRecord(Short, msgspec.Struct, frozen=True):
    """Record of a :class:`partialslip.result.SurfaceStress`: ``sigma_xx`` (Pa) by body, load point and point ``x``
    (m)."""

    x: Numbers
    sigma_xx: tuple[tuple[Numbers, Numbers], tuple[Numbers, Numbers]]


class TractionRecord(Short, msgspec.Struct, frozen=True, omit_defaults=True):
    """Columns of a :class:`partialslip.Traction`: ``x`` (m) and ``p``, ``dq``, ``q1``, ``q2``, ``p1`` (Pa).

    ``q1`` and ``q2`` are None where the method does not determine them, ``p1`` where the pressure is the same at both
    load points.
    """

    x: Numbers
    p: Numbers
    dq: Numbers
    q1: Numbers | None
    q2: Numbers | None
    p1: Numbers | None = None


class PlatesRecord(Short, msgspec.Struct, frozen=True, omit_defaults=True):
    """Record of :class:`partialslip.result.Plates`; ``loop`` is None in ledgers."""

    at_points: Numbers
    displacement: Numbers
    approach: Numbers
    compliance: tuple[Numbers, Numbers]
    loop: tuple[Numbers, ...] | None = None
    error: JsonNumber = None
    displacement_error: JsonNumber = None
    turn: Numbers | None = None

    @property
    def stiffness(self) -> tuple[JsonNumber, JsonNumber]:
        """As :attr:`partialslip.result.Plates.stiffness`, Pa; None if it is not known."""
        along, across = stiffness(np.array(self.compliance, float))
        return number(along), number(across)

    @property
    def work(self) -> JsonNumber:
        """As :attr:`partialslip.result.Plates.work`, J/m; None without the loop."""
        return None if self.loop is None else number(loop_area(np.array(self.loop, float)))


class ResultRecord(Short, msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """A :class:`partialslip.Result` as plain data, without bodies, edges, state and fields at other points.

    Fields have the names, units and meaning of the result: ``a``, ``p0``, ``regime``, ``m``, ``n``,
    ``stick_half_width``, ``stick_centre``, ``p_max``, ``settings``, ``counts``, ``limits``, ``certificate``,
    ``last_cycle_change``, ``estimate``, ``shares``, ``undetermined``, ``path_dependent``, ``end_slips``,
    ``permanent``, ``notes``, ``cost``. ``contact_ends`` are the left and right end (m) at load point 1 and at load
    point 2. ``plates`` are those of two finite bodies, ``right_grip`` is what a held right side bears. ``slip``,
    ``surface`` and ``traction`` are None if the result has none, and in ledgers, which keep no curves.
    """

    a: JsonNumber
    p0: JsonNumber
    regime: Regime
    m: JsonNumber
    n: JsonNumber
    stick_half_width: JsonNumber
    stick_centre: JsonNumber
    p_max: JsonNumber
    contact_ends: tuple[tuple[JsonNumber, JsonNumber], tuple[JsonNumber, JsonNumber]]
    settings: dict[str, str | float | int]
    counts: dict[str, int]
    limits: dict[str, JsonNumber]
    certificate: dict[str, JsonNumber]
    last_cycle_change: JsonNumber
    estimate: dict[str, JsonNumber]
    shares: dict[str, dict[str, JsonNumber]]
    undetermined: dict[str, str]
    path_dependent: bool
    notes: tuple[str, ...]
    cost: Cost
    end_slips: tuple[EndSlip, EndSlip] | None = None
    permanent: tuple[JsonNumber, JsonNumber] | None = None
    slip: SlipRecord | None = None
    surface: SurfaceRecord | None = None
    traction: TractionRecord | None = None
    plates: PlatesRecord | None = None
    right_grip: Numbers | None = None

    @classmethod
    def of(cls, result: Result, curves: bool = True) -> "ResultRecord":
        """Make the record of ``result``, with or without ``curves``."""
        known: dict[str, Any] = {"p_max": number(result.traction.p_max), "contact_ends": plain(result.ends)}
        slip, surface = (result.slip, result.surface) if curves else (None, None)
        known["slip"] = slip and record_of(SlipRecord, slip)
        known["surface"] = surface and SurfaceRecord(plain(surface.x), plain(surface.sigma))
        known["traction"] = record_of(TractionRecord, result.traction) if curves else None
        plates = result.plates
        known["plates"] = plates and record_of(PlatesRecord, plates, **({} if curves else {"loop": None}))
        return record_of(cls, result, **known)


def record_of(kind: type[R], source: Any, **known: Any) -> R:
    """Return a record of the ``kind`` with the fields of the ``source`` that are not ``known``."""
    others = [name for name in kind.__struct_fields__ if name not in known]
    return kind(**known, **{name: plain(getattr(source, name)) for name in others})


def plain(value: Any) -> Any:
    """Return ``value`` with None for numbers that are not finite, and tuples for arrays, also within mappings, tuples
    and data classes."""
    if isinstance(value, np.ndarray):
        return numbers(value) if value.ndim == 1 else tuple(map(plain, value))
    if isinstance(value, float):
        return number(value)
    if isinstance(value, Mapping):
        return {key: plain(each) for key, each in value.items()}
    if is_dataclass(value) and not isinstance(value, type):
        return replace(value, **plain(vars(value)))
    return tuple(map(plain, value)) if isinstance(value, tuple) else value


def number(value: float | None) -> JsonNumber:
    """Return ``value`` as a float; None if ``value`` is not finite."""
    return float(value) if value is not None and np.isfinite(value) else None


def numbers(values: Array) -> Numbers:
    """Return ``values`` (n,) with None in place of NaN and infinity."""
    found, finite = values.tolist(), np.isfinite(values)
    if finite.all():
        return tuple(found)
    return tuple(each if known else None for each, known in zip(found, finite, strict=True))
