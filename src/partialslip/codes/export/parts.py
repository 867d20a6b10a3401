"""The two bodies of a scene as meshes of quadrilaterals, with their materials and supports."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from partialslip.scene import Constants, Scene
from partialslip.tools.arrays import Array, Indices

if TYPE_CHECKING:
    from partialslip_fem.problem import Part as Shape
    from partialslip_meshes import QuadMesh


_CORNERS = 1e-3  # accuracy: largest change of the contact by the elements at corners of finite bodies, relative


@dataclass(frozen=True)
class MeshedBody:
    """A body in plane strain.

    Parameters
    ----------
    name : str
        "lower" or "upper".
    mesh : QuadMesh
        Lengths in m.
    E, nu : float
        Young's modulus, Pa, and Poisson's ratio.
    held : two of sequence of str
        Lines of the mesh that are held along x, and along y; on the upper body they move as a rigid frame.
    pulled : bool
        Whether the bulk tension acts as a traction on the right side.
    """

    name: str
    mesh: "QuadMesh"
    E: float
    nu: float
    held: tuple[tuple[str, ...], tuple[str, ...]]
    pulled: bool = False

    @property
    def held_nodes(self) -> tuple[Indices, Indices]:
        """Indices of the nodes held along x, and of those held along y, ascending."""
        along_x, along_y = (np.unique(np.vstack([self.mesh.lines[line] for line in lines])) for lines in self.held)
        return along_x, along_y

    @property
    def outer(self) -> Indices:
        """Indices of all held nodes, ascending."""
        return np.union1d(*self.held_nodes)

    @property
    def contact(self) -> Indices:
        """Indices of the nodes of the contact line, ascending."""
        return np.unique(self.mesh.lines["contact"])

    @property
    def face(self) -> tuple[Indices, Indices]:
        """Elements on the contact line, and the side of each on the line: side k goes from corner k to the next."""
        sides = np.sort(np.stack([self.mesh.quads, np.roll(self.mesh.quads, -1, axis=1)], axis=-1), axis=-1)
        count = len(self.mesh.points)
        line = np.sort(self.mesh.lines["contact"], axis=1) @ [count, 1]
        elements, side = np.nonzero(np.isin(sides @ [count, 1], line))
        return elements, side

    @property
    def strained(self) -> Array:
        """Strains along x and y under a unit bulk tension of a long body, (2,), 1/Pa; zero if the body is pulled."""
        return (1 + self.nu) / self.E * np.array([1 - self.nu, -self.nu]) * (not self.pulled)

    @property
    def pull(self) -> Array:
        """Nodal forces along x of a unit bulk tension, (n,), m: on the right side of a pulled body, otherwise on all
        sides that are free along x, so that the body is in uniform tension."""
        free = ("right",) if self.pulled else [name for name in self.mesh.lines if name not in self.held[0]]
        edges = np.vstack([self.mesh.lines[name] for name in free if name != "contact"])
        rise = np.diff(self.mesh.points[edges, 1], axis=1)  # the body is on the left of its boundary
        forces = np.zeros(len(self.mesh.points))
        np.add.at(forces, edges, rise / 2)
        return forces


def flat_parts(
    scene: Scene, a: float, reach: float, width: float, sizes: Mapping[float, float], growth: float, along: float,
    stiffer: float = 1.0,
) -> tuple[MeshedBody, MeshedBody]:  # fmt: skip
    """The lower and the upper body of ``scene``, both below the line y = 0, on which their contact lines lie.

    A pad is flat along the contact line, and has its true shape beyond.

    Parameters
    ----------
    scene : Scene
    a : float
        Unit of the following lengths, m.
    reach : float
        Half-width of the contact line.
    width : float
        Half-width and height of blocks that stand for half-planes.
    sizes : mapping of float to float
        Element size by point on the contact line.
    growth, along : float
        Growth of the element size with distance, and element size along the contact line.
    stiffer : float
        Factor of the stiffness.

    Raises
    ------
    InputError
        If the contact line does not fit on a finite body.
    """
    from partialslip_fem.problem import parts_of

    shapes = parts_of(scene, a)
    constants = map(_in_plane_strain, scene.material.bodies)
    lower, upper = (
        MeshedBody(
            shape.name,
            _mesh(shape, a, reach, width, _times(shape.fineness, sizes), growth, shape.fineness * along),
            stiffer * E,
            nu,
            _held_sides(shape),
            shape.pulled,
        )
        for shape, (E, nu) in zip(shapes, constants, strict=True)
    )
    return lower, upper


def _times(fineness: float, sizes: Mapping[float, float]) -> dict[float, float]:
    return {point: fineness * size for point, size in sizes.items()}


def _held_sides(shape: "Shape") -> tuple[tuple[str, ...], tuple[str, ...]]:
    along_x, along_y = shape.held
    return tuple(along_x), tuple(along_y)


def _mesh(
    shape: "Shape", a: float, reach: float, width: float, sizes: Mapping[float, float], growth: float, along: float
) -> "QuadMesh":
    """Mesh of a body, its contact line on y = 0; lengths in ``a`` become m."""
    from partialslip_meshes import quad_block

    fine = shape.fineness
    finer, face = {x: size * fine for x, size in sizes.items()}, shape.face
    half, height = shape.extent or (width, width)
    scaled = quad_block(
        half, (-reach, reach), finer, growth * fine, along * fine, height, shape.holder,
        (lambda x: face(x) - face(np.clip(x, -reach, reach))) if face else None,
        shape.corners(_CORNERS) if shape.extent else None,
    )  # fmt: skip
    return replace(scaled, points=scaled.points * a)


def _in_plane_strain(body: Constants) -> tuple[float, float]:
    """E (Pa) and nu in plane strain that give the same plane fields as ``body``."""
    nu = (3 - body.kappa) / 4
    return 2 * body.mu * (1 + nu), nu
