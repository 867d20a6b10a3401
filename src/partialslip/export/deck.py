"""Keywords and data lines common to the input decks of Abaqus and CalculiX."""

import numpy as np

from partialslip.arrays import Array, Indices
from partialslip.export.model import Model, Step
from partialslip.scene import Scene


def heading(scene: Scene, model: Model, what: str) -> list[str]:
    """Comment lines of the deck: scene, mesh, sign of q, load steps, in the scene's units.

    ``scene`` and ``model``, in SI units, are exported; ``what`` names the format.
    """
    a, shown = model.a, scene.units.labelled
    varies = model.presses_anew
    where = f" at load point {scene.load.ends[scene.largest - 1] + 1}" if varies else ""

    def loads(step: Step) -> str:
        pressed = f"P = {shown(step.P, 'N/m', 10)}, " if varies else ""
        return f"{pressed}Q = {shown(step.Q, 'N/m', 10)}, sigma = {shown(step.sigma, 'Pa', 10)}"

    lines = [
        f"** {scene.name}: {what}, written by partialslip export",
        f"** expected a = {shown(a, 'm')}; f = {model.f:g}, P = {shown(scene.P, 'N/m', 10)}{where}",
        f"** elements of {model.size / a:g} a along the contact, blocks {model.width:g} a wide on either side",
    ]
    if model.stiffer != 1:
        lines += [
            f"** bodies {model.stiffer:g} times stiffer and the gap {model.stiffer:g} times flatter than the scene's:",
            "** the same tractions, without the geometric effects of sloping surfaces",
        ]
    lines += ["** q acts along x from the lower on the upper body: positive Q and sigma add up at x = a"]
    return lines + [f"** step {number}: {step.name}: {loads(step)}" for number, step in enumerate(model.steps, start=1)]


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
    result: Indices = (nodes + count * np.arange(sheets)[:, None]).ravel()
    return result


def rows(form: str, table: Array | Indices, first: int) -> list[str]:
    """Rows of ``table`` as lines with numbers from ``first``; ``form`` is the format of an entry."""
    line = ", ".join(["%d", *[form] * table.shape[1]])
    return [line % (number, *row) for number, row in enumerate(table.tolist(), start=first)]


def members(name: str, numbers: Indices) -> list[str]:
    """Lines of the node set ``name`` with node ``numbers``."""
    listed = numbers.tolist()
    return [f"*NSET, NSET={name}", *(", ".join(map(str, listed[i : i + 12])) for i in range(0, len(listed), 12))]


def tied(nodes: Indices) -> list[str]:
    """Equations that make all ``nodes`` move like the first."""
    first, *others = nodes.tolist()
    return [
        f"*EQUATION\n2\n{other}, {component}, 1., {first}, {component}, -1." for component in (1, 2) for other in others
    ]


def load_step(model: Model, number: int, frame: int, held: Indices, depth: float, also: str = "") -> list[str]:
    """Lines of a load step up to its loads.

    Parameters
    ----------
    model : Model
    number : int
        Index of the step.
    frame : int
        Node that moves the upper body's outer boundary.
    held : (k,) int array
        Nodes of the lower body's outer boundary, sheet by sheet.
    depth : float
        Factor of forces per unit depth.
    also : str
        Further boundary conditions.
    """
    step = model.steps[number]
    increment = 1.0 if number == 0 else 1.0 / model.substeps
    bulk = model.bulk(step)
    lines = [f"** {step.name}", "*STEP, INC=1000", "*STATIC", f"{increment:.6g}, 1., 1e-5, {increment:.6g}"]
    lines += ["*BOUNDARY, OP=NEW"] + [also] * bool(also)
    for node, (along, across) in zip(held.tolist(), np.tile(bulk, (len(held) // len(bulk), 1)).tolist(), strict=True):
        lines += [f"{node}, 1, 1, {along:.12e}", f"{node}, 2, 2, {across:.12e}"]
    if number == 0 or not model.f:  # without contact or friction nothing else holds the upper body along x
        lines += [f"{frame}, 1, 1"]
    lines += ["*CLOAD, OP=NEW", f"{frame}, 2, {-step.P * depth:.12e}"]
    return lines + [f"{frame}, 1, {-step.Q * depth:.12e}"] * (number > 0)
