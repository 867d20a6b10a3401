"""Own meshes that are coarse, or have the groups that their support needs and no others."""

import meshio
import numpy as np
import pytest

from partialslip import plan
from partialslip.scene.reading import load_scene
from partialslip_fem import solve
from partialslip_meshes import block

MM = 1e-3


def written(path, along, names=("back", "contact", "left", "right")):
    """A flat specimen, 8 x 4 mm, as a file: elements of the size ``along`` (mm) on the contact line."""
    mesh = block(4.0, (-0.3, 0.3), {}, 0.5, along=along)
    groups = [mesh.lines[name] for name in names]
    member = np.repeat(np.arange(len(groups)), [len(edges) for edges in groups])
    cells = [("triangle", mesh.triangles), ("line", np.concatenate(groups))]
    sets = {name: [[], np.flatnonzero(member == number)] for number, name in enumerate(names)}
    meshio.write(path, meshio.Mesh(np.column_stack([mesh.points, 0 * mesh.points[:, 0]]), cells, cell_sets=sets))


def solved(path, *overrides, support="clamped"):
    scene = load_scene(
        "fretting-aluminium",
        ["load.P=135750", "load.Q=[-38750, 38750]", "load.sigma=[0, 0]", "load.cycles=1", *overrides,
         f"bodies={{lower={{mesh='{path}', unit={MM}, support='{support}'}}}}"],
    )  # fmt: skip
    return solve(scene, plan(scene, subsurface=True))


@pytest.mark.parametrize("along", [0.02, 0.035, 0.05])
def test_few_elements_along_the_contact(tmp_path, along):
    """From thirty to twelve elements along the line, from five to one beyond the contact: a, and the tension behind
    its ends, are those of half-planes to the size of an element."""
    written(tmp_path / "coarse.inp", along)
    found = solved(tmp_path / "coarse.inp")
    assert found.a == pytest.approx(0.2067 * MM, abs=along * MM)
    assert np.isfinite(found.surface.sigma).all()
    x, largest = found.surface.largest
    assert abs(x) == pytest.approx(found.a, rel=5e-3)
    assert largest == pytest.approx(238e6, rel=0.15)  # on 61 points: 238 MPa


def test_a_clamped_mesh_needs_no_sides(tmp_path):
    """``support = 'clamped'`` holds the back alone: the file needs no groups left and right."""
    written(tmp_path / "clamped.inp", 0.05, ("back", "contact"))
    found = solved(tmp_path / "clamped.inp", "load.Q=[-1e4, 1e4]")
    assert found.a == pytest.approx(0.2067 * MM, rel=0.05)


def test_supports_that_hold_the_sides_need_them(tmp_path):
    written(tmp_path / "clamped.inp", 0.05, ("back", "contact"))
    with pytest.raises(ValueError, match="must have a group 'left'"):
        solved(tmp_path / "clamped.inp", support="roller")
