"""Finite elements: two elastic bodies in frictional contact, in plane strain or plane stress."""

from partialslip_fem.bodies import Kept as Kept
from partialslip_fem.method import solve as solve
