"""partialslip: benchmarks for frictional contact calculations.

>>> import partialslip
>>> scene = partialslip.load_scene("fretting-aluminium")
>>> exact = partialslip.run(scene, methods=["exact"]).results["exact"]
>>> round(exact.m / exact.a, 6), round(exact.n / exact.a, 6)
(0.419531, 0.020906)
"""

from importlib.metadata import version

from partialslip.allowance import Allowance as Allowance
from partialslip.errors import InputError as InputError
from partialslip.errors import PartialslipError as PartialslipError
from partialslip.export import export as export
from partialslip.judge import Comparison as Comparison
from partialslip.judge import Outcome as Outcome
from partialslip.judge import Verdict as Verdict
from partialslip.judge import compare as compare
from partialslip.plan import Plan as Plan
from partialslip.plan import plan as plan
from partialslip.record import Record as Record
from partialslip.record import load_result as load_result
from partialslip.result import Result as Result
from partialslip.result import Slip as Slip
from partialslip.result import Traction as Traction
from partialslip.result.state import State as State
from partialslip.result.state import load_state as load_state
from partialslip.run import Run as Run
from partialslip.run import run as run
from partialslip.scene import Scene as Scene
from partialslip.scene.reading import load_scene as load_scene
from partialslip.scene.reading import parse_scene as parse_scene
from partialslip.scene.reading import shipped_scenes as shipped_scenes
from partialslip.score import score as score

__version__ = version("partialslip")
