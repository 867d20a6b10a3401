"""Random cycles of load by finite elements, and whether the conditions of their load steps hold on other grounds."""

import numpy as np
from coulomb import recorded
from numpy.polynomial import Legendre, legendre

import partialslip
from partialslip.run.judge import Outcome, conditions
from partialslip.verify.random_scenes import draw
from partialslip_fem import goals

SEED = 13
CERTIFIED = 1e-10  # in f p0, and in f P
SAME = 1e-12  # relative: rounding of units
EVEN = 4  # highest order of elements with evenly spaced nodes
FINEST = 1e-4  # in a: beyond it a zone that fades away asks for meshes of minutes, not for more of the load steps


def contact_line(traction, order):
    """Nodes of the contact line, and its mass matrix, for elements of ``order`` on the cells of a result."""
    k, cells = order, traction.cells
    local = np.linspace(-1, 1, k + 1)
    if k > EVEN:
        local[1:-1] = np.sort(Legendre.basis(k).deriv().roots())  # Lobatto's nodes
    at, weights = legendre.leggauss(k + 1)
    shapes = legendre.legvander(at, k) @ np.linalg.inv(legendre.legvander(local, k))
    mass = shapes.T @ (weights[:, None] / 2 * shapes)
    sizes = np.diff(cells)
    nodes = np.append((cells[:-1, None] + sizes[:, None] * (local[:-1] + 1) / 2).ravel(), cells[-1])
    total = np.zeros((len(nodes), len(nodes)))
    rows = k * np.arange(len(sizes))[:, None, None] + np.arange(k + 1)[:, None]
    np.add.at(total, (rows, rows.swapaxes(1, 2)), sizes[:, None, None] * mass)
    return nodes, total


def forces(traction, order):
    """Nodal forces in contact, N, T1 and T2, from a result's tractions alone."""
    nodes, mass = contact_line(traction, order)
    inside = np.abs(nodes[:, None] - traction.x).argmin(axis=0)
    outside = np.setdiff1d(np.arange(len(nodes)), inside)

    def of(values):  # what lies outside carries no force: its tractions follow
        line = np.zeros(len(nodes))
        line[inside] = values
        line[outside] = np.linalg.solve(mass[np.ix_(outside, outside)], -(mass @ line)[outside])
        return (mass @ line)[inside]

    return of(traction.p), *(None if q is None else of(q) for q in (traction.q1, traction.q2))


def missed(result):
    """What a result misses of the conditions on it alone: finite numbers, small residuals."""
    return [f"{each.quantity} {each.error}" for each in conditions(result) if each.outcome is Outcome.MISSED]


def complaints(scene, result, marches):
    """What is wrong with a result of finite elements and the load steps that it took, on all meshes."""
    yield from missed(result)
    certificate, f = result.certificate, scene.friction.f
    if not marches and result.last_cycle_change is not None:
        yield "nothing was solved"
    # n forces sum to Q but for n roundings, which make the more of a traction the less of the line a node has
    count, least = len(result.traction.x), np.diff(result.traction.cells).min() / result.a / (scene.fem.elements + 1)
    rounding = 4 * count * np.finfo(float).eps / least
    if not (certificate["kkt"] <= CERTIFIED + rounding and certificate["equilibrium"] <= CERTIFIED):
        yield f"certificate {certificate}"
    for march in marches:
        yield from march.complaints()
    if result.stick_half_width == 0 and not any("smaller than an element" in note for note in result.notes):
        yield "no stick zone, and nothing is said"
    N, T1, T2 = forces(result.traction, scene.fem.elements)
    unit = CERTIFIED * f * scene.P
    if abs(N.sum() / scene.P - 1) > CERTIFIED or not (N > -CERTIFIED * scene.P).all():
        yield f"sum of N {N.sum() / scene.P} P, least {N.min() / scene.P}"
    if result.slip is None:
        return
    for T in (T1, T2):
        if not (np.abs(T) <= f * N + unit).all():
            yield f"|T| - f N up to {(np.abs(T) - f * N).max() / unit * CERTIFIED} f P"
    if not scene.load.in_phase:
        return  # least and largest T over a cycle, not those of load points
    for T, (Q, _) in zip((T1, T2), (scene.load.points[end] for end in scene.load.ends), strict=True):
        if abs(T.sum() - Q) > unit:
            yield f"sum of T {T.sum()} in place of {Q}"
    # which slips and then sticks, or slips back, is on the bound on the way: see tests/friction/test_path_following.py
    if result.counts["steps"] == 1 and not result.counts["events"] and len(scene.load.points) == 2:
        slip = result.slip.slip
        held = slip != 0
        if not (np.abs(T2 - np.sign(slip) * f * N)[held] <= unit).all():
            yield "slip where q is not on the bound, or against it"
        if not (T2 * slip >= 0).all():
            yield "slip against q"
    if marches and not any(followed(march.history, scene, result, (T1, T2)) for march in marches):
        yield "tractions, slip and dissipation are those of no march"


def followed(history, scene, result, shear):
    """Whether the result is that of the history: shear forces at load points 1 and 2, slip and dissipation."""
    unit, bar = scene.material.A * scene.P, CERTIFIED * scene.friction.f * scene.P
    if len(history.slip) != len(result.slip.slip):
        return False
    held = all((np.abs(T - q * scene.P) <= bar).all() for T, q in zip(shear, history.at_ends, strict=True))
    slipped = np.allclose(result.slip.slip, history.slip * unit, SAME, SAME * unit * np.abs(history.slip).max())
    # what load steps miss of the work is found later, and is not known to a march in steps
    unknown, work = history.path.missed is None, history.dissipated * unit * scene.P
    return held and slipped and (unknown or np.isclose(result.slip.dissipated, work, SAME, 0))


def trials(numbers):
    """(number, kind, scene, result, marches) of each of them, or in place of the last two what was raised."""
    finest = goals.FINEST
    goals.FINEST = FINEST
    try:
        for number in numbers:
            kind, scene = draw(SEED, number)
            with recorded() as marches:
                try:
                    yield number, kind, scene, partialslip.run(scene, ["fem"]).results["fem"], marches
                except Exception as error:
                    yield number, kind, scene, repr(error), []
    finally:
        goals.FINEST = finest
