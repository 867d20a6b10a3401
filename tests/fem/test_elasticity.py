"""The body: rigid motions, constant strain, weights, and one factorisation that keeps the contact last."""

import numpy as np
import pytest
import scipy.sparse.linalg as spla
import skfem
from numpy.polynomial.legendre import legval
from skfem.models.elasticity import linear_elasticity
from skfem.models.poisson import laplace
from spying import spied

from partialslip_fem import elasticity, factor
from partialslip_fem.condensation import Condensation
from partialslip_fem.elasticity import body, triangles_of
from partialslip_fem.elements import ELEMENTS, nodes_of
from partialslip_fem.farfield import FarField
from partialslip_meshes import block

SIZES = {-1.0: 0.2, 0.3: 0.1, 1.0: 0.2}


@pytest.fixture(scope="module", params=[1, 2, 3, 4, 6])
def half(request):
    return body(block(5.0, (-1.2, 1.2), SIZES, 0.6), kappa=1.8, order=request.param)


def test_rigid_motions_are_free(half):
    N = half.stiffness.shape[0] // 2
    for motion in np.repeat(np.eye(2), N, axis=1):
        assert np.abs(half.stiffness @ motion).max() < 1e-10


def test_stiffness_is_symmetric(half):
    assert abs(half.stiffness - half.stiffness.T).max() < 1e-12


def test_weights_are_those_of_newton_and_cotes_or_of_lobatto(half):
    """Up to order 4 and beyond."""
    weights = half.weights
    assert weights.sum() == pytest.approx(2.4, rel=1e-13)
    assert (weights > 0).all()
    inner = {1: [], 2: [4 / 6], 3: [3 / 8, 3 / 8], 4: [32 / 90, 12 / 90, 32 / 90]}
    k = half.order
    lobatto = [1 / (k * (k + 1) * legval(2 * x - 1, [0] * k + [1]) ** 2) for x in nodes_of(k)[1:-1]]
    lengths = np.diff(half.x[::k])
    for offset, weight in enumerate(inner.get(k, lobatto), start=1):
        assert weights[offset::k] == pytest.approx(weight * lengths, rel=1e-12)


def test_nodes_of_the_contact_line_lie_alike_in_all_cells(half):
    """Evenly spaced up to order 4."""
    k = half.order
    vertices = half.x[::k]
    assert set(SIZES) <= {round(x, 12) for x in vertices}
    if k <= 4:
        assert nodes_of(k) == pytest.approx(np.arange(k + 1) / k)
    for offset, share in enumerate(nodes_of(k)[:-1]):
        assert half.x[offset::k][: len(vertices) - 1] == pytest.approx(vertices[:-1] + np.diff(vertices) * share)


@pytest.mark.parametrize("kappa", [1.0004, 1.8, 2.0, 2.9])
def test_constant_strain_is_exact(kappa):
    """Displacements linear in x and y on the outer boundary and balancing forces on the line: no error at any nu."""
    half = body(block(5.0, (-4.0, 4.0), {0.0: 1.0}, 0.3), kappa, order=4)
    mu = (kappa + 1) / 2
    lam = mu * (3 - kappa) / (kappa - 1)
    # uniaxial tension along x leaves the line y = 0 free: eps_y = -lam/(lam + 2 mu) eps_x
    strain = np.array([1.0, -lam / (lam + 2 * mu)])
    stretched = FarField((half.held_points * strain[:, None]).reshape(-1, 1), np.ones((1, half.contact.size)))
    displacement = (Condensation(half, stretched).compliance - Condensation(half).compliance)[:, 0]
    expected = np.concatenate([half.x * strain[0], 0 * half.x])
    assert displacement == pytest.approx(expected, abs=1e-9 * max(1.0, lam))


@pytest.mark.parametrize("backend", ["superlu", "cholmod"])
def test_schur_complement_from_the_factor_is_the_inverse(half, backend):
    condensed = Condensation(half, backend=backend)
    free = np.setdiff1d(np.arange(half.stiffness.shape[0]), half.held)
    forces = np.zeros((len(free), 2))
    places = np.searchsorted(free, half.contact.ravel()[[3, -5]])
    forces[places, [0, 1]] = 1.0
    direct = spla.spsolve(half.stiffness[free][:, free].tocsc(), forces)
    contact = np.searchsorted(free, half.contact.ravel())
    assert condensed.compliance[:, [3, -5]] == pytest.approx(direct[contact], abs=1e-11)
    assert condensed.compliance == pytest.approx(condensed.compliance.T, abs=1e-12)


def test_one_factorisation(half, monkeypatch):
    """The far field's displacements of the contact line are read off the same factor; displacing all nodes needs
    another one."""
    calls = spied(monkeypatch, factor.spla, "splu")
    far = FarField(np.ones((half.held.size, 3)), np.ones((3, half.contact.size)))
    condensed = Condensation(half, far)
    assert len(calls) == 1
    condensed.displace(np.zeros((half.contact.size, 3)))
    condensed.displace(np.zeros((half.contact.size, 3)))
    assert len(calls) == 2


@pytest.mark.parametrize(("backend", "more"), [("superlu", 0), ("cholmod", 1)])
def test_without_a_far_field_one_factor_serves_all(half, backend, more):
    """SuperLU's factor also displaces all nodes; CHOLMOD's is used up where the compliance is read off."""
    condensed = Condensation(half, backend=backend)
    assert condensed.factorizations == 1
    condensed.displace(np.zeros((half.contact.size, 1)))
    assert condensed.factorizations == 1 + more


@pytest.mark.parametrize("backend", ["superlu", "cholmod"])
def test_far_field_moves_the_contact_line_as_it_moves_all_nodes(half, backend):
    """By two ways: the border of the factor, and back substitution under given displacements."""
    random = np.random.default_rng(3)
    far = FarField(random.normal(size=(half.held.size, 3)), random.normal(size=(3, half.contact.size)))
    condensed = Condensation(half, far, backend)
    forces = random.normal(size=(half.contact.size, 2))
    moved = condensed.displace(forces)[half.contact.ravel()]
    assert condensed.compliance @ forces == pytest.approx(moved, abs=1e-11 * np.abs(moved).max())


@pytest.mark.parametrize("backend", ["superlu", "cholmod"])
def test_displacements_of_all_nodes_carry_the_contact_forces(half, backend):
    condensed = Condensation(half, backend=backend)
    forces = np.linspace(0, 1, half.contact.size)[:, None]
    u = condensed.displace(forces)
    residual = half.stiffness @ u
    residual[half.contact.ravel()] -= forces
    residual[half.held.ravel()] = 0
    assert np.abs(residual).max() < 1e-10


def with_all_nodes(mesh, order):
    """Stiffness with the nodes inside elements, by scikit-fem's own model of elasticity, in the order of ours."""
    element = ELEMENTS[order]()
    scalar, vector = (skfem.Basis(triangles_of(mesh), each) for each in (element, skfem.ElementVector(element)))
    mu = (1.8 + 1) / 2
    K = linear_elasticity(mu * (3 - 1.8) / (1.8 - 1), mu).assemble(vector)
    place = np.empty((2, scalar.N), dtype=int)
    for component in (0, 1):
        place[component, scalar.element_dofs] = vector.element_dofs[component::2]
    return K[place.ravel()][:, place.ravel()]


def off_the_model_with_all_nodes(order):
    """Displacements of all nodes under forces on the line: largest error against that model, over the largest one."""
    mesh = block(3.0, (-1.2, 1.2), SIZES, 0.8)
    small = body(mesh, 1.8, order)
    forces = np.random.default_rng(5).normal(size=(small.contact.size, 1))
    found = small.inner_nodes.everywhere(Condensation(small).displace(forces)[:, 0].reshape(2, -1))

    K = with_all_nodes(mesh, order)
    count, sides = K.shape[0] // 2, small.stiffness.shape[0] // 2
    assert small.unknowns == K.shape[0]

    def among_all(unknowns):
        return unknowns % sides + count * (unknowns >= sides)

    load = np.zeros(K.shape[0])
    load[among_all(small.contact.ravel())] = forces[:, 0]
    free = np.setdiff1d(np.arange(K.shape[0]), among_all(small.held))
    true = np.zeros(K.shape[0])
    true[free] = spla.spsolve(K[free][:, free].tocsc(), load[free])
    return np.abs(found - true.reshape(2, -1)).max() / np.abs(true).max()


@pytest.mark.parametrize("order", [2, 3, 4, 6])
def test_nodes_inside_elements_are_eliminated_exactly(order):
    assert off_the_model_with_all_nodes(order) < 1e-11


@pytest.mark.fault
def test_nodes_inside_eliminated_along_one_axis_alone_are_seen(monkeypatch):
    """Deliberate fault: displacements along y outside an element do not move the nodes inside it."""
    true = elasticity._without_inside

    def alone(of_each, outer):
        values, moved = true(of_each, outer)
        return values, moved * (np.arange(2 * outer) < outer)

    monkeypatch.setattr(elasticity, "_without_inside", alone)
    assert off_the_model_with_all_nodes(4) > 1e-2


@pytest.mark.parametrize(("order", "kept"), [(2, 1.0), (4, 0.65), (6, 0.48)])
def test_only_nodes_on_sides_of_elements_are_factored(order, kept):
    """Of k^2 / 2 nodes for a triangle of order k, (k - 1)(k - 2) / 2 lie inside."""
    small = body(block(3.0, (-1.2, 1.2), SIZES, 0.8), 1.8, order)
    assert small.stiffness.shape[0] / small.unknowns == pytest.approx(kept, abs=0.02)


@pytest.mark.parametrize("order", [4, 5, 6])
def test_harmonic_polynomials_of_the_elements_order_are_exact(order):
    """No residual inside, on straight triangles of any shape."""
    mesh = skfem.MeshTri().refined(2)
    mesh = skfem.MeshTri(mesh.p + 0.1 * np.sin(3 * mesh.p[::-1]), mesh.t)
    basis = skfem.Basis(mesh, ELEMENTS[order]())
    free = basis.complement_dofs(basis.get_dofs())
    harmonic = ((basis.doflocs[0] + 1j * basis.doflocs[1]) ** order).real
    assert np.abs(laplace.assemble(basis) @ harmonic)[free].max() < 1e-11
