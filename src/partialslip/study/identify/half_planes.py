"""The half-planes on which f is identified: those of the scene, or those that act like its bodies."""

from partialslip.march.equivalent import stand_ins
from partialslip.run import rig_of
from partialslip.scene import Scene
from partialslip.tools.errors import InputError


def half_planes(scene: Scene) -> tuple[Scene, tuple[str, ...]]:
    """Half-planes of ``scene`` under constant P, and remarks; of bodies of a size the equivalent half-planes, without
    their tilt and the slope of their tension.

    Raises
    ------
    InputError
        If the materials differ, f varies along x, P or M varies, the loads are not in phase or sigma_slope varies.
    """
    load = scene.load
    load.require_forces(scene.units)
    scene.require_uniform_friction("for partialslip identify, which finds it")
    for wrong, key, must in (
        (not scene.material.alike, "material.upper, material.lower: the bodies differ", "be of one material"),
        (scene.presses_anew, "load: P or M varies", "be constant"),
        (not load.in_phase, "load.sigma: out of phase with load.Q", "be in phase"),
        (bool(load.dslope), "load.sigma_slope: varies", "be constant"),
    ):
        if wrong:
            raise InputError(f"{key}: must {must} for partialslip identify")
    if not scene.finite:
        return scene, ()
    seen = stand_ins(scene, rig_of(scene)).scene
    plain = seen.replace(load={"M": None, "sigma_slope": [0.0] * len(seen.load.points)})
    return plain, ("Bodies of a size act as equivalent half-planes, without tilt and slope of the tension.",)
