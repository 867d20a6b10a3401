"""Fatigue criteria from the stresses of a solved scene."""

from partialslip.fatigue.criteria import fatemi_socie as fatemi_socie
from partialslip.fatigue.criteria import findley as findley
from partialslip.fatigue.criteria import principal_range as principal_range
from partialslip.fatigue.criteria import smith_watson_topper as smith_watson_topper
from partialslip.fatigue.criteria import with_zz as with_zz
from partialslip.fatigue.invariants import crossland as crossland
from partialslip.fatigue.invariants import dang_van as dang_van
