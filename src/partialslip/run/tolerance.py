"""What the tolerances of a scene's numbers allow its results: intervals, shares, and changes of regime, as plain data.

:mod:`partialslip.study.tolerance` finds them. They are no part of estimates, bars and verdicts, which are about the
numerical error: how far the solution of the scene, as given, is from the true one.
"""

import msgspec

from partialslip.scene.units import Dimension

COVERAGE = 0.95  # fixed: probability of an interval


class Interval(msgspec.Struct, frozen=True):
    """What the tolerances allow one quantity.

    Parameters
    ----------
    of : Dimension
    value : float
        For the scene as given, SI units; m and n in a.
    low, high : float or None
        Quantiles (1 -+ COVERAGE)/2 over the draws that have this quantity; None if it is known at no other values of
        the inputs.
    error : float or None
        Estimated numerical error of the value; None if there is no estimate.
    shares : dict of str to float
        By input, first-order Sobol' index: Var(E[y | input])/Var(y), largest first. What is missing to 1 is due to
        inputs together.
    ends : dict of str to (float or None, float or None)
        By input, the quantity at the lower and the upper reach of this input alone; None where it does not exist.
    """

    of: Dimension
    value: float
    low: float | None
    high: float | None
    error: float | None
    shares: dict[str, float]
    ends: dict[str, tuple[float | None, float | None]]


class RegimeChange(msgspec.Struct, frozen=True):
    """The ``value`` (SI units; of a list the largest size) at which the input ``key``, alone, changes the regime to
    ``regime``; ``share`` is the relative change of the input, None from 0."""

    regime: str
    key: str
    value: float
    share: float | None


class Propagation(msgspec.Struct, frozen=True):
    """What the tolerances of a scene allow its results.

    Parameters
    ----------
    method : str
        Method that solved the scene and its draws.
    solves, draws : int
        Number of solved scenes, and of draws among them; without draws the results follow from differences.
    misfit : float
        Largest deviation, in the width of the interval, at solved corners and draws that were not fitted.
    inputs : dict of str to str
        Tolerances as text, by dotted key.
    quantities : dict of str to Interval
    regimes : dict of str to float
        Probability of each regime.
    changes : tuple of RegimeChange
        The nearest changes of regime.
    refused : dict of str to int
        Numbers of scenes that could not be solved, by reason.
    """

    method: str
    solves: int
    draws: int
    misfit: float
    inputs: dict[str, str]
    quantities: dict[str, Interval]
    regimes: dict[str, float]
    changes: tuple[RegimeChange, ...] = ()
    refused: dict[str, int] = {}
