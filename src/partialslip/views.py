"""What a notebook shows of a scene, a result, a comparison or a run.

They ask here, and know no more of it; :mod:`partialslip.notebook` says that the report answers, which knows them all.
"""

from functools import singledispatch
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.axes import Axes as Axes


@singledispatch
def html(what: object) -> str:
    """``what`` as HTML: tables. Raises TypeError for what has no such view."""
    raise TypeError(f"{type(what).__name__} has no view as HTML")


@singledispatch
def plot(what: object, axes: "Axes | None" = None) -> "Axes":
    """``what`` drawn on ``axes``, or on new ones. Raises TypeError for what has no such view."""
    del axes
    raise TypeError(f"{type(what).__name__} has no plot")
