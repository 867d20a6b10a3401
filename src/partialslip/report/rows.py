"""A run in words and table cells: the terminal and the page show the same ones."""

from collections.abc import Iterator, Mapping

import msgspec
import numpy as np

from partialslip.compare import Comparison
from partialslip.plan import Plan
from partialslip.result import Result
from partialslip.run import Run
from partialslip.scene import Scene

HEADINGS = ("quantity", "reference", "value", "error", "bar", "")
_MEANING = {
    "a": "a, half-width",
    "m": "m, stick from -m",
    "n": "n, stick to n",
    "p": "p, pressure",
    "q": "q, shear",
}
_STRESSES = {
    "largest": "sigma_xx, largest",
    "surface": "sigma_xx, surfaces",
    "inside": "stresses inside",
}


def headings(run: Run, name: str) -> list[str]:
    """Those of the errors of method ``name``."""
    return [{"reference": run.reference or "", "value": name}.get(heading, heading) for heading in HEADINGS]


def error_rows(run: Run, name: str) -> list[tuple[str, ...]]:
    """Quantity, the reference's value, that of method ``name``, error, bar and verdict: a, m, n, p, q and stresses."""
    reference, result, comparison = run.results[run.reference or name], run.results[name], run.comparisons[name]
    return [
        (meaning, value(reference, key), value(result, key), *verdict)
        for key, (meaning, *verdict) in zip(_compared(comparison), verdicts(comparison), strict=True)
    ]


def verdicts(comparison: Comparison) -> list[tuple[str, ...]]:
    """Quantity, error, bar and verdict: a, m, n, p, q and stresses."""
    return [
        (meaning, *_verdict(getattr(comparison, key), comparison.bars.get(key)))
        for key, meaning in _compared(comparison).items()
    ]


def _compared(comparison: Comparison) -> dict[str, str]:
    """What is compared, by its key: stresses only where they were."""
    known = {key: meaning for key, meaning in _STRESSES.items() if getattr(comparison, key) is not None}
    return _MEANING | known


def _verdict(error: float | None, bar: float | None) -> tuple[str, str, str]:
    if error is None or bar is None:
        return "-" if error is None else f"{error:.1e}", "-", ""
    return f"{error:.1e}", f"{bar:.1e}", "ok" if error <= bar else "MISSED"


def verdict(run: Run) -> str:
    """In one line, on the whole run."""
    if run.missed:
        return "missed: " + "; ".join(run.missed)
    if not run.comparisons:
        return "nothing to compare with"
    if run.judged:
        return "all bars met"
    if run.plan.missing:
        return f"no bars: forced off: {', '.join(run.plan.missing)}; the errors are what that is worth"
    reasons = {"finite bodies": run.scene.finite, "the element size was given": run.scene.fem.size is not None}
    return "no bars: " + next((why for why, applies in reasons.items() if applies), "none were asked for")


def effects(plan: Plan) -> list[tuple[str, str, str]]:
    """Whether it is called for or left out (in the first row of either), effect, and why."""
    groups = {"called for": plan.called_for, "left out": plan.left_out}
    return [
        (title if number == 0 else "", effect, why)
        for title, group in groups.items()
        for number, (effect, why) in enumerate(group.items())
    ]


def settings(scene: Scene) -> list[tuple[str, str, str]]:
    """Table (in its first row), key and setting."""
    return [
        (table if number == 0 else "", *line)
        for table, lines in _set(scene).items()
        for number, line in enumerate(lines)
    ]


def settings_of_tables(scene: Scene) -> list[tuple[str, str]]:
    """Table, and all its settings in one line."""
    return [(table, "; ".join(" ".join(line) for line in lines)) for table, lines in _set(scene).items() if lines]


def _set(scene: Scene) -> dict[str, list[tuple[str, str]]]:
    """By table, keys and settings."""
    tables = {table: keys for table, keys in msgspec.to_builtins(scene).items() if isinstance(keys, dict)}
    return {
        table: [(key, setting(choice)) for key, choice in _flat(keys) if choice is not None]
        for table, keys in tables.items()
    }


def _flat(table: Mapping[str, object], before: str = "") -> Iterator[tuple[str, object]]:
    for key, choice in table.items():
        if isinstance(choice, dict):
            yield from _flat(choice, f"{before}{key}.")
        else:
            yield before + key, choice


def methods(results: Mapping[str, Result], *, compared: bool = False) -> list[tuple[str, str, str]]:
    """Method (in its first row), and its facts; what it found is told elsewhere where it is ``compared``."""
    return [
        (name if number == 0 else "", *line)
        for name, result in results.items()
        for number, line in enumerate(facts(result, compared).items())
    ]


def value(result: Result, key: str) -> str:
    """A quantity of a result with its unit; of p and q the largest value, of fields none."""
    if key in ("surface", "inside"):
        return ""
    if key == "largest":
        return engineering(result.surface.largest[1], "Pa", 6) if result.surface else ""
    if key in ("m", "n"):
        end = getattr(result, key)
        return "none" if end is None else f"{end / result.a:.7f} a"
    if key == "a":
        return f"{result.a * 1e3:.7g} mm" if 1e-6 <= result.a < 1 else engineering(result.a, "m", 7)
    if key == "q" and result.regime == "sliding":
        return "none"
    peak = result.traction.p.max() if key == "p" else np.abs(result.traction.dq).max() / 2
    return f"max {engineering(float(peak), 'Pa', 6)}"


_LIMITS = {
    "Q_sliding": ("slides at |Q| = {}", "N/m"),
    "dsigma_transition": ("small tension ends at dsigma = {}", "Pa"),
    "Q_mean": ("the mean of Q can be {}", "N/m"),
}


def limits(result: Result) -> str:
    """Loads at which something else begins."""
    return ", ".join(
        text.format(engineering(result.limits[key], unit, 4))
        for key, (text, unit) in _LIMITS.items()
        if key in result.limits
    )


def slip(result: Result) -> str:
    """The largest slip over half a cycle, and what a cycle dissipates."""
    if result.slip is None:
        return ""
    largest = engineering(float(np.abs(result.slip.slip).max()), "m", 5)
    return f"up to {largest} each way, {engineering(result.slip.dissipated, 'J/m', 5)} dissipated a cycle"


def engineering(number: float, unit: str, digits: int) -> str:
    """A number with the SI prefix that suits it, where there is one."""
    number = float(f"{number:.12g}")  # 1 - 1e-16 is 1, not 1000 thousandths
    for exponent, prefix in ((9, "G"), (6, "M"), (3, "k"), (0, ""), (-3, "m"), (-6, "µ"), (-9, "n")):
        if 1 <= abs(number) / 10.0**exponent < 1000:
            return f"{number / 10.0**exponent:.{digits}g} {prefix}{unit}"
    return f"{number:.4g} {unit}"


def setting(choice: object) -> str:
    """A scene's setting as text."""
    if isinstance(choice, (list, tuple)):
        return ", ".join(map(setting, choice))
    if not isinstance(choice, float):
        return str(choice)
    return min(f"{choice:.10g}", np.format_float_scientific(choice, 9, trim="-", exp_digits=1), key=len)


def facts(result: Result, compared: bool = False) -> dict[str, str]:
    """What a method found (unless that is told where it is ``compared``), built and certifies, and what it cost."""
    lines = {
        "regime": result.regime,
        "found": "" if compared else ", ".join(f"{key} = {value(result, key)}" for key in ("a", "m", "n")),
        "built": work(result),
        "certificate": certificate(result),
        "limits": limits(result),
        "slip": slip(result),
        "cost": cost(result),
        "note": "; ".join(result.notes),
    }
    return {key: text for key, text in lines.items() if text}


def work(result: Result) -> str:
    """What was built and counted, but for what was not."""
    counts = ", ".join(_counted(count, name.replace("_", " ")) for name, count in result.counts.items() if count)
    settings = ", ".join(f"{name.replace('_', ' ')} {setting(choice)}" for name, choice in result.settings.items())
    return "; ".join(part for part in (settings, counts) if part)


def _power(residual: float) -> str:
    return f"{residual:.0e}" if residual else "0"


def _counted(count: int, things: str) -> str:
    if count == 1:
        things = things.removesuffix("ies") + "y" if things.endswith("ies") else things.removesuffix("s")
    return f"{count:,} {things}"


def certificate(result: Result) -> str:
    """Residuals and the method's own error estimate."""
    residuals = ", ".join(
        f"{name.replace('_', ' ')} {_power(residual)}" for name, residual in result.certificate.items()
    )
    estimate = ", ".join(f"{name} {error:.1e}" for name, error in result.estimate.items())
    return "; ".join(part for part in (residuals, f"own estimate of errors: {estimate}" if estimate else "") if part)


def cost(result: Result) -> str:
    """CPU seconds, in all and by phase, wall seconds and memory."""
    spent = result.cost
    phases = ", ".join(f"{name} {seconds:.2f}" for name, seconds in spent.phases.items())
    memory = "" if spent.peak_rss_mb is None else f", peak memory {spent.peak_rss_mb:.0f} MB"
    return f"{spent.cpu_s:.3f} CPU s{f' ({phases})' if phases else ''}, {spent.wall_s:.3f} s{memory}"
