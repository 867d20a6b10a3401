"""What the input decks of Abaqus and CalculiX have in common: keywords, and lines of numbers under them."""

import numpy as np

from partialslip.arrays import Array, Indices
from partialslip.export.model import Model
from partialslip.scene import Scene


def heading(scene: Scene, model: Model, what: str) -> list[str]:
    """Comments that say what the deck is, and how its tractions are to be read."""
    a = model.a
    lines = [
        f"** {scene.name}: {what}, written by partialslip export",
        f"** expected a = {a:.6g} m; f = {model.f:g}, P = {scene.P:.10g} N/m",
        f"** elements of {model.size / a:g} a along the contact, blocks {model.width:g} a wide on either side",
    ]
    if model.stiffer != 1:
        lines += [
            f"** bodies {model.stiffer:g} times stiffer and the gap {model.stiffer:g} times flatter than the scene's:",
            "** the same tractions, without the geometric effects of sloping surfaces",
        ]
    lines += ["** q is what the lower body puts on the upper one along x: positive Q and sigma add up at x = a"]
    return lines + [
        f"** step {number}: {step.name}: Q = {step.Q:.10g} N/m, sigma = {step.sigma:.10g} Pa"
        for number, step in enumerate(model.steps, start=1)
    ]


def bodies(model: Model, element: str, section: str, thickness: float | None = None) -> tuple[list[str], list[int]]:
    """Nodes, elements, material, contact surface NAME_FACE and node sets NAME_OUTER and NAME_CONTACT of each body.

    Of a plane mesh, or, with a ``thickness``, of one layer of bricks between two such: then nodes of the second follow
    those of the first. ``section`` follows the keyword *SOLID SECTION. Returns the lines, and the number of each body's
    first node.
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
        lines += [f"*MATERIAL, NAME={name}", "*ELASTIC", f"{part.E:.12e}, {part.nu:.12e}"]
        lines += [f"*SOLID SECTION, ELSET={name}, MATERIAL={name}{section}"]
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
    """``nodes`` of each of the sheets, of ``count`` nodes each."""
    result: Indices = (nodes + count * np.arange(sheets)[:, None]).ravel()
    return result


def rows(form: str, table: Array | Indices, first: int) -> list[str]:
    """Numbered lines: from ``first`` on, each with its row of the table."""
    line = ", ".join(["%d", *[form] * table.shape[1]])
    return [line % (number, *row) for number, row in enumerate(table.tolist(), start=first)]


def members(name: str, numbers: Indices) -> list[str]:
    """A named set of nodes."""
    listed = numbers.tolist()
    return [f"*NSET, NSET={name}", *(", ".join(map(str, listed[i : i + 12])) for i in range(0, len(listed), 12))]


def tied(nodes: Indices) -> list[str]:
    """Equations: all ``nodes`` move as the first one does."""
    first, *others = nodes.tolist()
    return [
        f"*EQUATION\n2\n{other}, {component}, 1., {first}, {component}, -1." for component in (1, 2) for other in others
    ]


def load_step(model: Model, number: int, frame: int, held: Indices, depth: float, also: str = "") -> list[str]:
    """The step of that number up to its loads: ``held`` are the nodes of the lower body's outer boundary, sheet by
    sheet, ``frame`` the node that moves the upper's, ``depth`` what forces per unit depth are multiplied by; ``also``
    are further boundary conditions."""
    step = model.steps[number]
    increment = 1.0 if number == 0 else 1.0 / model.substeps
    bulk = model.bulk(step)
    lines = [f"** {step.name}", "*STEP, INC=1000", "*STATIC", f"{increment:.6g}, 1., 1e-5, {increment:.6g}"]
    lines += ["*BOUNDARY, OP=NEW"] + [also] * bool(also)
    for node, (along, across) in zip(held.tolist(), np.tile(bulk, (len(held) // len(bulk), 1)).tolist(), strict=True):
        lines += [f"{node}, 1, 1, {along:.12e}", f"{node}, 2, 2, {across:.12e}"]
    if number == 0:  # without shear nothing pushes it aside, and nothing would hold it before there is contact
        lines += [f"{frame}, 1, 1"]
    lines += ["*CLOAD, OP=NEW", f"{frame}, 2, {-step.P * depth:.12e}"]
    return lines + [f"{frame}, 1, {-step.Q * depth:.12e}"] * (number > 0)
