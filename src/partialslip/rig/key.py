"""Checksum of what a rig depends on."""

import hashlib

import msgspec

from partialslip.inputfile import LARGEST_MESH, checksum
from partialslip.scene import Scene


def key_of(scene: Scene) -> str:
    """Checksum of the bodies of ``scene``, their supports and meshes, E, nu and plane, and the profile of a pad.

    Raises
    ------
    InputError
        If a mesh file cannot be read.
    """
    bodies = msgspec.to_builtins(scene.bodies)
    bodies.pop("equivalent", None)
    for name, body in scene.bodies:
        if body.mesh is not None:
            bodies[name.removeprefix("bodies.")]["mesh"] = checksum(body.mesh, LARGEST_MESH)
    parts = [bodies, scene.material, scene.profile if scene.bodies.pad else None]
    return hashlib.sha256(msgspec.json.encode(parts, order="sorted")).hexdigest()[:16]
