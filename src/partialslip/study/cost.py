"""Errors against CPU seconds, over a ladder of settings of every method, and the figures of such a study."""

import math
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import cycle, zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec
import numpy as np

from partialslip.report import Record
from partialslip.result.record import ResultRecord
from partialslip.run.judge.reference import reference
from partialslip.scene import Scene
from partialslip.scene.plan import plan
from partialslip.study.batch.job import Job, Solved, solve_apart
from partialslip.study.batch.ledger import Ledger
from partialslip.tools.convergence import power
from partialslip.tools.errors import InputError
from partialslip.tools.groups import grouped
from partialslip.tools.inputfile import read_text
from partialslip.tools.output.svg import svg
from partialslip.tools.strictjson import decoded

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__path__: list[str] = []  # for the names of its former modules (partialslip.tools.moved)

SETTING = (
    "setting: accuracy asked of a, m and n, as a fraction of a (adapted meshes, march), or element size h (uniform "
    "meshes, other codes)"
)
ERRORS = ("a", "m", "n", "p", "q")
_Setting = tuple[str, dict[str, Any]]  # its name, and what it sets of finite elements
ADAPTED = "fem, adapted"
_ADAPTED: dict[str, tuple[dict[str, Any], tuple[float, ...]]] = {
    ADAPTED: ({}, (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)),
    "fem P6, adapted": ({"order": 6}, (1e-6, 1e-7, 1e-8)),
    "fem P4, adapted": ({"order": 4}, (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)),
    "fem P3, adapted": ({"order": 3}, (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)),
    "fem P2, adapted": ({"order": 2}, (1e-2, 1e-3, 1e-4, 1e-5)),
    "fem P1, adapted": ({"order": 1}, (1e-1, 3e-2, 1e-2, 3e-3)),
    "fem, box": ({"far_field": "box"}, (1e-3, 1e-4, 1e-5, 1e-6)),
    "fem, SuperLU": ({"factor": "superlu"}, (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)),
}
_UNIFORM = {"fem P1, uniform": 1, "fem P2, uniform": 2, "fem P4, uniform": 4}  # fixed: orders of the elements
_SIZES = (0.16, 0.08, 0.04, 0.02, 0.01, 0.005)  # display: of the elements of uniform meshes, in a
USUAL = ("exact", "march", ADAPTED, "fem P1, uniform", "fem P2, uniform")  # the series that answer, without --all
_SPAN = 1.5  # display: factor of the unknowns below which no exponent is told: meshes for two accuracies may be one
_LARGEST_FILE = 100_000_000  # limit: bytes
_ROUNDING = 1e-16  # display: smallest error drawn
_BARS = 4  # display: as many have room
_SHORT = 30.0  # display: ratio of the ends of an axis up to which there is room for three labels in a decade
_MARKS = ("o", "s", "^", "v", "D", "<", ">", "p", "h", "X", "P", "*", "d")
_GREYS = ("0.0", "0.45", "0.65")
_LINES = ("-", "--", ":", "-.")
_HATCHES = ("", "////", "....", "xxxx", "----", "\\\\\\\\", "oooo", "++++")


@dataclass(frozen=True)
class CostPoint:
    """One setting, solved by a process of its own.

    Parameters
    ----------
    series, setting : str
        Name of the series of settings, and of the setting.
    errors : dict of str to float
        Errors against the exact solution: a, m and n as fractions of a, p and q in relative L2 of cell averages.
    cpu_s, process_s, report_s : float
        CPU seconds of the method (the smallest of its repeats), of a whole process without the report, and of writing
        the report.
    wall_s : float
        Wall seconds.
    peak_rss_mb : float
        Peak memory, MB.
    phases : dict of str to float
        CPU seconds of the method by phase.
    counts : dict of str to int
        Counts of work.
    """

    series: str
    setting: str
    errors: dict[str, float]
    cpu_s: float
    process_s: float
    report_s: float
    wall_s: float
    peak_rss_mb: float
    phases: dict[str, float]
    counts: dict[str, int]

    @property
    def ends(self) -> float:
        """The larger error of m and n; the error of a where nothing sticks. Fractions of a."""
        of_stick = [self.errors[key] for key in ("m", "n") if key in self.errors]
        return max(of_stick) if of_stick else self.errors["a"]


LADDERS = ("exact", "march", "fem")  # fixed: methods with a ladder


class MeasuredCosts(NamedTuple):
    """What was measured: ``points``, and the settings that were ``left`` out when the budget was spent."""

    points: list[CostPoint]
    left: list[Job]


def setting_name(case: Job) -> str:
    """Return series and setting of a job of the ladder as text."""
    return ", ".join(filter(None, map(str, case.labels.values())))


def ladder(scene: Scene, methods: Collection[str] = LADDERS, every: bool = False) -> list[Job]:
    """Return the jobs for all settings of ``scene`` by ``methods``, the coarsest setting of each series first, then
    the next of each; of the series in :data:`USUAL`, or of ``every`` series.

    Raises
    ------
    InputError
        If the exact method cannot solve the scene.
    """
    if reference(scene).method != "exact":
        raise InputError(
            f"{scene.name}: a cost study needs the exact method: half-planes of equal material, loads in phase"
        )
    found = [_series(scene, "exact", "exact", [("", {})])]
    if plan(scene).needs("friction"):
        found.append(_series(scene, "march", "march", [_asked(each) for each in (1e-3, 1e-4, 1e-5, 1e-6)]))
    for name, (fixed, accuracies) in _ADAPTED.items():
        found.append(_series(scene, "fem", name, [_asked(each) for each in accuracies], fixed))
    for name, order in _UNIFORM.items():
        settings: list[_Setting] = [(f"h = {size:g} a", {"size": size}) for size in _SIZES]
        found.append(_series(scene, "fem", name, settings, {"order": order}))
    rungs = (case for rung in zip_longest(*found) for case in rung if case)
    return [case for case in rungs if case.methods[-1] in methods and (every or case.labels["series"] in USUAL)]


def _asked(accuracy: float) -> _Setting:
    digits, _, power = f"{accuracy:.0e}".partition("e")
    return f"accuracy {digits}e{int(power)}", {"accuracy": accuracy}


def _series(
    scene: Scene, method: str, name: str, settings: Iterable[_Setting], fixed: Mapping[str, Any] = {}
) -> list[Job]:
    """Return the jobs of one series, cheapest first: ``settings`` of finite elements, beside those that are
    ``fixed``."""
    found, methods = [], tuple(dict.fromkeys(("exact", method)))
    for setting, fem in settings:
        found.append(Job(scene.replace(fem={**fixed, **fem}), methods, {"series": name, "setting": setting}))
    return found


def measure_costs(
    scene: Scene,
    ledger: Ledger,
    repeats: int,
    progress: Callable[[int, int, str, float], None] = lambda *_: None,
    methods: Collection[str] = LADDERS,
    budget: float = math.inf,
    every: bool = False,
) -> MeasuredCosts:
    """Solve the ladder of ``scene``, one new process per setting. Settings in ``ledger`` are not solved again.

    Parameters
    ----------
    scene : Scene
    ledger : Ledger
    repeats : int
        Most solutions of a setting, whose CPU seconds are the smallest ones
        (:func:`partialslip.study.batch.job.solve_apart`).
    progress : callable
        ``progress(done, total, next, rest)``, with the next setting as text and the rest of the budget.
    methods : collection of str
        Of :data:`LADDERS`.
    budget : float
        CPU seconds of all processes, those in ``ledger`` included: once they are spent no setting is begun.
    every : bool
        Whether to take all series, or those of :data:`USUAL`.
    """
    cases, found, rest = ladder(scene, methods, every), list[Solved](), budget
    for number, case in enumerate(cases):
        if found and rest <= 0:
            break
        progress(number, len(cases), setting_name(case), rest)
        if case.key not in ledger:
            ledger.add(case.key, solve_apart(case, repeats))
        found.append(ledger.read(case.key, Solved))
        if process := found[-1].process:
            rest -= process.cpu_s + process.report_cpu_s + process.again_cpu_s
    progress(len(cases), len(cases), "", rest)
    return MeasuredCosts([_cost_point(entry, entry.run) for entry in found if entry.run], cases[len(found) :])


def _cost_point(entry: Solved, run: Record) -> CostPoint:
    comparison = next(iter(run.comparison.values()), None)
    cost, process = _method(run).cost, entry.process
    return CostPoint(
        series=str(entry.labels["series"]),
        setting=str(entry.labels["setting"]),
        errors={key: error for key in ERRORS if (error := comparison.errors[key]) is not None} if comparison else {},
        cpu_s=cost.cpu_s,
        process_s=process.cpu_s if process else math.nan,
        report_s=process.report_cpu_s if process else math.nan,
        wall_s=process.wall_s if process else math.nan,
        peak_rss_mb=process.peak_rss_mb if process else math.nan,
        phases=dict(cost.phases),
        counts=_method(run).counts,
    )


def _method(run: Record) -> ResultRecord:
    """Return the method of ``run`` other than exact; exact if there is no other."""
    return next((found for name, found in run.methods.items() if name != "exact"), run.methods["exact"])


class _Scene(msgspec.Struct):
    scene: str


class _Peer(_Scene):
    """Result of another code; further keys are allowed."""

    method: str
    setting: str
    element_size: float
    dofs: int
    errors: dict[str, float | None]
    cpu_s: float
    process_cpu_s: float
    wall_s: float
    peak_rss_mb: float


def read_peers(path: Path, scene: str) -> list[CostPoint]:
    """Read other codes' results for ``scene`` from the file ``path``, one JSON object per line.

    Keys: ``scene``, ``method``, ``setting``, ``element_size``, ``dofs``, ``errors``, ``cpu_s``, ``process_cpu_s``,
    ``wall_s`` and ``peak_rss_mb`` (see ``benchmarks/peers``).

    Raises
    ------
    InputError
        If the file cannot be read, or a line is not such an object.
    """
    found = []
    try:
        text = read_text(path, _LARGEST_FILE)
    except InputError as error:
        raise InputError(f"--peers {error}") from None
    for number, line in enumerate(text.splitlines(), start=1):
        told = f"--peers {path}: line {number}: must be a JSON result of another code, see benchmarks/peers"
        if decoded(line, _Scene, told).scene == scene:
            peer = decoded(line, _Peer, told)
            found.append(
                CostPoint(
                    series=f"{peer.method}, {_short_setting(peer.setting)}",
                    setting=f"h = {peer.element_size:g} a",
                    errors={key: off for key in ERRORS if (off := peer.errors.get(key)) is not None},
                    cpu_s=peer.cpu_s,
                    process_s=peer.process_cpu_s,
                    report_s=0.0,
                    wall_s=peer.wall_s,
                    peak_rss_mb=peer.peak_rss_mb,
                    phases={},
                    counts={"dofs": peer.dofs},
                )
            )
    return found


def _short_setting(setting: str) -> str:
    return setting.split(", growth")[0].replace(" to the ends", "").replace("surface-to-surface ", "")


def front(points: Iterable[CostPoint]) -> list[CostPoint]:
    """Return the Pareto front of ``points``, cheapest first: CPU seconds of the solution against errors of m and n."""
    best, found = np.inf, []
    for point in sorted((point for point in points if point.errors), key=lambda point: (point.cpu_s, point.ends)):
        if point.ends < best:
            found.append(point)
            best = point.ends
    return found


def by_series(points: Iterable[CostPoint]) -> dict[str, list[CostPoint]]:
    """Return ``points`` by series."""
    return grouped((point.series, point) for point in points)


def slopes(points: Iterable[CostPoint]) -> dict[str, dict[str, float]]:
    """Return exponents of the errors of m and n, and q, and of CPU seconds against unknowns, by series of finite
    elements among ``points``; NaN where the unknowns hardly differ."""
    found = {}
    for series, own in by_series(point for point in points if "dofs" in point.counts).items():
        dofs = [point.counts["dofs"] for point in own]
        data = {
            "m, n": [point.ends for point in own],
            "q": [point.errors.get("q", np.nan) for point in own],
            "CPU": [point.cpu_s for point in own],
        }
        apart = max(dofs) >= _SPAN * min(dofs)
        found[series] = {key: power(dofs, each) if apart else math.nan for key, each in data.items()}
    return found


def against(ours: Sequence[CostPoint], peer: Sequence[CostPoint], key: str) -> dict[str, float]:
    """Compare points of partialslip with points of another code.

    Parameters
    ----------
    ours, peer : sequence of CostPoint
    key : str
        Quantity whose error is compared.

    Returns
    -------
    dict of str to float
        ``error``: best error of the peer. ``cpu``, ``process``: CPU seconds of partialslip for the same error, of the
        method and of the process, over the peer's. ``error at its cpu``: best error of partialslip within the peer's
        CPU seconds, over the peer's. NaN where no point of ``ours`` qualifies.
    """
    best = min((point for point in peer if key in point.errors), key=lambda point: point.errors[key])
    good = [point for point in ours if point.errors.get(key, np.inf) <= best.errors[key]]
    in_time = [point.errors[key] for point in ours if key in point.errors and point.cpu_s <= best.cpu_s]
    return {
        "error": best.errors[key],
        "cpu": min((point.cpu_s for point in good), default=np.nan) / best.cpu_s,
        "process": min((point.process_s for point in good), default=np.nan) / best.process_s,
        "error at its cpu": min(in_time, default=np.nan) / best.errors[key],
    }


def cost_table(points: Sequence[CostPoint]) -> tuple[list[str], list[list[float | str]]]:
    """Return headings and rows for a CSV file with all values of ``points``."""
    phases = list(dict.fromkeys(phase for point in points for phase in point.phases))
    counts = list(dict.fromkeys(count for point in points for count in point.counts))
    costs = ["cpu_s", "process_s", "report_s", "wall_s", "peak_rss_mb"]
    head = ["series", "setting", *ERRORS, *costs, *(f"{phase}_cpu_s" for phase in phases), *counts]
    rows: list[list[float | str]] = [
        [
            point.series,
            point.setting,
            *(point.errors.get(key, "") for key in ERRORS),
            *(getattr(point, cost) for cost in costs),
            *(point.phases.get(phase, "") for phase in phases),
            *(point.counts.get(count, "") for count in counts),
        ]
        for point in points
    ]
    return head, rows


def start_s(points: Iterable[CostPoint]) -> float:
    """Return the CPU seconds that a process takes beside the solution: the smallest; NaN without points."""
    return min((point.process_s - point.cpu_s for point in points), default=math.nan)


def errors_svg(points: Sequence[CostPoint], peers: Sequence[CostPoint], title: str, asked: float) -> str:
    """Return the error of m and n against CPU seconds of the solution as SVG, legible at a width of 9 cm.

    ``points`` are results of partialslip, ``peers`` of other codes; ``asked`` is the accuracy that the scene asks for,
    as a fraction of a.
    """
    outside = {point.series for point in peers}

    def draw(figure: "Figure") -> None:
        axes, marks = figure.subplots(), cycle(_MARKS)
        for number, (series, found) in enumerate(by_series(each for each in [*points, *peers] if each.errors).items()):
            style: dict[str, Any] = {"ls": _LINES[number % len(_LINES)], "color": _GREYS[number % len(_GREYS)]}
            if series in outside:
                style = {"ls": "none", "color": "black", "mfc": "black"}
            data = np.array([[point.cpu_s, max(point.ends, _ROUNDING)] for point in found])
            axes.loglog(*data.T, next(marks), **{"mfc": "white", "ms": 5, "lw": 1, **style}, label=series)
        best = np.array([[point.cpu_s, max(point.ends, _ROUNDING)] for point in front([*points, *peers])])
        if len(best):
            axes.step(*best.T, where="post", color="0.82", lw=6, zorder=0, solid_capstyle="round", label="best of all")
        axes.axhline(asked, color="black", lw=0.8, ls=(0, (6, 2)), zorder=0.5, label=f"asked for: {asked:.0e} a")
        exact = [point.cpu_s for point in points if point.series == "exact"]
        if exact:
            axes.axvline(exact[0], color="black", lw=1, ls=(0, (1, 2)), label=f"exact: {exact[0]:.2g} s")
        start = start_s(points)
        if start > 0:
            low = axes.get_xlim()[0]
            axes.axvspan(low, start, color="0.93", lw=0, zorder=-1, label=f"start-up of a process: {start:.2g} s")
            axes.set_xlim(left=low)
        axes.set(xlabel="CPU s of the solution", ylabel="error of m and n, in a")
        axes.grid(which="major", color="0.88", lw=0.5, zorder=-2)
        axes.set_axisbelow(True)
        _tick_plainly(axes)
        figure.suptitle(title, x=0.01, ha="left", fontsize=10)
        figure.legend(loc="outside lower left", ncols=2, frameon=False, fontsize=8, handlelength=2.6)

    return svg(draw, (4.4, 4.6))


def phases_svg(points: Sequence[CostPoint], title: str) -> str:
    """Return CPU seconds of the finite elements by phase, and over the unknowns, as SVG, as far as ``points``, as
    measured, have them; empty without either."""
    series = {name: found for name, found in by_series(points).items() if "dofs" in found[0].counts}
    adapted = {name: found for name, found in series.items() if name.endswith("adapted")}
    shown = max(adapted, key=lambda name: (len(adapted[name]), name == ADAPTED), default="")
    grown = {name: found for name, found in series.items() if len({point.counts["dofs"] for point in found}) > 1}
    panels: list[Callable[[Any], None]] = []
    if shown:
        panels.append(lambda axes: _draw_shares(axes, adapted[shown], shown))
    if grown:
        panels.append(lambda axes: _draw_growth(axes, grown))
    if not panels:
        return ""

    def draw(figure: "Figure") -> None:
        for axes, panel in zip(figure.subplots(1, len(panels), squeeze=False).flat, panels, strict=True):
            panel(axes)
        figure.suptitle(title, x=0.01, ha="left", fontsize=10)

    return svg(draw, (5.9 * len(panels), 4.4))


def _draw_shares(axes: "Axes", points: Sequence[CostPoint], series: str) -> None:
    """Draw CPU seconds by phase as bars, one for each of the ``points`` of a series."""
    found = sorted(points, key=lambda point: point.counts["dofs"])
    names = list(dict.fromkeys(name for point in found for name in point.phases))
    place, bottom = np.arange(len(found)), np.zeros(len(found))
    others = [point.process_s - sum(point.phases.values()) for point in found]
    bars = {name: [point.phases.get(name, 0.0) for point in found] for name in names} | {"start, the rest": others}
    for number, (name, seconds) in enumerate(bars.items()):
        axes.bar(
            place, seconds, bottom=bottom, label=name, color=str(0.95 - 0.08 * number), ec="black", lw=0.6,
            hatch=_HATCHES[number % len(_HATCHES)], width=0.7,
        )  # fmt: skip
        bottom += seconds
    axes.set_xlim(-0.8, max(len(found), _BARS) - 0.2)
    axes.set_xticks(place, [f"{point.counts['dofs']:,}" for point in found], rotation=30)
    axes.set(xlabel=f"unknowns of the last mesh ({series})", ylabel="CPU s of the process")
    _put_legend(axes, reverse=True)  # as the bars are stacked


def _draw_growth(axes: "Axes", series: Mapping[str, Sequence[CostPoint]]) -> None:
    """Draw CPU seconds of the method over the unknowns, a line for each series."""
    exponents, marks = slopes(point for points in series.values() for point in points), cycle(_MARKS)
    for number, (name, points) in enumerate(series.items()):
        data = np.array([[point.counts["dofs"], point.cpu_s] for point in points])
        exponent = exponents[name]["CPU"]
        style = {"ls": _LINES[number % len(_LINES)], "color": _GREYS[number % len(_GREYS)], "mfc": "white"}
        label = name if math.isnan(exponent) else f"{name}: {exponent:.2f}"
        axes.loglog(*data.T, next(marks), ms=5, lw=1, label=label, **style)
    axes.set(xlabel="unknowns of the last mesh", ylabel="CPU s of the method")
    _tick_plainly(axes)
    _put_legend(axes, title="series: exponent")


def _tick_plainly(axes: "Axes") -> None:
    """Label the logarithmic x axis at powers of ten, and at 2 and 5 times these if the axis is short, by plain numbers:
    labels as 2 x 10^0 are so wide that they touch."""
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    low, high = axes.get_xlim()
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < _SHORT * low else (1,)))
    axes.xaxis.set_major_formatter(StrMethodFormatter("{x:,.7g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())


def _put_legend(axes: "Axes", **more: Any) -> None:
    """Put the legend beside the panel, where nothing is drawn."""
    axes.legend(
        frameon=False, fontsize=8, title_fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.3,
        **more,
    )  # fmt: skip
