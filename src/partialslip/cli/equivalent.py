"""partialslip equivalent: characterise the bodies of a scene as half-planes with other data."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

import partialslip
from partialslip.cli.common import Commands, add_out, add_scene, check_output, naming
from partialslip.cli.findings import Findings, present

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from partialslip.march.equivalent import Share
    from partialslip.report.page import Section
    from partialslip.scene.units import Units

RIG, SCENE = "rig.json", "half-planes.toml"


def add(commands: Commands) -> None:
    """Add the command to the parser of ``commands``."""
    equivalents = commands.add_parser(
        "equivalent",
        help="find half-planes that act like the bodies of a scene",
        description="Find what the size and the supports of the bodies change: curvature and tilt of the gap, bulk "
        f"tension. Write {RIG}, for bodies.equivalent in scenes with the same bodies, and {SCENE}, a scene of "
        "half-planes with these data.",
        examples=[
            "partialslip equivalent my-rig.toml",
            "partialslip equivalent my-rig.toml --set load.P=2e5 --out rigs",
        ],
    )
    add_scene(equivalents)
    add_out(equivalents, "results/NAME-equivalent[-HASH]")
    equivalents.set_defaults(command=_equivalent)


def _equivalent(options: argparse.Namespace) -> int:
    check_output(options)
    scene = partialslip.load_scene(options.scene, options.overrides)

    from partialslip.cli.consoles import working
    from partialslip.march.equivalent import in_words, shares, stand_ins
    from partialslip.result.rig import write_rig
    from partialslip.run import rig_of
    from partialslip.scene.reading import scene_toml
    from partialslip.tools.output.files import write_files

    with working(scene.name) as tell, naming(options.scene):
        rig = rig_of(scene)
        found = stand_ins(scene, rig, tell)
    named = found.scene.replace(name=f"{scene.name}-half-planes", title=f"Half-planes that act like {scene.name}"[:200])
    printed: list[str | Section] = [
        *([f"{scene.name}: {rig.note}"] if rig.note else []),
        f"{scene.name}: {in_words(scene, found.scene, found.data)}",
        "\nThe half-planes gain, where tractions act at x = 0:",
        _gains(shares(rig, scene), scene.units),
        f"The data hold where |x| <= {scene.units.length(rig.reach)}.",
    ]

    def find(folder: Path) -> Findings:
        files: dict[str, Callable[[Path], object]] = {
            RIG: lambda path: write_rig(rig, path),
            SCENE: lambda path: path.write_text(scene_toml(named), "utf-8"),
        }
        return Findings(write_files(folder, files), printed=printed)

    return present(options, "equivalent", f"{scene.name}-equivalent", scene, find)


def _gains(found: "Sequence[Share]", units: "Units") -> "Section":
    """Return the table of what loads add to half-planes, in ``units``; in SI units with prefixes."""
    from partialslip.report.page import Section
    from partialslip.scene.units import SI

    force = "kN/m" if units == SI else units.label("N/m")  # 1 N/mm is as much
    rows = []
    for share in found:
        name, size = ("1 MPa of sigma", 1e6) if share.load == "sigma" else (f"1 {force} of {share.load}", 1e3)
        curvature = (share.curvature, f"1/{units.label('m')}", 1 / units.size("m"))
        gains = [curvature, (share.tilt, "rad", 1.0), (share.sigma, "MPa", 1e6)]
        gains.append((share.sigma_slope, "MPa/mm", 1e9))
        rows.append((name, *(f"{size * gain / unit:.4g} {label}" for gain, label, unit in gains)))
    return Section("", headings=("load", "curvature", "tilt", "tension", "its slope"), rows=rows)
