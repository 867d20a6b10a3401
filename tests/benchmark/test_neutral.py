"""Plain files of the problems: what any code needs is in them, and it is the problem."""

import json

import numpy as np
import pytest

from partialslip.verify.benchmark import read_problems
from partialslip.verify.benchmark.neutral import files
from partialslip_meshes import read

PROBLEMS = read_problems()


@pytest.fixture(scope="module", params=["PS-02", "PS-23", "PS-24", "PS-28"])
def written(request, tmp_path_factory):
    """Problem, and the folder of its files."""
    problem, folder = PROBLEMS[request.param], tmp_path_factory.mktemp(request.param)
    for name, content in files(problem).items():
        (folder / name).write_bytes(content)
    return problem, folder


def test_all_formats_have_the_same_mesh_and_groups(written):
    problem, folder = written
    for body in ("lower", "upper"):
        sides = json.loads((folder / "model.json").read_text("utf-8"))["bodies"][body]["held_along_x"]
        text = (folder / f"{body}.inp").read_text("ascii")
        assert "CPE4" in text
        (folder / f"{body}.inp").write_text(text.replace("CPE4", "CPS4"), "ascii")  # what meshio reads
        face = None
        if body == "upper":  # lies above y = 0, so that its depth is the gap, but for the depth of the lowest point
            face = problem.scene.gap_at
        found = [read("mesh", str(folder / f"{body}{suffix}"), 1.0, face, [*sides, "back"])
                 for suffix in (".msh", ".inp", ".med", ".vtu")]  # fmt: skip
        for other in found[1:]:
            assert np.allclose(other.points, found[0].points, rtol=1e-11, atol=1e-15)
            assert other.lines.keys() == found[0].lines.keys()
            for name, edges in found[0].lines.items():
                assert np.array_equal(np.unique(other.lines[name]), np.unique(edges)), name


def test_the_size_is_that_of_the_body(written):
    problem, folder = written
    for name, body in problem.scene.bodies:
        mesh = read("mesh", str(folder / f"{name.removeprefix('bodies.')}.msh"), 1.0, problem.scene.gap_at
                    if "upper" in name else None)  # fmt: skip
        height = body.height + (body.holder.height if body.holder else 0)
        width = max(body.width, body.holder.width if body.holder else 0)
        assert np.ptp(mesh.points, axis=0) == pytest.approx([width, height], rel=2e-3)


@pytest.mark.slow
def test_every_problem_has_files():
    for problem in PROBLEMS.values():
        assert {"model.json", "lower.msh", "upper.vtu", "abaqus-untested.inp", "calculix-mortar.inp"} <= files(
            problem
        ).keys()
