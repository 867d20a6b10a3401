"""An allowance of CPU seconds: finite elements settle for what it suffices for, and say so. Work counts as seconds."""

import math

import pytest

from partialslip import Allowance, InputError, load_scene, plan, run
from partialslip.result import Clock, Pace
from partialslip_fem import adapt, solve, solving

ASKED = 1e-6
SCENE = load_scene("hertz-small-tension", [f"fem.accuracy={ASKED!r}"])
SECONDS = 1e4  # a thousand unknowns, beside which seconds of this machine are nothing


class Counter:
    """CPU seconds that pass only with solutions, in proportion to their unknowns."""

    def __init__(self, monkeypatch):
        self.seconds = 0.0
        for module, name in ((solving, "mesh_and_solve"), (adapt, "neighbour")):
            monkeypatch.setattr(module, name, self._counted(getattr(module, name)))

    def _counted(self, solution):
        def counted(*given, **settings):
            found = solution(*given, **settings)
            self.seconds += SECONDS * found.dofs / 1000
            return found

        return counted

    def __call__(self):
        return self.seconds


@pytest.fixture
def counter(monkeypatch):
    return Counter(monkeypatch)


def fem(allowance=None):
    return solve(SCENE, plan(SCENE), allowance=allowance)


@pytest.mark.slow
def test_enough_changes_nothing(counter):
    free, rich = fem(), fem(Allowance(1e9, counter))
    assert (rich.m, rich.n, rich.a) == (free.m, free.n, free.a)
    assert rich.estimate == free.estimate
    assert rich.counts == free.counts
    assert rich.settings == free.settings
    assert not rich.notes


def test_what_is_spent_after_the_first_mesh_gives_a_coarser_answer_that_says_so(counter):
    outcome = run(SCENE, allowance=Allowance(SECONDS, counter))
    found = outcome.results["fem"]
    reached = found.settings["accuracy"]
    assert found.counts["meshes"] == 2
    assert reached > 10 * ASKED
    assert max(found.estimate[key] for key in "amn") <= reached
    assert outcome.accuracy == reached
    assert outcome.passed
    assert any("allowed suffice" in note for note in found.notes)


@pytest.mark.slow
def test_what_is_allowed_buys_accuracy(counter):
    """More allowance is never worse; the last mesh and its estimate may exceed it by what their growth left unknown."""
    reached = []
    for allowed in (20, 40, 80):
        counter.seconds = 0.0
        reached.append(fem(Allowance(allowed * SECONDS, counter)).settings["accuracy"])
        assert counter.seconds <= 1.5 * allowed * SECONDS
    assert reached[0] >= reached[1] >= reached[2] < reached[0]


def test_meshes_grow_as_the_last_two_did():
    """The next mesh fits if the seconds that are left suffice for it; nothing is limited without an allowance."""
    seconds = [0.0]
    pace = Pace(Clock(Allowance(10.0, lambda: seconds[0])))
    for spent, needs in ((1.0, 1.0), (2.0, 4.0), (1.0, 1.0)):
        seconds[0] += spent
        pace.took()
        left = 10.0 - seconds[0]
        assert pace.fits(0.99 * left / needs)
        assert not pace.fits(1.01 * left / needs)
    for clock in (Clock(), Clock(Allowance(math.inf))):
        free = Pace(clock)
        free.took()
        assert free.fits(1e9)


@pytest.mark.fault
def test_meshes_taken_to_fit_always(counter, monkeypatch):
    monkeypatch.setattr(Pace, "fits", lambda *_: True)
    fem(Allowance(5 * SECONDS, counter))
    assert counter.seconds > 1.5 * 5 * SECONDS


def test_seconds_elsewhere_count():
    allowance = Allowance(5.0, lambda: 1.0)
    allowance.spend(2.0)
    assert allowance.remaining() == 3.0


def test_seconds_are_a_number():
    """A limit that is no number would limit nothing, in silence."""
    with pytest.raises(InputError, match="must be a number of CPU seconds"):
        Allowance(float("nan"))


def test_the_march_begins_no_mesh_that_nothing_is_left_for():
    """Four meshes at least, as errors are changes since the two before; and it says what these leave."""
    scene = load_scene("hertz-small-tension", ["load.Q=[-1e4, 8e4]", "load.sigma=[0, 1e8]", "fem.accuracy=1e-4"])
    free, poor = (run(scene, ["march"], allowance=limit).results["march"] for limit in (None, Allowance(0.0)))
    assert free.counts["meshes"] > poor.counts["meshes"] == 4
    assert abs(free.m - poor.m) < poor.estimate["m"] * poor.a
    assert any("not reached" in note for note in poor.notes)
    assert not any("not reached" in note for note in free.notes)
