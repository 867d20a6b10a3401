"""Badges of codes: the worst grade of each group, as SVG."""

import re
from collections.abc import Mapping
from typing import NamedTuple

from partialslip.benchmark.grade import BEYOND, LIMITS, NOT_GRADED, NOT_OFFERED
from partialslip.benchmark.measured import GROUPS
from partialslip.benchmark.problem import EDITION, Problem
from partialslip.benchmark.scoreboard import grades
from partialslip.benchmark.submission import Submission
from partialslip.output.template import template

_LETTER, _MARGIN = 6.6, 12.0  # width of a letter and of both margins of a cell; the text is fitted to its cell
_INK, _PAPER = "#ffffff", "#333333"
_FILLS = {"A": "#1a7f37", "B": "#4c7a1a", "C": "#8a6d00", "D": "#a34a00", "E": "#b3261e"}  # 4.5 : 1 to white, or more
_ORDER = (*LIMITS, BEYOND)


class _Cell(NamedTuple):
    x: float
    width: float
    fill: str
    ink: str
    text: str


def badge_name(submission: Submission) -> str:
    """Name of the badge's file."""
    plain = re.sub(r"[^A-Za-z0-9.-]+", "-", submission.meta.code).strip("-.").lower()
    return f"badge-{plain or 'code'}.svg"


def badge(problems: Mapping[str, Problem], submission: Submission) -> str:
    """Badge of a ``submission``: edition, code, how many ``problems`` it answers, and by group the worst grade of those
    that it answers. Groups without a grade are left out."""
    found = grades(problems, submission)
    texts = [(f"contact benchmark {EDITION}", _PAPER)]
    texts.append((f"{submission.meta.code}: {len(found)} of {len(problems)}", _PAPER))
    for group in GROUPS:
        marks = [each.groups[group].grade for each in found.values() if group in each.groups]
        known = [mark for mark in marks if mark not in (NOT_OFFERED, NOT_GRADED)]
        if known:
            worst = max(known, key=_ORDER.index)
            texts.append((f"{group} {worst}", _FILLS[worst]))
    cells: list[_Cell] = []
    for text, fill in texts:
        x = cells[-1].x + cells[-1].width if cells else 0.0
        cells.append(_Cell(x, round(_LETTER * len(text) + _MARGIN, 1), fill, _INK, text))
    width, title = cells[-1].x + cells[-1].width, ", ".join(text for text, _ in texts)
    return template("partialslip.benchmark", "badge.svg").render(cells=cells, width=width, title=title)
