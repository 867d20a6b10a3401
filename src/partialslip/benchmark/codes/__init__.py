"""Codes that answer the problems: an adapter each."""

from collections.abc import Callable, Mapping
from typing import Protocol

from partialslip.benchmark.codes.calculix import Calculix
from partialslip.benchmark.codes.own import Own
from partialslip.benchmark.problem import Problem
from partialslip.benchmark.submission import Answer, Meta, Submission
from partialslip.errors import InputError
from partialslip.origin import made_now


class Code(Protocol):
    """A code that answers problems."""

    @property
    def version(self) -> str | None:
        """Version; None if the code is not installed."""

    @property
    def settings(self) -> str:
        """Settings in words."""

    def answer(self, problem: Problem) -> Answer | None:
        """Answer to ``problem``; None if the code does not offer it."""


CODES: dict[str, Code] = {
    "exact": Own("exact", {}),
    "march": Own("march", {"accuracy": 1e-4}),
    "fem-1e-3": Own("fem", {"accuracy": 1e-3}),
    "fem-1e-4": Own("fem", {"accuracy": 1e-4}),
    "fem-1e-5": Own("fem", {"accuracy": 1e-5}),
    "fem-P1": Own("fem", {"order": 1, "size": 0.01}),
    "fem-P2": Own("fem", {"order": 2, "size": 0.02}),
    "equivalent": Own("equivalent", {}),
    "calculix-mortar": Calculix(0.05, False),
    "calculix-penalty": Calculix(0.05, True),
}


def answers(
    name: str, problems: Mapping[str, Problem], progress: Callable[[int, int, float], None] = lambda *_: None
) -> Submission:
    """Answers of one of :data:`CODES` to ``problems``. A problem that the code does not offer has no answer.

    Raises
    ------
    InputError
        If there is no such code, or it is not installed.
    """
    if name not in CODES:
        raise InputError(f"--code {name!r}: must be one of {', '.join(CODES)}")
    code = CODES[name]
    if code.version is None:
        raise InputError(f"--code {name!r}: is not installed; must be one of those that are")
    found: dict[str, Answer] = {}
    for number, (key, problem) in enumerate(problems.items()):
        progress(number, len(problems), float("nan"))
        if answer := code.answer(problem):
            found[key] = answer
    progress(len(problems), len(problems), 0.0)
    machine = made_now().machine
    own = isinstance(code, Own)
    meta = Meta(
        f"partialslip {name}" if own else name, code.version, code.settings, f"{machine.processor}, {machine.system}"
    )
    return Submission(meta, found)
