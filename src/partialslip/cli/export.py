"""partialslip export: write a scene as a model for another code."""

import argparse
from pathlib import Path

import partialslip
from partialslip.cli.common import Commands, add_out, add_scene, print_written, request
from partialslip.tools.errors import InputError

_TO = ("calculix", "abaqus", "gmsh", "moose", "code-aster")


def add(commands: Commands) -> None:
    """Add the command to the parser of ``commands``."""
    exports = commands.add_parser(
        "export",
        help="write a scene as a model for another code",
        description="Mesh both bodies of a scene and write a model for another code, with contact, friction and load "
        "steps. Compare the results with partialslip score.",
        examples=[
            "partialslip export hertz-small-tension --to calculix --size 0.025 -o hertz.inp",
            "partialslip export fretting-aluminium --to abaqus --stiffer 100 --set shown_in=N-mm",
            "partialslip export flat-rounded --to gmsh",
        ],
    )
    add_scene(exports)
    exports.add_argument("--to", required=True, choices=_TO,
                         help="calculix: an input deck; gmsh: the meshes of both bodies; abaqus: an input deck, and "
                         "moose, code-aster: an archive with a deck, that this project has never run")  # fmt: skip
    exports.add_argument("--size", metavar="H", default=0.05,
                         help="element size along the contact, in contact half-widths, if P varies in those of the "
                         "smallest contact (default: 0.05)")  # fmt: skip
    exports.add_argument("--growth", metavar="G", default=0.1,
                         help="growth of the element size per unit of distance from the contact (default: "
                         "0.1)")  # fmt: skip
    exports.add_argument("--width", metavar="W",
                         help="width of the blocks on either side of the contact, in contact half-widths (default: "
                         "wide enough for --size)")  # fmt: skip
    exports.add_argument("--stiffer", metavar="K", default=1.0,
                         help="make bodies K times stiffer and the gap K times flatter: same tractions, but smaller "
                         "slopes of the surfaces, which half-planes neglect (default: 1)")  # fmt: skip
    exports.add_argument("--ends", metavar="X,...",
                         help="points on the contact, in contact half-widths, at which the mesh is refined: "
                         "--ends=-1,-0.8,0.2,1")  # fmt: skip
    exports.add_argument("--fine", metavar="H",
                         help="element size at --ends, in the half-widths of --size (default: a tenth of "
                         "--size)")  # fmt: skip
    exports.add_argument("--penalty", action="store_true",
                         help="calculix: penalty contact instead of mortar contact")  # fmt: skip
    add_out(exports, "results/NAME-TO[-HASH].inp, .msh or .zip", "-o", what="file to write", metavar="FILE")
    exports.set_defaults(command=_export)


def _export(options: argparse.Namespace) -> int:
    from partialslip.cli.consoles import output
    from partialslip.codes.export import FORMATS, export
    from partialslip.tools.output.place import write_placed

    if options.out == "":
        raise InputError("--out '': must name a file")
    size, growth, stiffer = (
        _number_within(getattr(options, name), f"--{name}", least, most)
        for name, least, most in (("size", 1e-4, 0.5), ("growth", 0.01, 1.0), ("stiffer", 1.0, 1e4))
    )
    width = None if options.width is None else _number_within(options.width, "--width", 4, 1e6)
    ends = [_number_within(end, "--ends", -1.1, 1.1) for end in options.ends.split(",")] if options.ends else []
    fine = None if options.fine is None else _number_within(options.fine, "--fine", 1e-6, size)
    scene = partialslip.load_scene(options.scene, options.overrides)
    write = export(
        scene,
        options.to,
        size=size,
        width=width,
        growth=growth,
        stiffer=stiffer,
        ends=ends,
        fine=fine,
        penalty=options.penalty,
    )
    usual = Path("results") / f"{scene.name}-{options.to}{FORMATS[options.to]}"
    known = {"size": size, "growth": growth, "width": width, "stiffer": stiffer, "ends": ends or None, "fine": fine}
    asked = request(options, "export", scene, known, lambda: {"to": options.to})
    path, elsewhere = write_placed(usual, options.out, asked, write, options.force)
    print_written([path], output(), elsewhere)
    return 0


def _number_within(text: str | float, option: str, least: float, most: float) -> float:
    try:
        number = float(text)
    except ValueError:
        number = float("nan")
    if not least <= number <= most:
        raise InputError(f"{option} {text!r}: must be a number from {least:g} to {most:g}")
    return number
