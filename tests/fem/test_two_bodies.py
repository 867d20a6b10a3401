"""Two bodies that are not mirror images: other sizes, other materials, nodes that do not match."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import partialslip
from partialslip import load_scene, plan
from partialslip.friction import step_errors
from partialslip.result import Clock
from partialslip.run import default_methods
from partialslip_fem import solve
from partialslip_fem.adapt import adapt
from partialslip_fem.elasticity import body
from partialslip_fem.mortar import transfer
from partialslip_fem.problem import scaled
from partialslip_meshes import block

COARSE = "fem.accuracy=1e-3"
BLOCKS = (
    "bodies.upper.width=16e-3", "bodies.upper.height=4e-3", "bodies.lower.width=40e-3", "bodies.lower.height=20e-3",
)  # fmt: skip
STIFF = ("material.upper.E=728e9", "material.upper.nu=0.3")
FINER = "fem.lower_size=0.7"


def fem(*overrides, name="hertz-large-tension", subsurface=False):
    scene = load_scene(name, [COARSE, *overrides])
    return solve(scene, plan(scene, subsurface=subsurface))


@pytest.fixture(scope="module", autouse=True)
def steps_as_asked_for():
    """In one step from load point to load point: with more of them points that stick at both may slip on the way."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(step_errors, "_MOST_STEPS", 1)
        yield


@pytest.fixture(scope="module")
def lines():
    """Contact lines of one extent: P4 at some size, and P3 at another."""
    coarse = block(5.0, (-1.2, 1.2), {0.0: 0.2}, 0.2)
    fine = block(4.0, (-1.2, 1.2), {0.3: 0.03}, 0.1, 3.0)
    return body(coarse, 1.8, 4), body(fine, 2.2, 3)


def test_transfer_keeps_polynomials_forces_and_moments(lines):
    for onto, other in (lines, lines[::-1]):
        T = transfer(onto, other)
        for power in range(4):  # both have cubics
            assert T @ other.x**power == pytest.approx(onto.x**power, abs=1e-11)
        forces = np.cos(3 * onto.x)
        assert [(T.T @ forces).sum(), other.x @ (T.T @ forces)] == pytest.approx(
            [forces.sum(), onto.x @ forces], rel=1e-11
        )


def test_transfer_of_a_uniform_traction_is_uniform(lines):
    """The patch test: nodal forces of a constant traction become those of the same one, on nodes that do not match."""
    for onto, other in (lines, lines[::-1]):
        mine, its = (line.weights for line in (onto, other))
        assert transfer(onto, other).T @ mine == pytest.approx(its, abs=1e-12)


def test_transfer_between_matching_nodes_is_the_identity(lines):
    assert transfer(lines[0], lines[0]) == pytest.approx(np.eye(len(lines[0].x)), abs=1e-11)


def test_transfer_between_tiny_cells_off_the_middle_is_the_identity():
    """Coordinates near x = -0.8 resolve a cell of 1e-7 to 1e-9 of its size; compliances must not have that error, which
    made p oscillate by more than itself."""
    line = body(block(5.0, (-1.2, 1.2), {-0.7885596: 1e-7}, 0.5), 1.8, 4)
    assert transfer(line, line) == pytest.approx(np.eye(len(line.x)), abs=1e-11)


def test_similar_half_planes_as_two_coupled_bodies():
    """Mirror images whose meshes do not match are solved as two bodies: the closed form is still the truth."""
    scene = load_scene("hertz-large-tension", [COARSE, "fem.lower_size=1.3"])
    outcome = partialslip.run(scene)
    assert outcome.comparisons["fem"].passed
    assert outcome.results["fem"].counts["factorizations"] == 2 * (outcome.results["fem"].counts["meshes"] + 1)


def test_different_materials_that_do_not_couple():
    """Where mu_1 (kappa_2 - 1) = mu_2 (kappa_1 - 1), Dundurs' beta vanishes: pressure moves both surfaces alike along x
    and the closed form holds, with the pair's A and the tension's strain of the lower body."""
    lower, upper = {"E": 70e9, "nu": 0.3}, {"nu": 0.2}
    upper["E"] = lower["E"] * (1 + upper["nu"]) / (1 + lower["nu"]) * (2 - 4 * upper["nu"]) / (2 - 4 * lower["nu"])
    different = [f"material.{key}={value}" for key, value in lower.items()]
    different += [f"material.upper.{key}={value}" for key, value in upper.items()]
    scene = load_scene("hertz-large-tension", [COARSE, *different])
    of_lower = scene.material.bodies[0].A / scene.material.A
    alike = load_scene(
        "hertz-large-tension",
        [f"material.E={4 * (1 - 0.3**2) / scene.material.A}", f"load.sigma=[{-403e6 * of_lower}, {403e6 * of_lower}]"],
    )
    exact = partialslip.run(alike, ["exact"]).results["exact"]
    result = solve(scene, plan(scene))
    assert (result.a, result.m, result.n) == pytest.approx((exact.a, exact.m, exact.n), abs=1e-3 * exact.a)
    assert abs(of_lower - 1) > 0.05


@pytest.fixture(scope="module")
def different():
    return fem(*BLOCKS, *STIFF, FINER, "load.cycles=6", subsurface=True)


@pytest.mark.slow
def test_every_step_is_certified(different):
    assert different.certificate["kkt"] < 1e-9
    assert different.certificate["equilibrium"] < 1e-12


@pytest.mark.slow
def test_matching_and_not_matching_agree(different):
    """But for the discretisation: well within the accuracy that was asked of both."""
    matching = fem(*BLOCKS, *STIFF, "load.cycles=6")
    for key in ("a", "m", "n"):
        assert getattr(matching, key) == pytest.approx(getattr(different, key), abs=3e-4 * matching.a)


@pytest.mark.slow
def test_third_law_and_moment_balance():
    """What each body's own stiffness says that it feels at its contact nodes, and what its back holds against it."""
    scene = load_scene("hertz-large-tension", [COARSE, *BLOCKS, *STIFF, FINER, "load.cycles=3"])
    problem = scaled(scene, plan(scene, subsurface=True))
    found = adapt(problem, 1e-3, 16.0, Clock(), lambda _: None).solution
    shear, T = found.on_line(found.history.at_ends[1]), transfer(*(each.body for each in found.bodies))
    felt = []
    for half, way in zip(found.bodies, (1, -1), strict=True):
        forces = np.concatenate([-way * shear, -found.pressing.x])
        if way < 0:
            forces = np.concatenate([T.T @ part for part in np.split(forces, 2)])
        u = half.condensation.displace(forces[:, None])
        reactions = half.body.stiffness @ u[:, 0]
        contact, back = (
            reactions[dofs] * [[1.0], [way]] for dofs in (half.body.contact, half.body.held.reshape(2, -1))
        )
        y = way * half.body.held_points[1]
        felt.append([*contact.sum(axis=1), half.body.x @ contact[1]])
        held = [*back.sum(axis=1), half.body.held_points[0] @ back[1] - y @ back[0]]
        assert held == pytest.approx([-value for value in felt[-1]], abs=1e-9)
    assert felt[0] == pytest.approx([-value for value in felt[1]], abs=1e-10)
    assert felt[1][:2] == pytest.approx([scene.load.Q[1] / scene.P, 1], abs=1e-10)


def on_surface(body, x):
    """Displacements on the contact line at load points 1 and 2, interpolated, (2, k, 2)."""
    line = np.unique(body.lines["contact"])
    line = line[np.argsort(body.points[line, 0])]
    fields = (body.displacements[f"displacement_{point}"][line] for point in (1, 2))
    return np.array([CubicSpline(body.points[line, 0], field)(x) for field in fields])


@pytest.mark.slow
def test_bodies_meet(different):
    """Where they touch the surfaces have closed the gap, and where they stick they have moved alike between the
    load points: interpolated, as the nodes do not match."""
    scene = load_scene("hertz-large-tension")
    lower, upper = different.bodies
    x = np.linspace(-0.95 * different.m, 0.95 * different.n, 50)
    u = {b.name: on_surface(b, x) for b in (lower, upper)}
    change = [(u["upper"][k] - u["lower"][k])[:, 0] for k in (0, 1)]
    scale = scene.material.A * scene.friction.f * different.p0 * different.a
    assert np.ptp(change[1] - change[0]) < 1e-2 * scale
    apart = (u["upper"][1] - u["lower"][1])[:, 1] + scene.profile.gap_at(x)
    assert np.ptp(apart) < 1e-2 * scene.profile.gap_at(np.array([different.a]))[0]


def test_friction_acts_while_the_bodies_are_pressed():
    """Without tangential loads unlike bodies still shear each other: outwards on one, with no resultant."""
    result = fem(*STIFF, "load.Q=[0, 0]", "load.sigma=[0, 0]", "load.steps=4")
    x, q, p = result.traction.x, result.traction.q2, result.traction.p
    right = (x > 0.1 * result.a) & (x < 0.9 * result.a)
    assert (np.abs(q) <= 0.5 * p + 0.02 * result.p0).all()  # exact of the nodal forces, not of their recovery
    assert (np.abs(q[right]) > 0.02 * result.p0).all()
    assert len(set(np.sign(q[right]))) == 1
    skew = np.interp(-x[right], x, q) + q[right]  # largest where the stick zone ends, as the sides' meshes differ
    assert np.sqrt(np.mean(skew**2)) < 1e-2 * result.p0


def test_wide_blocks_are_half_planes():
    """Finite bodies of 400 a: what is left of the size is (a/W)^2 and less."""
    size = ("width=0.4", "height=0.2")
    blocks = [f"bodies.{name}.{setting}" for name in ("upper", "lower") for setting in size]
    scene = load_scene("hertz-large-tension", [COARSE, *blocks])
    comparison = partialslip.run(scene).comparisons["fem"]
    assert max(comparison.a, comparison.m, comparison.n) < 1e-3
    assert comparison.bars == {}


def test_unlike_bodies_have_no_exact_solution():
    scene = load_scene("hertz-large-tension", [COARSE, *STIFF])
    with pytest.raises(partialslip.InputError, match="the bodies differ"):
        partialslip.run(scene, "exact")
    assert default_methods(scene) == ("fem",)
