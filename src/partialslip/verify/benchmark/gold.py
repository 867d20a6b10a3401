"""Gold files: targets of contact, stick zone and tractions with tolerances, for the regression harness of a code.

A tolerance is absolute, (limit of a grade + uncertainty of the target) x its scale.
"""

from collections.abc import Callable, Mapping
from typing import NamedTuple

from partialslip.tools.errors import InputError
from partialslip.tools.output.files import csv_text, json_text
from partialslip.verify.benchmark.grade import LIMITS
from partialslip.verify.benchmark.problem import EDITION, Problem

GROUPS = ("contact", "stick", "tractions")  # fixed: groups of the targets that gold files hold


class Gold(NamedTuple):
    """A value with its absolute ``tolerance``, in its ``unit``."""

    value: float
    tolerance: float
    unit: str


_FLOORED = (3**0.5 - 1) / 2  # fixed: |g|/t where floor and relative tolerance accept values equally far off
_ABOUT = "gold values of the benchmark of partialslip, edition {edition} (CC-BY-4.0), in SI units; grade {grade}"
_PYTEST = '''\
"""{number}, {title}: {about}.

The fixture ``found`` of your conftest.py gives what your code finds: ``found("{number}")["a"]`` is a in m.
"""

import pytest

GOLD = {{  # value and absolute tolerance
{lines}}}


@pytest.mark.parametrize("key", GOLD)
def test_{name}(key, found):
    value, tolerance = GOLD[key]
    assert found("{number}")[key] == pytest.approx(value, rel=0, abs=tolerance)
'''


def gold_files(problem: Problem, form: str, grade: str = "C") -> dict[str, str]:
    """Texts of the gold files of ``problem`` by file name, in the form "pytest", "csvdiff" or "json"; tolerances are
    those of a ``grade``, A to D. Raises InputError if there is no such form or grade."""
    if form not in FORMS:
        raise InputError(f"--for {form}: must be one of {', '.join(FORMS)}")
    if grade not in LIMITS:
        raise InputError(f"--grade {grade}: must be one of {', '.join(LIMITS)}")
    gold = {
        key: Gold(target.value, (LIMITS[grade] + target.uncertainty) * target.scale, target.unit)
        for key, target in problem.targets.items()
        if target.group in GROUPS
    }
    return FORMS[form](problem, gold, _ABOUT.format(edition=EDITION, grade=grade))


def _pytest(problem: Problem, gold: Mapping[str, Gold], about: str) -> dict[str, str]:
    name = problem.number.lower().replace("-", "_")
    lines = "".join(f'    "{key}": ({of.value!r}, {of.tolerance:.6g}),  # {of.unit}\n' for key, of in gold.items())
    text = _PYTEST.format(number=problem.number, title=problem.title, about=about, lines=lines, name=name)
    return {f"test_{name}.py": text}


def _json(problem: Problem, gold: Mapping[str, Gold], about: str) -> dict[str, str]:
    values = {key: of._asdict() for key, of in gold.items()}
    return {f"{problem.number}.json": json_text({"problem": problem.number, "about": about, "gold": values})}


def _csvdiff(problem: Problem, gold: Mapping[str, Gold], about: str) -> dict[str, str]:
    """A row of values, and the comparison file of MOOSE's CSVDiff."""
    lines = [f"# {problem.number}, {problem.title}: {about}", "GLOBAL VARIABLES relative 0 floor 0"]
    for key, of in gold.items():
        relative, floor = _relative(of)
        lines.append(f"  {key}  relative {relative:.6e} floor {floor:.6e}")
    row = csv_text([*gold], [[of.value for of in gold.values()]])
    return {f"{problem.number}.csv": row, f"{problem.number}.cmp": "\n".join(lines) + "\n"}


def _relative(of: Gold) -> tuple[float, float]:
    """Relative tolerance and floor with which CSVDiff accepts values v near the gold value g, none farther off than the
    tolerance t.

    CSVDiff takes magnitudes below the floor for zero, and compares |v - g|/max(|v|, |g|). The relative tolerance
    t/(|g| + t) accepts g + t and |g| t/(|g| + t) below; the floor t - |g| accepts |v| < t - |g|. Both accept v within
    0.27 t at |g| = 0.37 t, the worst case.
    """
    size, t = abs(of.value), of.tolerance
    return (0.0, t - size) if size < _FLOORED * t else (t / (size + t), 0.0)


FORMS: Mapping[str, Callable[[Problem, Mapping[str, Gold], str], dict[str, str]]] = {
    "pytest": _pytest,
    "csvdiff": _csvdiff,
    "json": _json,
}
