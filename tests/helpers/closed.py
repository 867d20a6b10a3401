"""Problems of the benchmark whose targets are in closed form."""

import functools

from partialslip.run import run
from partialslip.verify.benchmark import read_problems
from partialslip.verify.benchmark.freeze import derivations

CLOSED = [number for number, problem in read_problems().items() if derivations(problem)[0].method == "exact"]


@functools.cache
def exact(number):
    """The exact result of a problem, solved once for all tests."""
    return run(read_problems()[number].scene, "exact")["exact"]
