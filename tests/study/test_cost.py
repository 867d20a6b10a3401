"""The study of cost: ladder, figures, results of other codes."""

import math
from dataclasses import replace

import made
import pytest
from outline import texts

import partialslip
from partialslip.cli import main
from partialslip.cli.cost import _left_out, _progress
from partialslip.study.batch.job import Job, ProcessCost, solve_apart
from partialslip.study.batch.ledger import Ledger
from partialslip.study.cost import ladder as cost
from partialslip.study.cost.figure import errors_svg, phases_svg
from partialslip.study.cost.spending import Spending

SCENE = partialslip.load_scene("hertz-large-tension")


def point(series, cpu, error, dofs=1000):
    return cost.CostPoint(
        series, "", {"m": error, "n": error, "q": 10 * error}, cpu, 2 * cpu, 0, cpu, 100, {}, {"dofs": dofs}
    )


def test_the_ladder_is_of_every_kind():
    cases = cost.ladder(SCENE)
    assert len({case.key for case in cases}) == len(cases)
    orders = {case.scene.fem.elements for case in cases}
    assert orders == {1, 2, 3, 4, 6}
    assert {case.scene.fem.far_field for case in cases} == {"half-plane", "box"}
    assert any(case.scene.fem.size for case in cases)
    unlike = partialslip.load_scene("hertz-shear", ["material.upper={E=1e9, nu=0.3}"])
    with pytest.raises(partialslip.InputError, match="needs the exact method"):
        cost.ladder(unlike)


def test_a_case_in_a_process_of_its_own_is_the_same_as_here():
    found = solve_apart(Job(SCENE, ("exact",), {"series": "exact", "setting": ""}))
    here = partialslip.run(SCENE, ["exact"]).results["exact"]
    exact = found.run.methods["exact"]
    assert exact.m == here.m
    assert 0 < exact.cost.cpu_s < found.process.cpu_s
    assert found.process.wall_s > 0


@pytest.fixture
def study(monkeypatch):
    """Call with pairs of series and setting, and with the seconds that a setting takes: the ladder of a study that is
    made up. Returns the settings that are solved, as they are solved."""

    def call(settings, seconds):
        solved = []

        def apart(case):
            solved.append(case.labels["setting"])
            spent, errors = float(seconds(solved)), dict.fromkeys(cost.ERRORS, 1e-3)
            found = {"cost": made.cost(spent, mesh=0.1), "counts": {"dofs": 10}}
            process = ProcessCost(spent, 0.0, 100.0, spent)
            return made.solved(case.scene, case.labels, errors, process, exact=found, fem=found)

        monkeypatch.setattr(cost, "solve_apart", apart)
        monkeypatch.setattr(cost, "ladder", lambda *_: [job(*setting) for setting in settings])
        return solved

    return call


def job(series, digits):
    """A setting of an accuracy, or of an element size of a series with uniform meshes."""
    fem = {"size" if "uniform" in series else "accuracy": 10.0**-digits}
    return Job(SCENE.replace(fem=fem), ("exact", "fem"), {"series": series, "setting": digits})


def test_what_was_measured_is_not_measured_again(tmp_path, study):
    """Medians are taken over the repeats of a setting."""
    solved = study([("P4", 1)], len)
    cost.measure_costs(SCENE, Ledger(tmp_path / "ledger.jsonl"), 1)
    (found,), left, *_ = cost.measure_costs(SCENE, Ledger(tmp_path / "ledger.jsonl"), 3)
    assert left == []
    assert len(solved) == 3
    assert found.cpu_s == 2.0


def test_a_study_of_cost_says_what_runs_and_how_long_it_takes(tmp_path, study):
    """The time left follows from an earlier repeat of the same setting, else from the mean."""
    walls = {2: 1.0, 5: 9.0}
    study([("P4, adapted", setting) for setting in walls], lambda solved: walls[solved[-1]])
    told = []
    cost.measure_costs(SCENE, Ledger(tmp_path / "ledger.jsonl"), 2, lambda *state: told.append(_progress(*state)))
    assert told == [
        "run 1 of at most 4: P4, adapted, 2",
        "run 2 of at most 4: P4, adapted, 5, 3 s left",
        "run 3 of at most 4: P4, adapted, 2, 10 s left",
        "run 4 of at most 4: P4, adapted, 5, 9 s left",
        "drawing",
    ]


def test_a_budget_leaves_out_what_is_predicted_not_to_fit(tmp_path, study):
    """Settings cost 1, 4, 16 and 64 s in one series, and 1 s in another. Each repeat solves the same settings;
    what was solved before counts, too."""
    settings = [*(("dear", each) for each in (1, 2, 3, 4)), *(("cheap", each) for each in (1.5, 2.5))]
    solved = study(settings, lambda solved: 1.0 if solved[-1] % 1 else 4.0 ** (solved[-1] - 1))
    names, ledger = [], Ledger(tmp_path / "ledger.jsonl")

    def measured(budget, repeats=1):
        states = []
        found, left, least, rest = cost.measure_costs(
            SCENE, ledger, repeats, lambda *state: states.append(state), budget=budget
        )
        names[:] = [(point.series, float(point.setting)) for point in found]
        assert states[-1][:2] == (repeats * len(found), repeats * len(found))
        assert not left or least > rest
        return {(str(case.labels["series"]), case.labels["setting"]) for case in left}

    left = measured(12.0)
    assert {*names} == {("dear", 1), ("cheap", 1.5), ("dear", 2), ("cheap", 2.5)}
    assert left == {("dear", 3), ("dear", 4)}
    count = len(solved)
    assert measured(12.0) == left
    assert len(solved) == count  # the ledger knows them
    assert measured(math.inf) == set()
    assert measured(12.0, 2) == left
    assert len(solved) == len(settings) + 4  # the second repeat is of what the first one ran


def test_a_budget_goes_from_cheap_to_dear_over_all_series():
    """What has run predicts what waits: a series that begins with a fine accuracy waits for the coarse ones."""
    series = {"fine": (6, 7), "coarse": (2, 3, 4), "uniform": (1, 2)}
    jobs = [job(name, digits) for name, settings in series.items() for digits in settings]
    spending, ran = Spending(jobs), []
    while case := spending.following(100.0):
        ran.append((case.labels["series"], case.labels["setting"]))
        spending.ran(case, 3.0 ** case.labels["setting"], 0.5)
    assert ran == [("uniform", 1), ("coarse", 2), ("uniform", 2), ("coarse", 3), ("coarse", 4)]
    assert {each.labels["series"] for each in spending.waiting} == {"fine"}
    assert spending.least == pytest.approx(3.0**6 + 0.5)  # as coarse has grown


def test_what_is_left_out_is_said_in_one_line():
    left = [job("P4, adapted", 6), job("P4, adapted", 7), job("P1, uniform", 3)]
    line = _left_out(cost.MeasuredCosts([], left, 53.21, 20.0), "60s")
    assert line == (
        "3 settings are left out: the cheapest of them is predicted to take 53.2 CPU s, and 20 s are left of --budget "
        "60s: P4, adapted, 6 on; P1, uniform, 3 on"
    )


def test_a_ladder_is_of_the_methods_asked_for():
    assert {case.methods for case in cost.ladder(SCENE, ("march",))} == {("exact", "march")}
    assert {case.labels["series"] for case in cost.ladder(SCENE, ("exact",))} == {"exact"}


def test_every_setting_says_what_it_is():
    labels = [case.labels for case in cost.ladder(SCENE)]
    assert {str(label["setting"]).split()[0] for label in labels if label["setting"]} == {"accuracy", "h"}
    assert [label["series"] for label in labels if not label["setting"]] == ["exact"]


def test_the_front_is_what_nothing_beats():
    points = [point("P4", 1.0, 1e-3), point("P4", 2.0, 1e-5), point("P1", 3.0, 1e-2), point("P1", 0.5, 1e-1)]
    assert [found.cpu_s for found in cost.front(points)] == [0.5, 1.0, 2.0]


def test_exponents_of_power_laws_are_found():
    points = [point("P4", 1e-6 * n**1.5, 7.0 * n**-2.0, n) for n in (100, 1000, 10_000)]
    assert cost.slopes(points)["P4"] == pytest.approx({"m, n": -2, "q": -2, "CPU": 1.5})


def test_meshes_alike_tell_no_exponent():
    assert math.isnan(cost.slopes([point("P4", 1.0, 1e-3, 1000), point("P4", 1.1, 1e-5, 1010)])["P4"]["CPU"])


def test_panels_of_phases_without_data_are_left_out():
    """One setting of each series has bars, but no growth; the exact method alone has neither. The legends stand beside
    their panels."""
    alone = phases_svg([point("P4, adapted", 1.0, 1e-3)], "one")
    assert "unknowns of the last mesh (P4, adapted)" in texts(alone)
    assert "CPU s of the method" not in texts(alone)
    both = phases_svg([point("P4, adapted", 1.0, 1e-3), point("P4, adapted", 4.0, 1e-5, 4000)], "two")
    assert {"CPU s of the process", "CPU s of the method", "P4, adapted: 1.00"} <= {*texts(both)}
    assert phases_svg([replace(point("exact", 1.0, 0.0), counts={})], "none") == ""


def test_seconds_have_plain_labels_that_do_not_touch():
    """A short axis has three labels in a decade, a long one the powers of ten alone."""
    short, long = (
        texts(errors_svg([point("P4", least, 1e-3), point("P4", most, 1e-5)], [], "one"))
        for least, most in ((0.55, 3.9), (0.55, 800.0))
    )
    assert {"1", "2"} <= {*short}
    assert {"1", "10", "100"} <= {*long}
    assert not {"2", "20"} & {*long}


def test_a_peer_is_met_at_its_best_error_and_in_its_time():
    ours = [point("P4", 0.1, 1e-4), point("P4", 1.0, 1e-6)]
    found = cost.against(ours, [point("peer", 20.0, 1e-3), point("peer", 50.0, 1e-5)], "m")
    assert found == pytest.approx({"error": 1e-5, "cpu": 1 / 50, "process": 1 / 50, "error at its cpu": 0.1})
    assert math.isnan(cost.against(ours[:1], [point("peer", 0.01, 1e-5)], "m")["cpu"])


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("{}", "scene: missing"),
        ("[]", "must be an object, not an array"),
        ("no", "not JSON"),
        ('{"scene": "hertz-large-tension", "method": "x"}', "setting: missing"),
        ('{"scene": 3}', "scene: must be a string, not a whole number"),
    ],
)
def test_what_is_no_peers_result_is_refused(tmp_path, capsys, line, told):
    (tmp_path / "peers.jsonl").write_text(line + "\n", "utf-8")
    arguments = ["study", "cost", "hertz-large-tension", "--peers", str(tmp_path / "peers.jsonl")]
    assert main([*arguments, "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert told in said
    assert not (tmp_path / "out").exists()
