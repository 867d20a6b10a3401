"""Step by step through any history of loads: conditions, energy, equilibrium, direction, sub-steps; march, and coarse
finite elements."""

import numpy as np
import pytest
from coulomb import recorded
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from pairs import answer, apart, guise, loads, solved, times
from random_marches import forces

from partialslip import halfplane, load_scene
from partialslip.halfplane.steady import steady_stick_zone
from partialslip.march.cells import on_cells

CLOSED = 1e-10  # residuals of a step, in f p0
BASES = {name: load_scene(name) for name in ("hertz-large-tension", "flat-rounded")}
UNITS = {
    name: (scene.friction.f * scene.P, scene.friction.f * halfplane.contact(scene).p0) for name, scene in BASES.items()
}
LOADS = st.tuples(  # Q/(f P) and sigma/(f p0), in thousandths
    st.integers(-950, 950).map(lambda k: k / 1000), st.integers(-6000, 6000).map(lambda k: k / 1000)
)
CYCLES = st.lists(LOADS, min_size=2, max_size=5)
FEM = st.tuples(st.sampled_from([1, 2, 3, 4, 6]), st.sampled_from([0.1, 0.2]))  # order, element size


@st.composite
def scenes(draw):
    """A path of up to five load points, up to two cycles of it, up to three steps from each to the next."""
    name = draw(st.sampled_from(list(BASES)))
    cycle = np.array(draw(CYCLES)) * UNITS[name]
    assume((cycle != cycle[0]).any())
    settings = *loads(*cycle.T), f"load.cycles={draw(st.integers(1, 2))}", f"load.steps={draw(st.integers(1, 3))}"
    return load_scene(name, settings)


def again(scene, *settings):
    """The same scene with other settings."""
    given = *times(scene), f"load.cycles={scene.load.cycles}", f"load.steps={scene.load.steps}"
    return load_scene(scene.name, [*given, *settings])


def sound(result, scene, marches, element=0.0):
    """What must hold of any answer and of all load steps that lead to it; a coarse mesh has a contact that is off the
    middle by less than an ``element``."""
    assert not [complaint for march in marches for complaint in march.complaints()]
    unit = scene.material.A * (scene.friction.f * result.p0 * result.a) ** 2
    assert result.certificate["kkt"] <= CLOSED
    assert result.certificate["equilibrium"] <= CLOSED
    assert result.slip.dissipated >= -1e-10 * unit
    if result.m is not None and scene.load.dQ:
        assert -1 - element <= -result.m / result.a <= result.n / result.a <= 1 + element


@given(scenes())
def test_march_closes_every_step_of_any_path(scene):
    with guise(), recorded() as marches:
        result = solved("march", scene)
    sound(result, scene, marches)
    traction, f = result.traction, scene.friction.f
    widths = np.diff(traction.cells)
    p = on_cells(result.state.p, traction.cells)  # the cells' forces
    for q in (traction.q1, traction.q2):
        assert (np.abs(q * widths) <= f * p + 1e-12 * f * scene.P).all()
    if scene.load.in_phase:
        for q, end in zip((traction.q1, traction.q2), scene.load.ends, strict=True):
            assert abs(q @ widths - scene.load.points[end][0]) <= 1e-12 * f * scene.P


@given(scenes())
def test_march_in_the_mirror(scene):
    with guise():
        one, other = (answer(solved("march", each), each) for each in (scene, again(scene, *times(scene, Q=-1))))
    off = apart(one, other.mirrored(), scene.friction.f)
    assert off.traction <= 1e-9


@given(st.floats(0.05, 0.9), st.floats(0.0, 1.0), st.booleans(), st.integers(2, 20), st.sampled_from(list(BASES)))
def test_march_does_not_mind_sub_steps_of_proportional_loading(Qf, share, large, steps, name):
    """As long as slip does not turn round on the way: tension below 4 Qf, or so much that it rules to the end."""
    Qf, share = round(Qf, 3), round(share, 3)
    sf = 4.5 + 10 * share if large else share * 3.5 * Qf
    zone = steady_stick_zone(Qf, sf, halfplane.contact(BASES[name]).shape)
    assume((zone.s > 0) != large)
    assume(not large or (zone.half_width * sf > 4.5 * Qf and -4 * Qf / sf < zone.centre + zone.half_width))
    assume(zone.half_width > 0.02)
    fP, fp0 = UNITS[name]
    reversed_loads = loads((-Qf * fP, Qf * fP), (-sf / 2 * fp0, sf / 2 * fp0))
    scenes = [load_scene(name, [*reversed_loads, f"load.steps={k}"]) for k in (1, steps)]
    with guise():
        one, other = (answer(solved("march", scene), scene) for scene in scenes)
    off = apart(one, other, BASES[name].friction.f)
    assert off.traction <= 1e-9
    assert off.ends <= 1e-9


@settings(max_examples=settings().max_examples // 3)
@given(scenes(), FEM)
def test_coarse_finite_elements_close_every_step_of_any_path(scene, mesh):
    order, size = mesh
    scene = again(scene, f"fem.order={order}", f"fem.size={size}")
    with recorded() as marches:
        result = solved("fem", scene)
    sound(result, scene, marches, size)
    N, *T = forces(result.traction, order)
    unit = CLOSED * scene.friction.f * scene.P
    for force in T:
        assert (np.abs(force) <= scene.friction.f * N + unit).all()
    if scene.load.in_phase:
        for force, end in zip(T, scene.load.ends, strict=True):
            assert abs(force.sum() - scene.load.points[end][0]) <= unit


@pytest.mark.slow  # tests/invariances has mirror images of given scenes
@settings(max_examples=settings().max_examples // 8)
@given(scenes())
def test_coarse_finite_elements_are_turned_round_with_the_loads(scene):
    one, other = (
        answer(solved("fem", again(scene, "fem.size=0.2", *times(scene, way, way))), scene) for way in (1, -1)
    )
    assert apart(one, other.turned(), scene.friction.f).traction <= 1e-9
