"""A scene as a finite-element model that any code can be given: two meshed blocks, materials, and load steps.

The blocks stand for half-planes, as with ``fem.far_field = "box"``: the outer boundary of the upper one moves as a
rigid frame, on which P and Q act; that of the lower one is held, and moves as the bulk tension alone would move it.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from partialslip.arrays import Array
from partialslip.errors import InputError
from partialslip.halfplane.contact import contact
from partialslip.scene import Constants, Scene

if TYPE_CHECKING:
    from partialslip_meshes import QuadMesh

SIZE, GROWTH = 0.05, 0.1
Indices = npt.NDArray[np.int64]

_REACH = 1.2  # half-widths: of the line that may come into contact
_OVERLAP = 0.25  # of the gap at the contact's end: how deep the bodies begin within each other
_WIDE = 50.0


class Step(NamedTuple):
    """What acts at the end of a load step: P, Q (N/m) and sigma (Pa)."""

    name: str
    P: float
    Q: float
    sigma: float


@dataclass(frozen=True)
class Part:
    """A body in plane strain: its name, mesh (m), Young's modulus (Pa) and Poisson's ratio."""

    name: str
    mesh: "QuadMesh"
    E: float
    nu: float

    @property
    def outer(self) -> Indices:
        """Indices of the nodes of the outer boundary, ascending."""
        return np.unique(np.vstack([self.mesh.lines[line] for line in ("back", "left", "right")]))

    @property
    def contact(self) -> Indices:
        """Indices of the nodes of the contact line, ascending."""
        return np.unique(self.mesh.lines["contact"])

    @property
    def face(self) -> tuple[Indices, Indices]:
        """The elements on the contact line and the number of the side (0 to 3, from its corner of that number to the
        next) that they have on it."""
        sides = np.sort(np.stack([self.mesh.quads, np.roll(self.mesh.quads, -1, axis=1)], axis=-1), axis=-1)
        count = len(self.mesh.points)
        line = np.sort(self.mesh.lines["contact"], axis=1) @ [count, 1]
        elements, side = np.nonzero(np.isin(sides @ [count, 1], line))
        return elements, side


@dataclass(frozen=True)
class Model:
    """Of the scene ``name``: ``parts`` are the lower and the upper body; ``steps`` what happens to them, in
    ``substeps`` increments each but the first; ``a`` (m) the half-width that is expected, ``size`` (m) the elements'
    along the contact, ``width`` that of the blocks on either side in ``a``, ``f`` the coefficient of friction; bodies
    are so many times ``stiffer`` than the scene's."""

    name: str
    parts: tuple[Part, Part]
    f: float
    steps: tuple[Step, ...]
    substeps: int
    a: float
    size: float
    width: float
    stiffer: float

    def bulk(self, step: Step) -> Array:
        """Displacements (k, 2) of the lower body's outer nodes under the bulk tension of ``step``, m."""
        lower = self.parts[0]
        strain = (1 + lower.nu) / lower.E * step.sigma * np.array([1 - lower.nu, -lower.nu])
        moved: Array = lower.mesh.points[lower.outer] * strain
        return moved

    def in_unit(self, length: float) -> "Model":
        """The same in another unit of ``length`` (m), forces in N."""

        def scaled(part: Part) -> Part:
            return replace(part, mesh=replace(part.mesh, points=part.mesh.points / length), E=part.E * length**2)

        lower, upper = self.parts
        steps = (Step(name, P * length, Q * length, sigma * length**2) for name, P, Q, sigma in self.steps)
        parts = scaled(lower), scaled(upper)
        return replace(self, parts=parts, steps=tuple(steps), a=self.a / length, size=self.size / length)


def modelled(
    scene: Scene,
    size: float = SIZE,
    width: float | None = None,
    growth: float = GROWTH,
    stiffer: float = 1.0,
    ends: Sequence[float] = (),
    fine: float | None = None,
) -> Model:
    """Mesh a scene and list its load steps.

    Parameters
    ----------
    scene : Scene
        Of half-planes of one material.
    size : float
        Of the elements along the contact, in contact half-widths a.
    width : float, optional
        Half-width and height of the blocks, in a. They are wrong by about 10 (a/width)^2 of q; without a width that
        is a small part of what the elements are wrong by.
    growth : float
        Element size gained per unit of distance from the contact.
    stiffer : float
        Both bodies so many times stiffer, and the gap so many times flatter: in linear elasticity no traction changes,
        while what the slope of the surfaces does beyond it goes.
    ends : sequence of float
        Points on the contact line, in a, towards which the elements get finer, as they do towards kinks of the gap:
        down to ``fine`` (a), by default a tenth of ``size``.

    Raises
    ------
    InputError
        If the bodies have a size or materials of their own, or the loads are more than friction holds.
    """
    if scene.finite:
        raise InputError("bodies: must be left out; only half-planes can be exported")
    f, P = scene.friction.f, scene.P
    if any(abs(Q) >= f * P for Q, _ in scene.load.points if Q) or (f == 0 and scene.load.dsigma):
        raise InputError(f"load.Q: must be within f P = {f * P:g}; beyond it the contact slides and has no equilibrium")
    pressed = contact(scene)
    a = pressed.a
    kinks = [kink / a for kink in scene.profile.kinks if abs(kink) < _REACH * a]
    points = dict.fromkeys([*ends, *kinks], fine if fine is not None else size / 10)
    wide = width if width is not None else _WIDE / min([size, *points.values()]) ** 0.5

    from partialslip_meshes import quad_block

    def mesh(fineness: float) -> "QuadMesh":
        sizes = {x: least * fineness for x, least in points.items()}
        scaled = quad_block(wide, (-_REACH, _REACH), sizes, growth * fineness, size * fineness)
        return replace(scaled, points=scaled.points * a)

    lower, upper = (
        Part(name, each, stiffer * E, nu)
        for name, each, (E, nu) in (
            ("lower", mesh(scene.fem.lower_size), _in_plane_strain(scene.material.bodies[0])),
            ("upper", _upper(mesh(1.0), scene, a, stiffer), _in_plane_strain(scene.material.bodies[1])),
        )
    )
    return Model(scene.name, (lower, upper), f, _steps(scene), scene.load.steps, a, size * a, wide, stiffer)


def _in_plane_strain(body: Constants) -> tuple[float, float]:
    """E and nu that a body has in plane strain: its own, or, in plane stress, those that give the same plane fields."""
    nu = (3 - body.kappa) / 4
    return 2 * body.mu * (1 + nu), nu


def _upper(mesh: "QuadMesh", scene: Scene, a: float, stiffer: float) -> "QuadMesh":
    """The mirror image of ``mesh``, its face shaped by the profile; that fades out upwards. Beyond the contact line the
    gap stays as it is at its end. The bodies begin a little within each other, so that none of them is loose."""
    x, y = mesh.points[:, 0], -mesh.points[:, 1]
    gap = scene.profile.gap_at(np.clip(x, -_REACH * a, _REACH * a)) - _OVERLAP * scene.profile.gap_at(np.array(a))
    shaped = np.column_stack([x, y + gap / stiffer * (1 - y / y.max())])
    lines = {name: line[:, ::-1] for name, line in mesh.lines.items()}
    return replace(mesh, points=shaped, quads=mesh.quads[:, ::-1], lines=lines)


def _steps(scene: Scene) -> tuple[Step, ...]:
    """Pressing, and then from load point to load point: the last, and all of them in every cycle."""
    load, P = scene.load, scene.P
    if not (load.dQ or load.dsigma or any(map(any, load.points))):
        return (Step("press", P, 0.0, 0.0),)
    count = len(load.points)
    visits = [(f"load point {count}, first time", load.points[-1])]
    visits += [
        (f"cycle {cycle}, load point {number}", point)
        for cycle in range(1, load.cycles + 1)
        for number, point in enumerate(load.points, start=1)
    ]
    return (Step("press", P, 0.0, 0.0), *(Step(name, P, Q, sigma) for name, (Q, sigma) in visits))
