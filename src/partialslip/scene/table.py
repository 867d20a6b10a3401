"""Base type of the tables of a scene file."""

from typing import Annotated, Any

import msgspec

from partialslip.shown import Short

Positive = Annotated[float, msgspec.Meta(gt=0)]


class Validated(msgspec.StructMeta):
    """Metaclass of tables: a call validates and converts its arguments like the keys of a scene file."""

    def __call__(cls, /, **keys: Any) -> Any:  # noqa: N805
        """Make the table from its ``keys``.

        Raises
        ------
        InputError
            With the line that the same keys in a scene file get.
        """
        optional = len([each for each in cls.__struct_defaults__ if each is not msgspec.NODEFAULT])
        if not keys and optional == len(cls.__struct_fields__):
            return super().__call__()  # the defaults, needed while the classes of partialslip.scene are defined
        from partialslip.scene.reading import make_table

        written = dict(zip(cls.__struct_fields__, cls.__struct_encode_fields__, strict=True))
        return make_table(cls, {written.get(key, key): value for key, value in keys.items()})  # type: ignore[arg-type]


class Table(Short, msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True, metaclass=Validated):
    """Table of a scene file: immutable, validated; unknown keys are errors."""
