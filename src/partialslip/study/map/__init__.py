"""The stick-zone map: stick zones as functions of the loads."""

from partialslip.study.map.files import place as place
from partialslip.study.map.files import write_map as write_map
from partialslip.study.map.grid import StickMap as StickMap
from partialslip.study.map.grid import stick_map as stick_map
from partialslip.study.map.varying import VaryingMap as VaryingMap
from partialslip.study.map.varying import varying_map as varying_map
