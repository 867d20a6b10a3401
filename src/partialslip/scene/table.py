"""Base type of the tables of a scene file, and the limits of numbers and text in them."""

from typing import Annotated, Any

import msgspec

from partialslip.tools.shown import Short

# limit: Numbers are zero or within these magnitudes, so that products and squares of a few numbers stay finite.
SMALLEST, LARGEST = 1e-100, 1e100

ROUGH = 1e-9  # limit: difference of numbers, relative to the largest, that is taken for rounding
STEEPEST = 0.9  # limit: largest sine of the slope angle of a pad's round face

# Characters forbidden in text shown in terminals, pages and figures: control characters, line and paragraph separators,
# bidirectional marks, unpaired surrogates, and characters that XML does not allow.
NO_TEXT = (
    r"\x00-\x1f\x7f-\x9f\u2028\u2029"
    r"\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069"
    r"\ud800-\udfff\ufffe\uffff"
)


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
