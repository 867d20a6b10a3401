"""Input deck for CalculiX: one layer of bricks, held in plane strain."""

from typing import Literal

from partialslip.codes.export.inp_lines import FRAME, bodies, deck_heading, frame_of, load_step
from partialslip.codes.export.model import Model
from partialslip.scene import Scene
from partialslip.scene.units import SYSTEMS, Units

ContactElements = Literal["mortar", "penalty"]

# accuracy: Penalties, in E/a: pressure over overlap, and shear over slip in stick. With much stiffer penalties
# version 2.20 does not converge, or converges to q that is off by 16 %. Mortar elements take any; 1e3 would move ends
# by 1e-4 a.
_NORMAL = 1e3
_STICK = {"mortar": 1e5, "penalty": 1e2}

# limit: Mortar contact of version 2.20 is wrong, without a message, if elements are smaller than about one unit of
# length: a is off by 30 % at a = 1e-3 units, by 0.2 % at 1.
_LEAST = 100.0  # limit: least a in the unit of length of a deck

_RESULTS = """\
*NODE FILE, FREQUENCY=1000
U
*CONTACT FILE, FREQUENCY=1000
CDIS, CSTR
*NODE PRINT, NSET=LOWER_CONTACT, FREQUENCY=1000
RF
*NODE PRINT, NSET=UPPER_CONTACT, FREQUENCY=1000
RF
*END STEP"""


def deck_units(scene: Scene, model: Model) -> Units:
    """Units of the deck of ``model``: those of ``scene``, or with a smaller unit of length if a is less than 100 of
    its."""
    smaller = [units for units in SYSTEMS if units.size("m") <= scene.units.size("m")]
    return next((units for units in smaller if units.from_si(model.a, "m") >= _LEAST), smaller[-1])


def calculix_deck(
    scene: Scene, model: Model, contact: ContactElements = "mortar", reading: str | None = None
) -> list[str]:
    """Lines of the deck of ``model``, made from ``scene``: a slice as thick as the elements along the contact line.

    ``contact`` is "mortar", or "penalty" for surface-to-surface penalties. The last increment of each step is written:
    contact stresses CONTACT at the lower body's nodes and displacements to the .frd file, forces RF on the nodes of
    both contact lines to the .dat file. ``reading`` is the command that reads these results; by default
    ``partialslip score`` with the name of the scene.
    """
    reading = reading or f"partialslip score {scene.name} JOB.frd"
    units = deck_units(scene, model)
    lines = deck_heading(scene, model, "CalculiX deck")
    model = model.in_units(units)
    thickness = model.size
    small = "" if units == scene.units else ", as CalculiX's mortar contact errs where a is about a unit or less"
    lines += [
        f"** the deck is in {units.words}{small}",
        f"** a slice of thickness {thickness:.12e} {units.label('m')}: forces and energies per unit depth are its own "
        "over the thickness",
        f"** the results are read by {reading}: the names of the materials tell the units",
    ]
    blocks, starts = bodies(model, "C3D8", "", thickness, f"_{units.identifier}")
    frame = frame_of(model, starts[1], 2)
    lines += [*blocks, *_contact(model, contact)]
    lines += [f"** {FRAME}", *frame.lines()]
    for number in range(len(model.steps)):
        lines += load_step(model, number, frame, starts[0], 2, thickness, "LOWER, 3, 3\nUPPER, 3, 3")
        lines += [_RESULTS]
    return lines


def _contact(model: Model, contact: ContactElements) -> list[str]:
    unit = model.parts[1].E / model.a
    lines = ["*SURFACE INTERACTION, NAME=INTERFACE"]
    if contact == "mortar":
        kind, behavior = "MORTAR", ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD"]
    else:
        kind, behavior = (
            "SURFACE TO SURFACE",
            ["*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{_NORMAL * unit:.6e}"],
        )
    lines += behavior
    if model.f:
        lines += ["*FRICTION", f"{model.f:.12e}, {_STICK[contact] * unit:.6e}"]
    lines += [f"*CONTACT PAIR, INTERACTION=INTERFACE, TYPE={kind}", "LOWER_FACE, UPPER_FACE"]  # slave, master
    return lines
