"""Results: the data types that every method returns."""

from partialslip.result.cost import Clock as Clock
from partialslip.result.cost import Cost as Cost
from partialslip.result.fields import DeformedBody as DeformedBody
from partialslip.result.fields import Slip as Slip
from partialslip.result.fields import StressAt as StressAt
from partialslip.result.fields import SurfaceStress as SurfaceStress
from partialslip.result.plates import Plates as Plates
from partialslip.result.refining import Pace as Pace
from partialslip.result.result import FRICTIONLESS as FRICTIONLESS
from partialslip.result.result import PATH_DEPENDENT as PATH_DEPENDENT
from partialslip.result.result import RATCHETS as RATCHETS
from partialslip.result.result import EndSlip as EndSlip
from partialslip.result.result import Regime as Regime
from partialslip.result.result import Result as Result
from partialslip.result.result import SteadyState as SteadyState
from partialslip.result.state import State as State
from partialslip.result.state import load_state as load_state
from partialslip.result.stick_zone import StickZone as StickZone
from partialslip.result.traction import Observed as Observed
from partialslip.result.traction import Traction as Traction
from partialslip.result.traction import TractionAt as TractionAt
