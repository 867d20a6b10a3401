"""Fatigue criteria from the stresses of a solved scene, and asymptotes at the ends of the contact."""

from partialslip.fatigue.assessment import Assessment as Assessment
from partialslip.fatigue.assessment import Rating as Rating
from partialslip.fatigue.assessment import Spot as Spot
from partialslip.fatigue.assessment import assess as assess
from partialslip.fatigue.criteria import Ruiz as Ruiz
from partialslip.fatigue.criteria import fatemi_socie as fatemi_socie
from partialslip.fatigue.criteria import findley as findley
from partialslip.fatigue.criteria import principal_range as principal_range
from partialslip.fatigue.criteria import ruiz as ruiz
from partialslip.fatigue.criteria import smith_watson_topper as smith_watson_topper
from partialslip.fatigue.criteria import with_zz as with_zz
from partialslip.fatigue.edges import Coefficient as Coefficient
from partialslip.fatigue.edges import Edge as Edge
from partialslip.fatigue.edges import edges as edges
from partialslip.fatigue.invariants import crossland as crossland
from partialslip.fatigue.invariants import dang_van as dang_van
from partialslip.fatigue.planes import Critical as Critical
from partialslip.fatigue.spots import HotSpot as HotSpot
from partialslip.fatigue.spots import hot_spots as hot_spots
