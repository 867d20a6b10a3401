"""Meshes as another processor makes them, on demand: ``MESH_RANDOM_FACTOR=1e-6 MESH_SIZE_FACTOR=0.999 pytest``.

Rounding decides which of two equal edges gmsh cuts, so that its meshes differ a little from processor to processor. Its
own factors are 1e-9 and 1. The second one changes which triangles there are; the first one hardly ever does.

Tests run side by side, one on each core: linear algebra on one thread each, as in a run.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # is read when NumPy and SciPy are imported

from partialslip_meshes import gmsh

_FACTORS = {"MESH_RANDOM_FACTOR": "RandomFactor", "MESH_SIZE_FACTOR": "MeshSizeFactor"}

gmsh.OPTIONS.update({option: float(os.environ[name]) for name, option in _FACTORS.items() if name in os.environ})
