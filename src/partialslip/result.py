"""What a method hands over: the same type from every one."""

import math
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from partialslip import views
from partialslip.allowance import Allowance
from partialslip.frame import frame
from partialslip.state import State

if TYPE_CHECKING:
    from partialslip.frame import DataFrame

try:
    import resource
except ImportError:  # Windows
    resource = None  # type: ignore[assignment]

Array = npt.NDArray[np.float64]
# A solver that has closed leaves residuals at rounding; on the finest meshes that is 1e-9 f p0.
CERTIFICATE_BAR = 1e-7
FRICTIONLESS = "f = 0 and Q = 0: nothing sticks, and without shear force the contact stays where it is"

Regime = Literal[
    "stuck", "small tension", "large tension", "out of phase", "sliding", "ratchets", "pressing", "frictionless"
]


@dataclass(frozen=True)
class Traction:
    """Tractions over the contact line.

    Parameters
    ----------
    x : (n,) array
        Points, ascending, m.
    p, dq : (n,) arrays
        Pressure and the change of shear traction q2 - q1, Pa.
    q1, q2 : (n,) arrays or None
        Shear traction at load points 1 and 2, Pa. None where the method determines the change only (with
        mean loads a closed form cannot know what the first cycles lock in). Where Q and sigma are out of phase,
        the least and the largest of the last cycle.
    at : callable
        ``at(x) -> (p, dq)``: tractions at any points, as this method represents them; zero outside the contact.
    breaks : (k,) array
        Points where the tractions are not smooth (ends of the contact and of the stick zone), m.
    cells : (c + 1,) array or None
        The ends of the cells (contact edges) that the method's accuracy is judged on, m; None if it has none.
    levels_at : callable or None
        ``levels_at(x) -> (q1, q2)`` at any points, zero outside the contact; None where ``q1`` and ``q2`` are.
    p1 : (n,) array or None
        Pressure at load point 1, Pa, where it differs from ``p``, which is that at load point 2.
    pressures_at : callable or None
        ``pressures_at(x) -> (p1, p2)`` at any points; None where the pressure is the same at both load points.
    """

    x: Array
    p: Array
    dq: Array
    q1: Array | None
    q2: Array | None
    at: Callable[[Array], tuple[Array, Array]]
    breaks: Array
    cells: Array | None = None
    levels_at: Callable[[Array], tuple[Array, Array]] | None = None
    p1: Array | None = None
    pressures_at: Callable[[Array], tuple[Array, Array]] | None = None

    @property
    def p_max(self) -> float:
        """The largest pressure, Pa: of the parabola through the largest value and those beside it, as points need not
        fall on the top."""
        if len(self.x) < 3:
            return float(self.p.max())
        near = np.clip(int(self.p.argmax()), 1, len(self.x) - 2) + np.array([-1, 0, 1])
        x, p = self.x[near], self.p[near]
        if np.diff(x).min() <= 0:
            return float(p.max())
        before, after = np.diff(p) / np.diff(x)
        bend = (after - before) / (x[2] - x[0])
        slope = before + bend * (x[1] - x[0])
        rise = -(slope**2) / (4 * bend) if bend < 0 and abs(slope) < -bend * (x[2] - x[0]) else 0.0
        return float(max(p.max(), p[1] + rise))


@dataclass(frozen=True)
class Slip:
    """Slip over half a cycle.

    Parameters
    ----------
    x : (k,) array
        Points, ascending, m.
    slip : (k,) array
        Change, from load point 1 to 2, of the displacement of the body that pushes with q against the other, m.
    dissipated : float
        Work against friction over a whole cycle, per unit depth, J/m.
    """

    x: Array
    slip: Array
    dissipated: float


@dataclass(frozen=True)
class SurfaceStress:
    """Direct stress along the surfaces of the bodies, their bulk tensions included.

    Parameters
    ----------
    x : (k,) array
        Points, ascending, within the contact, at its ends and beyond, m.
    sigma : (2, 2, k) array
        sigma_xx by body, lower (which pushes with q against the other, and has the tension) and upper, and by load
        point, Pa.
    at : callable
        ``at(x) -> (2, 2, k)``: the same at any points.
    """

    x: Array
    sigma: Array
    at: Callable[[Array], Array]

    @property
    def largest(self) -> tuple[float, float]:
        """Where along the lower body sigma_xx is largest, m, and that, Pa: as a rule at the trailing edge, x = +-a."""
        highest = self.sigma[0].max(axis=0)
        return float(self.x[highest.argmax()]), float(highest.max())


@dataclass(frozen=True)
class DeformedBody:
    """A body's mesh and its displacements.

    Parameters
    ----------
    name : str
    points : (n, 2) array
        Undeformed, m.
    triangles : (t, 3) int array
    lines : dict of (k, 2) int arrays
        Named groups of boundary edges.
    displacements : dict of (n, 2) arrays
        By name, m.
    stresses : dict of (t, 3) arrays
        sigma_xx, sigma_yy and sigma_xy in the middle of the triangles, by name, Pa.
    """

    name: str
    points: Array
    triangles: npt.NDArray[np.int64]
    lines: Mapping[str, npt.NDArray[np.int64]]
    displacements: Mapping[str, Array]
    stresses: Mapping[str, Array] = field(default_factory=dict)


@dataclass(frozen=True)
class Cost:
    """CPU and wall seconds, ``cpu_s`` and ``wall_s``; peak resident memory of this process, ``peak_rss_mb`` (None where
    the system does not tell); CPU seconds by phase, ``phases``; ``meshing_cpu_s``, the CPU seconds of ``cpu_s`` that
    the process which makes meshes took."""

    cpu_s: float
    wall_s: float
    peak_rss_mb: float | None
    phases: Mapping[str, float] = field(default_factory=dict)
    meshing_cpu_s: float = 0.0


@dataclass(frozen=True)
class Result:
    """A method's answer to a scene.

    ``a`` is the contact half-width (m) and ``p0`` = 2 P/(pi a) (Pa), for Hertz the largest pressure.

    The stick zone [-m, n] is kept as its centre, ``stick_centre`` = (n - m)/2, and ``stick_half_width`` = (n + m)/2
    (m), because n + m cancels when it is tiny; both are None where nothing sticks (``regime`` says "sliding", or
    "frictionless" where no shear force acts either).
    ``traction`` holds p, q1, q2 and dq along the contact, ``cost`` what it took.
    ``certificate`` holds residuals in units of f p0 (of p0 for the normal problem) and equilibrium relative to
    the load; ``estimate`` the method's own estimate of its errors in a, m and n, as fractions of a, and by finite
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

    def plot(self, axes: "views.Axes | None" = None) -> "views.Axes":
        """Draw p/p0 and q/p0, q = (q2 - q1)/2, over x/a on matplotlib ``axes``, as a rule new ones; returns them."""
        return views.plot(self, axes)

    def _repr_html_(self) -> str:
        return views.html(self)


class Clock:
    """Counts what a method costs, phase by phase, and what is left of its ``allowance``, if it has one."""

    def __init__(self, allowance: Allowance | None = None) -> None:
        self._allowance = allowance
        self._cpu, self._wall = time.process_time(), time.perf_counter()
        self._meshing = 0.0
        self.phases: dict[str, float] = {}

    @contextmanager
    def phase(self, name: str) -> Iterator[None]:
        """Add the CPU seconds of the block to phase ``name``."""
        start = time.process_time()
        try:
            yield
        finally:
            self.phases[name] = self.phases.get(name, 0.0) + time.process_time() - start

    def add_meshing(self, seconds: float) -> None:
        """Add CPU seconds of the process that makes meshes to phase "mesh"."""
        self.phases["mesh"] = self.phases.get("mesh", 0.0) + seconds
        self._meshing += seconds
        if self._allowance:
            self._allowance.spend(seconds)

    @property
    def limited(self) -> bool:
        """Whether there is an allowance."""
        return self._allowance is not None

    def remaining(self) -> float:
        """CPU seconds that may still be spent; infinite without an allowance."""
        return self._allowance.remaining() if self._allowance else math.inf

    def cost(self) -> Cost:
        """What it has cost up to now."""
        own, wall = time.process_time() - self._cpu, time.perf_counter() - self._wall
        return Cost(own + self._meshing, wall, _peak_rss_mb(), self.phases, self._meshing)


def _peak_rss_mb() -> float | None:
    if resource is None:
        return None
    peak: int = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss  # bytes on macOS, kilobytes elsewhere
    return peak / (1024**2 if sys.platform == "darwin" else 1024)
