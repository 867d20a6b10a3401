"""The names of the methods, and how figures mark their points. What solves is in :mod:`partialslip.run.methods`."""

from typing import NamedTuple


class Method(NamedTuple):
    """The ``marks`` of p and q in figures, and whether others may be compared with the method (``refers``)."""

    marks: tuple[str, str] = ("x", "s")
    refers: bool = True


METHODS = {  # by preference
    "exact": Method(),
    "march": Method(),
    "fem": Method(("+", "o")),
    "equivalent": Method(refers=False),
}
REFERENCES = tuple(name for name, method in METHODS.items() if method.refers)
