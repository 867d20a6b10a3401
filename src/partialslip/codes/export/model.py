"""A scene as a finite-element model for any code: two meshed bodies, materials, and load steps.

Half-planes are large blocks, as with ``fem.far_field = "box"``, held all around; finite bodies are held as their
supports say. What is held of the upper body moves as a rigid frame, on which P and Q act; it turns only where the
pressure has a moment. What is held of the lower body has the displacements of the bulk tension.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from partialslip.codes.export.load_steps import TOUCH, Step, slips_under_pressure, steps_of
from partialslip.codes.export.parts import MeshedBody, flat_parts
from partialslip.halfplane.contact import contact
from partialslip.scene import Pressing, Scene
from partialslip.scene.units import Units
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

if TYPE_CHECKING:
    from partialslip_meshes import QuadMesh

SIZE, GROWTH = 0.05, 0.1  # accuracy: element size at the ends of the contact, in a, and growth

_REACH = 1.2  # accuracy: half-width of the contact line, in the half-width of the largest contact
_FILLS = 0.95  # accuracy: largest contact line, in the width of a finite body
_OVERLAP = 0.25  # accuracy: initial overlap of the bodies, in the gap at the end of the smallest contact
_WIDE = 50.0  # accuracy: half-width of the blocks in a, times the square root of the smallest element in a


@dataclass(frozen=True)
class Model:
    """A finite-element model of a scene, in SI units until :meth:`in_units` converts the model.

    Parameters
    ----------
    name : str
        Of the scene.
    parts : two of MeshedBody
        The lower and the upper body.
    f : float
        Coefficient of friction.
    steps : tuple of Step
        Load steps.
    a : float
        Expected contact half-width at the load point with the larger P, m.
    size : float
        Element size along the contact line, m.
    width : float
        Half-width of the blocks that stand for half-planes, in ``a``.
    stiffer : float
        Stiffness of the bodies, in the scene's.
    turns : bool
        Whether the upper body turns, as the pressure has a moment.
    overlap : float
        How far the bodies overlap at the start, where nothing is stiffer, m.
    """

    name: str
    parts: tuple[MeshedBody, MeshedBody]
    f: float
    steps: tuple[Step, ...]
    a: float
    size: float
    width: float
    stiffer: float
    turns: bool
    overlap: float

    @property
    def presses_anew(self) -> bool:
        """Whether P or its moment varies after the pressing."""
        loads = [(step.P, step.M) for step in self.steps if step.name != "touch"]
        return len(set(loads)) > 1

    def bulk(self, step: Step) -> Array:
        """Displacements of the lower body's outer nodes under the bulk tension of ``step``, (k, 2), m."""
        lower = self.parts[0]
        return lower.mesh.points[lower.outer] * (lower.strained * step.sigma)

    def in_units(self, units: Units) -> "Model":
        """Convert the model from SI to ``units``."""
        of = units.from_si

        def converted(part: MeshedBody) -> MeshedBody:
            return replace(part, mesh=replace(part.mesh, points=of(part.mesh.points, "m")), E=of(part.E, "Pa"))

        lower, upper = self.parts
        steps = (
            step._replace(P=of(step.P, "N/m"), Q=of(step.Q, "N/m"), sigma=of(step.sigma, "Pa"), M=of(step.M, "N"))
            for step in self.steps
        )
        parts = converted(lower), converted(upper)
        lengths = {name: of(getattr(self, name), "m") for name in ("a", "size", "overlap")}
        return replace(self, parts=parts, steps=tuple(steps), **lengths)


@dataclass(frozen=True)
class Outline:
    """What the meshes of a scene resolve, in the expected contact half-width ``a`` (m): half-width ``reach`` of the
    contact line, half-width ``width`` of blocks that stand for half-planes, element size by point (``sizes``), element
    size ``along`` the line, and that half-width of the ``least`` contact of the path."""

    a: float
    reach: float
    width: float
    sizes: dict[float, float]
    along: float
    least: float


def outlined(
    scene: Scene, size: float = SIZE, width: float | None = None, ends: Sequence[float] = (), fine: float | None = None
) -> Outline:
    """Outline of the meshes of ``scene``; parameters and errors as for :func:`modelled`."""
    _require_exportable(scene)
    a, least, farthest = _half_widths(scene)
    size, fine = size * (least / a), (size / 10 if fine is None else fine) * (least / a)
    limits = [_FILLS / 2 * body.span / a for _, body in scene.bodies if body.width]
    reach = min([_REACH * (farthest / a), *limits])
    if reach * a <= farthest:
        name = min(((body.span, name) for name, body in scene.bodies))[1]
        raise InputError(f"{name}.width: must be wider than the contact, which fills more than {_FILLS:.0%} of it")
    kinks = [kink / a for kink in scene.profile.kinks if abs(kink) < reach * a]
    points = dict.fromkeys([*ends, *kinks], fine)
    wide = width if width is not None else _WIDE / min([size, *points.values()]) ** 0.5
    return Outline(a, reach, wide, points, size, least / a)


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
    size : float
        Element size along the contact line, in the contact half-width; if P varies, in that of the smallest contact.
    width : float, optional
        Half-width and height of the blocks that stand for half-planes, in a. The error of q due to the blocks is about
        10 (a/width)^2, relative. The default makes this error small beside the error of the elements.
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
        If the gap is not even, a body has a mesh of its own or is too narrow, the tension varies along x, or the loads
        make the contact slide.
    """
    line = outlined(scene, size, width, ends, fine)
    a, reach = line.a, line.reach
    lower, upper = flat_parts(scene, a, reach, line.width, line.sizes, growth, line.along, stiffer)
    touching = line.least * a * (TOUCH**0.5 if slips_under_pressure(scene) else 1)
    overlap = _OVERLAP * float(scene.gap_at(np.array(touching)))
    upper = replace(upper, mesh=_upper(upper.mesh, scene, reach * a, overlap, stiffer))
    turns = any(M for _, M in scene.pressing)
    parts, steps = (lower, upper), steps_of(scene)
    return Model(scene.name, parts, scene.friction.f, steps, a, line.along * a, line.width, stiffer, turns, overlap)


def _require_exportable(scene: Scene) -> None:
    """Raise InputError if ``scene`` cannot be exported."""
    if not scene.profile.even:
        raise InputError("profile.x: must begin at 0 to export; only even gaps")
    scene.require_uniform_friction("to export")
    scene.load.require_forces(scene.units)
    if any(scene.load.sigma_slope):
        raise InputError(f"load.sigma_slope = {scene.load.shown('sigma_slope')}: must be 0 or left out to export")
    scene.bodies.require_no_pin("to export")
    scene.bodies.require_widths("to export")
    if scene.bodies.lower and (share := scene.bodies.lower.right_grip):
        raise InputError(f"bodies.lower.right_grip = {share!r}: must be 0 or left out to export")
    if scene.meshed:
        name = next(name for name, body in scene.bodies if body.mesh is not None)
        raise InputError(f"{name}.mesh: must be left out to export; give width and height")
    if scene.slides or (scene.friction.f == 0 and scene.load.dsigma):
        raise InputError(f"load.Q: must be within {_bound(scene)}; beyond it the contact slides and has no equilibrium")


def _bound(scene: Scene) -> str:
    """Bound f P on |Q| in words, at the load point where Q exceeds it most."""
    f, pairs = scene.friction.f, zip(scene.load.points, scene.pressing, strict=True)
    excess = [abs(Q) - f * P for (Q, _), (P, _) in pairs]
    worst = int(np.argmax(excess))
    where = f" at load point {worst + 1}" if scene.presses_anew else ""
    return f"f P = {scene.units.labelled(f * scene.pressing[worst].P, 'N/m')}{where}"


def _half_widths(scene: Scene) -> tuple[float, float, float]:
    """Contact half-width a of ``scene``, that of the smallest contact of the path, and the largest distance of a
    contact's end from x = 0, m."""
    ends = {pressing: _contact_ends(scene, pressing) for pressing in dict.fromkeys(scene.pressing)}
    widths = [(right - left) / 2 for left, right in ends.values()]
    left, right = ends[scene.end_pressing[scene.largest - 1]]
    return (right - left) / 2, min(widths), max(max(-left, right) for left, right in ends.values())


def _contact_ends(scene: Scene, pressing: Pressing) -> tuple[float, float]:
    """Ends of the contact under P and M, m; for finite or dissimilar bodies nearly, without friction."""
    if scene.material.alike and not scene.sized:
        return contact(scene, pressing).ends
    from partialslip.run import run

    still = dict.fromkeys(("Q", "sigma"), (0.0, 0.0))
    pressed = scene.replace(load={"P": pressing.P, "M": None, "e": None, "a": None, "p0": None, **still},
                            friction={"f": 0.0}, fem={"accuracy": 1e-2})  # fmt: skip
    a = run(pressed, "fem")["fem"].a
    return -a, a


def _upper(mesh: "QuadMesh", scene: Scene, reach: float, overlap: float, stiffer: float) -> "QuadMesh":
    """Mirror ``mesh`` and shape its face by the profile, less and less upwards.

    Beyond the contact line, |x| > ``reach`` (m), what is added is constant. The bodies overlap a little at the start,
    by ``overlap`` (m), so that neither is loose.
    """
    x, y = mesh.points[:, 0], -mesh.points[:, 1]
    gap = scene.gap_at(np.clip(x, -reach, reach)) - overlap
    shaped = np.column_stack([x, y + gap / stiffer * (1 - y / y.max())])
    lines = {name: line[:, ::-1] for name, line in mesh.lines.items()}
    return replace(mesh, points=shaped, quads=mesh.quads[:, ::-1], lines=lines)
