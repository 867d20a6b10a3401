"""Input deck for Abaqus/Standard: plane strain, depth 1, so that forces are per unit depth.

This project has never run it."""

from partialslip.codes.export.inp_lines import FRAME, bodies, deck_heading, frame_of, load_step
from partialslip.codes.export.model import Model
from partialslip.scene import Scene

_UNTESTED = "** untested: made from the documentation of Abaqus, never run by this project"
_RESULTS = """\
*CONTACT PRINT, SLAVE=LOWER_FACE, MASTER=UPPER_FACE, FREQUENCY=1000
CSTRESS
CDISP
*OUTPUT, FIELD, FREQUENCY=1000
*NODE OUTPUT
U, RF
*CONTACT OUTPUT
CSTRESS, CDISP, CFORCE
*END STEP"""


def abaqus_deck(scene: Scene, model: Model) -> list[str]:
    """Lines of the deck of ``model``, made from ``scene``.

    Elements CPE4; small sliding, surface to surface; hard contact enforced directly; friction by Lagrange multipliers.
    At the end of each step contact stresses and nodal contact forces go to the .dat and the .odb file.
    """
    lines = [
        "*HEADING",
        f"{scene.name}, untested",
        _UNTESTED,
        *deck_heading(scene, model, f"Abaqus deck in {scene.units.words}"),
    ]
    model = model.in_units(scene.units)
    blocks, (lower, upper) = bodies(model, "CPE4", "\n1.,")
    lines += [*blocks, "*SURFACE INTERACTION, NAME=INTERFACE", "1."]
    lines += ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD, DIRECT"]
    if model.f:
        lines += ["*FRICTION, LAGRANGE", f"{model.f:.12e}"]
    lines += ["*CONTACT PAIR, INTERACTION=INTERFACE, TYPE=SURFACE TO SURFACE, SMALL SLIDING"]
    lines += ["LOWER_FACE, UPPER_FACE"]  # slave, master
    frame = frame_of(model, upper)
    lines += [f"** {FRAME}", *frame.lines()]
    for number in range(len(model.steps)):
        lines += [*load_step(model, number, frame, lower, 1, 1.0), _RESULTS]
    return lines
