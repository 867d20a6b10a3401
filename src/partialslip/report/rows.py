"""A run as texts and table cells, shared by terminal and page."""

import math
from collections.abc import Iterable, Iterator, Mapping

import msgspec
import numpy as np

from partialslip.report.answer import HALF_PLANES, NOT_ESTIMATED, dissipated, scale, whose, with_error
from partialslip.result import Cost, Result
from partialslip.run import Run
from partialslip.run.judge import BARS, NO_BAR, Comparison, Outcome, Verdict
from partialslip.run.judge.reference import error_of
from partialslip.scene import Scene
from partialslip.scene.dimensions import dimension
from partialslip.scene.plan import Plan
from partialslip.scene.plausible import implausible as implausible
from partialslip.scene.reading import scene_tables
from partialslip.scene.units import SI, Dimension, Units
from partialslip.tools.groups import grouped
from partialslip.tools.methods import METHODS

HEADINGS = ("quantity", "unit", "reference", "value", "error", "estimate", "bar", "")
_MEANING = {
    "a": "a, half-width",
    "left": "left end",
    "right": "right end",
    "m": "m, stick zone",
    "n": "n, stick zone",
    "P": "P, sum of p",
    "M": "M, moment of p",
    "p": "p, pressure",
    "p_max": "p_max, largest p",
    "p_least": "p, tension",
    "dQ": "dQ, sum of dq",
    "q": "q, shear",
    "q_max": "q, largest",
    "largest": "sigma_xx, largest",
    "surface": "sigma_xx, surfaces",
    "inside": "stresses inside",
} | {
    f"{key}_{point}": f"{text}, point {point}"
    for key, text in {"left": "left end", "right": "right end", "P": "P", "M": "M", "p": "p"}.items()
    for point in (1, 2)
}  # fmt: skip
_IN_A = ("fem.accuracy", "fem.size", "fem.width")  # settings in contact half-widths
_WORDS = {Outcome.PASSED: "ok", Outcome.MISSED: "MISSED", Outcome.NOT_JUDGED: "not judged"}
_SLIDES = "the contact slides as a whole, so there is no stick zone to compare"
_EVEN = 1e-4  # display: of a: a contact whose middle is nearer to x = 0 is even, to the error of elements
_DIGITS, _MOST = 7, 10  # display: decimals of values: the usual number, and the largest if the error is smaller


def beside_half_planes(run: Run, name: str) -> bool:
    """Return whether method ``name`` of ``run`` stands beside half-planes in the place of finite bodies: then it is
    half-planes that are off."""
    return run.scene.sized and run.reference in HALF_PLANES and name not in HALF_PLANES


def shown_half_planes(run: Run) -> bool:
    """Return whether any method of ``run`` stands :func:`beside_half_planes`."""
    return any(beside_half_planes(run, name) for name in run.comparisons)


def scored(run: Run) -> bool:
    """Return whether ``run`` compares results of another code."""
    return any(result.method not in METHODS for result in run.results.values())


def error_headings(run: Run, name: str) -> list[str]:
    """Return the headings of the table of :func:`error_rows` for method ``name`` of ``run``."""
    named = {"reference": run.reference or "", "value": name}
    if beside_half_planes(run, name):
        named |= {"reference": "half-planes", "error": "difference"}
    return [named.get(heading, heading) for heading in HEADINGS]


def error_title(run: Run, name: str) -> str:
    """Return the title of the table of :func:`error_rows` for method ``name`` of ``run``."""
    return f"What half-planes are off by, beside {name}" if beside_half_planes(run, name) else f"Errors of {name}"


def error_rows(comparison: Comparison, *, every: bool = False) -> list[tuple[str, ...]]:
    """Return rows of quantity, unit, reference's value, method's value, error, error estimate, bar and verdict.

    The error is \\|value - reference\\|; norms have no values. Quantities without values and error are left out; so
    are, unless ``every`` one is asked for, those that say nothing more than others (:func:`_telling`).
    """
    shown = [each for each in comparison.verdicts if each.quantity != "regime" and each.known]
    shown = shown if every else _telling(shown)
    return [(_MEANING.get(each.quantity, each.quantity), *verdict_numbers(each), word(each)) for each in shown]


def _telling(verdicts: list[Verdict]) -> list[Verdict]:
    """Return the ``verdicts`` that say something: all missed ones; the ends of the contact only where its middle is off
    x = 0; shear at the load points only where its errors are not those of q; no quantity without a bar where others
    have bars."""
    known = {verdict.quantity: verdict for verdict in verdicts}
    left, right = (known[key].reference if key in known else None for key in ("left", "right"))
    told = set()
    if isinstance(left, float) and isinstance(right, float) and abs(left + right) <= _EVEN:
        told |= {"left", "right"}
    if "q" in known:
        told |= {
            key for key in ("q1", "q2") if key in known and verdict_numbers(known[key]) == verdict_numbers(known["q"])
        }
    if any(verdict.bar is not None for verdict in verdicts):
        told |= {verdict.quantity for verdict in verdicts if verdict.reason == NO_BAR or verdict.quantity not in BARS}
    return [each for each in verdicts if each.quantity not in told or each.outcome is Outcome.MISSED]


def verdict_numbers(verdict: Verdict) -> tuple[str, ...]:
    """Return unit, reference's value, method's value, error, estimate and bar of ``verdict`` as texts."""
    error = verdict.error or 0.0
    digits = max(_DIGITS, math.ceil(-math.log10(error)) + 1) if 10.0**-_MOST < error < math.inf else _DIGITS
    values = (
        "" if each is None else each if isinstance(each, str) else f"{each:.{digits}f}"
        for each in (verdict.reference, verdict.found)
    )
    figures = ("" if each is None else f"{each:.1e}" for each in (verdict.error, verdict.estimate, verdict.bar))
    return verdict.scale, *values, *figures


def word(verdict: Verdict) -> str:
    """Return the verdict in a word: ok, MISSED, no bar or not judged."""
    return "no bar" if verdict.outcome is Outcome.NOT_JUDGED and verdict.reason == NO_BAR else _WORDS[verdict.outcome]


def units(run: Run) -> str:
    """Return the units of the error tables in one line: f p0 and P, and a and p0 if the answer shows others."""
    reference, scene, text = run.results[run.reference or ""], run.scene, run.scene.units.text
    own = run.results[run.answering]
    above = f" (m, n above: in a of {own.method})" if own.m is not None and own.steady else ""
    parts = {
        "a": scene.units.length(reference.a) + above if run.reference != run.answering else "",
        "p0": text(reference.p0, "Pa", 6) if run.reference != run.answering else "",
        "f p0": text(scene.friction.f * reference.p0, "Pa", 6) if scene.friction.f else "",
        "P": text(scene.P, "N/m", 6),
    }
    return f"{whose(run, run.reference or '')}: " + ", ".join(f"{key} = {size}" for key, size in parts.items() if size)


def unjudged(comparison: Comparison) -> list[str]:
    """Return quantities that usually have a bar, but are not judged, one line per reason: those that exist, and those
    that the outcome calls for."""
    reasons = grouped(
        (verdict.reason, verdict.quantity)
        for verdict in comparison.verdicts
        if verdict.outcome is Outcome.NOT_JUDGED and verdict.reason != NO_BAR
        if verdict.quantity in comparison.unjudged
        or (verdict.known and (verdict.quantity in BARS or verdict.quantity == "regime"))
    )
    return [f"not judged: {', '.join(quantities)}: {reason}" for reason, quantities in reasons.items()]


def verdict(run: Run) -> str:
    """Return the verdict on the whole ``run`` in one line, with what was asked for."""
    return "; ".join(reversed(verdict_lines(run)))


def verdict_lines(run: Run) -> tuple[str, ...]:
    """Return the verdict on the whole ``run`` as the last of one or two lines; the first of two says what was asked."""
    found = run.conclusion
    if found.asked or found.outcome is Outcome.MISSED:
        wanted = run.asked.text if run.asked else ""
        nothing = next((each.regime for each in run.results.values() if each.m is None), "")
        if found.outcome is Outcome.PASSED:
            return (", ".join(filter(None, [found.text, nothing])) + f": {wanted}{_larger_estimates(run)}",)
        return (f"asked: {wanted}", found.text) if wanted else (found.text,)
    if run.plan.missing:
        return (f"{found.text}: forced off: {', '.join(run.plan.missing)}; the errors measure these effects",)
    scene = run.scene
    reasons = {
        "finite bodies": scene.sized,
        "unlike bodies": not scene.material.alike,
        _SLIDES: not run.comparisons and run[run.answering].regime == "sliding",
        "nothing to compare with": not run.comparisons,
        "the element size was given": scene.fem.size is not None,
    }
    return (f"{found.text}: " + next((why for why, applies in reasons.items() if applies), "none were asked for"),)


def _larger_estimates(run: Run) -> str:
    """Return of which errors, all within their bars, the methods' own estimates are not, as text; empty if none."""
    larger = grouped(
        (verdict.quantity, name)
        for name, comparison in run.comparisons.items()
        for verdict in comparison.verdicts
        if verdict.outcome is Outcome.PASSED and verdict.bar is not None and (verdict.estimate or 0.0) > verdict.bar
    )
    if not larger:
        return ""
    what, whose = ("estimate", "its bar") if len(larger) == 1 else ("estimates", "their bars")
    return f"; {what} of {', '.join(larger)} above {whose}"


def effects(plan: Plan) -> list[tuple[str, str, str]]:
    """Return rows of "called for" or "left out" (in the first row of each group), effect, and reason."""
    return _titled({"called for": plan.called_for.items(), "left out": plan.left_out.items()})


def settings(scene: Scene) -> list[tuple[str, str, str]]:
    """Return rows of table (in the first row of each table), key and setting of ``scene``, in its units."""
    return _titled(_set(scene))


def _titled(groups: Mapping[str, Iterable[tuple[str, str]]]) -> list[tuple[str, str, str]]:
    """Return the rows of ``groups`` by title, with the title in the first row of each."""
    return [(title if number == 0 else "", *row) for title, rows in groups.items() for number, row in enumerate(rows)]


def settings_of_tables(scene: Scene) -> list[tuple[str, str]]:
    """Return pairs of table and its settings in one line."""
    return [(table, "; ".join(" ".join(line) for line in lines)) for table, lines in _set(scene).items() if lines]


def _set(scene: Scene) -> dict[str, list[tuple[str, str]]]:
    """Return pairs of key and setting by table."""
    tables = {table: keys for table, keys in scene_tables(scene).items() if isinstance(keys, dict)}
    return {
        table: [
            (key, _with_unit(f"{table}.{key}", choice, scene.units))
            for key, choice in _flat(keys)
            if choice is not None
        ]
        for table, keys in tables.items()
    }


def _with_unit(path: str, choice: object, units: Units) -> str:
    """Return a setting as text, numbers with their unit."""
    unit = "a" if path in _IN_A else units.label(dimension(path))
    return setting(choice) + (f" {unit}" if unit and not isinstance(choice, str) else "")


def _flat(table: Mapping[str, object], before: str = "") -> Iterator[tuple[str, object]]:
    for key, choice in table.items():
        if isinstance(choice, dict):
            yield from _flat(choice, f"{before}{key}.")
        else:
            yield before + key, choice


def methods(results: Mapping[str, Result], *, compared: bool = False, units: Units = SI) -> list[tuple[str, str, str]]:
    """Return rows of method (in the first row of each method), and a key and text of :func:`facts`, in ``units``.

    With ``compared`` the values found are left out: the table of errors shows them.
    """
    return _titled({name: facts(result, compared, units).items() for name, result in results.items()})


def methods_in_short(results: Mapping[str, Result]) -> list[tuple[str, str]]:
    """Return pairs of method, and regime, CPU seconds and size in one line."""
    return [(name, ", ".join([result.regime, *_spent(result)])) for name, result in results.items()]


def _spent(result: Result) -> list[str]:
    """Return CPU seconds, and unknowns or cells, as texts."""
    counts = [_counted(result.counts[key], key) for key in ("dofs", "cells") if result.counts.get(key)]
    seconds = result.cost.cpu_s
    return [f"{seconds:.3f} CPU s" if seconds < 0.1 else f"{seconds:.1f} CPU s", *counts]


def run_notes(run: Run) -> list[str]:
    """Return why effects were forced off, and the notes of all methods; a note that several methods share once."""
    forced_off = [(run.plan.left_out[effect], str(effect)) for effect in run.plan.missing]
    by_note = grouped([*forced_off, *((note, name) for name, result in run.results.items() for note in result.notes)])
    return [f"{', '.join(names)}: {note}" for note, names in by_note.items()]


def value(result: Result, key: str, units: Units = SI) -> str:
    """Return a, m or n (``key``) of ``result`` with the unit; a in ``units``, few digits of a stick zone whose error is
    not estimated, "none" where there is no steady state."""
    if key == "a":
        return units.length(result.a)
    end = getattr(result, key) if result.steady else None
    if end is None or math.isfinite(error_of(result, key, result.method)):
        return "none" if end is None else f"{end / result.a:.7f} a"
    return with_error(end / result.a, math.nan) + f" a{NOT_ESTIMATED}"


def found(result: Result, units: Units = SI) -> str:
    """Return a, m and n of ``result`` as text."""
    return ", ".join(f"{key} = {value(result, key, units)}" for key in ("a", "m", "n"))


_LIMITS: dict[str, tuple[str, Dimension]] = {
    "Q_sliding": ("slides at |Q| = {}", "N/m"),
    "dsigma_transition": ("small tension ends at dsigma = {}", "Pa"),
    "Q_mean": ("the mean of Q can be {}", "N/m"),
}


def limits(result: Result, units: Units = SI) -> str:
    """Return the loads at which the regime changes, in ``units``, as text."""
    texts = [
        text.format(units.text(result.limits[key], of, 4))
        for key, (text, of) in _LIMITS.items()
        if key in result.limits
    ]
    if "Q_mean_least" in result.limits:
        least, most = (units.text(result.limits[f"Q_mean_{key}"], "N/m", 4) for key in ("least", "most"))
        texts.append(f"the mean of Q can be from {least} to {most}")
    return ", ".join(texts)


def end_slips_text(result: Result) -> str:
    """Return how the ends of the contact slip from load point 1 to 2, as text; empty under constant pressure."""
    if result.end_slips is None:
        return ""
    words = {"never": "never slips", "part of the cycle": "slips during part of the cycle"}
    slips = zip(("left", "right"), result.end_slips, strict=True)
    return ", ".join(f"the {side} end {words.get(how, f'slips {how}')}" for side, how in slips)


def slip_text(result: Result, units: Units = SI) -> str:
    """Return the largest slip over half a cycle and the energy dissipated in a cycle, in ``units``, as text."""
    if result.slip is None:
        return ""
    largest = units.text(float(np.abs(result.slip.slip).max()), "m", 5)
    exponent, label = scale(result.slip.dissipated, "J/m", units)
    words = f"{label} dissipated a cycle"
    return f"up to {largest} each way, {dissipated(result.slip, exponent, words)}"


def setting(choice: object) -> str:
    """Return a setting of a scene as text."""
    if isinstance(choice, (list, tuple)):
        return ", ".join(map(setting, choice))
    if not isinstance(choice, float):
        return str(choice)
    return min(f"{choice:.10g}", np.format_float_scientific(choice, 9, trim="-", exp_digits=1), key=len)


def facts(result: Result, compared: bool = False, units: Units = SI) -> dict[str, str]:
    """Return what a method found, built and certified, and the cost, as texts by key, in ``units``.

    With ``compared`` the values found are left out: the table of errors shows them.
    """
    lines = {
        "regime": result.regime,
        "found": "" if compared else found(result, units),
        "built": work(result),
        "certificate": certificate_text(result),
        "ends": end_slips_text(result),
        "limits": limits(result, units),
        "slip": slip_text(result, units),
        "cost": cost(result),
        "note": "; ".join(result.notes),
    }
    return {key: text for key, text in lines.items() if text}


def work(result: Result) -> str:
    """Return settings and non-zero counts of ``result`` as text."""
    counts = ", ".join(_counted(count, name.replace("_", " ")) for name, count in result.counts.items() if count)
    settings = ", ".join(f"{name.replace('_', ' ')} {setting(choice)}" for name, choice in result.settings.items())
    return "; ".join(part for part in (settings, counts) if part)


def _power(residual: float) -> str:
    return f"{residual:.0e}" if residual else "0"


def _counted(count: int, things: str) -> str:
    if count == 1:
        things = things.removesuffix("ies") + "y" if things.endswith("ies") else things.removesuffix("s")
    return f"{count:,} {things}"


def certificate_text(result: Result) -> str:
    """Return residuals, change of q in the last cycle and error estimates of ``result`` as text."""
    residuals = ", ".join(
        f"{name.replace('_', ' ')} {_power(residual)}" for name, residual in result.certificate.items()
    )
    change = result.last_cycle_change
    estimate = ", ".join(f"{name} {error:.1e}" for name, error in result.estimate.items())
    told = "" if change is None else f"q changed by {_power(change)} f p0 in the last cycle"
    parts = (residuals, told, f"own estimate of errors: {estimate}" if estimate else "")
    return "; ".join(part for part in parts if part)


def cost(result: Result) -> str:
    """Return CPU seconds (total and by phase), wall seconds and memory of ``result`` as text."""
    spent = result.cost
    phases = ", ".join(f"{name} {seconds:.2f}" for name, seconds in spent.phases.items())
    return f"{spent.cpu_s:.3f} CPU s{f' ({phases})' if phases else ''}, {spent.wall_s:.3f} s wall time{_memory(spent)}"


def _memory(spent: Cost) -> str:
    if spent.peak_rss_mb is None:
        return f", peak memory not known: {spent.peak_rss_unknown}" if spent.peak_rss_unknown else ""
    before = "" if spent.start_rss_mb is None else f" ({spent.start_rss_mb:.0f} MB before the method)"
    return f", peak memory {spent.peak_rss_mb:.0f} MB{before}"


class Sheet(msgspec.Struct, frozen=True):
    """Texts of tables: ``title``, ``settings`` and ``effects`` of a scene, and facts about the ``methods``."""

    title: str
    settings: tuple[tuple[str, str], ...]
    effects: tuple[tuple[str, str, str], ...]
    methods: tuple[tuple[str, str, str], ...]


def sheet(run: Run) -> Sheet:
    """Return the sheet of ``run``."""
    return Sheet(
        run.scene.title,
        tuple(settings_of_tables(run.scene)),
        tuple(effects(run.plan)),
        tuple(methods(run.results, compared=True, units=run.scene.units)),
    )
