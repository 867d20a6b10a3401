"""Increments of load steps for codes that count slip from the start of an increment."""

from collections.abc import Sequence

from partialslip.codes.export.load_steps import Step
from partialslip.scene import Scene
from partialslip.verify.benchmark.turning import slip_reverses

_INCREMENTS = 16  # accuracy: of the decks, from load point to load point
_TURNING = 64  # accuracy: where slip reverses: with fewer, most codes find the zone of one step (docs/scoreboard.md)


def gradual(scene: Scene, increments: int | None = None) -> Scene:
    """``scene`` with exactly so many ``increments`` a step. None: with at least 16 where the contact grows or shrinks
    while it slips (P or M varies, or the pressure depends on the shear), and at least 64 where slip reverses."""
    if increments is None:
        anew = (scene.presses_anew or not scene.mirrored) and not scene.only_pressed
        least = _TURNING if slip_reverses(scene) else _INCREMENTS if anew else 1
        increments = max(scene.load.steps, least)
    return scene if increments == scene.load.steps else scene.replace(load={"steps": increments})


def refined(steps: Sequence[Step], least: int, just: int | None = None) -> list[Step]:
    """``steps`` with ``least`` increments or more each; those after pressing as they are if ``just`` so many are
    asked for."""
    leasts = (1 if just and step.name != "press" else least for step in steps)
    return [step._replace(increments=max(step.increments, of)) for step, of in zip(steps, leasts, strict=True)]


def told(increments: int | None) -> str:
    """Words for a number of ``increments`` that was chosen, to end settings with."""
    return "" if increments is None else f", {increments} increments a step"
