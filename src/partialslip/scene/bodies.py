"""Finite bodies: their shapes, or the files of their meshes, and what holds them."""

from collections.abc import Iterator
from typing import Annotated, Literal

import msgspec

from partialslip.errors import InputError
from partialslip.scene.table import Positive, Table

_SLENDEREST = 1e-4  # height in width, or the other way round


class Holder(Table, frozen=True, kw_only=True):
    """A block behind a body and one piece with it: ``width`` and ``height``, m."""

    width: Positive
    height: Positive


class Body(Table, frozen=True, kw_only=True):
    """A finite body, pressed on in the middle of its face.

    Its ``kind``: a ``block`` is rectangular; the face of a ``pad`` has the profile's true shape, a cylinder's arc for
    hertz, and only one body can have it. ``width`` and ``height`` (m; of a pad in its middle) are the body's, behind
    which a ``holder`` may sit. Instead of those ``mesh`` may be the path of a file, whose lengths are in units of
    ``unit`` (m).

    ``support`` says what holds the body, or its holder, and carries P and Q: ``clamped``, the back by a rigid plate
    that does not turn; ``roller``, the back by a plate along which it slides (the middle plane of a specimen of twice
    the height), and the sides against motion along x; ``sides``, those alone, by rigid plates. All else is free. Of the
    lower body, if it is ``pulled``, the right side is free of its support: there sigma is a traction, and is carried by
    the left side.
    """

    kind: Literal["block", "pad"] = "block"
    width: Positive | None = None
    height: Positive | None = None
    holder: Holder | None = None
    mesh: Annotated[str, msgspec.Meta(min_length=1)] | None = None
    unit: Positive | None = None
    support: Literal["clamped", "roller", "sides"] = "clamped"
    pulled: bool = False

    def check(self, name: str) -> None:
        """Raise InputError, with ``name`` before the field's, if the fields do not go together."""
        sizes = {"width": self.width, "height": self.height}
        for key, value in sizes.items():
            if (value is None) == (self.mesh is None):
                raise InputError(f"{name}.{key}: {'missing' if value is None else 'not together with a mesh'}")
        if self.mesh is not None and self.holder:
            raise InputError(f"{name}.holder: not together with a mesh")
        if self.unit is not None and self.mesh is None:
            raise InputError(f"{name}.unit = {self.unit}: only together with a mesh")
        if self.pulled and self.support == "clamped":
            raise InputError(f"{name}.pulled = true: must have support 'roller' or 'sides', not 'clamped'")
        tables = {name: (self.width, self.height)}
        if self.holder:
            tables[f"{name}.holder"] = (self.holder.width, self.holder.height)
        for table, (width, height) in tables.items():
            if width and height and not _SLENDEREST <= height / width <= 1 / _SLENDEREST:
                times = f"must be {_SLENDEREST:g} to {1 / _SLENDEREST:g} times its width, {width}"
                raise InputError(f"{table}.height = {height}: {times}")


class Bodies(Table, frozen=True, kw_only=True):
    """The bodies that are finite, ``upper`` or ``lower`` or both; the others, None, are half-planes."""

    upper: Body | None = None
    lower: Body | None = None

    def __post_init__(self) -> None:
        for name, body in self:
            body.check(name)
        if self.upper and self.upper.pulled:
            raise InputError("bodies.upper.pulled = true: must be false; sigma is the lower body's")
        if self.upper and self.lower and self.upper.kind == self.lower.kind == "pad":
            raise InputError("bodies.lower.kind = 'pad': must be 'block', as the upper one is the pad")

    def __iter__(self) -> Iterator[tuple[str, Body]]:
        """Names, as in a scene file, and bodies."""
        named = {"bodies.upper": self.upper, "bodies.lower": self.lower}
        return ((name, body) for name, body in named.items() if body)

    @property
    def pad(self) -> str | None:
        """Which of them has the profile for its face."""
        return next((name for name, body in self if body.kind == "pad"), None)
