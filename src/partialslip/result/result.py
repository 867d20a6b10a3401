"""What a method hands over: the same type from every one."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from partialslip.arrays import Array
from partialslip.frame import frame
from partialslip.result.cost import Cost
from partialslip.result.fields import DeformedBody, Slip, SurfaceStress
from partialslip.result.state import State
from partialslip.result.traction import Traction

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from partialslip.frame import DataFrame

FRICTIONLESS = "f = 0 and Q = 0: nothing sticks, and without shear force the contact stays where it is"

Regime = Literal[
    "stuck", "small tension", "large tension", "out of phase", "sliding", "ratchets", "pressing", "frictionless"
]


@dataclass(frozen=True)
class Result:
    """A method's answer to a scene.

    ``a`` is the contact half-width (m) and ``p0`` = 2 P/(pi a) (Pa), for Hertz the largest pressure.

    The stick zone [-m, n] is kept as its centre, ``stick_centre`` = (n - m)/2, and ``stick_half_width`` = (n + m)/2
    (m), because n + m cancels when it is tiny; both are None where nothing sticks (``regime`` says "sliding", or
    "frictionless" where no shear force acts either).
    ``traction`` holds p, q1, q2 and dq along the contact, ``cost`` what it took.
    ``certificate`` holds residuals in units of f p0 (of p0 for the normal problem) and equilibrium relative to
    the load; ``last_cycle_change`` is the largest change of q over the last cycle, in f p0 (None where no whole cycle
    was followed); ``estimate`` the method's own estimate of its errors in a, m and n, as fractions of a, and by finite
    elements in p and q, too (relative L2 of cell averages);
    ``settings`` and ``counts`` say what was built and how much work it was; ``notes`` what a reader must know;
    ``limits`` are loads at which something else begins, where the method knows them: ``dsigma_transition`` (Pa, where
    small tension turns large at this dQ), ``Q_sliding`` (N/m, f P) and ``Q_mean`` (N/m, the largest mean that a steady
    state can hold). ``slip`` is None where the contact slides as a whole or there is no friction; ``bodies`` is there
    only where fields inside the bodies were asked for, and so are ``surface`` and ``stress_at``, from methods that know
    stresses everywhere (the exact one, at fully reversed loads that do not slide): ``stress_at(x, y) -> (2, 3, k)``, by
    load point and component xx, yy, xy, Pa, at points (k,) of which y <= 0 are in the lower body.

    ``contact_ends`` are the contact's left and right end (m) at load points 1 and 2; None stands for -a and a at both.
    ``estimate`` may hold ``left`` and ``right`` (fractions of a), ``q1`` and ``q2`` (relative L2 of cell averages)
    besides, and ``shares`` says what each estimate is made of: by source (``discretisation``, ``steps``, ``table``,
    ``rounding``) and then by the estimate's key. ``undetermined`` gives, by quantity (``m``, ``n``, ``q``, ``q1``,
    ``q2``), the reason why the method's value is none to judge others by; ``path_dependent`` says that slip turns round
    on the way between the load points, so that a method that takes one step is no reference.
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
    stress_at: Callable[[Array, Array], Array] | None = None
    contact_ends: tuple[tuple[float, float], tuple[float, float]] | None = None
    shares: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    undetermined: Mapping[str, str] = field(default_factory=dict)
    path_dependent: bool = False

    @property
    def ends(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The contact's left and right end at load points 1 and 2, m."""
        return self.contact_ends or ((-self.a, self.a), (-self.a, self.a))

    @property
    def m(self) -> float | None:
        """The stick zone's left end is at x = -m, m."""
        if self.stick_centre is None or self.stick_half_width is None:
            return None
        return self.stick_half_width - self.stick_centre

    @property
    def n(self) -> float | None:
        """The stick zone's right end is at x = n, m."""
        if self.stick_centre is None or self.stick_half_width is None:
            return None
        return self.stick_half_width + self.stick_centre

    @property
    def columns(self) -> dict[str, Array | None]:
        """Tractions as columns of a table (n,), SI units; None what the method does not determine. ``p1`` only where
        the pressure differs between the load points."""
        of = self.traction
        columns = {"x": of.x, "x_over_a": of.x / self.a, "p": of.p, "q1": of.q1, "q2": of.q2, "dq": of.dq}
        return columns if of.p1 is None else columns | {"p1": of.p1}

    def to_dataframe(self) -> "DataFrame":
        """Tractions, a row a point: x (m), x_over_a, p, q1, q2 and dq (Pa), NaN what the method does not determine.

        Raises
        ------
        MissingLibraryError
            If pandas is not installed.
        """
        return frame(self.columns)

    def plot(self, axes: "Axes | None" = None) -> "Axes":
        """Draw p/p0 and q/p0, q = (q2 - q1)/2, over x/a on matplotlib ``axes``, as a rule new ones; returns them."""
        from partialslip.report.notebook import plot

        return plot(self, axes)

    def _repr_html_(self) -> str:
        from partialslip.report.notebook import html

        return html(self)
