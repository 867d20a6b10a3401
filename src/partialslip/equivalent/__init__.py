"""Bodies of a size as half-planes with other data: another curvature, a tilt, another tension that varies along x."""

from partialslip.equivalent.many import stick_zone as stick_zone
from partialslip.equivalent.method import StandIns as StandIns
from partialslip.equivalent.method import solve as solve
from partialslip.equivalent.method import stand_ins as stand_ins
from partialslip.equivalent.words import Share as Share
from partialslip.equivalent.words import in_words as in_words
from partialslip.equivalent.words import shares as shares
