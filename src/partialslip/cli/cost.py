"""partialslip study cost: errors against CPU seconds."""

import argparse
import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import partialslip
from partialslip.cli.common import (
    Commands,
    add_out,
    add_pdf,
    add_scene,
    add_verbose,
    check_output,
    methods_of,
    seconds,
    study_ledger,
)
from partialslip.cli.findings import Findings, present
from partialslip.tools.errors import InputError

if TYPE_CHECKING:
    from partialslip.study.cost import CostPoint, MeasuredCosts


def add(topics: Commands) -> None:
    """Add the topic to the parser of ``topics``."""
    cost = topics.add_parser(
        "cost",
        help="errors against CPU seconds, over a ladder of settings of every method",
        description="Solve a scene with a ladder of settings of every method, one process per setting, the coarsest "
        "setting of each method first, until the budget is spent. Print errors of m and n against CPU seconds of the "
        "solution. A stopped study continues.",
        examples=[
            "partialslip study cost hertz-large-tension",
            "partialslip study cost hertz-large-tension --with march,fem --budget 300s",
            "partialslip study cost hertz-small-tension --budget none --all --peers benchmarks/peers/measured.jsonl",
        ],
    )
    add_scene(cost)
    cost.add_argument("--with", dest="methods", metavar="METHODS", default="exact,march,fem",
                      help="methods of exact, march and fem, separated by commas (default: all)")  # fmt: skip
    cost.add_argument("--budget", metavar="SECONDS", default="60s",
                      help="CPU seconds of all processes, after which no setting is begun, or none: the whole ladder "
                      "(default: 60s)")  # fmt: skip
    cost.add_argument("--all", dest="every", action="store_true",
                      help="elements of all orders, a plain box, SuperLU, too")  # fmt: skip
    cost.add_argument("--repeats", type=int, default=5, metavar="N",
                      help="most solutions of a setting; fewer if the two smallest CPU seconds agree to 10 %% "
                      "(default: 5)")  # fmt: skip
    cost.add_argument("--peers", metavar="FILE", help="results of other codes, JSON lines, to add to the diagram")
    add_out(cost, "results/NAME-cost[-HASH]")
    add_verbose(cost, "the settings that another one beats in cost and error, and how errors fall with unknowns")
    add_pdf(cost)
    cost.set_defaults(command=_cost)


def _cost(options: argparse.Namespace) -> int:
    check_output(options)
    if options.repeats < 1:
        raise InputError(f"--repeats {options.repeats}: must be >= 1")
    budget = math.inf if options.budget == "none" else seconds(options.budget, " or none")
    scene = partialslip.load_scene(options.scene, options.overrides)
    name = f"{scene.name}-cost"

    from partialslip.cli.consoles import working
    from partialslip.study import cost

    methods = methods_of(options.methods, cost.LADDERS)
    peers = cost.read_peers(Path(options.peers), scene.name) if options.peers is not None else []
    known = {
        "peers": options.peers and Path(options.peers),
        "methods": sorted({*methods}),
        "budget": str(budget),
        "every": options.every,
    }

    def usual() -> dict[str, object]:
        return {"methods": sorted(cost.LADDERS), "budget": str(seconds(options.default("budget"))), "every": False}

    def find(folder: Path) -> Findings:
        ledger = study_ledger(folder)
        with working(name) as tell:
            measured = cost.measure_costs(
                scene, ledger, options.repeats, lambda *state: tell(_progress(*state)), methods, budget, options.every
            )
        return _evaluated(options, scene, measured, peers, ledger.path)

    return present(options, "study cost", name, scene, find, known, usual)


def _evaluated(
    options: argparse.Namespace,
    scene: "partialslip.Scene",
    measured: "MeasuredCosts",
    peers: "list[CostPoint]",
    ledger: Path,
) -> Findings:
    """Draw, write and tabulate what was ``measured`` of ``scene``."""
    from partialslip.report.page import Section
    from partialslip.study import cost
    from partialslip.tools.output.files import csv_text, write_texts

    found, name = measured.points, scene.name
    phases = cost.phases_svg(found, f"{name}: where the time goes")
    texts = {
        "cost.csv": csv_text(*cost.cost_table([*found, *peers])),
        "cost.svg": cost.errors_svg(found, peers, f"{name}: what accuracy costs", scene.fem.accuracy),
    } | ({"phases.svg": phases} if phases else {})
    front = cost.front(found)
    best = {id(point) for point in front}
    head = ["series (* on the front)", "setting", "m, in a", "n, in a", "q, norm", "unknowns", "CPU s", "process"]
    rows = [_cost_row(point, id(point) in best) for point in [*found, *peers]]
    slopes = [
        [each, *(_formatted(value, ".2f") for value in of.values())]
        for each, of in cost.slopes(found).items()
        if not math.isnan(of["CPU"])
    ]
    exponents = ["exponent against unknowns", "m, n", "q", "CPU"]
    heading = f"{name}: what accuracy costs"
    answer, against = _answer(front, scene.fem.accuracy), _against(found, peers)
    if measured.left:
        against.append(_left_out(measured, options.budget))
    sections = [
        Section("Errors and costs", [*answer, *against], texts["cost.svg"], "", head, rows, (1,)),
        Section("Growth with the unknowns", (), phases, "", exponents, slopes),
    ]
    if options.verbose:
        tables: list[str | Section] = [replace(section, title="") for section in sections]
    else:
        beaten = sum(bool(point.errors) for point in found) - len(front)  # exact is what errors are measured against
        shown = [_cost_row(point, False) for point in front]
        tables = [
            Section("", headings=["series", *head[1:]], rows=shown, words=(1,)),
            f"{beaten} other settings cost more for the error: --verbose, or cost.csv",
        ]
    files = [ledger, *write_texts(ledger.parent, texts)]
    return Findings(files, heading, [*answer, cost.SETTING, *tables, *against], heading, sections)


def _answer(front: "list[CostPoint]", asked: float) -> list[str]:
    """Return the cheapest setting that reaches the accuracy ``asked`` for, and the best one, a line each."""
    lines = []
    for point in front:
        if point.ends <= asked:
            lines.append(f"m and n to {asked:.0e} a: {point.series}, {point.setting}, in {point.cpu_s:.2g} CPU s")
            break
    if front:
        best = front[-1]
        lines.append(f"best: {best.ends:.1e} a by {best.series}, {best.setting}, in {best.cpu_s:.2g} CPU s")
    return lines


def _left_out(measured: "MeasuredCosts", budget: str) -> str:
    """Return which settings were left out, and why, as one line."""
    from partialslip.study.cost import setting_name

    first = {case.labels["series"]: setting_name(case) for case in reversed(measured.left)}
    where = "; ".join(f"{name} on" for name in reversed(first.values()))
    return f"{len(measured.left)} settings are left out, as --budget {budget} is spent: {where}"


def _progress(done: int, total: int, setting: str, rest: float) -> str:
    """Return the progress of the study as text."""
    if done == total:
        return "drawing"
    return f"setting {done + 1} of {total}: {setting}{'' if math.isinf(rest) else f', {rest:.0f} CPU s left'}"


def _cost_row(point: "CostPoint", front: bool) -> list[str]:
    errors = [_formatted(point.errors.get(key, math.nan), ".1e") for key in ("m", "n", "q")]
    unknowns = f"{point.counts['dofs']:,}" if "dofs" in point.counts else ""
    costs = [f"{point.cpu_s:.3g}", f"{point.process_s:.2f}"]
    return [point.series + (" *" if front else ""), point.setting, *errors, unknowns, *costs]


def _formatted(value: float, form: str) -> str:
    return "" if math.isnan(value) else format(value, form)


def _against(found: "list[CostPoint]", peers: "list[CostPoint]") -> list[str]:
    """Return lines that compare the finite elements of partialslip with each peer."""
    from partialslip.study.cost import against

    ours = [point for point in found if point.series.startswith("fem")]
    lines = []
    for series in dict.fromkeys(point.series.partition(",")[0] for point in peers):
        theirs = [point for point in peers if point.series.partition(",")[0] == series]
        for key in ("m", "n", "q"):
            if any(key in point.errors for point in theirs):
                ratio = {name: f"{value:.2g}" for name, value in against(ours, theirs, key).items()}
                lines.append(
                    f"{series}, {key}: best error {ratio['error']}; partialslip reaches the same error in "
                    f"{ratio['cpu']} of the CPU seconds ({ratio['process']} with the whole process), and "
                    f"{ratio['error at its cpu']} of the error in the same CPU seconds"
                )
    return lines
