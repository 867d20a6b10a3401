"""The rig of two equal strips, by the kernels of a layer (:mod:`partialslip.halfplane.layer`): no finite elements."""

import numpy as np
from numpy.polynomial import chebyshev

from partialslip.halfplane.layer import Layer
from partialslip.result.rig import Rig, Terms, key_of
from partialslip.scene import Scene
from partialslip.tools.arrays import Array

_REACH = 0.75  # accuracy: range of the polynomials, in heights: what the backs add is singular at 2 heights beyond t
_TERMS, _FEWER = 16, 13  # accuracy: of each polynomial, to about 1e-12, and of those that tell the error


def rig_of_strips(scene: Scene, layer: Layer) -> Rig:
    """The rig of the strips of ``scene``, two equal ``layer``."""
    reach = _REACH * layer.height
    fine, rough = (_terms(scene, layer, reach, count) for count in (_TERMS, _FEWER))
    return Rig(key_of(scene), reach, fine, rough)


def _terms(scene: Scene, layer: Layer, reach: float, count: int) -> Terms:
    """Polynomials with ``count`` terms."""
    points = chebyshev.chebpts1(count)
    series = np.linalg.inv(chebyshev.chebvander(points, count - 1))
    to_powers = np.array([np.pad(own := chebyshev.cheb2poly(row), (0, count - len(own))) for row in np.eye(count)]).T
    odd = np.add.outer(range(count), range(count)) % 2

    def projected(values: Array, parity: int) -> Array:
        found = to_powers @ series @ values @ series.T @ to_powers.T
        return np.pad(np.where(odd == parity, found, 0.0), (0, _TERMS - count))

    shear, normal = (projected(layer.moved(reach * points, along), 0) for along in ("shear", "normal"))
    shear, normal = (shear + shear.T) / 2, (normal + normal.T) / 2
    halves, lower = [shear / 2, shear / 2], scene.bodies.lower
    moved = projected(layer.moved_across(reach * points), 1)
    across = np.array([-moved, moved])  # mirror images: nothing for the pair
    for way, body, held in zip((1, -1), range(2), layer.strips.held, strict=True):
        # sides that are held share shear in proportion to its moment, and bear what pressing widens
        halves[body][1, 1] -= held * reach**2 / (4 * layer.height)
        across[body][1, 0] += way * held * reach * layer.widening / 4
    if lower and lower.pulled and not lower.gripped:  # the left side carries Q: half of it as tension
        halves[0][[0, 1], [1, 0]] += reach / (8 * layer.height)
    return Terms(
        halves[0] + halves[1], normal, across.sum(axis=0), np.zeros((2, _TERMS)), halves[0], normal / 2, across[0]
    )
