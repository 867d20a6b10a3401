"""What is verified: a case is a scene, the methods that solve it and the bars they must meet; a verdict is one quantity
of one method against its bar, and answers one of the requirements, R1 to R9."""

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from partialslip.compare import P_BAR, Q_BAR, compare
from partialslip.plan import plan
from partialslip.result import CERTIFICATE_BAR, Result
from partialslip.run import run
from partialslip.scene import Scene
from partialslip_meshes.mesh import Mesh

Meshes = Callable[[Scene], Sequence[Mesh]]

_BARS = {"a": 1.0, "m": 1.0, "n": 1.0, "p": P_BAR, "q": Q_BAR}  # in the accuracy asked for
REQUIREMENTS = {
    "finishes": "the method ends with a result, without an error",
    "finite": "no value is NaN or infinite",
    "certificate": "no residual of the method's own conditions, in f p0 and in f P, is larger",
    "regime": "the regime is that of the exact solution",
    "a": "the contact's half-width differs from the exact one by at most that, in a",
    "m": "the stick zone's left end differs from the exact one by at most that, in a",
    "n": "the stick zone's right end differs from the exact one by at most that, in a",
    "p": "cell averages of pressure differ from the exact ones by at most that, relative L2",
    "q": "cell averages of shear's change differ from the exact ones by at most that, relative L2",
}


class Failure(NamedTuple):
    """What a method raised instead of a result, and the CPU seconds until then."""

    error: str
    cpu_s: float


Found = Mapping[str, Result | Failure]


class Bar(NamedTuple):
    """A bar other than the usual one, and why; None judges nothing."""

    value: float | None
    reason: str


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


@dataclass(frozen=True)
class Verdict:
    """One quantity of one method against its bar.

    Parameters
    ----------
    case, method, check : str
        Which case, which method, and what is judged (a key of the requirements in this module).
    value, bar : float or None
        The quantity and what it must not exceed; None for what is no number, and where nothing is judged.
    passed : bool
    requirement : str
        What is required: its number and words.
    found : str
        What was found, in words, where it is no number.
    reason : str
        Why the bar is not the usual one.
    iterations : int
        Faces solved by the method in all.
    cpu_s : float
        CPU seconds of the method in all.
    """

    case: str
    method: str
    check: str
    value: float | None
    bar: float | None
    passed: bool
    requirement: str
    found: str = ""
    reason: str = ""
    iterations: int = 0
    cpu_s: float = 0.0

    @property
    def share(self) -> float | None:
        """Of its bar that the value takes; None where one of them is none, or the bar is 0."""
        return None if self.value is None or not self.bar else self.value / self.bar

    @property
    def judged(self) -> bool:
        """Whether anything is asked: a bar of None that has a reason asks nothing."""
        return self.bar is not None or (self.value is None and not self.reason)


def number_of(check: str) -> str:
    """That of the requirement which a ``check`` answers: R1 to R9."""
    return f"R{list(REQUIREMENTS).index(check) + 1}"


def run_case(case: Case) -> list[Verdict]:
    """Solve the case by each of its methods and judge what they find; what they raise is a verdict, too."""
    return judge(case, solve_case(case))


def solve_case(case: Case) -> Found:
    """What each method of the case finds or raises, the exact one's first where it is what others are compared with."""
    needed = ["exact"] if case.compared else []
    return {method: _solve(case, method) for method in dict.fromkeys([*needed, *case.methods])}


def judge(case: Case, found: Found) -> list[Verdict]:
    """The verdicts on what the methods of a case have found."""
    reference = found["exact"] if case.compared else None
    verdicts = []
    for method in case.methods:
        result = found[method]
        if isinstance(result, Failure):
            failed = _verdict(
                case, method, "finishes", None, None, passed=False, found=result.error, cpu_s=result.cpu_s
            )
            verdicts.append(failed)
            continue
        known = reference if isinstance(reference, Result) and method != "exact" else None
        work: dict[str, Any] = {"iterations": result.counts.get("iterations", 0), "cpu_s": result.cost.cpu_s}
        verdicts += [_verdict(case, method, *judged, **work) for judged in _judged(case, method, result, known)]
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


def _judged(
    case: Case, method: str, result: Result, reference: Result | None
) -> Iterator[tuple[str, float | None, float | None, bool, str]]:
    """Check, value, bar, whether it is passed and what was found, one by one."""
    yield "finishes", None, None, True, ""
    lost = _not_finite(result)
    yield "finite", float(lost), 0.0, lost == 0, ""
    if residuals := [value for name, value in result.certificate.items() if name != "steady"]:
        worst = max(residuals, key=lambda value: math.inf if math.isnan(value) else value)
        yield "certificate", worst, CERTIFICATE_BAR, worst <= CERTIFICATE_BAR, ""
    if not reference:
        return
    judges = case.bars.get(f"{method}.regime", Bar(1.0, "")).value is not None
    yield "regime", None, None, not judges or result.regime == reference.regime, result.regime
    errors = compare(result, reference, case.scene.friction.f, None)
    for check, share in _BARS.items():
        error: float | None = getattr(errors, check)
        own = case.bars.get(f"{method}.{check}")
        usual = None if case.meshes or case.scene.fem.size else share * case.scene.fem.accuracy
        bar = own.value if own else usual
        if error is not None and (check != "a" or method == "fem"):
            yield check, error, bar, bar is None or error <= bar, ""


def _verdict(
    case: Case,
    method: str,
    check: str,
    value: float | None,
    bar: float | None,
    passed: bool,
    found: str = "",
    **work: Any,
) -> Verdict:
    reason = case.bars[f"{method}.{check}"].reason if f"{method}.{check}" in case.bars else ""
    requirement = f"{number_of(check)}: {REQUIREMENTS[check]}"
    finite = value if value is not None and math.isfinite(value) else None
    if value is not None and finite is None:
        found = str(value)
    return Verdict(case.name, method, check, finite, bar, passed, requirement, found, reason, **work)


def _not_finite(result: Result) -> int:
    """How many of the numbers of a result are not."""
    traction, slip = result.traction, result.slip
    arrays = [traction.x, traction.p, traction.dq, traction.q1, traction.q2]
    arrays += [slip.x, slip.slip, np.array(slip.dissipated)] if slip else []
    numbers = [result.a, result.p0, result.stick_centre, result.stick_half_width]
    numbers += [*result.certificate.values(), *result.estimate.values(), *result.limits.values()]
    arrays.append(np.array([number for number in numbers if number is not None]))
    return sum(int((~np.isfinite(array)).sum()) for array in arrays if array is not None)
