"""Finite elements: two elastic bodies in frictional contact, in plane strain or plane stress."""

from partialslip_fem.level import forget as forget
from partialslip_fem.model import solve as solve
