"""Make meshes with gmsh, read and write them with meshio. No other package imports gmsh or meshio."""

from partialslip_meshes.blocks import Corner as Corner
from partialslip_meshes.blocks import block as block
from partialslip_meshes.blocks import quad_block as quad_block
from partialslip_meshes.fans import fanned as fanned
from partialslip_meshes.grading import Eased as Eased
from partialslip_meshes.grading import size_at as size_at
from partialslip_meshes.mesh import Mesh as Mesh
from partialslip_meshes.mesh import QuadMesh as QuadMesh
from partialslip_meshes.read import read as read
