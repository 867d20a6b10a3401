"""Corners of the faces of CalculiX's elements, by the type number of the .frd file and the number of the face.

Source: CalculiX CrunchiX manual, chapters on the element types.
"""

Corners = tuple[tuple[int, ...], ...]

_HEXAHEDRON: Corners = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))
_WEDGE: Corners = ((0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))
_TETRAHEDRON: Corners = ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))
# Plane elements are expanded to solids, whose first two faces are the plane ones.
_TRIANGLE: Corners = ((), (), (0, 1), (1, 2), (2, 0))
_QUADRILATERAL: Corners = ((), (), (0, 1), (1, 2), (2, 3), (3, 0))

#: Indices of a face's corners among the nodes of the element: ``FACE_CORNERS[type][face - 1]``.
FACE_CORNERS: dict[int, Corners] = {
    1: _HEXAHEDRON, 4: _HEXAHEDRON,
    2: _WEDGE, 5: _WEDGE,
    3: _TETRAHEDRON, 6: _TETRAHEDRON,
    7: _TRIANGLE, 8: _TRIANGLE,
    9: _QUADRILATERAL, 10: _QUADRILATERAL,
}  # fmt: skip
