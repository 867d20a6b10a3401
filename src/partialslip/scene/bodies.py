"""Finite bodies: shapes or mesh files, and supports."""

import math
from collections.abc import Iterator
from typing import Annotated, Literal, NamedTuple

import msgspec

from partialslip.scene.table import Positive, Table
from partialslip.tools.errors import InputError

# limit: width of strips, in heights, from which their sides hardly count: the slowest of the states that decay along a
# strip does so as exp(-2.1 x/h), and comes back from either side
_LONG = {"roller": 6.0, "clamped": 20.0}
_SLENDEREST = 1e-4  # limit: smallest ratio of height to width, or of width to height


class Holder(Table, frozen=True, kw_only=True):
    """Block behind a body, bonded to it: ``width`` and ``height``, m."""

    width: Positive
    height: Positive


Name = Annotated[str, msgspec.Meta(min_length=1)] | int


class Groups(Table, frozen=True, kw_only=True):
    """What a mesh file calls the lines of a body's boundary: names, or numbers of physical groups."""

    contact: Name | None = None
    face: Name | None = None
    back: Name | None = None
    left: Name | None = None
    right: Name | None = None

    @property
    def given(self) -> dict[str, str | int]:
        """Names in the file by line, of those that are given."""
        return {line: name for line in self.__struct_fields__ if (name := getattr(self, line)) is not None}


class Body(Table, frozen=True, kw_only=True):
    """A finite body, in contact in the middle of its face.

    ``kind``: a ``block`` is rectangular; the face of a ``pad`` has the true shape of the profile, a circular arc for
    hertz. At most one body is a pad. ``width`` and ``height`` (m; the height of a pad is that in the middle) are the
    size of the body, behind which a ``holder`` may be bonded. The width of two equal strips may be ``infinite``, but
    not for fem. Alternatively ``mesh`` is the path of a mesh file with lengths in units of ``unit`` (m). Of a file with
    more bodies, ``body`` is the part, set or physical group (or its number) that is this one; ``groups`` are the names
    in the file of ``contact``, ``back``, ``left``, ``right`` and ``face``.

    ``support`` holds the body, or its holder, and carries P and Q. ``clamped``: the back is fixed to a rigid plate that
    does not rotate. ``pivot``: this plate turns on a pin on the axis x = 0, at the distance ``pivot_height`` (m) from
    the contact line, until the moment of all forces about the pin is the given one; P and Q act at the pin. ``roller``:
    the back slides along a plate (the middle plane of a specimen of twice the height), and
    the sides cannot move along x. ``sides``: the sides are fixed to rigid plates. All other boundaries are free.
    ``pulled`` (lower body only): sigma acts as a traction on the right side, which has no support, and is carried by
    the left side. The grip on the right side carries the share ``right_grip`` of Q, and the left side the rest. With
    ``right_grip`` = "stiffness" a rigid plate holds the right side as the left one. Sigma moves this plate; it stands
    still while P and Q act, and the shares follow from the stiffness of the body.
    """

    kind: Literal["block", "pad"] = "block"
    width: Positive | Literal["infinite"] | None = None
    height: Positive | None = None
    holder: Holder | None = None
    mesh: Annotated[str, msgspec.Meta(min_length=1)] | None = None
    unit: Positive | None = None
    body: Name | None = None
    groups: Groups | None = None
    support: Literal["clamped", "roller", "sides", "pivot"] = "clamped"
    pivot_height: Annotated[float, msgspec.Meta(ge=0)] | None = None
    pulled: bool = False
    right_grip: Annotated[float, msgspec.Meta(ge=0, le=1)] | Literal["stiffness"] | None = None

    @property
    def span(self) -> float:
        """Width, m: infinite of an infinite strip, NaN of a mesh file."""
        if self.width is None:
            return math.nan
        return self.width if isinstance(self.width, (int, float)) else math.inf

    @property
    def gripped(self) -> bool:
        """Whether a plate holds the right side of a pulled body, so that its share of Q is a result."""
        return self.right_grip == "stiffness"

    @property
    def right_share(self) -> float:
        """Share of Q that is given to the right side of a pulled body."""
        return self.right_grip if isinstance(self.right_grip, (int, float)) else 0.0

    def check(self, name: str) -> None:
        """Raise InputError if fields contradict each other; ``name`` is the body's name in the scene file."""
        sizes = {"width": self.width, "height": self.height}
        for key, value in sizes.items():
            if (value is None) == (self.mesh is None):
                wrong = "missing" if value is None else "must not be given together with mesh"
                raise InputError(f"{name}.{key}: {wrong}")
        if self.mesh is not None and self.holder:
            raise InputError(f"{name}.holder: must not be given together with mesh")
        for key in ("unit", "body", "groups"):
            if (given := getattr(self, key)) is not None and self.mesh is None:
                raise InputError(f"{name}.{key} = {given!r}: must be given only together with mesh")
        if self.pulled and self.support in ("clamped", "pivot"):
            raise InputError(f"{name}.pulled = true: must have support 'roller' or 'sides', not {self.support!r}")
        if self.right_grip and not (self.pulled and (self.gripped or self.mesh is None)):
            only = "must be given only with pulled = true" + ("" if self.gripped else ", width and height")
            raise InputError(f"{name}.right_grip = {self.right_grip!r}: {only}")
        if self.support == "pivot" and self.pivot_height is None:
            raise InputError(f"{name}.pivot_height: missing; must be given with support 'pivot'")
        if self.pivot_height is not None and self.support != "pivot":
            given = f"{name}.pivot_height = {self.pivot_height}"
            raise InputError(f"{given}: must be given only with support 'pivot', not {self.support!r}")
        if self.width == "infinite" and (self.support not in _LONG or self.kind == "pad"):
            either = "support = 'roller' or 'clamped'"
            raise InputError(f"{name}.width = 'infinite': must be a number, or kind = 'block' and {either}")
        tables = {name: (None if self.width == "infinite" else self.width, self.height)}
        if self.holder:
            tables[f"{name}.holder"] = (self.holder.width, self.holder.height)
        for table, (width, height) in tables.items():
            if width and height and not _SLENDEREST <= height / width <= 1 / _SLENDEREST:
                times = f"must be {_SLENDEREST:g} to {1 / _SLENDEREST:g} times the width, {width} m"
                raise InputError(f"{table}.height = {height}: {times}")


class Strips(NamedTuple):
    """Two equal long blocks, on rollers or ``bonded`` to clamped backs: their ``height``, m; ``held``, 1/width of the
    lower and the upper block, 1/m, or zero if not both sides are held along x; and the tension of the lower block, Pa
    per N/m of Q, that its grips make of Q because they do not carry half of it each (``skew``). ``width`` is that of
    the shorter block, m.
    """

    height: float
    width: float
    held: tuple[float, float]
    skew: float
    bonded: bool


class Bodies(Table, frozen=True, kw_only=True):
    """Finite bodies ``upper`` and ``lower``; None stands for a half-plane. ``equivalent`` is the path of a file with
    the rig of these bodies (:func:`partialslip.run.characterise`), for the method ``equivalent``."""

    upper: Body | None = None
    lower: Body | None = None
    equivalent: Annotated[str, msgspec.Meta(min_length=1)] | None = None

    def __post_init__(self) -> None:
        for name, body in self:
            body.check(name)
        if self.equivalent is not None and not (self.upper or self.lower):
            raise InputError(f"bodies.equivalent = {self.equivalent!r}: must be given only with bodies.upper or lower")
        if self.upper and self.upper.pulled:
            raise InputError("bodies.upper.pulled = true: must be false; sigma acts on the lower body")
        if self.upper and self.lower and self.upper.support == self.lower.support == "pivot":
            raise InputError(
                "bodies.lower.support = 'pivot': must be another; bodies.upper pivots, and two pins bear no Q"
            )
        if self.upper and self.lower and self.upper.kind == self.lower.kind == "pad":
            raise InputError("bodies.lower.kind = 'pad': must be 'block'; bodies.upper is a pad")

    def __iter__(self) -> Iterator[tuple[str, Body]]:
        """Names in the scene file and bodies, of the finite bodies."""
        named = {"bodies.upper": self.upper, "bodies.lower": self.lower}
        return ((name, body) for name, body in named.items() if body)

    @property
    def pivots(self) -> str | None:
        """Name of the body that pivots; None if there is none."""
        return next((name for name, body in self if body.support == "pivot"), None)

    @property
    def pin(self) -> float | None:
        """Height of the pin of the body that pivots over the contact line, m, negative for the lower body; None if no
        body pivots."""
        way = {"bodies.upper": 1.0, "bodies.lower": -1.0}
        heights = (way[name] * (body.pivot_height or 0.0) for name, body in self if body.support == "pivot")
        return next(heights, None)

    def require_no_pin(self, purpose: str) -> None:
        """Raise InputError if a body pivots, which the ``purpose`` (in words) does not know."""
        if self.pivots:
            raise InputError(f"{self.pivots}.support = 'pivot': must be another {purpose}")

    def require_widths(self, purpose: str) -> None:
        """Raise InputError if a body is infinite, which the ``purpose`` (in words) does not know."""
        for name, body in self:
            if body.width == "infinite":
                raise InputError(f"{name}.width = 'infinite': must be a number {purpose}, about 40 times the height")

    @property
    def strips(self) -> Strips | None:
        """The bodies, if they are two equal long blocks, both on rollers or both clamped; None otherwise."""
        upper, lower = self.upper, self.lower
        if not (upper and lower and upper.height == lower.height and upper.height):
            return None
        if any(body.kind != "block" or body.holder or body.support != upper.support for body in (upper, lower)):
            return None
        width = min(upper.span, lower.span)
        if upper.support not in _LONG or not width >= _LONG[upper.support] * upper.height:
            return None
        if upper.support == "clamped":
            return Strips(upper.height, width, (0.0, 0.0), 0.0, bonded=True)
        loose = lower.pulled and not lower.gripped
        held = 0.0 if loose else 1 / lower.span, 1 / upper.span
        skew = (lower.right_share - 0.5) / upper.height if loose else 0.0
        return Strips(upper.height, width, held, skew, bonded=False)

    @property
    def pad(self) -> str | None:
        """Name of the body that is a pad; None if there is none."""
        return next((name for name, body in self if body.kind == "pad"), None)
