"""partialslip map: draw the stick zones over the loads."""

import argparse
from pathlib import Path

import partialslip
from partialslip.cli.common import Commands, add_out, add_scene, check_output
from partialslip.cli.findings import Findings, present
from partialslip.tools.errors import InputError


def add(commands: Commands) -> None:
    """Add the command to the parser of ``commands``."""
    maps = commands.add_parser(
        "map",
        help="draw the stick zones over shear and tension",
        description="Draw the stick zones of a profile over dQ and dsigma: map.svg, ends.svg and map.csv; over dP and "
        "dQ if P varies: map.svg and map.csv. Mark the loads of the scene, and print its regime and stick zone.",
        examples=["partialslip map", "partialslip map flat-rounded", "partialslip map my-scene.toml --out maps"],
    )
    told = "a shipped scene or a TOML file, with the profile to map and the loads to mark (default: Hertz)"
    add_scene(maps, told, optional=True)
    add_out(maps, "results/map, results/NAME-map[-HASH]")
    maps.set_defaults(command=_map)


def _map(options: argparse.Namespace) -> int:
    check_output(options)
    if options.scene is None and options.overrides:
        raise InputError(f"--set {options.overrides[0]}: must have a SCENE, for example hertz-shear")
    scene = None if options.scene is None else partialslip.load_scene(options.scene, options.overrides)
    name = "map" if scene is None else f"{scene.name}-map"

    from partialslip.cli.consoles import working
    from partialslip.study.map import place, stick_map, varying_map, write_map

    def find(folder: Path) -> Findings:
        with working(name) as tell:
            data = varying_map(scene, tell) if scene and scene.presses_anew else stick_map(scene, tell)
            return Findings(write_map(data, folder), printed=place(data))

    return present(options, "map", name, scene, find)
