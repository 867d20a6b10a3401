"""One proportional change of the loads, of half-planes or of layers."""

from partialslip.halfplane.contact import Contact
from partialslip.halfplane.loading import Loading, in_half_planes
from partialslip.halfplane.sheared_layers import in_layers


def loading(pressed: Contact, f: float, dQ: float, dsigma: float, dslope: float = 0.0, *, bound: int) -> Loading:
    r"""Loading by ``dQ`` (N/m), ``dsigma`` (Pa) and ``dslope`` (Pa/m, of half-planes) of any sign, with \|dQ\| <
    ``bound`` f P.

    Raises
    ------
    InputError
        If the tension, or friction, varies too much along x for a single stick zone.
    """
    if pressed.layer:
        return in_layers(pressed, f, dQ, dsigma, bound=bound)
    return in_half_planes(pressed, f, dQ, dsigma, dslope, bound=bound)
