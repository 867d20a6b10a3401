"""partialslip run: solve a scene, compare the methods, write the report."""

import argparse
import math
import time
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import partialslip
from partialslip.cli.common import (
    Commands,
    add_out,
    add_pdf,
    add_scene,
    add_tolerance,
    add_verbose,
    check_output,
    folder_if_wanted,
    methods_of,
    naming,
    origin,
    print_long_path,
    print_outcome,
    seconds,
)
from partialslip.tools.allowance import Allowance
from partialslip.tools.errors import InputError
from partialslip.tools.methods import METHODS

if TYPE_CHECKING:
    from partialslip.result import Result
    from partialslip.result.state import State
    from partialslip.run import Run
    from partialslip.scene import Scene

_CLOSING = 0.5  # cost: CPU seconds of report and exit, which a budget includes (measured: 0.4)


def add(commands: Commands) -> None:
    """Add the command to the parser of ``commands``."""
    runs = commands.add_parser(
        "run",
        help="solve a scene, compare the methods, write the report",
        description="Solve a scene by finite elements and, where an exact solution is known, exactly. Print the "
        "errors, and write report.html, results.json and tractions.csv.",
        examples=[
            "partialslip run fretting-aluminium",
            "partialslip run my-scene.toml --set load.Q=[-30e3,30e3] --accuracy 1e-6",
            "partialslip run fretting-aluminium --set fem.far_field=box --out results/box",
        ],
        failure="a bar or a certificate missed",
        unjudged="headline quantities not judged",
    )
    add_scene(runs)
    add_tolerance(runs)
    runs.add_argument("--with", dest="methods", metavar="METHODS",
                      help=f"methods of {', '.join(METHODS)}, separated by commas (default: fem and, of one "
                      "material, exact or else march; with bodies.equivalent exact and equivalent)")  # fmt: skip
    runs.add_argument("--accuracy", metavar="FRACTION",
                      help="accuracy of a, m and n, as a fraction of a; tells the CPU seconds taken")  # fmt: skip
    runs.add_argument("--budget", metavar="SECONDS",
                      help="CPU seconds of the whole process, e.g. 5s: no mesh is begun that is not likely to fit; "
                      "errors are estimated in any case")  # fmt: skip
    runs.add_argument("--fields", action="store_true",
                      help="also compare stresses, and write surface.csv and, of fem, bodies.vtu")  # fmt: skip
    runs.add_argument("--start", metavar="FILE",
                      help="start from the state in FILE (see --save) instead of from zero shear")  # fmt: skip
    runs.add_argument("--save", metavar="FILE",
                      help="write the state at the end of the load path to FILE, .npz (of fem, else of "
                      "march)")  # fmt: skip
    add_out(runs, "results/NAME[-HASH]")
    add_pdf(runs)
    add_verbose(runs, "limits, slip, certificates, costs by phase, and the effects with reasons")
    runs.add_argument("--json", action="store_true", help="print results.json and nothing else; files only with --out")
    runs.set_defaults(command=_run)


def _run(options: argparse.Namespace) -> int:
    methods = None if options.methods is None else methods_of(options.methods, METHODS)
    check_output(options)
    if options.save == "":
        raise InputError("--save '': must name a file")
    scene = partialslip.load_scene(options.scene, [*_accuracy(options), *options.overrides])
    if scene.tolerance and options.start is not None:
        raise InputError(f"--start {options.start}: must be left out with tolerances, which move the start, too")
    start = partialslip.load_state(options.start) if options.start is not None else None
    budget = _budget(options, scene, methods)

    from partialslip.cli.consoles import working
    from partialslip.report import write_run
    from partialslip.run import default_methods
    from partialslip.study.fatigue.page import criteria_sections
    from partialslip.tools.output.files import write_files

    counted, allowance = options.accuracy is not None or budget is not None, None
    if counted:
        import partialslip_fem.method  # noqa: F401 - imports count as start
    start_s = time.process_time() if options.own_process else 0.0
    began = time.process_time()
    taken = methods or default_methods(scene)
    chosen = sorted({*taken})
    known = {"methods": chosen, "start": options.start and Path(options.start)}

    def usual() -> dict[str, object]:
        if methods is None:
            return {"methods": chosen}
        # the default methods may take seconds to find: one of these two is always among them
        return {"methods": sorted(default_methods(scene)) if {"fem", "equivalent"} & {*methods} else []}

    with folder_if_wanted(options, "run", scene.name, scene, known, usual) as (folder, elsewhere):
        if budget is not None:
            allowance = Allowance(budget - start_s - _CLOSING - (time.process_time() - began))
        print_long_path(scene, chosen)
        with working(scene.name) as tell:
            with naming(options.scene):
                outcome = partialslip.run(
                    scene,
                    taken,
                    subsurface=options.fields,
                    stresses=True,
                    progress=tell,
                    start=start,
                    allowance=allowance,
                )
            if getattr(scene.profile, "measured", None):
                tell("noise of the profile")
                _ = outcome.noise  # while the console shows what the command is doing
            if scene.tolerance:
                from partialslip.study.tolerance import with_tolerance

                with naming(options.scene):
                    outcome = with_tolerance(outcome, tell)
            files = []
            if options.save is not None:
                save = Path(options.save)
                files += write_files(save.parent, {save.name: _state(outcome).save})
            if folder:
                files += write_run(
                    outcome, folder, origin(options), pdf=options.pdf, sections=criteria_sections(outcome)
                )
    paid = _paid(options, outcome, start_s + time.process_time() - began) if counted else []
    return print_outcome(outcome, options, files, paid, elsewhere)


def _budget(options: argparse.Namespace, scene: "Scene", methods: list[str] | None) -> float | None:
    """Return the CPU seconds for the whole process; None without ``--budget``."""
    if options.budget is None:
        return None
    if options.accuracy is not None:
        raise InputError("--budget: must not be given together with --accuracy")
    budget = seconds(options.budget)
    if methods and "fem" not in methods:
        raise InputError("--budget: needs the method fem: add fem to --with")
    if scene.fem.size is not None or scene.meshed:
        raise InputError("--budget: needs adaptive meshes: remove fem.size and given meshes from the scene")
    return budget


def _accuracy(options: argparse.Namespace) -> list[str]:
    """Return the setting of ``--accuracy``."""
    if options.accuracy is None:
        return []
    try:
        return [f"fem.accuracy={float(options.accuracy)!r}"]
    except ValueError:
        raise InputError(
            f"--accuracy {options.accuracy!r}: must be a number, a fraction of a, for example 1e-4"
        ) from None


def _paid(options: argparse.Namespace, outcome: "Run", spent: float) -> list[str]:
    """Return lines with the budget or the accuracy, the CPU seconds, ``spent`` by this process, and what these have led
    to."""
    spent += sum(result.cost.meshing_cpu_s for result in outcome.results.values())
    asked = f"budget of {options.budget}" if options.budget is not None else f"accuracy {options.accuracy}"
    reached = [_reached(result) for name, result in outcome.results.items() if name == "fem"]
    return [f"{asked}: {spent:.2g} CPU s", *reached]


def _reached(fem: "Result") -> str:
    """Return how well ``fem`` knows its ends, in a, as text."""
    from partialslip.run.judge.reference import error_of

    keys = [key for key in ("a", "m", "n") if getattr(fem, key) is not None]
    errors = {key: error_of(fem, key, fem.method) for key in keys}
    known = {key: error for key, error in errors.items() if math.isfinite(error)}
    lost = [key for key in keys if key not in known]
    parts = [f"{_joined_by_and(known)} known to {max(known.values()):.1e} a"] if known else []
    return "fem: " + ", ".join([*parts, *([f"no error estimate of {_joined_by_and(lost)}"] if lost else [])])


def _joined_by_and(keys: Iterable[str]) -> str:
    *before, last = keys
    return " and ".join(filter(None, [", ".join(before), last]))


def _state(outcome: "Run") -> "State":
    """Return the state at the end of the load path, of fem, else of march."""
    for name in ("fem", "march"):
        if name in outcome.results and (state := outcome.results[name].state):
            return state
    raise InputError("--save: no method has followed a path of loads with friction; use --with march or fem")
