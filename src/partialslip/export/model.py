"""A scene as a finite-element model for any code: two meshed blocks, materials, and load steps.

The blocks stand for half-planes, as with ``fem.far_field = "box"``. The outer boundary of the upper block moves as a
rigid frame, on which P and Q act. The outer boundary of the lower block has the displacements of the bulk tension.
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
from partialslip.units import Units

if TYPE_CHECKING:
    from partialslip_meshes import QuadMesh

SIZE, GROWTH = 0.05, 0.1
Indices = npt.NDArray[np.int64]

_REACH = 1.2  # half-width of the contact line, in the half-width of the largest contact
_OVERLAP = 0.25  # initial overlap of the bodies, in the gap at the end of the smallest contact
_WIDE = 50.0  # half-width of the blocks in a, times the square root of the smallest element in a


class Step(NamedTuple):
    """Loads at the end of the load step ``name``: ``P``, ``Q`` (N/m) and ``sigma`` (Pa)."""

    name: str
    P: float
    Q: float
    sigma: float


@dataclass(frozen=True)
class Part:
    """A body in plane strain: ``name``, ``mesh`` (m), Young's modulus ``E`` (Pa) and Poisson's ratio ``nu``."""

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
        """Elements on the contact line, and the side of each on the line: side k goes from corner k to the next."""
        sides = np.sort(np.stack([self.mesh.quads, np.roll(self.mesh.quads, -1, axis=1)], axis=-1), axis=-1)
        count = len(self.mesh.points)
        line = np.sort(self.mesh.lines["contact"], axis=1) @ [count, 1]
        elements, side = np.nonzero(np.isin(sides @ [count, 1], line))
        return elements, side


@dataclass(frozen=True)
class Model:
    """A finite-element model of a scene, in SI units until :meth:`in_units` converts the model.

    Parameters
    ----------
    name : str
        Of the scene.
    parts : two of Part
        The lower and the upper body.
    f : float
        Coefficient of friction.
    steps : tuple of Step
        Load steps.
    substeps : int
        Increments of each step except the first.
    a : float
        Expected contact half-width at the load point with the larger P, m.
    size : float
        Element size along the contact line, m.
    width : float
        Half-width of the blocks, in ``a``.
    stiffer : float
        Stiffness of the bodies, in the scene's.
    """

    name: str
    parts: tuple[Part, Part]
    f: float
    steps: tuple[Step, ...]
    substeps: int
    a: float
    size: float
    width: float
    stiffer: float

    @property
    def presses_anew(self) -> bool:
        """Whether P varies."""
        return len({step.P for step in self.steps}) > 1

    def bulk(self, step: Step) -> Array:
        """Displacements of the lower body's outer nodes under the bulk tension of ``step``, (k, 2), m."""
        lower = self.parts[0]
        strain = (1 + lower.nu) / lower.E * step.sigma * np.array([1 - lower.nu, -lower.nu])
        moved: Array = lower.mesh.points[lower.outer] * strain
        return moved

    def in_units(self, units: Units) -> "Model":
        """Convert the model from SI to ``units``."""
        of = units.from_si

        def converted(part: Part) -> Part:
            return replace(part, mesh=replace(part.mesh, points=of(part.mesh.points, "m")), E=of(part.E, "Pa"))

        lower, upper = self.parts
        steps = (Step(name, of(P, "N/m"), of(Q, "N/m"), of(sigma, "Pa")) for name, P, Q, sigma in self.steps)
        parts = converted(lower), converted(upper)
        return replace(self, parts=parts, steps=tuple(steps), a=of(self.a, "m"), size=of(self.size, "m"))


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
        Of half-planes.
    size : float
        Element size along the contact line, in the contact half-width; if P varies, in that of the smallest contact.
    width : float, optional
        Half-width and height of the blocks, in a. The error of q due to the blocks is about 10 (a/width)^2, relative.
        The default makes this error small beside the error of the elements.
    growth : float
        Element size gained per unit of distance from the contact.
    stiffer : float
        Factor on the stiffness of both bodies; the gap is divided by it. In linear elasticity no traction changes,
        while geometric effects of sloping surfaces vanish.
    ends : sequence of float
        Points on the contact line, in a, to refine at, besides the kinks of the gap.
    fine : float, optional
        Element size at these points, in the same half-width as ``size``; by default a tenth of ``size``.

    Raises
    ------
    InputError
        If the bodies are of finite size, the pressure is not even, or the loads make the contact slide.
    """
    if scene.finite:
        raise InputError("bodies: must be left out to export; only half-planes can be exported")
    scene.require_even("to export")
    f = scene.friction.f
    if scene.slides or (f == 0 and scene.load.dsigma):
        raise InputError(f"load.Q: must be within {_bound(scene)}; beyond it the contact slides and has no equilibrium")
    a, least, most = _half_widths(scene)
    size, fine = size * (least / a), (size / 10 if fine is None else fine) * (least / a)
    reach = _REACH * (most / a)
    kinks = [kink / a for kink in scene.profile.kinks if abs(kink) < reach * a]
    points = dict.fromkeys([*ends, *kinks], fine)
    wide = width if width is not None else _WIDE / min([size, *points.values()]) ** 0.5

    from partialslip_meshes import quad_block

    def mesh(fineness: float) -> "QuadMesh":
        sizes = {x: least * fineness for x, least in points.items()}
        scaled = quad_block(wide, (-reach, reach), sizes, growth * fineness, size * fineness)
        return replace(scaled, points=scaled.points * a)

    overlap = _OVERLAP * float(scene.profile.gap_at(np.array(least)))
    meshes = mesh(scene.fem.lower_size), _upper(mesh(1.0), scene, reach * a, overlap, stiffer)
    constants = map(_in_plane_strain, scene.material.bodies)
    lower, upper = (
        Part(name, each, stiffer * E, nu)
        for name, each, (E, nu) in zip(("lower", "upper"), meshes, constants, strict=True)
    )
    return Model(scene.name, (lower, upper), f, _steps(scene), scene.load.steps, a, size * a, wide, stiffer)


def _bound(scene: Scene) -> str:
    """Bound f P on |Q| in words, at the load point where Q exceeds it most."""
    f, pairs = scene.friction.f, zip(scene.load.points, scene.pressing, strict=True)
    excess = [abs(Q) - f * P for (Q, _), (P, _) in pairs]
    worst = int(np.argmax(excess))
    where = f" at load point {worst + 1}" if scene.presses_anew else ""
    return f"f P = {scene.units.labelled(f * scene.pressing[worst].P, 'N/m')}{where}"


def _half_widths(scene: Scene) -> tuple[float, float, float]:
    """Contact half-width a of ``scene``, and those of the smallest and the largest contact of the cycle, m."""
    a, forces = contact(scene).a, [P for P, _ in scene.pressing]
    least, most = (a if P == scene.P else contact(scene.replace(load={"P": P})).a for P in (min(forces), max(forces)))
    return a, least, most


def _in_plane_strain(body: Constants) -> tuple[float, float]:
    """E (Pa) and nu in plane strain that give the same plane fields as ``body``."""
    nu = (3 - body.kappa) / 4
    return 2 * body.mu * (1 + nu), nu


def _upper(mesh: "QuadMesh", scene: Scene, reach: float, overlap: float, stiffer: float) -> "QuadMesh":
    """Mirror ``mesh`` and shape its face by the profile, less and less upwards.

    Beyond the contact line, |x| > ``reach`` (m), the gap is constant. The bodies overlap a little at the start, by
    ``overlap`` (m), so that neither is loose.
    """
    x, y = mesh.points[:, 0], -mesh.points[:, 1]
    gap = scene.profile.gap_at(np.clip(x, -reach, reach)) - overlap
    shaped = np.column_stack([x, y + gap / stiffer * (1 - y / y.max())])
    lines = {name: line[:, ::-1] for name, line in mesh.lines.items()}
    return replace(mesh, points=shaped, quads=mesh.quads[:, ::-1], lines=lines)


def _steps(scene: Scene) -> tuple[Step, ...]:
    """Load steps: press, go to the last load point, then through all load points in every cycle."""
    load = scene.load
    points = [(P, Q, sigma) for (P, _), (Q, sigma) in zip(scene.pressing, load.points, strict=True)]
    press = Step("press", points[-1][0], 0.0, 0.0)
    if not scene.presses_anew and not any(map(any, load.points)):
        return (press,)
    visits = [(f"load point {len(points)}, first time", points[-1])]
    visits += [
        (f"cycle {cycle}, load point {number}", point)
        for cycle in range(1, load.cycles + 1)
        for number, point in enumerate(points, start=1)
    ]
    return (press, *(Step(name, *point) for name, point in visits))
