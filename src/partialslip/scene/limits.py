"""Limits of the numbers and the text of a scene."""

# Numbers are zero or within these magnitudes, so that products and squares of a few numbers stay finite.
SMALLEST, LARGEST = 1e-100, 1e100

ROUGH = 1e-9  # difference of numbers, relative to the largest, that is taken for rounding
STEEPEST = 0.9  # largest sine of the slope angle of a pad's round face

# Characters forbidden in text shown in terminals, pages and figures: control characters, line and paragraph separators,
# bidirectional marks, unpaired surrogates, and characters that XML does not allow.
NO_TEXT = (
    r"\x00-\x1f\x7f-\x9f\u2028\u2029"
    r"\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069"
    r"\ud800-\udfff\ufffe\uffff"
)
