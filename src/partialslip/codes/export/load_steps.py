"""Load steps of a scene: pressing, and then the load points in every cycle."""

from typing import NamedTuple

from partialslip.scene import Scene

TOUCH = 1 / 64  # accuracy: of P, under which the upper body is guided, where pressing makes the surfaces slip
_CYCLES = 5  # accuracy: towards the steady state, where the loads are not fully reversed and load.cycles does not tell
_PRESSING = 16  # accuracy: increments of pressing, where it makes the surfaces slip


class Step(NamedTuple):
    """A load step.

    Parameters
    ----------
    name : str
    P, Q, sigma, M : float
        Loads at the end of the step, N/m, N/m, Pa and N.
    increments : int
        Number of increments.
    guided : bool
        Whether the upper body is held along x, as there is no friction that could carry it.
    """

    name: str
    P: float
    Q: float
    sigma: float
    M: float = 0.0
    increments: int = 1
    guided: bool = False


def slips_under_pressure(scene: Scene) -> bool:
    """Whether pressing alone moves the surfaces along x against each other, and friction resists."""
    return scene.friction.f > 0 and not scene.mirrored


def steps_of(scene: Scene) -> tuple[Step, ...]:
    """Load steps: press, go to the last load point, then through all load points in every cycle.

    Where pressing makes the surfaces slip, it is gradual, and the upper body is guided only while it begins to touch.
    """
    load, free = scene.load, not scene.friction.f
    points = [(P, Q, sigma, M or 0.0) for (P, M), (Q, sigma) in zip(scene.pressing, load.points, strict=True)]
    P, *_, M = points[-1]
    if slips_under_pressure(scene):
        touch = Step("touch", P * TOUCH, 0.0, 0.0, M * TOUCH, guided=True)
        pressed = [touch, Step("press", P, 0.0, 0.0, M, _PRESSING)]
    else:
        pressed = [Step("press", P, 0.0, 0.0, M, guided=True)]
    if scene.only_pressed:
        return tuple(pressed)
    cycles = load.cycles or (1 if load.fully_reversed else _CYCLES)
    visits = [(f"load point {len(points)}, first time", points[-1])]
    visits += [
        (f"cycle {cycle}, load point {number}", point)
        for cycle in range(1, cycles + 1)
        for number, point in enumerate(points, start=1)
    ]
    return (*pressed, *(Step(name, *point, load.steps, guided=free) for name, point in visits))
