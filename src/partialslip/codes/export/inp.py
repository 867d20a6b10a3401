"""Input decks for CalculiX and Abaqus, whose keywords are the same.

This project has never run those for Abaqus.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from partialslip.codes.export.load_steps import Step
from partialslip.codes.export.model import Model
from partialslip.scene import Scene
from partialslip.scene.units import SYSTEMS, Units
from partialslip.tools.arrays import Array, Indices

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
_UNTESTED = "** untested: made from the documentation of Abaqus, never run by this project"
_ABAQUS_RESULTS = """\
*CONTACT PRINT, SLAVE=LOWER_FACE, MASTER=UPPER_FACE, FREQUENCY=1000
CSTRESS
CDISP
*OUTPUT, FIELD, FREQUENCY=1000
*NODE OUTPUT
U, RF
*CONTACT OUTPUT
CSTRESS, CDISP, CFORCE
*END STEP"""


def deck_heading(scene: Scene, model: Model, what: str) -> list[str]:
    """Comment lines of the deck: scene, mesh, sign of q, load steps, in the scene's units.

    ``scene`` and ``model``, in SI units, are exported; ``what`` names the format.
    """
    a, shown = model.a, scene.units.labelled
    varies = model.presses_anew
    where = f" at load point {scene.load.ends[scene.largest - 1] + 1}" if varies else ""

    def loads(step: Step) -> str:
        pressed = f"P = {shown(step.P, 'N/m', 10)}, " if varies else ""
        pressed += f"M = {shown(step.M, 'N', 10)}, " if model.turns else ""
        return f"{pressed}Q = {shown(step.Q, 'N/m', 10)}, sigma = {shown(step.sigma, 'Pa', 10)}"

    lines = [
        f"** {scene.name}: {what}, written by partialslip export",
        f"** expected a = {shown(a, 'm', 2)}; f = {model.f:g}, P = {shown(scene.P, 'N/m', 10)}{where}",
        f"** elements of {model.size / a:g} a along the contact{_wide(scene, model)}",
    ]
    if model.stiffer != 1:
        lines += [
            f"** bodies {model.stiffer:g} times stiffer and the gap {model.stiffer:g} times flatter than the scene's:",
            "** the same tractions, without the geometric effects of sloping surfaces; slip and dissipated energy",
            f"** are {model.stiffer:g} times smaller than the scene's",
        ]
    lines += ["** q acts along x from the lower on the upper body: positive Q and sigma add up at x = a"]
    return lines + [f"** step {number}: {step.name}: {loads(step)}" for number, step in enumerate(model.steps, start=1)]


def _wide(scene: Scene, model: Model) -> str:
    """What a heading says of the blocks that stand for half-planes, if there are any."""
    if scene.bodies.lower and scene.bodies.upper:
        return ""
    return f", blocks {model.width:g} a wide on either side"


def bodies(
    model: Model, element: str, section: str, thickness: float | None = None, ending: str = ""
) -> tuple[list[str], list[int]]:
    """Nodes, elements, material, contact surface NAME_FACE and node sets NAME_OUTER and NAME_CONTACT of each body.

    Parameters
    ----------
    model : Model
    element : str
        Element type.
    section : str
        Text after the keyword *SOLID SECTION.
    thickness : float, optional
        Thickness of one layer of bricks between two plane meshes; the nodes of the second mesh follow those of the
        first. By default plane elements.
    ending : str
        End of the names of the materials.

    Returns
    -------
    list of str, list of int
        The lines, and the number of each body's first node.
    """
    lines, starts, first_element = [], [1], 1
    sides_from = 1 if thickness is None else 3  # the first two sides of a brick are the plane meshes
    for part in model.parts:
        name, points, quads = part.name.upper(), part.mesh.points, part.mesh.quads
        first, count, sheets = starts[-1], len(points), 1
        if thickness is not None:
            depth = np.repeat([0.0, thickness], count)
            points, quads, sheets = (
                np.column_stack([np.tile(points, (2, 1)), depth]),
                np.hstack([quads, quads + count]),
                2,
            )
        lines += [f"*NODE, NSET={name}", *rows("%.12e", points, first)]  # 20 characters at most
        lines += [f"*ELEMENT, TYPE={element}, ELSET={name}", *rows("%d", quads + first, first_element)]
        lines += [f"*MATERIAL, NAME={name}{ending}", "*ELASTIC", f"{part.E:.12e}, {part.nu:.12e}"]
        lines += [f"*SOLID SECTION, ELSET={name}, MATERIAL={name}{ending}{section}"]
        elements, sides = part.face
        lines += [f"*SURFACE, NAME={name}_FACE, TYPE=ELEMENT"]
        lines += [
            f"{e}, S{s}"
            for e, s in zip((elements + first_element).tolist(), (sides + sides_from).tolist(), strict=True)
        ]
        for line, nodes in {"OUTER": part.outer, "CONTACT": part.contact}.items():
            lines += members(f"{name}_{line}", sheeted(nodes, count, sheets) + first)
        starts.append(first + sheets * count)
        first_element += len(quads)
    return lines, starts[:-1]


def sheeted(nodes: Indices, count: int, sheets: int) -> Indices:
    """Repeat ``nodes`` for each of the ``sheets``, which have ``count`` nodes each."""
    return (nodes + count * np.arange(sheets)[:, None]).ravel()


def rows(form: str, table: Array | Indices, first: int) -> list[str]:
    """Rows of ``table`` as lines with numbers from ``first``; ``form`` is the format of an entry."""
    line = ", ".join(["%d", *[form] * table.shape[1]])
    return [line % (number, *row) for number, row in enumerate(table.tolist(), start=first)]


def members(name: str, numbers: Indices) -> list[str]:
    """Lines of the node set ``name`` with node ``numbers``."""
    listed = numbers.tolist()
    return [f"*NSET, NSET={name}", *(", ".join(map(str, listed[i : i + 12])) for i in range(0, len(listed), 12))]


FRAME = "the upper body's outer boundary is a rigid frame, moved by its first node"


@dataclass(frozen=True)
class Frame:
    """Rigid frame that moves the upper body.

    Parameters
    ----------
    along_x, along_y : (k,) int array
        Numbers of the nodes that move together along x, and along y; Q and P act on the first.
    turn : int, optional
        Number of the node whose displacement along x is the frame's angle times ``arm``, where the frame turns about
        the origin. The first nodes of the frame are then a node at the origin.
    arm : float
    arms : two of (k,) float array, optional
        y of the nodes ``along_x`` and x of the nodes ``along_y``, where the frame turns.
    """

    along_x: Indices
    along_y: Indices
    turn: int | None = None
    arm: float = 1.0
    arms: tuple[Array, Array] | None = None

    def lines(self) -> list[str]:
        """Equations that make the nodes move as the frame."""
        if self.arms is None:
            return [*_tied(self.along_x, 1), *_tied(self.along_y, 2)]
        ys, xs = self.arms
        origin = [f"*NODE, NSET=FRAME\n{self.along_x[0]}, 0., 0., 0.", f"*NODE, NSET=TURN\n{self.turn}, 0., 0., 0."]
        note = "** displacement of TURN along x: angle of the frame times the expected a"
        return [*origin, note, *self._turned(self.along_x, 1, -ys), *self._turned(self.along_y, 2, xs)]

    def _turned(self, nodes: Indices, component: int, arms: Array) -> list[str]:
        first, *others = nodes.tolist()
        return [
            f"*EQUATION\n3\n{other}, {component}, 1., {first}, {component}, -1., {self.turn}, 1, {-by / self.arm:.12e}"
            for other, by in zip(others, arms[1:].tolist(), strict=True)
        ]


def _tied(nodes: Indices, component: int) -> list[str]:
    """Equations that make all ``nodes`` move like the first."""
    first, *others = nodes.tolist()
    return [f"*EQUATION\n2\n{other}, {component}, 1., {first}, {component}, -1." for other in others]


def frame_of(model: Model, start: int, sheets: int = 1) -> Frame:
    """Frame of the upper body of ``model``, whose first node has the number ``start``, in so many ``sheets``."""
    points, held = model.parts[1].mesh.points, model.parts[1].held_nodes
    along_x, along_y = (sheeted(nodes, len(points), sheets) + start for nodes in held)
    if not model.turns:
        return Frame(along_x, along_y)
    origin = start + sheets * len(points)
    ys, xs = (np.append(0.0, np.tile(points[nodes, 1 - i], sheets)) for i, nodes in enumerate(held))
    return Frame(np.append(origin, along_x), np.append(origin, along_y), origin + 1, model.a, (ys, xs))


def load_step(
    model: Model, number: int, frame: Frame, start: int, sheets: int, depth: float, also: str = ""
) -> list[str]:
    """Lines of a load step up to its loads.

    Parameters
    ----------
    model : Model
    number : int
        Index of the step.
    frame : Frame
        Frame that moves the upper body.
    start : int
        Number of the lower body's first node.
    sheets : int
        Number of plane meshes of a body.
    depth : float
        Factor of forces per unit depth.
    also : str
        Further boundary conditions.
    """
    step, lower = model.steps[number], model.parts[0]
    increment = 1.0 / step.increments
    lines = [f"** {step.name}", "*STEP, INC=1000", "*STATIC", f"{increment:.6g}, 1., 1e-5, {increment:.6g}"]
    lines += ["*BOUNDARY, OP=NEW"] + [also] * bool(also)
    held, count = [np.isin(lower.outer, nodes).tolist() for nodes in lower.held_nodes], len(lower.mesh.points)
    moved = list(zip(lower.outer.tolist(), *held, model.bulk(step).tolist(), strict=True))
    for sheet in range(sheets):
        for node, along_x, along_y, (along, across) in moved:
            named = node + sheet * count + start
            lines += [f"{named}, 1, 1, {along:.12e}"] * along_x + [f"{named}, 2, 2, {across:.12e}"] * along_y
    if step.guided:
        lines += [f"{frame.along_x[0]}, 1, 1"]
    lines += ["*CLOAD, OP=NEW", f"{frame.along_y[0]}, 2, {-step.P * depth:.12e}"]
    lines += [f"{frame.along_x[0]}, 1, {-step.Q * depth:.12e}"] * (number > 0)
    if frame.turn is not None:
        lines += [f"{frame.turn}, 1, {-step.M / frame.arm * depth:.12e}"]
    pull = lower.pull * (step.sigma * depth / sheets)
    return lines + [
        f"{node + sheet * count + start}, 1, {pull[node]:.12e}"
        for sheet in range(sheets)
        for node in np.flatnonzero(pull).tolist()
    ]


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
    lines += [*blocks, *_contact_cards(model, contact)]
    lines += [f"** {FRAME}", *frame.lines()]
    for number in range(len(model.steps)):
        lines += load_step(model, number, frame, starts[0], 2, thickness, "LOWER, 3, 3\nUPPER, 3, 3")
        lines += [_RESULTS]
    return lines


def _contact_cards(model: Model, contact: ContactElements) -> list[str]:
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
        lines += [*load_step(model, number, frame, lower, 1, 1.0), _ABAQUS_RESULTS]
    return lines
