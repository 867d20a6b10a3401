"""What bodies of a size add to half-planes: plain data, which finite elements find once for each geometry."""

from partialslip.result.rig.file import load_rig as load_rig
from partialslip.result.rig.file import write_rig as write_rig
from partialslip.result.rig.rig import Rig as Rig
from partialslip.result.rig.rig import Terms as Terms
from partialslip.result.rig.rig import key_of as key_of
