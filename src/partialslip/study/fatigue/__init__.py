"""Fatigue criteria from the stresses of a solved scene, and asymptotes at the ends of the contact."""

from partialslip.study.fatigue.assessment import Assessment as Assessment
from partialslip.study.fatigue.assessment import Rating as Rating
from partialslip.study.fatigue.assessment import Spot as Spot
from partialslip.study.fatigue.assessment import assess as assess
from partialslip.study.fatigue.criteria import crossland as crossland
from partialslip.study.fatigue.criteria import dang_van as dang_van
from partialslip.study.fatigue.critical_plane import Ruiz as Ruiz
from partialslip.study.fatigue.critical_plane import fatemi_socie as fatemi_socie
from partialslip.study.fatigue.critical_plane import findley as findley
from partialslip.study.fatigue.critical_plane import principal_range as principal_range
from partialslip.study.fatigue.critical_plane import ruiz as ruiz
from partialslip.study.fatigue.critical_plane import smith_watson_topper as smith_watson_topper
from partialslip.study.fatigue.critical_plane import with_zz as with_zz
from partialslip.study.fatigue.edges import Coefficient as Coefficient
from partialslip.study.fatigue.edges import Edge as Edge
from partialslip.study.fatigue.edges import edges as edges
from partialslip.study.fatigue.planes import Critical as Critical
from partialslip.study.fatigue.spots import HotSpot as HotSpot
from partialslip.study.fatigue.spots import hot_spots as hot_spots
