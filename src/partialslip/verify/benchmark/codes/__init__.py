"""Codes that answer the problems: an adapter each."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from msgspec.structs import replace

from partialslip.scene import Scene
from partialslip.tools.errors import InputError, MissingLibraryError, PartialslipError, one_line
from partialslip.tools.origin import made_now
from partialslip.tools.output.files import files_in
from partialslip.verify.benchmark.codes.calculix import Calculix
from partialslip.verify.benchmark.codes.getfem import GetFEM
from partialslip.verify.benchmark.codes.kratos import Kratos
from partialslip.verify.benchmark.codes.opensees import OpenSees
from partialslip.verify.benchmark.codes.own import Own
from partialslip.verify.benchmark.codes.process import CodeOutcome
from partialslip.verify.benchmark.folder import examined
from partialslip.verify.benchmark.measured import answer_of
from partialslip.verify.benchmark.problem import Problem, read_problems
from partialslip.verify.benchmark.submission import META, Answer, Meta, Rung, Submission, write_submission

_RUNGS = 0.1, 0.05  # accuracy: sizes of elements of other codes, in a: twice the same mesh for all


class Code(Protocol):
    """A code that answers problems."""

    @property
    def version(self) -> str | None:
        """Version; None if the code is not installed."""

    @property
    def settings(self) -> str:
        """Settings in words."""

    def solve(self, scene: Scene) -> CodeOutcome | None:
        """Solve ``scene``; None if the code does not offer it. A code that fails says why."""


@dataclass(frozen=True)
class Ladder:
    """A code on meshes of ``sizes`` of elements along the contact, from coarse to fine, in a: one of the ``rungs``
    each. Its answers are those of the finest."""

    sizes: tuple[float, ...]
    rungs: tuple[Code, ...]

    @classmethod
    def of(cls, code: Callable[[float], Code], *sizes: float) -> "Ladder":
        """Ladder of a ``code`` by size."""
        return cls(sizes, tuple(map(code, sizes)))

    @property
    def version(self) -> str | None:
        """Version of the code; None if it is not installed."""
        return self.rungs[-1].version

    @property
    def settings(self) -> str:
        """Settings of the finest rung in words, and the sizes of the others."""
        return f"{self.rungs[-1].settings}; coarser rungs of {', '.join(f'{size:g} a' for size in self.sizes[:-1])}"

    def solve(self, scene: Scene) -> CodeOutcome | None:
        """Solve ``scene`` on the finest mesh; None if the code does not offer it."""
        return self.rungs[-1].solve(scene)


CODES: dict[str, Code] = {
    "exact": Own("exact", {}),
    "march": Own("march", {"accuracy": 1e-4}),
    "fem-1e-3": Own("fem", {"accuracy": 1e-3}),
    "fem-1e-4": Own("fem", {"accuracy": 1e-4}),
    "fem-1e-5": Own("fem", {"accuracy": 1e-5}),
    "fem-P1": Ladder.of(lambda size: Own("fem", {"order": 1, "size": size}), 0.1, 0.05, 0.025, 0.0125),
    "fem-P2": Ladder.of(lambda size: Own("fem", {"order": 2, "size": size}), 0.1, 0.05, 0.025),
    "equivalent": Own("equivalent", {}),
    "calculix-mortar": Ladder.of(lambda size: Calculix(size, False), *_RUNGS),
    "calculix-mortar-C3D8I": Ladder.of(lambda size: Calculix(size, False, element="C3D8I"), *_RUNGS),
    "calculix-penalty": Ladder.of(lambda size: Calculix(size, True), *_RUNGS),
    "calculix-penalty-30": Ladder.of(lambda size: Calculix(size, True, stick=30.0), *_RUNGS),
    "kratos": Ladder.of(lambda size: Kratos(size, 8, tangent_factor=None), *_RUNGS),
    "kratos-tangent-1": Ladder.of(lambda size: Kratos(size, 8), *_RUNGS),
    "opensees": Ladder.of(lambda size: OpenSees(size, 8), *_RUNGS),
    "opensees-bbar": Ladder.of(lambda size: OpenSees(size, 8, element="bbarQuad"), *_RUNGS),
    "getfem": Ladder.of(GetFEM, *_RUNGS),
    "getfem-graded": Ladder.of(lambda size: GetFEM(size, 0.06 * size), *_RUNGS),
}


def installed(name: str) -> str:
    """Version of a code. Raises InputError if there is no such code, or it is not installed."""
    if name not in CODES:
        raise InputError(f"--code {name!r}: must be one of {', '.join(CODES)}")
    version = CODES[name].version
    if version is None:
        raise InputError(f"--code {name!r}: is not installed; must be one of those that are")
    return version


def code_answers(
    name: str,
    problems: Mapping[str, Problem],
    progress: Callable[[int, int, float], None] = lambda *_: None,
    folder: Path | None = None,
) -> Submission:
    """Answers of one of :data:`CODES` to ``problems``. A problem that the code does not offer has no answer.

    Parameters
    ----------
    name : str
    problems : mapping of str to Problem
    progress : callable
        ``progress(done, total, seconds_left)``.
    folder : Path, optional
        Each answer is written there at once; answers of the same code and settings that are there are kept.

    Raises
    ------
    InputError
        If there is no such code, or it is not installed.
    """
    version, code, machine = installed(name), CODES[name], made_now().machine
    title = f"partialslip {name}" if isinstance(next(iter(rungs_of(code).values())), Own) else name
    meta = Meta(title, version, code.settings, f"{machine.processor}, {machine.system}")
    found = _kept(meta, problems, folder)
    if folder:
        write_submission(Submission(meta, found), folder)
    for number, (key, problem) in enumerate(problems.items()):
        progress(number, len(problems), float("nan"))
        if key not in found and (answer := _answered(code, problem)):
            found[key] = answer
            if folder:
                write_submission(Submission(meta, {key: answer}), folder)
    progress(len(problems), len(problems), 0.0)
    return Submission(meta, {key: found[key] for key in problems if key in found})


def _answered(code: Code, problem: Problem) -> Answer | None:
    rungs = [_code_outcome(each, problem.scene) for each in rungs_of(code).values()]
    return answer_on(code, problem, rungs)


def rungs_of(code: Code) -> dict[float | None, Code]:
    """Codes by size of the elements on the ladder of a ``code``; the code itself if it has no ladder."""
    return dict(zip(code.sizes, code.rungs, strict=True)) if isinstance(code, Ladder) else {None: code}


def answer_on(code: Code, problem: Problem, outcomes: Sequence[CodeOutcome | None]) -> Answer | None:
    """Answer to ``problem`` of the ``outcomes`` of all :func:`rungs_of` a ``code``; None if it does not offer it."""
    found = [_answer(problem, each) for each in outcomes if each]
    if len(found) < len(outcomes):
        return None
    if not isinstance(code, Ladder):
        return found[0]
    ladder = (
        Rung(h, each.values, each.cpu_s, each.unknowns, each.estimate)
        for h, each in zip(code.sizes, found, strict=True)
    )
    return replace(found[-1], ladder=tuple(ladder))


def _code_outcome(code: Code, scene: Scene) -> CodeOutcome | None:
    try:
        return code.solve(scene)
    except MissingLibraryError:
        raise
    except PartialslipError as error:  # such as a mesh that cannot be made
        return CodeOutcome(None, str(error))


def _answer(problem: Problem, solved: CodeOutcome) -> Answer:
    found = answer_of(problem, solved.result) if solved.result else Answer({})
    costs = {"cpu_s": solved.cpu_s, "unknowns": solved.unknowns, "memory_mb": solved.memory_mb}
    return replace(found, **costs, note=one_line(solved.why))


def _kept(meta: Meta, problems: Mapping[str, Problem], folder: Path | None) -> dict[str, Answer]:
    """Answers in ``folder`` to the ``problems``, of the code ``meta``. Tables beside them are no part of them."""
    if not folder or not (folder / META).exists() or not files_in(folder, "*.json"):
        return {}
    kept = examined(folder, read_problems(), with_tables=False).as_written()
    return {key: answer for key, answer in kept.answers.items() if key in problems} if kept.meta == meta else {}
