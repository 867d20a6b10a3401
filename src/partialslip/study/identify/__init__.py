"""The coefficient of friction from measurements: from a loop of Q over displacement, or the width of a scar."""

from partialslip.study.identify.fit import Identified as Identified
from partialslip.study.identify.fit import from_loop as from_loop
from partialslip.study.identify.interval import Interval as Interval
from partialslip.study.identify.measured_loop import MeasuredLoop as MeasuredLoop
from partialslip.study.identify.measured_loop import read_loop as read_loop
from partialslip.study.identify.width import from_width as from_width
