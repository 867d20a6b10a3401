"""A result as plain data for JSON: numbers, strings and lists."""

from collections.abc import Mapping

import msgspec
import numpy as np

from partialslip.arrays import Array
from partialslip.result.cost import Cost
from partialslip.result.result import EndSlip, Regime, Result
from partialslip.shown import Short

Number = float | None  # None: NaN or infinite, which JSON cannot hold
Numbers = tuple[Number, ...]


class SlipRecord(Short, msgspec.Struct, frozen=True):
    """Record of a :class:`partialslip.Slip`: points ``x`` (m), ``slip`` (m), work ``dissipated`` in a cycle (J/m)."""

    x: Numbers
    slip: Numbers
    dissipated: Number


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


class ResultRecord(Short, msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """A :class:`partialslip.Result` as plain data, without bodies, edges, state and fields at other points.

    Fields have the names, units and meaning of the result: ``a``, ``p0``, ``regime``, ``m``, ``n``,
    ``stick_half_width``, ``stick_centre``, ``p_max``, ``settings``, ``counts``, ``limits``, ``certificate``,
    ``last_cycle_change``, ``estimate``, ``shares``, ``undetermined``, ``path_dependent``, ``end_slips``,
    ``permanent``, ``notes``, ``cost``. ``contact_ends`` are the left and right end (m) at load point 1 and at load
    point 2. ``slip``, ``surface`` and ``traction`` are None if the result has none, and in ledgers,
    which keep no curves.
    """

    a: Number
    p0: Number
    regime: Regime
    m: Number
    n: Number
    stick_half_width: Number
    stick_centre: Number
    p_max: Number
    contact_ends: tuple[tuple[Number, Number], tuple[Number, Number]]
    settings: dict[str, str | float | int]
    counts: dict[str, int]
    limits: dict[str, Number]
    certificate: dict[str, Number]
    last_cycle_change: Number
    estimate: dict[str, Number]
    shares: dict[str, dict[str, Number]]
    undetermined: dict[str, str]
    path_dependent: bool
    notes: tuple[str, ...]
    cost: Cost
    end_slips: tuple[EndSlip, EndSlip] | None = None
    permanent: tuple[Number, Number] | None = None
    slip: SlipRecord | None = None
    surface: SurfaceRecord | None = None
    traction: TractionRecord | None = None

    @classmethod
    def of(cls, result: Result, curves: bool = True) -> "ResultRecord":
        """Make the record of ``result``, with or without ``curves``."""
        (left1, right1), (left2, right2) = result.ends
        slip, surface = result.slip, result.surface
        return cls(
            a=number(result.a),
            p0=number(result.p0),
            regime=result.regime,
            m=number(result.m),
            n=number(result.n),
            stick_half_width=number(result.stick_half_width),
            stick_centre=number(result.stick_centre),
            p_max=number(result.traction.p_max),
            contact_ends=((number(left1), number(right1)), (number(left2), number(right2))),
            settings=dict(result.settings),
            counts=dict(result.counts),
            limits=_by_key(result.limits),
            certificate=_by_key(result.certificate),
            last_cycle_change=number(result.last_cycle_change),
            estimate=_by_key(result.estimate),
            shares={source: _by_key(share) for source, share in result.shares.items()},
            undetermined=dict(result.undetermined),
            path_dependent=result.path_dependent,
            notes=result.notes,
            cost=result.cost,
            end_slips=result.end_slips,
            permanent=(number(result.permanent[0]), number(result.permanent[1])) if result.permanent else None,
            slip=SlipRecord(numbers(slip.x), numbers(slip.slip), number(slip.dissipated)) if curves and slip else None,
            surface=SurfaceRecord(numbers(surface.x), _by_body(surface.sigma)) if curves and surface else None,
            traction=TractionRecord(
                x=numbers(result.traction.x),
                p=numbers(result.traction.p),
                dq=numbers(result.traction.dq),
                q1=_column(result.traction.q1),
                q2=_column(result.traction.q2),
                p1=_column(result.traction.p1),
            )
            if curves
            else None,
        )


def number(value: float | None) -> Number:
    """Return ``value`` as a float; None if ``value`` is not finite."""
    return float(value) if value is not None and np.isfinite(value) else None


def numbers(values: Array) -> Numbers:
    """Return ``values`` (n,) with None in place of NaN and infinity."""
    return tuple(each if known else None for each, known in zip(values.tolist(), np.isfinite(values), strict=True))


def _column(values: Array | None) -> Numbers | None:
    return None if values is None else numbers(values)


def _by_key(values: Mapping[str, float]) -> dict[str, Number]:
    return {key: number(value) for key, value in values.items()}


def _by_body(sigma: Array) -> tuple[tuple[Numbers, Numbers], tuple[Numbers, Numbers]]:
    lower, upper = ((numbers(body[0]), numbers(body[1])) for body in sigma)
    return lower, upper
