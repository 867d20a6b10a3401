"""Faults of friction and its history."""

from dataclasses import replace

import numpy as np
import pytest
from pairs import SIZE, restart
from random_marches import CERTIFIED, forces
from scipy.interpolate import PPoly

import partialslip
from partialslip.friction import coulomb_constant_pressure, coupled_step, zone_ends
from partialslip.friction.active_set import _BlockPivoting, solve_bounded
from partialslip.friction.contact_line import ContactLine
from partialslip.friction.coulomb_constant_pressure import march as true_march
from partialslip.friction.zone_ends import StickInterval
from partialslip.march import similar as marching
from partialslip.result.state import State
from partialslip.tools.bars import CERTIFICATE_BAR
from partialslip_fem import problem, solving

LARGE = "hertz-large-tension"
MEAN = ("load.Q=[31415.9, 219911.5]", "load.sigma=[2e8, 1e9]", "load.cycles=12")
STIFF = ("material.upper.E=728e9", "material.upper.nu=0.3")


def march_with(change):
    """A march along a path whose load points have been changed, and that says nothing of it."""

    def march(C, x, normal, f, path, *_):
        changed = replace(path, cycle=tuple((*change(Q, strain), slope) for Q, strain, slope in path.cycle))
        return replace(true_march(C, x, normal, f, changed), path=path)

    return march


@pytest.mark.fault
def test_tension_of_the_wrong_sign(monkeypatch, sound, red):
    scene = sound(LARGE)
    monkeypatch.setattr(coulomb_constant_pressure, "march", march_with(lambda Q, strain: (Q, -strain)))
    red.comparison("m", scene)


@pytest.mark.fault
def test_tension_left_out(monkeypatch, sound, red):
    scene = sound(LARGE)
    monkeypatch.setattr(coulomb_constant_pressure, "march", march_with(lambda Q, _: (Q, 0.0)))
    red.comparison("n", scene)


@pytest.mark.fault
def test_friction_silently_smaller(monkeypatch, sound, red):
    scene = sound(LARGE)
    monkeypatch.setattr(
        coulomb_constant_pressure, "march", lambda C, x, normal, f, path, *_: true_march(C, x, normal, 0.9 * f, path)
    )
    red.comparison("q", scene)


@pytest.mark.fault
def test_friction_silently_none(monkeypatch, sound, red):
    scene = sound(LARGE)
    monkeypatch.setattr(problem, "load_path", lambda *_: None)
    red.comparison("q", scene)


@pytest.mark.slow
@pytest.mark.fault
def test_bound_of_the_pressure_before(monkeypatch, red):
    """Pressure of unlike bodies changes with shear; what bounds friction is the one of the step before."""
    true = coupled_step.solve

    def lagging(step, starts):
        p, q = true(step, starts)
        before = starts[0][0].x
        on = np.flatnonzero(before > 0)
        if len(on) == 0:
            return p, q
        bound, free = step.f[on] * before[on], (step.kept - step.xy @ p.x)[on]
        held = solve_bounded(step.xx[np.ix_(on, on)], free, -bound, bound, step.Q)
        return p, held.spread(on, len(before))

    def beyond():
        """How far nodal forces at load point 2, made again from the tractions, are beyond f times normal ones."""
        scene = partialslip.load_scene(LARGE, [*STIFF, SIZE, "load.cycles=2"])
        N, _, T = forces(partialslip.run(scene, ["fem"]).results["fem"].traction, scene.fem.elements)
        return float((np.abs(T) - scene.friction.f * N).max() / (scene.friction.f * scene.P))

    red.passes(beyond(), CERTIFIED)
    monkeypatch.setattr(coupled_step, "solve", lagging)
    red("friction bound", beyond(), CERTIFIED)


@pytest.mark.slow
@pytest.mark.fault
def test_history_not_committed_between_steps(monkeypatch, sound, red):
    """Every step starts from nothing: reversed proportional loads cannot tell, a mean load does."""

    def forgetful(C, x, normal, f, path, *_):
        alone = [
            true_march(C, x, normal, f, replace(path, cycle=(load,), ends=(0, 0), cycles=1)) for load in path.cycle
        ]
        first, second = (alone[end].q2 for end in path.ends)
        return replace(true_march(C, x, normal, f, path), q1=first, q2=second)

    scene = sound(LARGE, "load.Q=[-62831.9, 125664]", "load.sigma=[-1e8, 7e8]")  # shakes down in a few cycles
    monkeypatch.setattr(coulomb_constant_pressure, "march", forgetful)
    red.comparison("q", scene)


@pytest.mark.fault
def test_restart_that_forgets_the_traction(monkeypatch, red):
    """Loads and pressure are saved, and what sticks where is found again; of q only its resultant is."""
    red.passes(restart("march", "mean loads", SIZE).traction, 1e-11)
    true = State.save
    even = lambda state: PPoly(state.p.c * state.Q / state.P, state.p.x)  # noqa: E731
    forgotten = lambda state, path: true(replace(state, q=even(state)), path)  # noqa: E731
    monkeypatch.setattr(State, "save", forgotten)
    red("invariance: restart", restart("march", "mean loads", SIZE).traction, 1e-11)


@pytest.mark.fault
def test_restart_off_by_a_millionth(monkeypatch, red):
    """Of q at every stop; by finite elements, whose rounding errors are the largest."""
    red.passes(restart("fem", "mean loads", SIZE).traction, 2e-6)
    true = State.save
    off = lambda state: replace(state, q=PPoly(state.q.c * (1 + 1e-6), state.q.x))  # noqa: E731
    monkeypatch.setattr(State, "save", lambda state, path: true(off(state), path))
    red("invariance: restart", restart("fem", "mean loads", SIZE).traction, 2e-6)


@pytest.mark.fault
def test_stick_that_is_a_stiff_spring(monkeypatch, sound, red):
    """Penalty: what sticks creeps in proportion to its traction, here by about a hundredth of the slip."""
    scene = sound(LARGE)
    springs = lambda C, x, normal, f, path, *_: true_march(C + 0.01 * np.diag(1 / (f * normal)), x, normal, f, path)  # noqa: E731
    monkeypatch.setattr(coulomb_constant_pressure, "march", springs)
    red.comparison("n", scene)


@pytest.mark.fault
def test_slip_of_the_other_body(monkeypatch, sound, red):
    """Slip of the one body on the other taken for that of the other on the one: friction then gives energy."""

    def off():
        results = partialslip.run(scene).results
        return abs(results["fem"].slip.dissipated / results["exact"].slip.dissipated - 1)

    def turned(*args):
        history = true_march(*args)
        return replace(history, slip=-history.slip, dissipated=-history.dissipated)

    scene = sound(LARGE)
    red.passes(off(), 1e-3)
    monkeypatch.setattr(coulomb_constant_pressure, "march", turned)
    red("dissipated energy", off(), 1e-3)


@pytest.mark.slow
@pytest.mark.fault
def test_stick_zone_from_flags_of_one_instant(monkeypatch, sound, red):
    """With a mean load nodes rest on the bound without slipping any more: who is on it at load point 2 says little."""

    def flagged(line, history, *_):
        sticks = line.x[np.abs(history.q2) < (1 - 1e-9) * history.bound]
        return StickInterval(float(sticks[0]), float(sticks[-1]), (-1, 1))

    scene = sound(LARGE, *MEAN)
    monkeypatch.setattr(ContactLine, "stick_zone", flagged)
    red.comparison("n", scene)


@pytest.mark.fault
def test_stick_zone_up_to_the_last_node_that_sticks(monkeypatch, sound, red):
    """It is the end of the contact, read in the same way, that shows it first."""
    scene = sound(LARGE, "fem.accuracy=1e-4")
    monkeypatch.setattr(zone_ends, "right_end", lambda *args: float(args[2][-1]))
    red.comparison("left", scene)


@pytest.mark.fault
def test_iteration_that_ends_before_it_has_converged(monkeypatch, sound, red):
    """The first guess of what slips is taken for the answer."""

    def guessed(self, total):
        line = self._solutions()
        return (total - line.total) / line.slope

    def hasty(self, shift):
        x, r, _ = self._solution_and_sides(shift)
        return x, r, self._solutions().slope

    def in_haste(*args):
        with pytest.MonkeyPatch.context() as inner:
            inner.setattr(_BlockPivoting, "settle", guessed)
            inner.setattr(_BlockPivoting, "solve", hasty)
            return solve_bounded(*args)

    scene = sound(LARGE)
    monkeypatch.setattr(coulomb_constant_pressure, "solve_bounded", in_haste)
    certificate = partialslip.run(scene, ["march"]).results["march"].certificate
    red("certificate: kkt", certificate["kkt"], CERTIFICATE_BAR)


def test_faults_touch_what_is_used():
    """The names patched above are the ones the model calls."""
    assert solving.coulomb_constant_pressure is marching.coulomb_constant_pressure is coulomb_constant_pressure
