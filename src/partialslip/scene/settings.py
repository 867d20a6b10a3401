"""Settings in a scene: of finite elements, forced effects, and constants of fatigue criteria."""

from typing import Annotated, Literal

import msgspec

from partialslip.scene.table import Positive, Table

# cost: accuracy below which elements of order 6 cost less than those of order 4 (benchmarks/accuracy.py cost)
_FINE = 1e-7
WIDTHS = {"half-plane": 16.0, "box": 4096.0}  # accuracy: default half-width of a block, in contact half-widths


class Fem(Table, frozen=True, kw_only=True):
    """Settings of the finite-element method.

    ``accuracy``: of a, m and n, as a fraction of a (marching uses it for m and n, too). ``order``: polynomial order of
    the triangles; default 4, and 6 where meshes are refined to less than 1e-7. ``far_field``: condition on the outer
    boundary of a block that stands for a half-plane, either the displacements of the half-plane under the contact
    tractions or a clamped ``box``. ``width``: half-width of such a block, in contact half-widths. ``lower_size``:
    element size of the lower body relative to the upper body; the nodes of the two bodies match only at 1. ``size``:
    element size along the contact, in contact half-widths, of one mesh, instead of refinement to ``accuracy``.
    ``factor``: solver of the stiffness; default cholmod if cvxopt is installed.
    """

    accuracy: Annotated[float, msgspec.Meta(ge=1e-9, le=0.1)] = 2e-5
    order: Literal[1, 2, 3, 4, 6] | None = None
    far_field: Literal["half-plane", "box"] = "half-plane"
    width: Annotated[float, msgspec.Meta(ge=4, le=1e6)] | None = None
    lower_size: Annotated[float, msgspec.Meta(ge=0.1, le=10)] = 1.0
    size: Annotated[float, msgspec.Meta(ge=1e-4, le=0.5)] | None = None
    factor: Literal["superlu", "cholmod"] | None = None

    @property
    def elements(self) -> int:
        """Order of the elements: the one asked for, or the one that costs least."""
        return self.order or (6 if self.size is None and self.accuracy < _FINE else 4)


class Effects(Table, frozen=True, kw_only=True, rename="kebab"):
    """Effects that are forced on (true) or off (false); None leaves the decision to :mod:`partialslip.plan`.

    ``normal``, ``varying_pressure``, ``moment``, ``friction``, ``shear``, ``tension``, ``opposing_slip``, ``history``,
    ``coupling``, ``finite_size``, ``far_field``, ``subsurface``; in a scene file with hyphens.
    """

    normal: bool | None = None
    varying_pressure: bool | None = None
    moment: bool | None = None
    friction: bool | None = None
    shear: bool | None = None
    tension: bool | None = None
    opposing_slip: bool | None = None
    history: bool | None = None
    coupling: bool | None = None
    finite_size: bool | None = None
    far_field: bool | None = None
    subsurface: bool | None = None


_Influence = Annotated[float, msgspec.Meta(ge=0)]


class Fatigue(Table, frozen=True, kw_only=True):
    """Constants of fatigue criteria (:func:`partialslip.assess`), which change no solution. None has a default.

    ``sigma_y``: yield stress, Pa. ``k_fatemi_socie``, ``k_findley``, ``alpha_dang_van``, ``alpha_crossland``: influence
    of the normal or hydrostatic stress in the criterion. ``distance``: depth over which stresses are averaged, m.
    ``sigma_upper``: tension at load points 1 and 2, Pa, of the upper body of half-planes, which the lower body carries
    besides ``load.sigma``.
    """

    sigma_y: Positive | None = None
    k_fatemi_socie: _Influence | None = None
    k_findley: _Influence | None = None
    alpha_dang_van: _Influence | None = None
    alpha_crossland: _Influence | None = None
    distance: Positive | None = None
    sigma_upper: tuple[float, float] | None = None
