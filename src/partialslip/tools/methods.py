"""The methods: the modules that solve, and how figures mark their points. A new method is entered here."""

import importlib
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple


class Method(NamedTuple):
    """A method: the ``module`` that has ``solve(scene, plan, progress, start)``; what else ``solve`` ``takes`` by name;
    the ``marks`` of p and q in figures; and whether others may be compared with it (``refers``). The module is imported
    when it first solves, as finite elements import slowly."""

    module: str
    takes: tuple[str, ...] = ()
    marks: tuple[str, str] = ("x", "s")
    refers: bool = True

    def solver(self, **offered: Any) -> Callable[..., Any]:
        """Return ``solve``, with what it takes of the things ``offered``."""
        solve: Callable[..., Any] = importlib.import_module(self.module).solve
        return partial(solve, **{name: offered[name] for name in self.takes})


METHODS = {  # by preference
    "exact": Method("partialslip.halfplane.method"),
    "march": Method("partialslip.march.method", ("allowance",)),
    "fem": Method("partialslip_fem.method", ("keep", "allowance"), ("+", "o")),
    "equivalent": Method("partialslip.march.equivalent.method", ("rig_of",), refers=False),
}
REFERENCES = tuple(name for name, method in METHODS.items() if method.refers)
