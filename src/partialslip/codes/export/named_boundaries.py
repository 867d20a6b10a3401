"""A model for codes that name boundaries: lines of both meshes, loads over time, and tractions on the sides.

Time counts increments: each takes one unit of it. Forces on the rigid frame are uniform tractions along its lines, as
only their sum matters.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from partialslip.codes.export.inp import deck_heading
from partialslip.codes.export.model import Model
from partialslip.codes.export.parts import MeshedBody
from partialslip.scene import Scene
from partialslip.tools.arrays import Array, Indices
from partialslip.tools.errors import InputError

if TYPE_CHECKING:
    from partialslip_meshes import QuadMesh

UNTESTED = "untested"  # part of file names: nobody of the project has run these decks
_STRAIGHT = 1e-9  # limit: largest change of the normal along a side, which is then straight


@dataclass(frozen=True)
class Named:
    """A model with named lines, in the units of the scene.

    Parameters
    ----------
    model : Model
    meshes : mapping of str to QuadMesh
        "lower" and "upper"; the lines of the upper body's frame are one, "frame", or "frame-x" and "frame-y".
    held : two of tuple of str
        Lines of the lower body that have the displacements of the bulk tension along x, and along y.
    frame : two of str
        Lines of the upper body that move together along x, and along y.
    pulls : mapping of str to float
        Traction along x on lines of the lower body under a unit bulk tension.
    times : tuple of int
        Time at the end of each step.
    guided : int
        Time until which the frame is held along x.
    ends : two of int
        Times of load points 1 and 2 in the last cycle.
    """

    model: Model
    meshes: Mapping[str, "QuadMesh"]
    held: tuple[tuple[str, ...], tuple[str, ...]]
    frame: tuple[str, str]
    pulls: Mapping[str, float]
    times: tuple[int, ...]
    guided: int
    ends: tuple[int, int]

    def length(self, line: str) -> float:
        """Length of a ``line`` of the upper body."""
        mesh = self.meshes["upper"]
        return float(np.linalg.norm(_along(mesh.points, mesh.lines[line]), axis=1).sum())

    def load(self, name: str) -> tuple[float, ...]:
        """Values of the load ``name``, P, Q or sigma, at time 0 and at :attr:`times`."""
        return (0.0, *(getattr(step, name) for step in self.model.steps))


def named(scene: Scene, model: Model, to: str) -> Named:
    """Name the lines of a model.

    Parameters
    ----------
    scene : Scene
    model : Model
        Made from ``scene``, in SI units.
    to : str
        Name of the code, for messages.

    Raises
    ------
    InputError
        If the upper body turns, or the bulk tension acts on sides that are not straight.
    """
    if model.turns:
        key = "e" if scene.load.M is None else "M"
        raise InputError(f"load.{key}: must be left out to export to {to}; decks for calculix and abaqus turn bodies")
    model = model.in_units(scene.units)
    lower, upper = model.parts
    pulls = _pulls(lower, to) if any(step.sigma for step in model.steps) else {}
    mesh, frame = _framed(upper)
    times = np.cumsum([step.increments for step in model.steps]).tolist()
    guided = [time for time, step in zip(times, model.steps, strict=True) if step.guided]
    first, second = (-1, -1) if scene.only_pressed else (end - len(scene.load.points) for end in scene.load.ends)
    return Named(model, {"lower": lower.mesh, "upper": mesh}, lower.held, frame, pulls, tuple(times),
                 guided[-1], (times[first], times[second]))  # fmt: skip


def heading(scene: Scene, model: Model, what: str, notes: tuple[str, ...]) -> list[str]:
    """Comment lines that begin with #: those of all decks, that nobody has run this one, and ``notes``. ``model`` is in
    SI units."""
    told = [line.removeprefix("** ") for line in deck_heading(scene, model, f"{what} in {scene.units.words}")]
    warning = (f"{UNTESTED}: made from the documentation of the code, never run by this project",)
    return [f"# {line}" for line in (told[0], *warning, *told[1:], *notes)]


def _framed(upper: MeshedBody) -> tuple["QuadMesh", tuple[str, str]]:
    """Mesh of the ``upper`` body with the held lines as one or two, and their names along x and y. What is held along x
    is all that is held along y, or nothing of it."""
    along_x, along_y = upper.held
    frames = {"frame": along_x} if set(along_x) == set(along_y) else {"frame-x": along_x, "frame-y": along_y}
    merged = {name: np.vstack([upper.mesh.lines[line] for line in lines]) for name, lines in frames.items()}
    rest = {name: edges for name, edges in upper.mesh.lines.items() if name not in (*along_x, *along_y)}
    return replace(upper.mesh, lines=rest | merged), (next(iter(frames)), list(frames)[-1])


def _pulls(lower: MeshedBody, to: str) -> dict[str, float]:
    """Traction along x on the lines of :attr:`MeshedBody.pull` under a unit tension: the normal of each."""
    free = ("right",) if lower.pulled else [name for name in lower.mesh.lines if name not in lower.held[0]]
    found = {}
    for name in free:
        if name == "contact":
            continue
        along = _along(lower.mesh.points, lower.mesh.lines[name])
        normal = along[:, 1] / np.linalg.norm(along, axis=1)  # the body is on the left of its boundary
        if np.ptp(normal) > _STRAIGHT:
            raise InputError(
                f"bodies.lower: must be a block without a holder to export to {to}, as sigma acts on its sides"
            )
        if abs(normal[0]) > _STRAIGHT:
            found[name] = float(normal.mean())
    return found


def _along(points: Array, edges: Indices) -> Array:
    """Vectors along ``edges``, (k, 2)."""
    return np.diff(points[edges], axis=1)[:, 0]
