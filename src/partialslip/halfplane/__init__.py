"""The exact solution for two elastically similar half-planes: numpy and scipy only.

>>> import numpy as np
>>> import partialslip
>>> from partialslip import halfplane
>>> pressed = halfplane.contact(partialslip.load_scene("fretting-aluminium"))
>>> zones = halfplane.stick_zone(pressed, f=0.3, dQ=77.5e3, dsigma=np.array([0, 1e8, 2e8]))
>>> np.round(zones.m / pressed.a, 6), np.round(zones.n / pressed.a, 6)
(array([0.220218, 0.319874, 0.419531]), array([0.220218, 0.120562, 0.020906]))
"""

from partialslip.halfplane.contact import Contact as Contact
from partialslip.halfplane.contact import contact as contact
from partialslip.halfplane.contact import contact_of as contact_of
from partialslip.halfplane.contact import one_step_zone as one_step_zone
from partialslip.halfplane.contact import tilted_contact as tilted_contact
from partialslip.halfplane.loop import Loop as Loop
from partialslip.halfplane.loop import hysteresis as hysteresis
from partialslip.halfplane.method import solve as solve
from partialslip.halfplane.stress import Stress as Stress
from partialslip.halfplane.traction import adhered as adhered
from partialslip.halfplane.zones import stick_zone as stick_zone
from partialslip.result import StickZone as StickZone

__all__ = [
    "Contact",
    "Loop",
    "StickZone",
    "Stress",
    "adhered",
    "contact",
    "contact_of",
    "hysteresis",
    "one_step_zone",
    "solve",
    "stick_zone",
    "tilted_contact",
]


def __dir__() -> list[str]:
    """The public names."""
    return __all__
