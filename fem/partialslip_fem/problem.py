"""The scaled problem of a scene: lengths in sqrt(A R P), forces in P, displacements in A P.

A is the compliance of the pair of bodies, R the profile's radius and P the normal force per unit depth.
"""

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
from scipy.interpolate import PPoly

from partialslip.friction.even_gap import EvenGap, even_gap
from partialslip.friction.load_path import Path, load_path, lower_strain, scaled_pressing
from partialslip.result.state import State
from partialslip.scene import Friction, Profile, Scene
from partialslip.scene.bodies import Body
from partialslip.scene.plan import Plan
from partialslip.tools.arrays import Array
from partialslip_fem.corners import free_exponent, held_exponent, size
from partialslip_fem.elasticity import ALL_AROUND, HeldSides
from partialslip_fem.factor import Backend, default_backend
from partialslip_meshes import Corner, Mesh, read

Support = Literal["clamped", "roller", "sides", "pivot"]
_HELD: dict[Support, HeldSides] = {
    "clamped": (("back",), ("back",)),
    "roller": (("left", "right"), ("back",)),
    "sides": (("left", "right"), ("left", "right")),
    "pivot": (("back",), ("back",)),  # displacements count from the plate, which turns
}


@dataclass(frozen=True)
class PadFace:
    """Depth of a pad's curved face below its highest point, as a function of x.

    Parameters
    ----------
    profile : Profile
    length : float
        Unit of length of x and depth, m.
    """

    profile: Profile
    length: float

    def __call__(self, x: Array) -> Array:
        return self.profile.face_at(x * self.length) / self.length

    @property
    def radius(self) -> float:
        """Radius of curvature."""
        return self.profile.R / self.length


@dataclass(frozen=True)
class Part:
    """One of the two bodies. A part without ``extent`` and ``mesh`` is a block that stands for a half-plane.

    Parameters
    ----------
    name : str
        "lower" or "upper".
    kappa : float
        Kolosov's constant.
    compliance : float
        (kappa+1)/(2 mu), relative to the pair's A.
    fineness : float
        Element size, relative to the size that is asked for.
    extent, holder : (float, float), optional
        Half-width and height of a finite block, and of the holder below it.
    face : PadFace, optional
        Curved face; without it the face is flat.
    mesh : Mesh, optional
        Mesh from a file.
    support : str
        Which sides of a finite body are held.
    pulled : bool
        Whether the bulk tension acts on the right side.
    gripped : bool
        Whether a plate that is held pulls the right side.
    """

    name: str
    kappa: float
    compliance: float
    fineness: float = 1.0
    extent: tuple[float, float] | None = None
    holder: tuple[float, float] | None = None
    face: PadFace | None = None
    mesh: Mesh | None = None
    support: Support = "clamped"
    pulled: bool = False
    gripped: bool = False

    @property
    def finite(self) -> bool:
        """Whether the part is a finite body, not a block that stands for a half-plane."""
        return self.extent is not None or self.mesh is not None

    @property
    def even(self) -> bool:
        """Whether the part is sure to be a mirror image of itself."""
        return not self.mesh and (not self.pulled or self.support in ("clamped", "pivot"))

    def meshed_like(self, other: "Part") -> bool:
        """Whether both stand for half-planes with elements of one size: their meshes are the same."""
        return not self.finite and not other.finite and self.fineness == other.fineness

    @property
    def held(self) -> HeldSides:
        """Lines of the mesh that are held along x, and along y."""
        return _held_lines(self.support, self.pulled and not self.gripped) if self.finite else (ALL_AROUND, ALL_AROUND)

    @cached_property
    def exponents(self) -> dict[Corner, float]:
        """Exponents of the displacements at the singular corners of a block."""
        assert self.extent
        across, width, low = math.pi / 2, self.extent[0], (self.holder or self.extent)[0]
        held = set(self.held[0]) & set(self.held[1])
        found: dict[Corner, float] = {}
        if held:  # a held side meets a free side
            found["foot"] = held_exponent(across, self.kappa)
        if held - {"back"}:
            angle = across if not self.holder or low > width else 3 * across if low < width else 2 * across
            found["shoulder"] = held_exponent(angle, self.kappa)
        if self.holder and low != width and ("shoulder" not in found or low > width):
            found["notch"] = free_exponent(3 * across)
        return found

    def corners(self, tolerance: float) -> dict[Corner, float]:
        """Element sizes at the singular corners of a block.

        With these sizes the corners change the contact by about ``tolerance``, relative.
        """
        assert self.extent
        least = min(*self.extent, *(self.holder or self.extent))
        return {corner: least * size(tolerance, exponent) for corner, exponent in self.exponents.items()}


@dataclass(frozen=True)
class ScaledProblem:
    """The scaled contact problem; P = 1, at the load point with the larger P if P varies. Where the bodies turn, x
    counts from the line of action of this P, about which the pressure then has no moment.

    Parameters
    ----------
    gap : callable
        Gap at points x (k,), smooth except at its ``kinks``.
    kinks : tuple of float
        Points x where the gap's slope or curvature jumps, which meshes are graded to.
    friction : Friction
        Coefficient of friction, along the x of the scene, m.
    path : Path or None
        Load path; None without friction.
    parts : tuple of Part
        The lower and the upper body; the lower body alone if the bodies are mirror images.
    order : int
        Polynomial order of the elements.
    far_field : "half-plane" or "box"
        Displacements of the outer boundary: those of a half-plane, or zero.
    backend : str
        Library that factors the stiffness.
    start : two PPoly, optional
        Tractions p and q at the beginning of the path.
    breaks : tuple of float
        All points x where the gap's curvature jumps; between them the gap is a parabola.
    bends : tuple of float
        By how much the gap's curvature jumps at each of the ``kinks``.
    coupled : bool
        Whether p moves the surfaces along x and q moves them along y.
    inside : bool
        Whether displacements inside the bodies are needed.
    strains : two of (float, float)
        Bulk strain of the lower surface at load points 1 and 2, at the scene's x = 0, and its slope along x.
    even_gap : EvenGap or None
        Curvature of the gap, if the bodies are pressed together by P alone, with one f, in a convex even gap.
    nearly_similar : bool
        Whether bodies of a size are mirror images of themselves, on elements of one size: the contact nearly keeps its
        shape, and elements are as fine for what it was when it was small.
    accuracy : float
        Accuracy asked for: error of the contact's ends, in its half-width.
    turns : bool
        Whether the bodies turn until the pressure has no moment.
    origin : float
        Position of the origin of x in the scene.
    length : float
        Unit of length, m.
    pressing : two of (float, float), optional
        P and M at load points 1 and 2, where the pressure varies.
    largest : int
        Load point with the larger P, 1 or 2.
    pin : float or None
        Height of the pin of a body that pivots over the contact line, negative for the lower body.
    moment : float
        Moment about the pin, where P and M do not vary.
    """

    gap: Callable[[Array], Array]
    kinks: tuple[float, ...]
    friction: Friction
    path: Path | None
    parts: tuple[Part, ...]
    order: int
    far_field: Literal["half-plane", "box"]
    backend: Backend
    start: tuple[PPoly, PPoly] | None = None
    breaks: tuple[float, ...] = ()
    bends: tuple[float, ...] = ()
    coupled: bool = True
    inside: bool = True
    strains: tuple[tuple[float, float], ...] = ((0.0, 0.0), (0.0, 0.0))
    even_gap: EvenGap | None = None
    nearly_similar: bool = False
    accuracy: float = 1e-3
    turns: bool = False
    origin: float = 0.0
    length: float = 1.0
    pressing: tuple[tuple[float, float], tuple[float, float]] | None = None
    largest: int = 2
    pin: float | None = None
    moment: float = 0.0

    @property
    def f(self) -> float:
        """Coefficient of friction; the largest where it varies along x."""
        return self.friction.f

    @property
    def friction_kinks(self) -> tuple[Array, Array]:
        """Points at which the coefficient of friction is not smooth, and the jumps of its slope there, over its largest
        value, (k,) each."""
        return np.array(self.friction.kinks) / self.length - self.origin, self.friction.jumps * self.length

    def sharp_kinks(self, length: float) -> tuple[float, ...]:
        """The sharp ones of these points, for functions that are smooth over the ``length``."""
        return tuple(kink / self.length - self.origin for kink in self.friction.sharp_kinks(length * self.length))

    @property
    def coarsest(self) -> float:
        """Fineness of the coarsest body, of which element sizes are."""
        return max(part.fineness for part in self.parts)

    def bent(self, low: float, high: float) -> tuple[Array, Array]:
        """The ``kinks`` between two points, and by how much the gap's curvature jumps there, (k,) each."""
        kinks = np.array(self.kinks)
        between = (kinks > low) & (kinks < high)
        return kinks[between], np.array(self.bends)[between]

    def f_at(self, x: Array) -> Array:
        """Coefficient of friction at ``x`` (k,)."""
        return self.friction.at((x + self.origin) * self.length)

    @property
    def lines(self) -> tuple[float, ...]:
        """Lines of action of P at the load points, where the pressure varies: where it has no moment."""
        loads: tuple[tuple[float, float], ...] = self.pressing or ()
        if self.path and self.path.presses_anew:
            loads = tuple((P, M) for *_, P, M in self.path.cycle)
        if self.pin is not None:
            loads = loads or ((1.0, self.moment),)
            if self.path and self.path.actuator is None:  # otherwise Q is not known yet
                loads = tuple((P, M - self.pin * Q) for Q, *_, P, M in self.path.cycle)
        return tuple(M / P for P, M in loads)

    @property
    def contact_moves(self) -> bool:
        """Whether the pressure varies: with P or M, or along the path with Q on a body that pivots."""
        return self.pressing is not None or (self.path is not None and self.path.presses_anew)

    @property
    def beta(self) -> float:
        """Dundurs' constant of the bodies: positive where pressure moves the upper surface more than the lower one
        towards the load."""
        if len(self.parts) == 1 or not self.coupled:
            return 0.0
        lower, upper = (part.compliance * (part.kappa - 1) / (part.kappa + 1) for part in self.parts)
        return (upper - lower) / sum(part.compliance for part in self.parts)

    @property
    def similar(self) -> bool:
        """Whether the contact grows self-similarly, as between half-planes under an even gap."""
        return self.even_gap is not None and not self._sized

    @property
    def touches_first(self) -> float | None:
        """Point at which bodies of dissimilar materials touch first under an even gap: q, locked in while they are
        pressed together, varies there like x log|x|, and p like |x|. None where there is no such point."""
        if self.even_gap is None or self.even_gap.places[0] or not (self.beta and self.path) or self.start:
            return None
        return -self.origin

    @property
    def sized(self) -> bool:
        """Whether the contact grows nearly self-similarly although p and q are coupled: bodies of one material, of
        finite size, under an even gap."""
        even = self.even_gap is not None and (self.even_gap.parabolic or all(part.even for part in self.parts))
        return even and self._sized and self.coupled and not (self.beta or self.start)

    @property
    def _sized(self) -> bool:
        return any(part.finite for part in self.parts)

    @property
    def meshed(self) -> bool:
        """Whether every body has a mesh from a file."""
        return all(part.mesh for part in self.parts)


def scaled(scene: Scene, plan: Plan, start: State | None = None) -> ScaledProblem:
    """Scale ``scene``, with the effects in ``plan``, from the state ``start`` if given.

    Raises
    ------
    InputError
        If a mesh file cannot be read.
    """
    P, A, L, origin = scene.P, scene.material.A, scene.length, scene.origin
    parts, at_ends = parts_of(scene, L), [scene.load.tension[end] for end in scene.load.ends]
    curvature, under = scene.profile.curvature, even_gap(scene, L)
    bends = np.abs(np.diff(curvature.values))
    parabolic = under is not None and under.parabolic
    return ScaledProblem(
        gap=lambda x: scene.gap_at(x * L + origin) / (A * P),
        kinks=tuple((kink - origin) / L for kink in scene.profile.kinks),
        friction=scene.friction,
        path=load_path(scene, plan, start, scene.pin is not None),
        parts=parts[:1] if scene.fem.lower_size == 1 and not plan.needs("coupling") and scene.mirrored else parts,
        order=scene.fem.elements,
        far_field=scene.fem.far_field,
        backend=scene.fem.factor or default_backend(),
        start=tuple(rescaled(q, L / P, 1 / L, -origin / L) for q in (start.p, start.q)) if start else None,
        breaks=tuple(((curvature.breaks - origin) / L).tolist()),
        bends=tuple((bends[np.isin(curvature.breaks, scene.profile.kinks)] * L**2 / (A * P)).tolist()),
        coupled=plan.needs("coupling"),
        inside=plan.needs("subsurface"),
        strains=tuple((lower_strain(scene, sigma), lower_strain(scene, slope * L)) for sigma, slope in at_ends),
        even_gap=under,
        nearly_similar=parabolic and scene.finite and scene.fem.size is not None and all(part.even for part in parts),
        accuracy=scene.fem.accuracy,
        turns=plan.needs("moment"),
        origin=origin / L,
        length=L,
        pressing=_at_load_points(scene) if scene.presses_anew else None,
        largest=scene.largest,
        pin=None if scene.pin is None else scene.pin / L,
        moment=0.0 if scene.pin is None else scaled_pressing(scene)[0][1],
    )


def parts_of(scene: Scene, length: float) -> tuple[Part, Part]:
    """The lower and the upper body of ``scene``; lengths in units of ``length`` (m).

    Raises
    ------
    InputError
        If a mesh file cannot be read.
    """
    bodies, A, sizes = scene.bodies, scene.material.A, (scene.fem.lower_size, 1.0)
    lower, upper = (
        _finite(Part(name, own.kappa, own.A / A, size), body, scene, length)
        for name, body, size, own in zip(
            ("lower", "upper"), (bodies.lower, bodies.upper), sizes, scene.material.bodies, strict=True
        )
    )
    return lower, upper


def _at_load_points(scene: Scene) -> tuple[tuple[float, float], tuple[float, float]]:
    """Scaled P and M at load points 1 and 2."""
    pressing = scaled_pressing(scene)
    first, second = scene.load.ends
    return pressing[first], pressing[second]


def rescaled(polynomials: PPoly, value: float, length: float, origin: float = 0.0) -> PPoly:
    """Convert ``polynomials`` to other units: values times ``value``, abscissae times ``length`` plus ``origin``."""
    powers = np.arange(len(polynomials.c) - 1, -1, -1)[:, None]
    return PPoly(polynomials.c * value / length**powers, polynomials.x * length + origin)


def _held_lines(support: Support, pulled: bool) -> HeldSides:
    """Lines of a finite body that its ``support`` holds along x, and along y; not the right side, if it is ``pulled``
    by a traction."""
    along_x, along_y = ([line for line in lines if line != "right" or not pulled] for lines in _HELD[support])
    return along_x, along_y


def _finite(plain: Part, body: Body | None, scene: Scene, L: float) -> Part:
    """Replace the half-plane ``plain`` by the finite ``body``, if there is one."""
    if not body:
        return plain
    holder = body.holder
    face = PadFace(scene.profile, L) if body.kind == "pad" else None
    part = replace(plain, face=face, support=body.support, pulled=body.pulled, gripped=body.gripped)
    if body.mesh is not None:
        needed = {*itertools.chain(*_held_lines(body.support, False))} | ({"right"} if body.pulled else set())
        field = f"bodies.{part.name}.mesh"
        unit = (body.unit or 1.0) / L
        groups = body.groups.given if body.groups else {}
        return replace(part, mesh=read(field, body.mesh, unit, face, sorted(needed), body.body, groups))
    return replace(
        part,
        extent=(body.span / 2 / L, (body.height or 0.0) / L),
        holder=(holder.width / 2 / L, holder.height / L) if holder else None,
    )
