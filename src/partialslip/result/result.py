"""The result of a method; every method returns this type."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, NamedTuple

from partialslip.result.cost import Clock, Cost
from partialslip.result.fields import DeformedBody, Slip, StressAt, SurfaceStress
from partialslip.result.plates import Plates
from partialslip.result.state import State
from partialslip.result.traction import Traction
from partialslip.tools.arrays import Array
from partialslip.tools.frame import frame
from partialslip.tools.shown import Drawn

if TYPE_CHECKING:
    from partialslip.tools.frame import DataFrame

PATH_DEPENDENT = "path-dependent: slip reverses "
RATCHETS = "the contact ratchets: there is no steady state"
FRICTIONLESS = "f = 0 and Q = 0: nothing sticks, and without shear force the contact stays where it is"

Regime = Literal[
    "stuck",
    "small tension",
    "large tension",
    "no slip",
    "sticking ends",
    "out of phase",
    "sliding",
    "ratchets",
    "pressing",
    "frictionless",
]
EndSlip = Literal["forwards", "backwards", "never", "part of the cycle"]


class SteadyState(NamedTuple):
    """Steady state found by a method; lengths in any one unit.

    ``centre`` and ``half_width`` of the stick zone (None: nothing sticks); ``slips``: slip of the left and right
    contact edge under varying pressure; ``permanent``: ends of the zone that never slips, (nan, nan) if there is no
    such zone, None if not known. ``undetermined`` as in :class:`Result`.
    """

    regime: Regime
    centre: float | None = None
    half_width: float | None = None
    notes: tuple[str, ...] = ()
    slips: tuple[EndSlip, EndSlip] | None = None
    permanent: tuple[float, float] | None = None
    undetermined: Mapping[str, str] = {}

    def placed(self, origin: float, length: float) -> "SteadyState":
        """Steady state in m, from lengths in the unit ``length`` (m) and x = 0 at ``origin`` (m)."""
        return self._replace(
            centre=None if self.centre is None else origin + self.centre * length,
            half_width=None if self.half_width is None else self.half_width * length,
            permanent=self.permanent and (origin + self.permanent[0] * length, origin + self.permanent[1] * length),
        )


@dataclass(frozen=True, repr=False)
class Result(Drawn):
    """Solution of a scene by one method.

    Parameters
    ----------
    method : str
        Name of the method.
    a, p0 : float
        Contact half-width, m, and 2 P/(pi a), Pa; p0 is the largest pressure of Hertz's contact.
    regime : str
        One of :data:`Regime`.
    stick_centre, stick_half_width : float or None
        (n - m)/2 and (n + m)/2 of the stick zone [-m, n], the zone of the tractions in which \\|dq\\| < f (p_1 + p_2)
        between the load points, m; None where nothing sticks. Stored instead of m and n
        because n + m cancels where the zone is tiny.
    traction : Traction
        p, q1, q2 and dq along the contact.
    cost : Cost
        CPU seconds, wall seconds and memory.
    slip : Slip or None
        Slip along the contact; None in full sliding and without friction.
    settings, counts : mapping
        Settings of the discretisation, and counts of work (unknowns, iterations, load steps).
    limits : mapping of str to float
        Loads at which the regime changes, where the method knows them: ``dsigma_transition`` (Pa, from small to large
        tension at this dQ), ``Q_sliding`` (N/m, f P), ``Q_mean`` (N/m, the largest mean Q of a steady state), and
        where the pressure varies ``Q_mean_least`` and ``Q_mean_most`` (N/m, the range of this mean).
    certificate : mapping of str to float
        Residuals in f p0 (p0 for the normal problem); equilibrium relative to the load.
    last_cycle_change : float or None
        Largest change of q over the last cycle, in f p0; None if no whole cycle was followed.
    estimate : mapping of str to float
        The method's error estimates: ``a``, ``m``, ``n``, ``left``, ``right`` as fractions of a; ``p``, ``q``, ``q1``,
        ``q2`` as relative L2 errors of cell averages.
    notes : tuple of str
        Remarks for the reader.
    bodies : tuple of DeformedBody
        Fields inside the bodies; empty unless asked for.
    state : State or None
        Loads and tractions at the end of the load path, to continue from.
    surface : SurfaceStress or None
        sigma_xx along the surfaces, if asked for and known (exact method: where q1 and q2 are).
    stress_at : StressAt or None
        ``stress_at(x, y) -> (2, 3, ...)``: stresses by load point and component xx, yy, xy, Pa, at points of any
        shape, m; the lower body is y <= 0. ``stress_at(x, y, phases) -> (s, 3, ...)``: at ``phases`` (s,) of the
        cycle. Known if asked for, where q1 and q2 are; see :class:`partialslip.result.StressAt`.
    contact_ends : ((float, float), (float, float)) or None
        Left and right end of the contact at load points 1 and 2, m; None stands for -a and a at both.
    shares : mapping of str to mapping
        Parts of the estimates by source (``discretisation``, ``steps``, ``start``, ``table``, ``rounding``) and key of
        ``estimate``.
    undetermined : mapping of str to str
        By quantity (``m``, ``n``, ``q``, ``q1``, ``q2``), why the value cannot serve as a reference; ``regime``: why
        its name is not certain; ``steady``: why the cycles do not tell the steady state.
    path_dependent : bool
        Whether slip reverses between the load points and the result is that of one load step, which gradual loads do
        not have.
    end_slips : (EndSlip, EndSlip) or None
        Where the pressure varies: whether the left and the right end of the contact slip from load point 1 to 2
        "forwards" (the lower body along +x), "backwards", "never", or only during "part of the cycle".
    permanent : (float, float) or None
        Left and right end, m, of the permanent stick zone, which are the points that never slip in the steady cycle;
        (nan, nan) where every point slips. [-m, n], where dq between the load points is below the bound f (p_1 + p_2),
        is the same unless the stick zone moves on the way. None where the method does not know.
    edges : (Array, Array) or ()
        Element edges of the lower and the upper body near the contact, (k, 2, 2) by edge, end and x, y, m, undeformed;
        only edges long enough to be seen. Empty for methods without elements.
    plates : Plates or None
        Forces and displacements of the plates that hold two finite bodies (:class:`partialslip.result.Plates`), and
        how stiff the rig is (fem).
    right_grip : (2,) array or None
        Force along x that the plate on the right side of the lower body bears besides sigma, at load points 1 and 2,
        N/m, positive where Q is: its share of Q, and what P stretches (fem, with ``right_grip`` = "stiffness").
    """

    method: str
    a: float
    p0: float
    regime: Regime
    stick_centre: float | None
    stick_half_width: float | None
    traction: Traction
    cost: Cost
    slip: Slip | None = None
    settings: Mapping[str, str | float | int] = field(default_factory=dict)
    counts: Mapping[str, int] = field(default_factory=dict)
    limits: Mapping[str, float] = field(default_factory=dict)
    certificate: Mapping[str, float] = field(default_factory=dict)
    last_cycle_change: float | None = None
    estimate: Mapping[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    bodies: tuple[DeformedBody, ...] = ()
    state: State | None = None
    surface: SurfaceStress | None = None
    stress_at: StressAt | None = None
    contact_ends: tuple[tuple[float, float], tuple[float, float]] | None = None
    shares: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    undetermined: Mapping[str, str] = field(default_factory=dict)
    path_dependent: bool = False
    end_slips: tuple[EndSlip, EndSlip] | None = None
    permanent: tuple[float, float] | None = None
    edges: tuple[Array, Array] | tuple[()] = ()
    plates: Plates | None = None
    right_grip: Array | None = None

    @classmethod
    def of(
        cls, method: str, found: SteadyState, half_width: float, p0: float, traction: Traction, clock: Clock
    ) -> "Result":
        """Result with the quantities that every method finds; :func:`dataclasses.replace` adds those of one method.

        Parameters
        ----------
        method : str
            Name of the method.
        found : SteadyState
            In m.
        half_width, p0 : float
            ``a`` and ``p0`` of the result, m and Pa.
        traction : Traction
        clock : Clock
            Has counted the seconds.
        """
        return cls(
            method=method,
            a=half_width,
            p0=p0,
            regime=found.regime,
            stick_centre=found.centre,
            stick_half_width=found.half_width,
            traction=traction,
            cost=clock.cost(),
            notes=found.notes,
            end_slips=found.slips,
            permanent=found.permanent,
            undetermined=found.undetermined,
        )

    def __repr__(self) -> str:
        """Method, regime, a, m, n and p0, in a line."""
        ends = {"m": self.m, "n": self.n}
        found = ", ".join(f"{key} = {end / self.a:.7g} a" for key, end in ends.items() if end is not None)
        stick = (found if self.steady else "no steady state") or "no stick zone"
        return f"Result of {self.method}: {self.regime}; a = {self.a:.7g} m, {stick}; p0 = {self.p0:.7g} Pa"

    @property
    def steady(self) -> bool:
        """Whether the cycle has a steady state. Where the contact ratchets, [-m, n] is the zone in which \\|dq\\| is
        below the bound: of the closed form (exact), which no cycle reaches, or of the last cycle (march, fem)."""
        return self.regime != "ratchets"

    @property
    def ends(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Left and right end of the contact at load points 1 and 2, m."""
        return self.contact_ends or ((-self.a, self.a), (-self.a, self.a))

    @property
    def m(self) -> float | None:
        """Minus the position of the left end of the stick zone [-m, n], m; None where nothing sticks."""
        if self.stick_centre is None or self.stick_half_width is None:
            return None
        return self.stick_half_width - self.stick_centre

    @property
    def n(self) -> float | None:
        """Position of the right end of the stick zone [-m, n], m; None where nothing sticks."""
        if self.stick_centre is None or self.stick_half_width is None:
            return None
        return self.stick_half_width + self.stick_centre

    @property
    def columns(self) -> dict[str, Array | None]:
        """Tractions as columns (n,), SI units; None for values that the method does not determine.

        ``p1`` is present only where the pressure differs between the load points.
        """
        of = self.traction
        columns = {"x": of.x, "x_over_a": of.x / self.a, "p": of.p, "q1": of.q1, "q2": of.q2, "dq": of.dq}
        return columns if of.p1 is None else columns | {"p1": of.p1}

    def to_dataframe(self) -> "DataFrame":
        """Return the tractions as a table, one row per point: x (m), x_over_a, p, q1, q2 and dq (Pa).

        Values that the method does not determine are NaN.
        """
        return frame(self.columns)
