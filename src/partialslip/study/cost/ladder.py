"""What accuracy costs: errors against CPU seconds, over a ladder of settings of every method."""

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

import msgspec
import numpy as np

from partialslip.arrays import Array
from partialslip.batch.job import Job, Solved, solve_apart
from partialslip.batch.ledger import Ledger
from partialslip.errors import InputError
from partialslip.inputfile import read_text
from partialslip.plan import plan
from partialslip.report import Record
from partialslip.result.record import ResultRecord
from partialslip.run import default_methods
from partialslip.scene import Scene
from partialslip.scene.reading import parse_scene

KEYS = ("a", "m", "n", "p", "q")
_ADAPTED: dict[str, tuple[dict[str, Any], tuple[float, ...]]] = {
    "P4": ({"order": 4}, (1e-2, 1e-3, 1e-4, 2e-5, 1e-6, 1e-7)),
    "P3": ({"order": 3}, (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)),
    "P2": ({"order": 2}, (1e-2, 1e-3, 1e-4, 1e-5)),
    "P1": ({"order": 1}, (1e-1, 3e-2, 1e-2, 3e-3)),
    "P4, box": ({"order": 4, "far_field": "box"}, (1e-3, 1e-4, 1e-5, 1e-6)),
    "P4, SuperLU": ({"order": 4, "factor": "superlu"}, (1e-2, 1e-3, 1e-4, 2e-5, 1e-6, 1e-7)),
}
_LARGEST_FILE = 100_000_000  # bytes
_UNIFORM = {"P1": 1, "P2": 2, "P4": 4}
_SIZES = (0.16, 0.08, 0.04, 0.02, 0.01)


@dataclass(frozen=True)
class Point:
    """Medians over the repeats of one ``setting``, of a ``series`` of them.

    ``errors`` by quantity, against the exact solution (a, m and n in a, p and q in the relative L2 norm of cell means);
    ``cpu_s`` of the method, by ``phases``, ``process_s`` of the whole process, ``report_s`` of writing the report (not
    in the former), all CPU seconds; ``wall_s``; ``peak_rss_mb``, memory; ``counts`` of work.
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
        """The larger error of m and n; of a where nothing sticks."""
        of_stick = [self.errors[key] for key in ("m", "n") if key in self.errors]
        return max(of_stick) if of_stick else self.errors["a"]


def ladder(scene: Scene) -> list[Job]:
    """The settings that ``scene`` is solved with, cheapest first within each series.

    Raises
    ------
    InputError
        If there is nothing exact to compare with.
    """
    reference = default_methods(scene)[0]
    if reference != "exact" or scene.finite:
        raise InputError(
            f"{scene.name}: a cost study needs the exact method: bodies alike, half-planes, loads in phase"
        )
    cases = [_case(scene, ("exact",), "exact", "", {})]
    if plan(scene).needs("friction"):
        cases += [
            _case(scene, ("exact", "march"), "march", f"{asked:g}", {"accuracy": asked})
            for asked in (1e-3, 1e-4, 1e-5, 1e-6)
        ]
    for series, (fixed, accuracies) in _ADAPTED.items():
        cases += [
            _case(scene, ("exact", "fem"), f"{series}, adapted", f"{asked:g}", {**fixed, "accuracy": asked})
            for asked in accuracies
        ]
    for series, order in _UNIFORM.items():
        sizes = _SIZES if order > 1 else (*_SIZES, 0.005)
        cases += [
            _case(scene, ("exact", "fem"), f"{series}, uniform", f"h = {size:g} a", {"order": order, "size": size})
            for size in sizes
        ]
    return cases


def _case(scene: Scene, methods: tuple[str, ...], series: str, setting: str, fem: dict[str, Any]) -> Job:
    data = msgspec.to_builtins(scene)
    data["fem"] = {**data["fem"], **fem}
    return Job(parse_scene(data), methods, {"series": series, "setting": setting})


def measure(
    scene: Scene, ledger: Ledger, repeats: int, progress: Callable[[int, int, str], None] = lambda *_: None
) -> list[Point]:
    """Solve the ladder of ``scene`` ``repeats`` times, each setting in a process of its own, but for what ``ledger``
    has.

    One repeat of all settings comes after the other, so that what disturbs the machine for a while disturbs no setting
    alone. ``progress`` is called with how many are done, how many there are, and the next one in words.
    """
    cases = ladder(scene)
    runs = [
        Job(case.scene, case.methods, {**case.labels, "repeat": repeat}) for repeat in range(repeats) for case in cases
    ]
    for number, case in enumerate(runs):
        progress(number, len(runs), f"{case.labels['series']} {case.labels['setting']}")
        if case.key not in ledger:
            ledger.add(case.key, solve_apart(case))
    progress(len(runs), len(runs), "")
    return points(Solved.of(ledger[case.key]) for case in runs)


def points(entries: Iterable[Solved]) -> list[Point]:
    """Medians of the ``entries`` of a ledger, setting by setting."""
    by_setting: dict[tuple[str, str], list[Solved]] = {}
    for entry in entries:
        if entry.run:
            by_setting.setdefault((str(entry.labels["series"]), str(entry.labels["setting"])), []).append(entry)
    return [_point(series, setting, found) for (series, setting), found in by_setting.items()]


def _point(series: str, setting: str, entries: Sequence[Solved]) -> Point:
    runs = [entry.run for entry in entries if entry.run]
    comparison = next(iter(runs[0].comparison.values()), None)
    costs = [_method(run).cost for run in runs]
    processes = [entry.process for entry in entries if entry.process]
    return Point(
        series=series,
        setting=setting,
        errors={key: error for key in KEYS if (error := comparison.errors[key]) is not None} if comparison else {},
        cpu_s=median(cost.cpu_s for cost in costs),
        process_s=median(process.cpu_s for process in processes),
        report_s=median(process.report_cpu_s for process in processes),
        wall_s=median(process.wall_s for process in processes),
        peak_rss_mb=median(process.peak_rss_mb for process in processes),
        phases={phase: median(cost.phases[phase] for cost in costs) for phase in costs[0].phases},
        counts=_method(runs[0]).counts,
    )


def _method(run: Record) -> ResultRecord:
    """The method that ``run`` compares with the exact one; the exact one where that is alone."""
    return next((found for name, found in run.methods.items() if name != "exact"), run.methods["exact"])


def read_peers(path: Path, scene: str) -> list[Point]:
    """Other codes' results for ``scene`` from the file ``path``, one a line as JSON: ``scene``, ``method``,
    ``setting``, ``element_size``, ``dofs``, ``errors``, ``cpu_s``, ``process_cpu_s``, ``wall_s`` and ``peak_rss_mb``
    (see ``benchmarks/peers``).

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
        try:
            data = json.loads(line)
            if data["scene"] == scene:
                found.append(
                    Point(
                        series=f"{data['method']}, {_short(str(data['setting']))}",
                        setting=f"h = {float(data['element_size']):g} a",
                        errors={key: float(data["errors"][key]) for key in KEYS if data["errors"].get(key) is not None},
                        cpu_s=float(data["cpu_s"]),
                        process_s=float(data["process_cpu_s"]),
                        report_s=0.0,
                        wall_s=float(data["wall_s"]),
                        peak_rss_mb=float(data["peak_rss_mb"]),
                        phases={},
                        counts={"dofs": int(data["dofs"])},
                    )
                )
        except (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, RecursionError) as error:
            raise InputError(f"--peers {path}: line {number}: must be a peer's result ({error})") from None
    return found


def _short(setting: str) -> str:
    return setting.split(", growth")[0].replace(" to the ends", "").replace("surface-to-surface ", "")


def front(points: Iterable[Point]) -> list[Point]:
    """Those of ``points`` that no other one beats in CPU seconds of the process and in m and n, cheapest first."""
    best, found = np.inf, []
    for point in sorted((point for point in points if point.errors), key=lambda point: (point.process_s, point.ends)):
        if point.ends < best:
            found.append(point)
            best = point.ends
    return found


def slope(x: Sequence[float], y: Sequence[float]) -> float:
    """The exponent k of the power law ``y = C x^k`` by least squares in logarithms; NaN for fewer than two points."""
    if len(x) < 2:
        return float("nan")
    return float(np.polyfit(np.log(x), np.log(np.maximum(y, 1e-300)), 1)[0])


def slopes(points: Iterable[Point]) -> dict[str, dict[str, float]]:
    """By series of finite elements among ``points``: exponents of the errors of m, n and q against unknowns, and of CPU
    seconds."""
    by_series: dict[str, list[Point]] = {}
    for point in points:
        if "dofs" in point.counts:
            by_series.setdefault(point.series, []).append(point)
    return {
        series: {
            "m, n": slope(dofs := [point.counts["dofs"] for point in found], [point.ends for point in found]),
            "q": slope(dofs, [point.errors.get("q", np.nan) for point in found]),
            "CPU": slope(dofs, [point.cpu_s for point in found]),
        }
        for series, found in by_series.items()
    }


def against(ours: Sequence[Point], peer: Sequence[Point], key: str) -> dict[str, float]:
    """What a ``peer``'s best error in ``key`` costs here, over what it costs there (CPU of the method, and of the
    process), and the best error here at its CPU, over its own; NaN where ``ours`` never get there."""
    best = min((point for point in peer if key in point.errors), key=lambda point: point.errors[key])
    good = [point for point in ours if point.errors.get(key, np.inf) <= best.errors[key]]
    in_time = [point.errors[key] for point in ours if key in point.errors and point.cpu_s <= best.cpu_s]
    return {
        "error": best.errors[key],
        "cpu": min((point.cpu_s for point in good), default=np.nan) / best.cpu_s,
        "process": min((point.process_s for point in good), default=np.nan) / best.process_s,
        "error at its cpu": min(in_time, default=np.nan) / best.errors[key],
    }


def table(points: Sequence[Point]) -> tuple[list[str], list[list[float | str]]]:
    """Headings and rows for a CSV file: every figure of all ``points``."""
    phases = list(dict.fromkeys(phase for point in points for phase in point.phases))
    counts = list(dict.fromkeys(count for point in points for count in point.counts))
    costs = ["cpu_s", "process_s", "report_s", "wall_s", "peak_rss_mb"]
    head = ["series", "setting", *KEYS, *costs, *(f"{phase}_cpu_s" for phase in phases), *counts]
    rows: list[list[float | str]] = [
        [
            point.series,
            point.setting,
            *(point.errors.get(key, "") for key in KEYS),
            *(getattr(point, cost) for cost in costs),
            *(point.phases.get(phase, "") for phase in phases),
            *(point.counts.get(count, "") for count in counts),
        ]
        for point in points
    ]
    return head, rows


def errors_of(points: Iterable[Point], key: str) -> Array:
    """(k, 2) array: CPU seconds of the process and the error in ``key``, of those ``points`` that have one."""
    return np.array([[point.process_s, point.errors[key]] for point in points if key in point.errors]).reshape(-1, 2)
