"""gmsh as another processor has it: its meshes differ a little, as rounding decides which of two equal edges is cut.

On demand, in front of the real module: ``MESH_RANDOM_FACTOR=1e-6 MESH_SIZE_FACTOR=1.000001
PYTHONPATH=tests/other_processors pytest``. gmsh's own factors are 1e-9 and 1; the second one changes which triangles
there are, the first one hardly ever does.
"""

import importlib.util
import os
import sys
from importlib.machinery import PathFinder
from pathlib import Path

_HERE = Path(__file__).resolve().parent
_spec = PathFinder.find_spec("gmsh", [path for path in sys.path if Path(path).resolve() != _HERE])
assert _spec is not None
assert _spec.loader is not None
_gmsh = sys.modules["gmsh"] = importlib.util.module_from_spec(_spec)  # what ``import gmsh`` hands out
_spec.loader.exec_module(_gmsh)
_initialize = _gmsh.initialize


def _initialize_otherwise(*args, **kwargs):
    _initialize(*args, **kwargs)
    _gmsh.option.setNumber("Mesh.RandomFactor", float(os.environ.get("MESH_RANDOM_FACTOR", "1e-9")))
    _gmsh.option.setNumber("Mesh.MeshSizeFactor", float(os.environ.get("MESH_SIZE_FACTOR", "1")))


_gmsh.initialize = _initialize_otherwise
