"""Benchmarks for frictional contact calculations in partial slip. All values are in SI units.

Scenes
    load_scene("fretting-aluminium")    a shipped scene by name (shipped_scenes), or a TOML file
    parse_scene({...})                  a scene from nested tables; Scene(...) from Python objects
    scene.replace(friction={"f": 0.4})  a changed scene
    refitted(scene, 20)                 noisy copies of a measured profile

Solving
    run(scene)                          exact and fem, compared: a Run; run["fem"] is a Result
    run(scene, "exact")                 one method of exact, march, fem and equivalent
    sweep(scene, {"friction.f": [...]}) many points, as a data frame
    assess(scene, run["exact"])         fatigue criteria: an Assessment
    characterise(scene)                 what the size of its bodies adds to half-planes: a Rig
    plan(scene)                         the effects that the scene calls for
    compare(result, reference, ...)     a Comparison of two results

Results
    result.a, .m, .n, .p0, .regime      half-width, stick zone [-m, n], 2 P/(pi a), regime
    result.traction.at(x)               p, dq, q1 and q2 at any points
    run.plot(), run.to_dataframe()      figure and table of the tractions

Other codes and files
    score(scene, file), export(scene, ...), load_result(file), load_state(file)

Half-planes alone, for many loads at once: partialslip.halfplane.

>>> import partialslip
>>> scene = partialslip.load_scene("fretting-aluminium")
>>> exact = partialslip.run(scene, "exact")["exact"]
>>> round(exact.m / exact.a, 6), round(exact.n / exact.a, 6)
(0.419531, 0.020906)
"""

import importlib
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from partialslip.tools.lazy import Lazy, make_lazy
from partialslip.tools.moved import keep_old_names

if TYPE_CHECKING:
    from partialslip.codes.export import export as export
    from partialslip.codes.score import score as score
    from partialslip.report.record import Record as Record
    from partialslip.report.record import load_result as load_result
    from partialslip.result import Result as Result
    from partialslip.result import Slip as Slip
    from partialslip.result import Traction as Traction
    from partialslip.result.rig import load_rig as load_rig
    from partialslip.result.state import State as State
    from partialslip.result.state import load_state as load_state
    from partialslip.run import Run as Run
    from partialslip.run import characterise as characterise
    from partialslip.run import run as run
    from partialslip.run.judge import Comparison as Comparison
    from partialslip.run.judge import Outcome as Outcome
    from partialslip.run.judge import Verdict as Verdict
    from partialslip.run.judge import compare as compare
    from partialslip.scene import Scene as Scene
    from partialslip.scene.measured import refitted as refitted
    from partialslip.scene.plan import Plan as Plan
    from partialslip.scene.plan import plan as plan
    from partialslip.scene.reading import load_scene as load_scene
    from partialslip.scene.reading import parse_scene as parse_scene
    from partialslip.scene.reading import shipped_scenes as shipped_scenes
    from partialslip.study.batch.grid import sweep as sweep
    from partialslip.study.fatigue import Assessment as Assessment
    from partialslip.study.fatigue import assess as assess
    from partialslip.tools.allowance import Allowance as Allowance
    from partialslip.tools.errors import InputError as InputError
    from partialslip.tools.errors import PartialslipError as PartialslipError

    __version__: str

# Where each name is defined: modules are imported when a name is used first, so that the command line starts fast.
_HOMES = {
    "Allowance": "tools.allowance",
    "Assessment": "study.fatigue",
    "Comparison": "run.judge",
    "InputError": "tools.errors",
    "Outcome": "run.judge",
    "PartialslipError": "tools.errors",
    "Plan": "scene.plan",
    "Record": "report.record",
    "Result": "result",
    "Run": "run",
    "Scene": "scene",
    "Slip": "result",
    "State": "result.state",
    "Traction": "result",
    "Verdict": "run.judge",
    "assess": "study.fatigue",
    "characterise": "run",
    "compare": "run.judge",
    "export": "codes.export",
    "load_result": "report.record",
    "load_rig": "result.rig",
    "load_scene": "scene.reading",
    "load_state": "result.state",
    "parse_scene": "scene.reading",
    "plan": "scene.plan",
    "refitted": "scene.measured",
    "run": "run",
    "score": "codes.score",
    "shipped_scenes": "scene.reading",
    "sweep": "study.batch.grid",
}
__all__ = [*_HOMES]
_SHOWN = [*__all__, "__version__", "halfplane"]


class _Package(Lazy):
    """This package: also its version, and its folders, which are imported when they are used first."""

    def __dir__(self) -> list[str]:
        return sorted(_SHOWN)

    def __getattr__(self, name: str) -> Any:
        if name == "__version__":
            from importlib.metadata import version

            value: Any = version(self.__name__)
        elif name not in _HOMES and not name.startswith("_") and find_spec(f"{self.__name__}.{name}"):
            value = importlib.import_module(f"{self.__name__}.{name}")
        else:
            return super().__getattr__(name)
        setattr(self, name, value)
        return value


make_lazy(__name__, _HOMES, _Package)
keep_old_names()
