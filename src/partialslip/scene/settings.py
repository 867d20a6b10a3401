"""What a scene asks of the methods: settings of finite elements, and effects that are forced."""

from typing import Annotated, Literal

import msgspec

from partialslip.scene.table import Table

WIDTHS = {"half-plane": 16.0, "box": 4096.0}  # half-widths of a block in contact half-widths, as a rule


class Fem(Table, frozen=True, kw_only=True):
    """Settings of the finite-element method.

    ``accuracy`` is asked of a, m and n, as a fraction of a (of m and n in marching, too); ``order`` is the
    polynomial order of the triangles; ``far_field`` says what holds the block's outer boundary: the half-plane's
    displacements under the contact tractions, or a clamped ``box``; ``width`` is the block's half-width in contact
    half-widths. Both are of bodies without a size of their own. ``lower_size`` is the size of the lower body's elements
    in that of the upper body's: with any other than 1 the nodes of the two do not match. ``size`` asks for one mesh of
    that element size, in contact half-widths, all along the contact, instead of refinement to an accuracy. ``factor``
    names what factors the stiffness: as a rule cholmod, if cvxopt is installed.
    """

    accuracy: Annotated[float, msgspec.Meta(ge=1e-9, le=0.1)] = 2e-5
    order: Literal[1, 2, 3, 4] = 4
    far_field: Literal["half-plane", "box"] = "half-plane"
    width: Annotated[float, msgspec.Meta(ge=4, le=1e6)] | None = None
    lower_size: Annotated[float, msgspec.Meta(ge=0.1, le=10)] = 1.0
    size: Annotated[float, msgspec.Meta(ge=1e-4, le=0.5)] | None = None
    factor: Literal["superlu", "cholmod"] | None = None


class Effects(Table, frozen=True, kw_only=True, rename="kebab"):
    """Effects that are forced on (true) or off (false), whatever the scene calls for; see :mod:`partialslip.plan`.

    ``normal``, ``friction``, ``shear``, ``tension``, ``opposing_slip``, ``history``, ``coupling``, ``finite_size``,
    ``far_field``, ``subsurface``; in a scene file with hyphens.
    """

    normal: bool | None = None
    friction: bool | None = None
    shear: bool | None = None
    tension: bool | None = None
    opposing_slip: bool | None = None
    history: bool | None = None
    coupling: bool | None = None
    finite_size: bool | None = None
    far_field: bool | None = None
    subsurface: bool | None = None
