"""The methods: what solves a scene. A new one is entered here and, by name, in :mod:`partialslip.tools.methods`."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, NamedTuple, Protocol

from partialslip.result import Result
from partialslip.result.rig import Rig
from partialslip.result.state import State
from partialslip.scene import Scene
from partialslip.scene.plan import Plan
from partialslip.tools.allowance import Allowance

if TYPE_CHECKING:
    from partialslip_fem import Kept

Progress = Callable[[str], None]


class Means(NamedTuple):
    """What a run offers its methods; each takes what it has a use for.

    Parameters
    ----------
    rig_of : callable
        Gives the rig of a scene.
    keep : Kept or None
        Condensed bodies of earlier runs, to reuse and to add to.
    allowance : Allowance or None
        CPU seconds that the run may take.
    """

    rig_of: Callable[[Scene], Rig]
    keep: "Kept | None" = None
    allowance: Allowance | None = None


class Solve(Protocol):
    """A method: solves ``scene`` with the effects of ``plan`` from the state ``start``, or from bodies without shear,
    and calls ``progress`` with a line from time to time. Raises InputError for what it cannot solve."""

    def __call__(
        self, scene: Scene, plan: Plan, progress: Progress, start: State | None, means: Means, /
    ) -> Result: ...


# each is imported when it first solves, as finite elements import slowly
def _exact(scene: Scene, plan: Plan, progress: Progress, start: State | None, _: Means) -> Result:
    from partialslip.halfplane.method import solve

    return solve(scene, plan, progress, start)


def _march(scene: Scene, plan: Plan, progress: Progress, start: State | None, means: Means) -> Result:
    from partialslip.march.method import solve

    return solve(scene, plan, progress, start, means.allowance)


def _fem(scene: Scene, plan: Plan, progress: Progress, start: State | None, means: Means) -> Result:
    from partialslip_fem.method import solve

    return solve(scene, plan, progress, start, means.keep, means.allowance)


def _equivalent(scene: Scene, plan: Plan, progress: Progress, start: State | None, means: Means) -> Result:
    from partialslip.march.equivalent.method import solve

    return solve(scene, plan, progress, start, rig_of=means.rig_of)


SOLVERS: Mapping[str, Solve] = {"exact": _exact, "march": _march, "fem": _fem, "equivalent": _equivalent}
