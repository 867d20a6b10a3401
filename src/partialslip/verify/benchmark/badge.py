"""Badges of codes: how many problems count, and the worst grade of each group, as SVG."""

import hashlib
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import msgspec

from partialslip.tools.output.page import template
from partialslip.verify.benchmark.problem import EDITION, Problem
from partialslip.verify.benchmark.scoreboard import standing
from partialslip.verify.benchmark.submission import Submission, check_apart

_LETTER, _MARGIN = 6.6, 12.0  # display: width of a letter and of both margins of a cell; the text is fitted to its cell
_INK, _PAPER, _NONE = "#ffffff", "#333333", "#6b6b6b"
_FILLS = {"A": "#1a7f37", "B": "#4c7a1a", "C": "#8a6d00", "D": "#a34a00", "E": "#b3261e"}  # 4.5 : 1 to white, or more
_HASHED = re.compile(r"-[0-9a-f]{8}$")


class _Cell(NamedTuple):
    x: float
    width: float
    fill: str
    ink: str
    text: str


def badge_names(submissions: Sequence[Submission]) -> list[str]:
    """Return the names of the badges' files of ``submissions``, all different.

    A name is made of ASCII letters, digits, dots and hyphens of the code's name. Where several would be alike, each has
    a checksum of code, version, settings and machine.

    Raises
    ------
    InputError
        As :func:`partialslip.verify.benchmark.submission.check_apart`.
    """
    check_apart(submissions)
    plain = [_plain(each.meta.code) for each in submissions]
    count = Counter(plain)
    return [
        f"badge-{name}-{_checksum(each)}.svg" if count[name] > 1 or _HASHED.search(name) else f"badge-{name}.svg"
        for name, each in zip(plain, submissions, strict=True)
    ]


def badge(submission: Submission, problems: Mapping[str, Problem] | None = None) -> str:
    """Return the badge of a ``submission``: edition, code, how many problems count, and the grade of each group
    (:func:`partialslip.verify.benchmark.scoreboard.standing`), over the ``problems`` or the whole edition."""
    found = standing(submission, problems)
    texts = [
        (f"contact benchmark {EDITION}", _PAPER),
        (f"{submission.meta.code}: {found.counted} of {found.of}", _PAPER),
        *((group.text, _FILLS.get(group.grade, _NONE)) for group in found.groups),
    ]
    cells: list[_Cell] = []
    for text, fill in texts:
        x = cells[-1].x + cells[-1].width if cells else 0.0
        cells.append(_Cell(x, round(_LETTER * len(text) + _MARGIN, 1), fill, _INK, text))
    width, title = cells[-1].x + cells[-1].width, ", ".join(text for text, _ in texts)
    return template("partialslip.verify.benchmark", "badge.svg").render(cells=cells, width=width, title=title)


def _plain(code: str) -> str:
    return re.sub(r"[^a-z0-9.-]+", "-", code.lower()).strip("-.") or "code"


def _checksum(submission: Submission) -> str:
    return hashlib.sha256(msgspec.json.encode(submission.meta)).hexdigest()[:8]
