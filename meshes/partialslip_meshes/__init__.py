"""Meshes: gmsh recipes, and reading and writing through meshio. The only package that imports either."""

from partialslip_meshes.blocks import Corner as Corner
from partialslip_meshes.blocks import block as block
from partialslip_meshes.blocks import quad_block as quad_block
from partialslip_meshes.mesh import Mesh as Mesh
from partialslip_meshes.mesh import QuadMesh as QuadMesh
from partialslip_meshes.read import read as read
