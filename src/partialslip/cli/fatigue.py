"""partialslip fatigue: assess a scene by fatigue criteria."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

import partialslip
from partialslip.cli.common import Commands, add_method, add_out, add_pdf, add_scene, check_output, naming
from partialslip.cli.findings import Findings, present
from partialslip.tools.errors import InputError
from partialslip.tools.methods import REFERENCES

if TYPE_CHECKING:
    from partialslip.report.page import Section
    from partialslip.scene import Scene
    from partialslip.study.fatigue import Assessment


def add(commands: Commands) -> None:
    """Add the command to the parser of ``commands``."""
    fatigue = commands.add_parser(
        "fatigue",
        help="assess a scene by fatigue criteria",
        description="Evaluate fatigue criteria from the stresses of a scene: largest values at the surface and inside, "
        "critical planes, averages over a distance, and asymptotes at the ends of the contact. The table fatigue of "
        "the scene holds the constants of the criteria.",
        examples=[
            "partialslip fatigue fretting-aluminium",
            "partialslip fatigue fretting-aluminium --criterion swt --distance 50e-6",
            "partialslip fatigue my-scene.toml --criterion findley,ruiz --set fatigue.k_findley=0.3 --with fem",
        ],
    )
    add_scene(fatigue)
    fatigue.add_argument("--criterion", metavar="CRITERIA",
                         help="of principal, swt, fatemi-socie, findley, dang-van, crossland and ruiz, separated by "
                         "commas (default: all whose constants the scene has)")  # fmt: skip
    fatigue.add_argument("--distance", metavar="LENGTH",
                         help="depth over which stresses are averaged, in the scene's unit of length, as "
                         "fatigue.distance")  # fmt: skip
    told = "exact, march or fem (default: the reference of the scene, and march where exact does not know q1 and q2)"
    add_method(fatigue, told, choices=REFERENCES)
    fatigue.add_argument("--body", choices=("lower", "upper"), default="lower", metavar="BODY",
                         help="lower or upper (default: lower)")  # fmt: skip
    add_out(fatigue, "results/NAME-fatigue[-HASH]", "-o")
    add_pdf(fatigue)
    fatigue.set_defaults(command=_fatigue)


def _fatigue(options: argparse.Namespace) -> int:
    check_output(options)
    if options.distance is not None:
        options.overrides = [*options.overrides, f"fatigue.distance={options.distance}"]
    scene = partialslip.load_scene(options.scene, options.overrides)

    from partialslip.cli.consoles import working
    from partialslip.run import solved_with_stresses
    from partialslip.study.fatigue import assess, tables
    from partialslip.study.fatigue.criteria import check_distance, chosen
    from partialslip.study.fatigue.page import drawn, sections, write_assessment

    names = None if options.criterion is None else [name.strip() for name in options.criterion.split(",")]
    with naming(options.scene):
        names = chosen(scene, names)  # before anything is solved
        check_distance(scene, options.body)
        _check_method(scene, options.method)
    name = f"{scene.name}-fatigue"
    known = {"criterion": names, "distance": None}  # the distance is in the scene

    def usual() -> dict[str, object]:
        return {"criterion": chosen(scene, None), "method": None}

    def find(folder: Path) -> Findings:
        with working(name) as tell:
            result = solved_with_stresses(scene, options.method, tell)
            tell("criteria")
            found = assess(scene, result, names, body=options.body)
            tell("figures")
            figures = drawn(found)
            files = write_assessment(found, figures, folder)
        heading = tables.assessment_heading(found)
        return Findings(files, heading, _printed(found), f"{scene.name}: fatigue", sections(found, figures))

    return present(options, "fatigue", name, scene, find, known, usual, True)


def _check_method(scene: "Scene", method: str | None) -> None:
    """Raise InputError if ``method`` solves dissimilar bodies, but finds no stresses in them."""
    if method not in (None, "fem") and not scene.material.alike:
        raise InputError(f"--with {method}: must be fem for unlike materials; {method} finds no stresses in them")


def _printed(found: "Assessment") -> "list[str | Section]":
    """Return the tables of an assessment and the lines between them."""
    from partialslip.report.page import Section
    from partialslip.study.fatigue import tables

    parts: list[str | Section] = [tables.assessment_answer(found)]
    if found.ratings:
        parts.append(Section("", (), "", "", *tables.rating_table(found), (1,)))
    if (averages := tables.average_table(found))[1]:
        distance = found.scene.units.length(found.scene.fatigue.distance or 0.0)
        parts.append(f"Averaged over {distance} from the surface:")
        parts.append(Section("", (), "", "", *averages, (1,)))
    if found.edges:
        parts.append(f"Ends of the contact, {tables.edge_units(found)}:")
        parts.append(Section("", (), "", "", *tables.edge_table(found)))
    return [*parts, *tables.assessment_notes(found)]
