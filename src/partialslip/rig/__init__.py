"""What bodies of a size add to half-planes: plain data, which finite elements find once for each geometry."""

from partialslip.rig.file import load_rig as load_rig
from partialslip.rig.file import write_rig as write_rig
from partialslip.rig.rig import Rig as Rig
from partialslip.rig.rig import Terms as Terms
from partialslip.rig.rig import key_of as key_of
