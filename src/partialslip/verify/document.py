"""The verification report: one self-contained page with all verdicts and their distances from the bars."""

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from msgspec.structs import replace

from partialslip.report import rows
from partialslip.run.judge import P_BAR, Q_BAR, Outcome
from partialslip.tools.bars import CERTIFICATE_BAR
from partialslip.tools.errors import InputError
from partialslip.tools.groups import grouped
from partialslip.tools.inputfile import read_text
from partialslip.tools.origin import origin_lines
from partialslip.tools.output.files import files_in
from partialslip.tools.output.page import render_page
from partialslip.tools.output.svg import svg
from partialslip.verify.case import REQUIREMENTS, CaseVerdict, number_of, requirement_of
from partialslip.verify.entry import Entry, Settings
from partialslip.verify.formulas import PUBLICATIONS
from partialslip.verify.ladder import SIZES, Convergence
from partialslip.verify.verdicts import Verdicts, bar_left, every_one, missed, nearest

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SCOPE = {
    "quick": "The shipped scenes: two half-planes of one material, pressed together and loaded by shear and bulk "
    "tension in phase. Each scene is solved by every method.",
    "full": "The shipped scenes and the catalogue of hard cases: scenes on which contact codes may fail. Each scene is "
    "solved by the methods that it names.",
    "book": "The numbered problems of the benchmark. Each is solved by the methods that its targets come from.",
    "stress": "Random scenes of one method. Each can be made again from its number.",
}
_LARGEST = 10**8  # limit: bytes of a figure
_LEAST = 1e-18  # display: smallest certificate in the figure, drawn for a residual of 0


class Study(NamedTuple):
    """Files of a study: ``figures``, SVG text by file name, and ``tables``, file names, in ``folder``."""

    folder: Path
    figures: dict[str, str]
    tables: list[str]


@dataclass(frozen=True)
class Account:
    """Content of the report.

    Parameters
    ----------
    settings : Settings
        Settings of the verification.
    entries : mapping of str to Entry
        Entries of the ledger by case.
    figures : mapping of str to str
        Traction plots by case, SVG.
    sketches : mapping of str to str
        Sketches by case, SVG.
    studies : sequence of Study
    """

    settings: Settings
    entries: Mapping[str, Entry]
    figures: Mapping[str, str]
    sketches: Mapping[str, str]
    studies: Sequence[Study] = ()

    @property
    def verdicts(self) -> dict[str, list[CaseVerdict]]:
        """Verdicts by case."""
        return {case: list(entry.verdicts) for case, entry in self.entries.items()}


def read_study(folder: Path) -> Study:
    """Read the figures written by ``partialslip study`` into ``folder``. Raises InputError if there are none."""
    try:
        figures = {path.name: read_text(path, _LARGEST) for path in files_in(folder, "*.svg")}
    except InputError:
        raise InputError(f"--include {folder}: figures (.svg) cannot be read as UTF-8 text") from None
    if not figures or any("<svg" not in figure for figure in figures.values()):
        raise InputError(f"--include {folder}: must be the folder of a study, with figures (.svg)")
    return Study(folder, figures, [path.name for path in files_in(folder, "*.csv")])


def document(account: Account) -> str:
    """Return the report on ``account`` as HTML."""
    settings, verdicts = account.settings, account.verdicts
    listed, stress = every_one(verdicts), account.settings.suite == "stress"
    made = [entry.made for entry in account.entries.values() if entry.made]
    return render_page(
        "partialslip.verify",
        "document.html",
        title=_title(settings),
        verdict=_headline(listed),
        origin=[*settings.block.given.items(), ("command", command(settings, settings.only)), *origin_lines(made)],
        scope=SCOPE[settings.suite],
        references=PUBLICATIONS,
        sizes=SIZES,
        account=account,
        verdicts=verdicts,
        again={case: command(settings, [case.rpartition("-")[2] if stress else case]) for case in verdicts},
        stress=stress,
        count=f"{len(listed):,}",
        missed=list(filter(missed, listed)),
        summary=_summary(verdicts),
        requirements=_requirements(listed),
        usual={"certificate": CERTIFICATE_BAR, "p": P_BAR, "q": Q_BAR},
        closest=[_close(verdict) for verdict in sorted(nearest(verdicts), key=bar_left)],
        found={case: list(map(_found, some)) for case, some in verdicts.items()},
        reasons={case: _reasons(some) for case, some in verdicts.items()},
        estimates=_estimates(listed),
        ladders=_ladders(account.entries),
        climbed={case: list(map(_converged, entry.ladder)) for case, entry in account.entries.items()},
        kinds=_kinds(account) if stress else [],
        spread=_certificate_histogram(listed) if stress else None,
    )


def _title(settings: Settings) -> str:
    parts = [f"{key} {value}" for key, value in settings.asked.items()]
    return ", ".join(["Verification of partialslip", *parts, *(["in part"] if settings.only else [])])


def command(settings: Settings, only: Sequence[str]) -> str:
    """Return the command that repeats a verification with ``settings``, limited to the cases ``only`` if any."""
    words = [f"--{key} {value}" for key, value in replace(settings, only=tuple(only)).asked.items()]
    words += [f"--only {shlex.quote(name)}" for name in only]
    words += ["--ladder"] if settings.ladder else []
    return " ".join(["partialslip verify", *words])


def _headline(verdicts: Sequence[CaseVerdict]) -> str:
    """Return the number of missed verdicts, or else of passed and not judged verdicts, as text."""
    counts = {outcome: sum(verdict.outcome is outcome for verdict in verdicts) for outcome in Outcome}
    if counts[Outcome.MISSED]:
        return f"{counts[Outcome.MISSED]:,} of {len(verdicts):,} verdicts missed"
    unjudged = f", {counts[Outcome.NOT_JUDGED]:,} not judged" if counts[Outcome.NOT_JUDGED] else ""
    return f"{counts[Outcome.PASSED]:,} verdicts passed, none missed{unjudged}"


def _summary(verdicts: Verdicts) -> list[tuple[str, ...]]:
    """Return rows by method, and a total: cases, verdicts, missed, not judged, CPU seconds."""
    closest, listed = nearest(verdicts), every_one(verdicts)
    table: list[tuple[str, ...]] = []
    for method in (*dict.fromkeys(verdict.method for verdict in closest), None):
        some = [verdict for verdict in listed if method in (None, verdict.method)]
        cpu_s = sum(verdict.cpu_s for verdict in closest if method in (None, verdict.method))
        unjudged = sum(verdict.outcome is Outcome.NOT_JUDGED for verdict in some)
        counts = len({verdict.case for verdict in some}), len(some), sum(map(missed, some)), unjudged
        table.append((method or "in all", *(f"{count:,}" for count in counts), f"{cpu_s:.1f}", ""))
    return table


def _requirements(verdicts: Sequence[CaseVerdict]) -> list[tuple[str, ...]]:
    """Return rows of number, requirement, verdicts, missed, largest share of a bar, and case and method."""
    table: list[tuple[str, ...]] = []
    for key, text in REQUIREMENTS.items():
        some = [
            each for each in verdicts if requirement_of(each.quantity) == key and each.outcome is not Outcome.NOT_JUDGED
        ]
        worst = min(some, key=bar_left, default=None)
        told = worst is not None and (worst.share is not None or missed(worst))
        where = f"{worst.case}, {worst.method}" if worst and told else ""
        share = _share(worst) if worst else ""
        table.append((number_of(key), text, f"{len(some):,}", f"{sum(map(missed, some)):,}", share, where))
    return table


def _estimates(verdicts: Sequence[CaseVerdict]) -> list[tuple[str, ...]]:
    """Return rows of requirement, check, number of estimates, ratio of true error to estimate (median, largest), number
    of errors above the estimate, and where the ratio is largest."""
    groups = grouped(
        (f"{verdict.method}.{verdict.quantity}", verdict)
        for verdict in verdicts
        if verdict.estimate and verdict.error is not None
    )
    table: list[tuple[str, ...]] = []
    for check, some in sorted(groups.items(), key=lambda group: number_of(group[1][0].quantity)):
        ratios = np.array([(each.error or 0.0) / (each.estimate or 1.0) for each in some])
        counts = f"{len(some):,}", f"{np.median(ratios):.2f}", f"{ratios.max():.2f}", f"{(ratios > 1).sum():,}"
        table.append((number_of(some[0].quantity), check, *counts, some[int(ratios.argmax())].case))
    return table


def _converged(found: Convergence) -> tuple[str, ...]:
    """Return a row of requirement, quantity, changes, observed order, GCI, true error and its share of the GCI."""
    share = "" if found.error is None or not found.gci else f"{100 * found.error / found.gci:.0f} %"
    order = "" if found.order is None else f"{found.order:.2f}"
    numbers = *map(_error_text, found.changes), order, _error_text(found.gci), _error_text(found.error), share
    return number_of(found.quantity), found.quantity, *numbers


def _ladders(entries: Mapping[str, Entry]) -> list[tuple[str, ...]]:
    """Return rows by requirement: ladders, observed order (least, median, largest), largest GCI, errors within it."""
    groups = grouped((found.quantity, found) for entry in entries.values() for found in entry.ladder)
    table: list[tuple[str, ...]] = []
    for quantity, some in groups.items():
        orders = [each.order for each in some if each.order is not None]
        spread = [f"{value:.2f}" for value in (min(orders), np.median(orders), max(orders))] if orders else ["", "", ""]
        known = [each for each in some if each.error is not None]
        within = sum((each.error or 0.0) <= each.gci for each in known)
        largest = _error_text(max(each.gci for each in some))
        table.append((number_of(quantity), quantity, f"{len(some):,}", *spread, largest, f"{within} of {len(known)}"))
    return table


def _close(verdict: CaseVerdict) -> tuple[str, ...]:
    """Return a row of case, requirement, check, error, bar, share of the bar, CPU seconds and verdict."""
    numbers = _error_text(verdict.error), _error_text(verdict.bar), _share(verdict), f"{verdict.cpu_s:.2f}"
    return (
        verdict.case,
        number_of(verdict.quantity),
        f"{verdict.method}.{verdict.quantity}",
        *numbers,
        rows.word(verdict),
    )


def _found(verdict: CaseVerdict) -> tuple[str, ...]:
    """Return a row of requirement, check, unit, exact value, value, error or residual, bar, share and verdict."""
    unit, *pair = rows.verdict_numbers(verdict)[:3]
    numbers = _error_text(verdict.error), _error_text(verdict.bar), _share(verdict)
    check = f"{verdict.method}.{verdict.quantity}"
    return number_of(verdict.quantity), check, unit, *pair, *numbers, rows.word(verdict)


def _reasons(verdicts: Sequence[CaseVerdict]) -> list[str]:
    """Return the reasons for unusual bars and for missed or unjudged quantities, each reason once."""
    reasons = grouped((each.reason, f"{each.method}.{each.quantity}") for each in verdicts if each.reason)
    return [f"{', '.join(checks)}: {reason}." for reason, checks in reasons.items()]


def _error_text(value: float | None) -> str:
    return "" if value is None else f"{value:.1e}" if value else "0"


def _share(verdict: CaseVerdict) -> str:
    if verdict.share is None:
        return ""
    return "< 0.1 %" if verdict.share < 1e-3 else f"{100 * verdict.share:.1f} %"


def _kinds(account: Account) -> list[tuple[str, ...]]:
    """Return rows by kind of loads: number of certificates, median, largest, and case of the largest."""
    groups = grouped((account.entries[case].hard, verdicts) for case, verdicts in account.verdicts.items())
    table: list[tuple[str, ...]] = []
    for kind, of_kind in groups.items():
        some = [verdict for verdicts in of_kind for verdict in _certificates(verdicts)]
        values = [verdict.error or 0.0 for verdict in some]
        worst = max(some, key=lambda verdict: verdict.error or 0.0, default=None)
        figures = (f"{np.median(values):.1e}", f"{max(values):.1e}", worst.case) if worst else ("", "", "")
        table.append((kind, f"{len(some):,}", *figures))
    return table


def _certificate_histogram(verdicts: Sequence[CaseVerdict]) -> str | None:
    """Return a histogram of the certificates as SVG; None without certificates."""
    some = _certificates(verdicts)
    if not some:
        return None
    tens = np.log10([max(verdict.error or 0.0, _LEAST) for verdict in some])
    bar = np.log10(some[0].bar or np.nan)

    def draw(figure: "Figure") -> None:
        axes = figure.subplots()
        bins = np.arange(np.floor(tens.min()), max(np.ceil(tens.max()), bar) + 1, 0.5)
        axes.hist(tens, bins.tolist(), color="0.75", edgecolor="black", lw=0.6)
        axes.axvline(bar, color="black", lw=1.4, ls="--", label="bar")
        axes.set(xlabel="log10 of the certificate", ylabel="scenes", yscale="log")
        axes.legend(frameon=False)

    return svg(draw, (7.4, 3.2))


def _certificates(verdicts: Sequence[CaseVerdict]) -> list[CaseVerdict]:
    return [verdict for verdict in verdicts if verdict.quantity == "certificate" and verdict.error is not None]
