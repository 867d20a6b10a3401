"""The study of cost: ladder, figures, results of other codes."""

import math
from dataclasses import replace

import made
import pytest
from outline import texts

import partialslip
from partialslip.cli.cost import _answer, _left_out, _progress
from partialslip.study import cost
from partialslip.study.batch.job import Job, ProcessCost, solve_apart
from partialslip.study.batch.job import _timing_settled as known
from partialslip.study.batch.ledger import Ledger
from partialslip.study.cost import phases_svg

SCENE = partialslip.load_scene("hertz-large-tension")


def point(series, cpu, error, dofs=1000):
    return cost.CostPoint(
        series, "", {"m": error, "n": error, "q": 10 * error}, cpu, 2 * cpu, 0, cpu, 100, {}, {"dofs": dofs}
    )


def test_the_ladder_is_of_every_kind():
    cases = cost.ladder(SCENE, every=True)
    assert len({case.key for case in cases}) == len(cases)
    orders = {case.scene.fem.elements for case in cases}
    assert orders == {1, 2, 3, 4, 6}
    assert {case.scene.fem.far_field for case in cases} == {"half-plane", "box"}
    assert any(case.scene.fem.size for case in cases)
    labels = [case.labels for case in cases]
    assert {str(label["setting"]).split()[0] for label in labels if label["setting"]} == {"accuracy", "h"}
    assert [label["series"] for label in labels if not label["setting"]] == ["exact"]
    names = [case.labels["series"] for case in cost.ladder(SCENE)]  # the coarsest setting of each series first
    assert (names[:5], {*names}) == (list(cost.USUAL), {*cost.USUAL})
    assert {case.methods for case in cost.ladder(SCENE, ("march",))} == {("exact", "march")}
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

        def apart(case, repeats):
            assert repeats >= 1
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
    solved = study([("fem, adapted", 1)], len)
    for repeats in (1, 3):
        (found,), left = cost.measure_costs(SCENE, Ledger(tmp_path / "ledger.jsonl"), repeats)
        assert (len(solved), found.cpu_s, left) == (1, 1.0, [])


def test_a_budget_ends_in_the_order_of_the_ladder(tmp_path, study):
    """A setting that is begun is finished, the first one whatever it costs; what was solved before counts, too."""
    study([("fem, adapted", each) for each in (1, 2, 3, 4)], lambda solved: 4.0 ** (solved[-1] - 1))
    for budget, count in ((0.5, 1), (1.0, 1), (3.0, 2), (6.0, 3), (math.inf, 4)):
        told, ledger = [], Ledger(tmp_path / "ledger.jsonl")
        found, left = cost.measure_costs(
            SCENE, ledger, 1, lambda *state, told=told: told.append(_progress(*state)), budget=budget
        )
        assert (len(found), len(left)) == (count, 4 - count)
        assert told[-1] == "drawing"
    assert told[0] == "setting 1 of 4: fem, adapted, 1"
    assert _progress(1, 4, "march", 12.3) == "setting 2 of 4: march, 12 CPU s left"


def test_seconds_of_a_solution_are_the_smallest_that_are_known():
    """Alone nothing tells how much of a solution is imports, unless it is long."""
    assert not known([0.3])
    assert not known([0.3, 0.2])
    assert known([0.3, 0.2, 0.21])
    assert known([9.0])


def test_repeats_in_one_process_solve_the_same():
    once, often = (solve_apart(Job(SCENE, ("exact", "march"), {}), repeats) for repeats in (1, 5))
    assert often.process.again_cpu_s > 100 * once.process.again_cpu_s  # which solves nothing again
    assert often.run.methods["march"].m == once.run.methods["march"].m


def test_what_is_left_out_is_said_in_one_line():
    left = [job("fem, adapted", 6), job("fem, adapted", 7), job("fem P1, uniform", 3)]
    line = _left_out(cost.MeasuredCosts([], left), "60s")
    assert line == "3 settings are left out, as --budget 60s is spent: fem, adapted, 6 on; fem P1, uniform, 3 on"


def test_the_answer_is_the_cheapest_setting_that_does():
    points = [point("march", 0.1, 1e-4), point("fem, adapted", 0.5, 1e-6), point("fem, adapted", 2.0, 1e-8)]
    assert _answer(cost.front(points), 2e-5) == [
        "m and n to 2e-05 a: fem, adapted, , in 0.5 CPU s", "best: 1.0e-08 a by fem, adapted, , in 2 CPU s"
    ]  # fmt: skip
    assert _answer(cost.front(points), 1e-9) == ["best: 1.0e-08 a by fem, adapted, , in 2 CPU s"]


def test_the_front_is_what_nothing_beats():
    points = [point("P4", 1.0, 1e-3), point("P4", 2.0, 1e-5), point("P1", 3.0, 1e-2), point("P1", 0.5, 1e-1)]
    assert [found.cpu_s for found in cost.front(points)] == [0.5, 1.0, 2.0]


def test_exponents_of_power_laws_are_found():
    points = [point("P4", 1e-6 * n**1.5, 7.0 * n**-2.0, n) for n in (100, 1000, 10_000)]
    assert cost.slopes(points)["P4"] == pytest.approx({"m, n": -2, "q": -2, "CPU": 1.5})
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


def test_a_peer_is_met_at_its_best_error_and_in_its_time():
    ours = [point("P4", 0.1, 1e-4), point("P4", 1.0, 1e-6)]
    found = cost.against(ours, [point("peer", 20.0, 1e-3), point("peer", 50.0, 1e-5)], "m")
    assert found == pytest.approx({"error": 1e-5, "cpu": 1 / 50, "process": 1 / 50, "error at its cpu": 0.1})
    assert math.isnan(cost.against(ours[:1], [point("peer", 0.01, 1e-5)], "m")["cpu"])
