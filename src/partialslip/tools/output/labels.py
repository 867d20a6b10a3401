"""Place labels on lines where there is most room."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from partialslip.tools.arrays import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# display: distances in heights of the axes
_MARGIN = 0.055  # display: to the border
_PACE = 0.01  # display: between candidate places
_SIZE = 8.0  # display: of the text, points
_ROOM = 0.05  # display: to other lines and labels
_CLEAR = 0.07  # display: to avoided points
_ALIKE = 0.12  # display: between labels with the same text, of which the second is left out
CROSSING = 2.0


def label_lines(
    axes: "Axes",
    lines: Sequence[Array],
    texts: Sequence[str],
    avoided: Array,
    crossing: float = CROSSING,
    size: float = _SIZE,
    margin: float = _MARGIN,
) -> None:
    """Label ``lines`` on ``axes`` with ``texts``, each label at the place farthest from other lines and labels.

    Parameters
    ----------
    axes : matplotlib Axes
        Must have the final size.
    lines : sequence of (n, 2) arrays
    texts : sequence of str
        One per line. A line without room gets no label, nor does one whose label would stand near another that says
        the same.
    avoided : (k, 2) array
        Points to keep clear.
    crossing : float
        Ratio of the distance to a label to the distance to a line.
    size : float
        Of the text, points.
    margin : float
        Least distance of the middle of a label to the border, in heights of the axes.
    """
    to_paper = axes.transData - axes.transAxes
    width = axes.bbox.width / axes.bbox.height
    scale = np.array([width, 1.0])
    on_paper = [to_paper.transform(line) * scale for line in lines]
    places = label_places(on_paper, to_paper.transform(avoided) * scale, width, crossing, margin)
    told: list[tuple[str, Array]] = []
    for place, text in zip(places, texts, strict=True):
        if place is None or any(text == other and math.dist(place[0], at) < _ALIKE for other, at in told):
            continue
        told.append((text, place[0]))
        (x, y), along = place[0] / scale, place[1]
        axes.text(
            x,
            y,
            text,
            transform=axes.transAxes,
            rotation=np.degrees(np.arctan(along[1] / along[0])),
            ha="center",
            va="center",
            fontsize=size,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5},
        )


def label_places(
    lines: Sequence[Array], avoided: Array, width: float, crossing: float = CROSSING, margin: float = _MARGIN
) -> list[tuple[Array, Array] | None]:
    """Return place (2,) and direction (2,) of the label of each line; None where there is no room.

    All lengths are in heights of the axes: ``lines`` (n, 2), ``avoided`` points (k, 2), and ``width`` of the axes.
    """
    shape = np.array([width, 1.0])
    paced = [_paced(line) for line in lines]
    paced = [line[((line > 0) & (line < shape)).all(axis=1)] for line in paced]
    places: list[tuple[Array, Array] | None] = []
    labels = np.empty((0, 2))
    for number, line in enumerate(paced):
        others = np.concatenate([labels[:0], *paced[:number], *paced[number + 1 :]])
        room = np.minimum(crossing * _distance(line, others), _distance(line, labels))
        room[((line < margin) | (line > shape - margin)).any(axis=1) | (_distance(line, avoided) < _CLEAR)] = 0
        if room.max(initial=0) < _ROOM:
            places.append(None)
            continue
        best = int(room.argmax())
        labels = np.vstack([labels, line[best]])
        places.append((line[best], line[min(best + 1, len(line) - 1)] - line[max(best - 1, 0)]))
    return places


def _paced(line: Array) -> Array:
    """Return points along ``line`` (n, 2), _PACE apart."""
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    at = np.arange(0.0, way[-1], _PACE)
    return np.column_stack([np.interp(at, way, along) for along in line.T])


def _distance(points: Array, others: Array) -> Array:
    """Return the distances (n,) of ``points`` (n, 2) to the nearest of ``others`` (k, 2), 1 at most."""
    apart = points[:, None] - others
    return np.sqrt((apart**2).sum(axis=-1)).min(axis=1, initial=1.0)
