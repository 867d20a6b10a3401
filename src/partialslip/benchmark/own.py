"""Our own methods as codes of the benchmark, without privileges: they answer as any other code."""

from collections.abc import Callable, Mapping

import partialslip
from partialslip.benchmark.measured import quantities
from partialslip.benchmark.problem import Problem
from partialslip.benchmark.submission import Answer, Meta, Submission
from partialslip.errors import PartialslipError
from partialslip.origin import made_now
from partialslip.run import run

CODES: dict[str, tuple[str, dict[str, float | int]]] = {
    "exact": ("exact", {}),
    "march": ("march", {"accuracy": 1e-4}),
    "fem-1e-3": ("fem", {"accuracy": 1e-3}),
    "fem-1e-4": ("fem", {"accuracy": 1e-4}),
    "fem-1e-5": ("fem", {"accuracy": 1e-5}),
    "fem-P1": ("fem", {"order": 1, "size": 0.01}),
    "fem-P2": ("fem", {"order": 2, "size": 0.02}),
    "equivalent": ("equivalent", {}),
}


def answers(
    code: str, problems: Mapping[str, Problem], progress: Callable[[int, int, float], None] = lambda *_: None
) -> Submission:
    """Answers of one of :data:`CODES` to ``problems``. A problem that the method does not offer has no answer."""
    method, settings = CODES[code]
    found: dict[str, Answer] = {}
    for number, (name, problem) in enumerate(problems.items()):
        progress(number, len(problems), float("nan"))
        if answer := _answer(problem, method, settings):
            found[name] = answer
    progress(len(problems), len(problems), 0.0)
    made = made_now()
    told = ", ".join(f"{key} {value:g}" for key, value in settings.items())
    meta = Meta(
        f"partialslip {code}", partialslip.__version__, told, f"{made.machine.processor}, {made.machine.system}"
    )
    return Submission(meta, found)


def _answer(problem: Problem, method: str, settings: Mapping[str, float | int]) -> Answer | None:
    scene = problem.scene.replace(fem=dict(settings))
    try:
        result = run(scene, method)[method]
    except PartialslipError:
        return None
    a = problem.targets["a"].value
    values = quantities(problem.scene, result, problem.places, a)
    return Answer(
        values={key: values[key].value for key in problem.targets if key in values},
        cpu_s=result.cost.cpu_s,
        unknowns=result.counts.get("dofs") or result.counts.get("cells"),
        memory_mb=result.cost.peak_rss_mb,
    )
