"""The stick-zone map: which loads give which stick zone."""

from partialslip.map.files import place as place
from partialslip.map.files import write_map as write_map
from partialslip.map.grid import StickMap as StickMap
from partialslip.map.grid import stick_map as stick_map
