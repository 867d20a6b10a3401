"""How the plates that hold two finite bodies move, and how stiff the rig is."""

from dataclasses import dataclass

from msgspec.structs import replace

from partialslip.scene import Scene
from partialslip.tools.arrays import Array
from partialslip.tools.shown import Short


@dataclass(frozen=True, repr=False)
class Plates(Short):
    """Plates that hold two finite bodies: forces and displacements per unit depth, in the steady cycle.

    Parameters
    ----------
    at_points : (c,) array
        Shear force at all c load points of the cycle, N/m.
    displacement : (2,) array
        Displacement along x of the lower body's plate less that of the upper body's at load points 1 and 2, m, since
        the bodies were pressed together; positive where Q is. NaN if it is not known: cycles on the way to the steady
        state were skipped.
    approach : (2,) array
        Approach of the plates along y since the bodies first touched, m; on the axis of the pin, if a body pivots.
    compliance : (2, 2) array
        Displacements along x and y (rows) under unit forces along x and y (columns) at load point 2, 1/Pa, while
        nothing slips and the contact keeps its size.
    loop : (k, 2) array
        Displacement (m, from its value where the cycle begins) and Q (N/m) along the cycle, first and last point the
        same. That of mirror images under constant P has a point at each event; else it is straight between load steps:
        ``load.steps`` makes it finer.
    error : float or None
        Estimated error of the compliance, relative; None on meshes as given. Elements of another order tell what those
        away from the contact's ends leave, and the next node and the error of the contact what the ends leave.
    displacement_error : float or None
        Estimated error of the displacement under given loads, m; None on meshes as given. If the plates are moved, Q
        is off by this times the stiffness.
    turn : (2,) array or None
        Angle by which the lower body's plate has turned counterclockwise at load points 1 and 2, less that of the upper
        body's, rad; None if no body pivots. Displacements are then those of the pin.
    """

    at_points: Array
    displacement: Array
    approach: Array
    compliance: Array
    loop: Array
    error: float | None = None
    displacement_error: float | None = None
    turn: Array | None = None

    def told(self, scene: Scene) -> Scene:
        """Return ``scene`` with the Q that its plates bear, if their displacements drive it; otherwise as it is."""
        if scene.load.displacement is None:
            return scene
        return replace(scene, load=replace(scene.load, Q_found=tuple(self.at_points.tolist())))

    @property
    def stiffness(self) -> tuple[float, float]:
        """Forces along x and along y per displacement, N/m per m and unit depth (Pa), while nothing slips and the
        contact keeps its size; the other force does not change."""
        return stiffness(self.compliance)

    @property
    def work(self) -> float:
        """Area of the loop, J/m: the work of Q over a cycle, which friction consumes where no other load changes."""
        return loop_area(self.loop)


def stiffness(compliance: Array) -> tuple[float, float]:
    """Return the stiffness along x and along y of plates with the ``compliance`` (2, 2)."""
    return 1 / float(compliance[0, 0]), 1 / float(compliance[1, 1])


def loop_area(loop: Array) -> float:
    """Return the area of a closed ``loop`` (k, 2) of displacement and force."""
    moved, force = loop.T
    return float(((moved[1:] - moved[:-1]) * (force[1:] + force[:-1])).sum() / 2)
