"""Bodies of a size as half-planes with other data: another curvature, a tilt, another tension that varies along x."""

from partialslip.march.equivalent.many import stick_zone as stick_zone
from partialslip.march.equivalent.method import StandIns as StandIns
from partialslip.march.equivalent.method import solve as solve
from partialslip.march.equivalent.method import stand_ins as stand_ins
from partialslip.march.equivalent.words import Share as Share
from partialslip.march.equivalent.words import in_words as in_words
from partialslip.march.equivalent.words import shares as shares
