"""Codes that answer the problems: an adapter each."""

from collections.abc import Callable, Mapping
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


CODES: dict[str, Code] = {
    "exact": Own("exact", {}),
    "march": Own("march", {"accuracy": 1e-4}),
    "fem-1e-3": Own("fem", {"accuracy": 1e-3}),
    "fem-1e-4": Own("fem", {"accuracy": 1e-4}),
    "fem-1e-5": Own("fem", {"accuracy": 1e-5}),
    "fem-P1": Own("fem", {"order": 1}, (0.1, 0.05, 0.025, 0.0125)),
    "fem-P2": Own("fem", {"order": 2}, (0.1, 0.05, 0.025)),
    "equivalent": Own("equivalent", {}),
    "calculix-mortar": Calculix(0.05, False),
    "calculix-penalty": Calculix(0.05, True),
    "kratos": Kratos(0.1, 8),
    "opensees": OpenSees(0.05, 8),
    "getfem": GetFEM(0.05),
    "getfem-graded": GetFEM(0.05, 0.003),
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
    title = f"partialslip {name}" if isinstance(code, Own) else name
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
    """Answer of ``code``, on its ladder of meshes if it has one; None if it does not offer the ``problem``."""
    if not isinstance(code, Own) or not code.sizes:
        solved = _code_outcome(code, problem.scene)
        return _answer(problem, solved) if solved else None
    rungs = [_code_outcome(each, problem.scene) for each in code.rungs]
    found = [_answer(problem, each) for each in rungs if each]
    if len(found) < len(rungs):
        return None
    ladder = (Rung(h, each.values, each.cpu_s, each.unknowns) for h, each in zip(code.sizes, found, strict=True))
    return replace(found[-1], ladder=tuple(ladder))


def _code_outcome(code: Code, scene: Scene) -> CodeOutcome | None:
    try:
        return code.solve(scene)
    except MissingLibraryError:
        raise
    except PartialslipError as error:  # such as a mesh that cannot be made
        return CodeOutcome(None, str(error))


def _answer(problem: Problem, solved: CodeOutcome) -> Answer:
    values = answer_of(problem, solved.result).values if solved.result else {}
    return Answer(values, solved.cpu_s, solved.unknowns, solved.memory_mb, one_line(solved.why))


def _kept(meta: Meta, problems: Mapping[str, Problem], folder: Path | None) -> dict[str, Answer]:
    """Answers in ``folder`` to the ``problems``, of the code ``meta``. Tables beside them are no part of them."""
    if not folder or not (folder / META).exists() or not files_in(folder, "*.json"):
        return {}
    kept = examined(folder, read_problems(), with_tables=False).as_written()
    return {key: answer for key, answer in kept.answers.items() if key in problems} if kept.meta == meta else {}
