"""Cases and requirements of the verification.

A case is a scene, methods and bars. A verdict compares one quantity of one method with a bar, and belongs to one of the
requirements R1 to R10.
"""

import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from partialslip.result import RATCHETS, Result
from partialslip.run import run
from partialslip.run.judge import (
    ESTIMATE,
    NO_BAR,
    Bar,
    Conclusion,
    Outcome,
    Verdict,
    compare,
    conclude,
    conditions,
    estimate_verdicts,
    together,
)
from partialslip.run.judge.reference import reference as reference_of
from partialslip.run.judge.reference import reference_among
from partialslip.scene import Scene
from partialslip.scene.plan import plan
from partialslip.tools.bars import BARS
from partialslip.tools.groups import grouped
from partialslip_meshes.mesh import Mesh

Meshes = Callable[[Scene], Sequence[Mesh]]

REQUIREMENTS = {
    "finishes": "the method ends with a result, without an error",
    "finite": "no value is NaN or infinite",
    "certificate": "every residual of the method is at most the bar, in f p0 or f P",
    "regime": "the regime equals the exact solution's",
    "a": "half-width and ends of the contact differ from the exact values by at most the bar, in a",
    "m": "the left end of the stick zone differs from the exact value by at most the bar, in a",
    "n": "the right end of the stick zone differs from the exact value by at most the bar, in a",
    "p": "cell averages of p differ from the exact ones by at most the bar, relative L2; so does the resultant from P",
    "q": "cell averages of q differ from the exact ones by at most the bar, relative L2; so does the resultant of dq "
    "from dQ, in 2 f P",
    "estimate": "errors of a, m, n, p and q are at most twice the method's own estimates of them, or a "
    "hundredth of the bar",
}
_PART_OF = {
    **dict.fromkeys(("left", "right", "left_1", "right_1", "left_2", "right_2"), "a"),
    **dict.fromkeys(("P", "P_1", "M", "M_1", "p_1", "p_least"), "p"),
    **dict.fromkeys(("dQ", "q1", "q2"), "q"),
}
_CONDITIONS = ("finishes", "finite", "certificate", "estimate")
_BAR = Bar(1.0)  # stands for the usual bar


class Failure(NamedTuple):
    """Failure of a method: message of the ``error``, and CPU seconds until the error, ``cpu_s``."""

    error: str
    cpu_s: float


Found = Mapping[str, Result | Failure]


@dataclass(frozen=True)
class Case:
    """A scene to verify.

    Parameters
    ----------
    name : str
    scene : Scene
    methods : sequence of str
        Of "exact", "march", "fem" and "equivalent".
    bars : mapping of str to Bar
        Unusual bars by method and quantity, for example ``"fem.q"``. Usual bars: the accuracy of the scene, ten times
        the accuracy for p, fifteen times the accuracy for q.
    reference : str
        Method with which the others are compared: "exact", "march" where there is no closed form, or "": only
        certificates are judged.
    meshes : callable, optional
        ``meshes(scene)``: given meshes for the finite elements (see :func:`partialslip_fem.method.solve_meshed`).
        There are then no usual bars.
    hard : str
        Why the scene is hard, and how other codes may fail.
    """

    name: str
    scene: Scene
    methods: Sequence[str] = ("exact", "march", "fem")
    bars: Mapping[str, Bar] = field(default_factory=dict)
    reference: str = "exact"
    meshes: Meshes | None = None
    hard: str = ""


@dataclass(frozen=True, kw_only=True)
class CaseVerdict(Verdict):
    """The verdict on one quantity of one method in one case.

    Parameters
    ----------
    case, method : str
    requirement : str
        Number and text of the requirement.
    iterations : int
        Linear solves of the active-set iteration, total of the method.
    cpu_s : float
        CPU seconds, total of the method.
    waived : bool
        Whether the quantity need not be judged: there is no bar for it, the result says that it does not hold, no
        solution of the scene is known to hold, or there is no steady state.
    """

    case: str
    method: str
    requirement: str
    iterations: int = 0
    cpu_s: float = 0.0
    waived: bool = False


def requirement_of(quantity: str) -> str:
    """Return the key in :data:`REQUIREMENTS` of the requirement on ``quantity``."""
    return "estimate" if quantity.startswith(ESTIMATE) else _PART_OF.get(quantity, quantity)


def number_of(quantity: str) -> str:
    """Return the number of the requirement on ``quantity``, R1 to R10."""
    return f"R{list(REQUIREMENTS).index(requirement_of(quantity)) + 1}"


def run_case(case: Case) -> list[CaseVerdict]:
    """Solve ``case`` by each method and judge the results; a failure of a method is a missed verdict."""
    return judge_case(case, solve_case(case))


def solve_case(case: Case) -> Found:
    """Return result or failure of each method of ``case``; the reference comes first."""
    needed = [case.reference] if case.reference else []
    return {method: _result_or_failure(case, method) for method in dict.fromkeys([*needed, *case.methods])}


def judge_case(case: Case, found: Found) -> list[CaseVerdict]:
    """Return the verdicts on the results ``found`` for ``case``.

    If the reference fails, the failure is a missed verdict.
    """
    lost = [case.reference] if case.reference and isinstance(found[case.reference], Failure) else []
    results = {method: result for method, result in found.items() if isinstance(result, Result)}
    judging = reference_among(case.scene, results) if case.reference and not lost else None
    unknown = reference_of(case.scene).unknown
    verdicts = []
    for method in dict.fromkeys([*lost, *case.methods]):
        result = found[method]
        if isinstance(result, Failure):
            each: Iterator[Verdict] = iter([Verdict("finishes", Outcome.MISSED, reason=result.error)])
            iterations, cpu_s, waived = 0, result.cpu_s, False
        else:
            waived = result.path_dependent
            each = _judged(case, method, result, results[judging] if judging and method != judging else None)
            iterations, cpu_s = result.counts.get("iterations", 0), result.cost.cpu_s
        verdicts += [
            CaseVerdict(
                **vars(verdict),
                case=case.name,
                method=method,
                requirement=f"{number_of(verdict.quantity)}: {REQUIREMENTS[requirement_of(verdict.quantity)]}",
                iterations=iterations,
                cpu_s=cpu_s,
                waived=waived
                or verdict.quantity in unknown
                or verdict.reason in (NO_BAR, RATCHETS)
                or case.bars.get(f"{method}.{verdict.quantity}", _BAR).value is None,
            )
            for verdict in each
        ]
    return verdicts


def conclusions(verdicts: Iterable[CaseVerdict]) -> dict[tuple[str, str], Conclusion]:
    """Return the outcome of the ``verdicts`` by case and method (:func:`partialslip.run.judge.conclude`)."""
    groups = grouped(((verdict.case, verdict.method), verdict) for verdict in verdicts)
    return {
        group: conclude(
            [verdict for verdict in some if requirement_of(verdict.quantity) not in _CONDITIONS],
            [verdict for verdict in some if requirement_of(verdict.quantity) in _CONDITIONS],
            {verdict.quantity for verdict in some if verdict.waived},
        )
        for group, some in groups.items()
    }


def whole(verdicts: Iterable[CaseVerdict]) -> Conclusion:
    """Return what the ``verdicts`` on many cases amount to; where no case has a reference, by the conditions alone."""
    verdicts = tuple(verdicts)
    found = together(conclusions(verdicts).values())
    certified = (
        bool(verdicts)
        and all(requirement_of(verdict.quantity) in _CONDITIONS for verdict in verdicts)
        and not found.missed
    )
    return replace(found, outcome=Outcome.PASSED, asked=True) if certified else found


def _result_or_failure(case: Case, method: str) -> Result | Failure:
    """Return the result of a method, or the failure."""
    start = time.process_time()
    try:
        with np.errstate(all="ignore"):  # the verdict "finite" finds NaN and infinity
            if method == "fem" and case.meshes:
                from partialslip_fem.method import solve_meshed

                return solve_meshed(case.scene, plan(case.scene), case.meshes(case.scene))
            return run(case.scene, [method]).results[method]
    except Exception as error:
        return Failure(f"{type(error).__name__}: {error}", time.process_time() - start)


def _judged(case: Case, method: str, result: Result, reference: Result | None) -> Iterator[Verdict]:
    """Yield the verdicts on a result: the largest residual, the regime, the quantities that usually have bars, and the
    estimates of their errors."""
    yield Verdict("finishes", Outcome.PASSED)
    finite, *certificate = conditions(result)
    yield finite
    if certificate:
        worst = max(certificate, key=lambda verdict: (verdict.outcome is Outcome.MISSED, verdict.error))
        yield replace(worst, quantity="certificate")
    if reference:
        own = {key.removeprefix(f"{method}."): bar for key, bar in case.bars.items() if key.startswith(f"{method}.")}
        accuracy = None if case.meshes or case.scene.fem.size else case.scene.fem.accuracy
        every = compare(result, reference, case.scene, accuracy, own, stresses=False).verdicts
        verdicts = [verdict for verdict in every if verdict.quantity in ("regime", *BARS)]
        yield from verdicts
        yield from estimate_verdicts(verdicts, reference)
