"""What is verified: a case is a scene, the methods that solve it and the bars they must meet; a verdict is one quantity
of one method against its bar, and answers one of the requirements, R1 to R9."""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from partialslip.bars import BARS
from partialslip.judge import Bar, Outcome, Verdict, compare, conditions
from partialslip.judge.reference import reference_of
from partialslip.plan import plan
from partialslip.result import Result
from partialslip.run import run
from partialslip.scene import Scene
from partialslip_meshes.mesh import Mesh

Meshes = Callable[[Scene], Sequence[Mesh]]

REQUIREMENTS = {
    "finishes": "the method ends with a result, without an error",
    "finite": "no value is NaN or infinite",
    "certificate": "no residual of the method's own conditions, in f p0 and in f P, is larger",
    "regime": "the regime is that of the exact solution",
    "a": "the contact's half-width and ends differ from the exact ones by at most that, in a",
    "m": "the stick zone's left end differs from the exact one by at most that, in a",
    "n": "the stick zone's right end differs from the exact one by at most that, in a",
    "p": "cell averages of pressure differ from the exact ones by at most that, relative L2; its resultant from P",
    "q": "cell averages of shear differ from the exact ones by at most that, relative L2; the resultant of its change "
    "from dQ, in 2 f P",
}
_PART_OF = {
    **dict.fromkeys(("left", "right", "left_1", "right_1", "left_2", "right_2"), "a"),
    **dict.fromkeys(("P", "P_1", "p_1"), "p"),
    **dict.fromkeys(("dQ", "q1", "q2"), "q"),
}


class Failure(NamedTuple):
    """What a method raised instead of a result, and the CPU seconds until then."""

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
        Of "exact", "march" and "fem".
    bars : mapping of str to Bar
        Where they are not the usual ones, by method and check, as in ``"fem.q"``. The usual ones are the accuracy that
        the scene asks for, ten times that for p and fifteen times that for q.
    compared : bool
        Whether to compare with the exact solution; without it, certificates are all there is.
    meshes : callable, optional
        Takes the scene to meshes for the finite elements (see :func:`partialslip_fem.model.solve_meshed`), on which
        bars are the case's own.
    hard : str
        Why it is hard, and what goes wrong with it elsewhere.
    """

    name: str
    scene: Scene
    methods: Sequence[str] = ("exact", "march", "fem")
    bars: Mapping[str, Bar] = field(default_factory=dict)
    compared: bool = True
    meshes: Meshes | None = None
    hard: str = ""


@dataclass(frozen=True, kw_only=True)
class CaseVerdict(Verdict):
    """The verdict on one quantity of one method in one case.

    Parameters
    ----------
    case, method : str
    requirement : str
        What is required: its number and words.
    iterations : int
        Linear solves of the active-set iteration, in all, by the method.
    cpu_s : float
        CPU seconds of the method in all.
    """

    case: str
    method: str
    requirement: str
    iterations: int = 0
    cpu_s: float = 0.0


def requirement_of(quantity: str) -> str:
    """The key in :data:`REQUIREMENTS` of what is required of a quantity."""
    return _PART_OF.get(quantity, quantity)


def number_of(quantity: str) -> str:
    """The number of the requirement that a quantity answers: R1 to R9."""
    return f"R{list(REQUIREMENTS).index(requirement_of(quantity)) + 1}"


def run_case(case: Case) -> list[CaseVerdict]:
    """Solve the case by each of its methods and judge what they find; what they raise is a verdict, too."""
    return judge_case(case, solve_case(case))


def solve_case(case: Case) -> Found:
    """What each method of the case finds or raises, the exact one's first where it is what others are compared with."""
    needed = ["exact"] if case.compared else []
    return {method: _solve(case, method) for method in dict.fromkeys([*needed, *case.methods])}


def judge_case(case: Case, found: Found) -> list[CaseVerdict]:
    """The verdicts on what the methods of a case have found. An exact solution that is missing is missed, too, where
    others are to be compared with it; the march stands in for one that cannot judge."""
    lost = ["exact"] if case.compared and isinstance(found["exact"], Failure) else []
    results = {method: result for method, result in found.items() if isinstance(result, Result)}
    judging = reference_of(results) if case.compared and not lost else None
    verdicts = []
    for method in dict.fromkeys([*lost, *case.methods]):
        result = found[method]
        if isinstance(result, Failure):
            each: Iterator[Verdict] = iter([Verdict("finishes", Outcome.MISSED, reason=result.error)])
            iterations, cpu_s = 0, result.cpu_s
        else:
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
            )
            for verdict in each
        ]
    return verdicts


def _solve(case: Case, method: str) -> Result | Failure:
    """The result of a method, or what it raises."""
    start = time.process_time()
    try:
        with np.errstate(all="ignore"):  # what is not finite is found below
            if method == "fem" and case.meshes:
                from partialslip_fem.model import solve_meshed

                return solve_meshed(case.scene, plan(case.scene), case.meshes(case.scene))
            return run(case.scene, [method]).results[method]
    except Exception as error:
        return Failure(f"{type(error).__name__}: {error}", time.process_time() - start)


def _judged(case: Case, method: str, result: Result, reference: Result | None) -> Iterator[Verdict]:
    """The verdicts on a result: of its residuals on the worst, and on the quantities that have bars as a rule."""
    yield Verdict("finishes", Outcome.PASSED)
    finite, *certificate = conditions(result)
    yield finite
    if certificate:
        worst = max(certificate, key=lambda verdict: (verdict.outcome is Outcome.MISSED, verdict.error))
        yield replace(worst, quantity="certificate")
    if reference:
        own = {key.removeprefix(f"{method}."): bar for key, bar in case.bars.items() if key.startswith(f"{method}.")}
        accuracy = None if case.meshes or case.scene.fem.size else case.scene.fem.accuracy
        verdicts = compare(result, reference, case.scene, accuracy, own).verdicts
        yield from (verdict for verdict in verdicts if verdict.quantity in ("regime", *BARS))
