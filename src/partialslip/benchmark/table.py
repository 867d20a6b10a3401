"""Answers from tables of tractions."""

from collections.abc import Mapping
from pathlib import Path

import msgspec

from partialslip.benchmark.measured import answer_of
from partialslip.benchmark.problem import Problem
from partialslip.benchmark.submission import Answer
from partialslip.score.method import scored
from partialslip.score.read import read


def answer_from(problem: Problem, file: str | Path, columns: Mapping[str, str] | None = None) -> Answer:
    """Answer to ``problem`` from the tractions in ``file``: a, m and n as :func:`partialslip.score` finds them, and its
    ``columns``.

    Raises
    ------
    InputError
        If the file cannot be read.
    """
    samples = read(Path(file), problem.scene, (1.0, 1.0, 1.0), 1, None, columns)
    answer = answer_of(problem, scored(problem.scene, samples, "table", str(file)))
    return msgspec.structs.replace(answer, cpu_s=None, memory_mb=None)  # those of reading
