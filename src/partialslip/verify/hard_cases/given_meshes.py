"""Meshes of poor quality for hard cases, for scenes whose bodies are mirror images; lengths in m."""

import numpy as np

from partialslip.arrays import Array
from partialslip.halfplane.contact import contact
from partialslip.scene import Scene
from partialslip_meshes.blocks import block
from partialslip_meshes.mesh import Mesh

_WIDTH = 16.0  # accuracy: width of the blocks, in contact half-widths
_ALONG = 0.05  # accuracy: element size along the contact, in contact half-widths


def one_node(scene: Scene) -> list[Mesh]:
    """Return a mesh for ``scene`` with elements so large that one vertex is in contact."""
    a = contact(scene).a
    return [block(16 * _WIDTH * a, (-32 * a, 32 * a), {0.0: 16 * a}, 0.7)]


def shifted(scene: Scene, share: float) -> list[Mesh]:
    """Return a mesh for ``scene`` of equal elements along the contact, shifted by ``share`` of their size."""
    a = contact(scene).a
    mesh = block(_WIDTH * a, (-1.5 * a, 1.5 * a), {}, 0.3, along=_ALONG * a)
    return [Mesh(mesh.points + np.array([share * _ALONG * a, 0.0]), mesh.triangles, mesh.lines)]


def flat_triangles(scene: Scene, aspect: float) -> list[Mesh]:
    """Return a grid for ``scene`` with equal columns along the contact; cells of the first row are ``aspect`` times
    wider than high."""
    a = contact(scene).a
    middle = np.linspace(-1.5, 1.5, round(3 / _ALONG) + 1)
    beyond = 1.5 + _growing(_ALONG, _WIDTH - 1.5)
    x, y = np.concatenate([-beyond[::-1], middle, beyond]), np.append(0.0, -_growing(_ALONG / aspect, _WIDTH))
    columns, rows = len(x), len(y)
    node = np.arange(rows * columns).reshape(rows, columns)  # from the contact line down
    upper_left, upper_right = node[:-1, :-1].ravel(), node[:-1, 1:].ravel()
    lower_left, lower_right = node[1:, :-1].ravel(), node[1:, 1:].ravel()
    triangles = np.vstack(
        [
            np.column_stack([lower_left, lower_right, upper_right]),
            np.column_stack([lower_left, upper_right, upper_left]),
        ]
    )
    top, outer = np.column_stack([node[0, :-1], node[0, 1:]]), len(beyond)
    lines = {
        "contact": top[outer:-outer],
        "face": np.vstack([top[:outer], top[-outer:]]),
        "back": np.column_stack([node[-1, :-1], node[-1, 1:]]),
        "left": np.column_stack([node[:-1, 0], node[1:, 0]]),
        "right": np.column_stack([node[:-1, -1], node[1:, -1]]),
    }
    return [Mesh(a * np.column_stack([np.tile(x, rows), np.repeat(y, columns)]), triangles, lines)]


def _growing(first: float, end: float) -> Array:
    """Return distances up to ``end``; the first step is about ``first``, each next step 1.5 times the previous."""
    count = int(np.ceil(np.log1p(end / first / 2) / np.log(1.5)))
    result: Array = (1.5 ** np.arange(1.0, count + 1) - 1) * end / (1.5**count - 1)
    return result
