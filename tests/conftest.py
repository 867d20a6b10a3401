"""Meshes as another processor makes them, on demand: ``MESH_RANDOM_FACTOR=1e-6 MESH_SIZE_FACTOR=0.999 pytest``.

Rounding decides which of two equal edges gmsh cuts, so that its meshes differ a little from processor to processor. Its
own factors are 1e-9 and 1. The second one changes which triangles there are; the first one hardly ever does.

Tests run side by side, one on each core: linear algebra on one thread each, as in a run.

Programs that tests start and stop by Ctrl-C would ignore it if this one did, as background jobs of a shell do.

They keep the bytecode of the modules that they import: compiling takes a third of a second for each of them.

More than half of all meshes of the tests have been made before: they are remembered, but for tests of meshing itself.

Every test that is marked as a deliberate fault fails if the fault does not bite (``tests/helpers/biting.py``).
"""

import functools
import math
import os
import signal

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # is read when NumPy and SciPy are imported
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

import pytest
from biting import biting
from refusing import check

from partialslip.cli import consoles, main
from partialslip_meshes import blocks, gmsh

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

_FACTORS = {"MESH_RANDOM_FACTOR": "RandomFactor", "MESH_SIZE_FACTOR": "MeshSizeFactor"}

gmsh.OPTIONS.update({option: float(os.environ[name]) for name, option in _FACTORS.items() if name in os.environ})

_MESHING = ("meshes", "test_threads.py", "test_cost.py", "test_interrupted.py")  # these make all of theirs


class _Request(dict):
    """A request for a mesh that can be looked up: the same request and options give the same mesh."""

    def __hash__(self):
        return hash(repr(self))


@functools.lru_cache(maxsize=128)
def _made(request, options):
    del options
    return gmsh.ask(request)


@pytest.fixture(autouse=True)
def _remembered_meshes(request, monkeypatch):
    if not set(request.path.parts).intersection(_MESHING):
        monkeypatch.setattr(blocks, "ask", lambda each: _made(_Request(each), repr(gmsh.OPTIONS)))


@pytest.fixture(autouse=True)
def _biting(request, _remembered_meshes):
    if request.node.get_closest_marker("fault"):
        with biting():
            yield
    else:
        yield


@pytest.fixture
def refused(capsys, monkeypatch):
    """Call with arguments: checks that they are refused as bad input, returns the message. A slow machine adds no line
    of progress to it."""
    monkeypatch.setattr(consoles, "EVERY", math.inf)
    return lambda *arguments: check(main(arguments), capsys.readouterr())
