"""Hard cases: mirrored loads."""

from collections.abc import Iterator

from partialslip.verify.case import Case
from partialslip.verify.hard_cases.scenes import hard_scene

TITLE = "Mirrored loads"
HARD = """
If Q changes sign and sigma does not, the stick zone moves to the other side. This case alone detects a sign that is
right in only one half of the contact, or a tension applied in the wrong direction.
"""


def cases() -> Iterator[Case]:
    """Make the cases of the family."""
    for name, Qf, sf in (("mirrored-small", -0.75, 2.4), ("mirrored-large", -0.4, 4.03)):
        yield Case(name, hard_scene(name, Qf, sf))
