"""Problems of the benchmark whose targets are in closed form."""

from partialslip.benchmark import read_problems
from partialslip.benchmark.freeze import derivations

CLOSED = [number for number, problem in read_problems().items() if derivations(problem)[0].method == "exact"]
