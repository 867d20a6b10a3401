"""An allowance of CPU seconds: finite elements settle for what it suffices for, and say so. Work counts as seconds."""

import pytest

from partialslip import Allowance, InputError, load_scene, plan, run
from partialslip_fem import estimate, mesh_cost, solve, solving

ASKED = 1e-6
SCENE = load_scene("hertz-small-tension", [f"fem.accuracy={ASKED!r}"])
SECONDS = 1e4  # a thousand unknowns, beside which seconds of this machine are nothing


class Counter:
    """CPU seconds that pass only with solutions, in proportion to their unknowns."""

    def __init__(self, monkeypatch):
        self.seconds = 0.0
        for module, name in ((solving, "mesh_and_solve"), (estimate, "neighbour")):
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
def test_what_is_allowed_is_kept_and_buys_accuracy(counter):
    reached = []
    for allowed in (20, 40, 80):
        counter.seconds = 0.0
        reached.append(fem(Allowance(allowed * SECONDS, counter)).settings["accuracy"])
        assert counter.seconds <= 1.1 * allowed * SECONDS
    assert reached[0] > reached[1] > reached[2]


@pytest.mark.parametrize(
    "loads",
    [[], ["load.P=[100e3, 135750]"], pytest.param(["material.upper={E=150e9, nu=0.3}"], marks=pytest.mark.slow)],
)
def test_the_work_of_a_run_without_an_allowance_suffices_for_its_errors(counter, loads):
    """Load steps are refined and checked, and meshes made, as without an allowance."""
    scene = load_scene("fretting-aluminium", [*loads, "fem.accuracy=1e-3"])
    free = solve(scene, plan(scene))
    allowed, counter.seconds = counter.seconds, 0.0
    limited = solve(scene, plan(scene), allowance=Allowance(allowed, counter))
    assert limited.estimate == free.estimate
    assert limited.counts == free.counts


def test_seconds_that_are_left_buy_accuracy_up_to_the_finest(counter):
    scene = load_scene("hertz-shear", ["fem.accuracy=1e-3"])
    free, spent = solve(scene, plan(scene)), counter.seconds
    found = {}
    for times, finest in ((1, 1e-5), (1000, 1e-5), (1000, float("inf"))):
        counter.seconds = 0.0
        found[times, finest] = solve(scene, plan(scene), allowance=Allowance(times * spent, counter, finest))
        assert counter.seconds <= 1.1 * times * spent
    assert found[1, 1e-5].estimate == found[1000, float("inf")].estimate == free.estimate
    assert max(found[1000, 1e-5].estimate[key] for key in "amn") <= 1e-5 == found[1000, 1e-5].settings["accuracy"]


def test_the_finest_accuracy_is_priced_where_the_contact_moves(counter):
    """Its meshes would have a million vertices in what the ends of the contact sweep."""
    scene = load_scene("fretting-aluminium", ["load.P=[100e3, 135750]", "fem.accuracy=1e-2"])
    free = solve(scene, plan(scene))
    allowed, counter.seconds = 4 * counter.seconds, 0.0
    limited = solve(scene, plan(scene), allowance=Allowance(allowed, counter, 1e-9))
    assert counter.seconds <= 1.1 * allowed
    assert max(limited.estimate.values()) <= max(free.estimate.values())


@pytest.mark.fault
def test_meshes_taken_to_cost_nothing(counter, monkeypatch):
    monkeypatch.setattr(mesh_cost, "_work", lambda _: 1e-9)
    fem(Allowance(5 * SECONDS, counter))
    assert counter.seconds > 1.1 * 5 * SECONDS


def test_seconds_elsewhere_count():
    allowance = Allowance(5.0, lambda: 1.0)
    allowance.spend(2.0)
    assert allowance.remaining() == 3.0


def test_seconds_are_a_number():
    """A limit that is no number would limit nothing, in silence."""
    with pytest.raises(InputError, match="must be a number of CPU seconds"):
        Allowance(float("nan"))


def test_the_march_begins_no_mesh_that_nothing_is_left_for():
    """Two meshes at least, as the errors of one are not known; and it says what these leave."""
    scene = load_scene("hertz-small-tension", ["load.Q=[-1e4, 8e4]", "load.sigma=[0, 1e8]", "fem.accuracy=1e-4"])
    free, poor = (run(scene, ["march"], allowance=limit).results["march"] for limit in (None, Allowance(0.0)))
    assert free.counts["meshes"] > poor.counts["meshes"] == 2
    assert abs(free.m - poor.m) < poor.estimate["m"] * poor.a
    assert any("not reached" in note for note in poor.notes)
    assert not any("not reached" in note for note in free.notes)
