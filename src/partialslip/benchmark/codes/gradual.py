"""Increments of load steps for codes that count slip from the start of an increment."""

from partialslip.scene import Scene

_INCREMENTS = 16


def gradual(scene: Scene) -> Scene:
    """``scene`` with at least 16 increments a step where the contact grows or shrinks while it slips: where P or M
    varies, or the pressure depends on the shear."""
    if not (scene.presses_anew or not scene.mirrored) or scene.only_pressed:
        return scene
    return scene.replace(load={"steps": max(scene.load.steps, _INCREMENTS)})
