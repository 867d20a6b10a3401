"""What numbers and text of a scene may be."""

# Numbers are zero or within these magnitudes, so that products and squares of a few of them stay finite.
SMALLEST, LARGEST = 1e-100, 1e100

ROUGH = 1e-9  # a difference of numbers, in the largest one, that is taken for rounding
STEEPEST = 0.9  # sine of the angle to which a pad's round face may go

# What may not be in text that terminals, pages and figures show: control characters, line and paragraph separators,
# marks that turn the direction of writing round, halves of surrogate pairs, and what XML does not allow.
NO_TEXT = (
    r"\x00-\x1f\x7f-\x9f\u2028\u2029"
    r"\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069"
    r"\ud800-\udfff\ufffe\uffff"
)
