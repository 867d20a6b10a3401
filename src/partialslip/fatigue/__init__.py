"""Fatigue criteria from the stresses of a solved scene, and asymptotes at the ends of the contact."""

from partialslip.fatigue.assessment import Assessment as Assessment
from partialslip.fatigue.assessment import Rating as Rating
from partialslip.fatigue.assessment import Spot as Spot
from partialslip.fatigue.assessment import assess as assess
from partialslip.fatigue.critical_plane import Ruiz as Ruiz
from partialslip.fatigue.critical_plane import fatemi_socie as fatemi_socie
from partialslip.fatigue.critical_plane import findley as findley
from partialslip.fatigue.critical_plane import principal_range as principal_range
from partialslip.fatigue.critical_plane import ruiz as ruiz
from partialslip.fatigue.critical_plane import smith_watson_topper as smith_watson_topper
from partialslip.fatigue.critical_plane import with_zz as with_zz
from partialslip.fatigue.edges import Coefficient as Coefficient
from partialslip.fatigue.edges import Edge as Edge
from partialslip.fatigue.edges import edges as edges
from partialslip.fatigue.invariants import crossland as crossland
from partialslip.fatigue.invariants import dang_van as dang_van
from partialslip.fatigue.planes import Critical as Critical
from partialslip.fatigue.spots import HotSpot as HotSpot
from partialslip.fatigue.spots import hot_spots as hot_spots
