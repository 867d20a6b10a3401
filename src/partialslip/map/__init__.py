"""The stick-zone map: stick zones as functions of the loads."""

from partialslip.map.files import place as place
from partialslip.map.files import write_map as write_map
from partialslip.map.grid import StickMap as StickMap
from partialslip.map.grid import stick_map as stick_map
from partialslip.map.varying import VaryingMap as VaryingMap
from partialslip.map.varying import varying_map as varying_map
