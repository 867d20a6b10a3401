"""The study of cost: ladder, figures, results of other codes, and price list."""

import importlib
import json
import math
from dataclasses import replace
from types import SimpleNamespace

import made
import numpy as np
import pytest
from outline import texts

import partialslip
from partialslip.batch.job import Job, ProcessCost, solve_apart
from partialslip.batch.ledger import Ledger
from partialslip.cli import main
from partialslip.cli import run as command
from partialslip.cli.cost import _left_out, _progress
from partialslip.study.cost import ladder as cost
from partialslip.study.cost import prices
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


# the price list


def measured(spread=0.0):
    """Artificial costs from a model: Hertz contacts and punches, without and with mean loads, both factorisations."""
    random = np.random.default_rng(3)
    for name, kind in (("hertz-shear", 1.0), ("flat-rounded", 1.5)):
        for loads, family in (([], 1.0), (["load.Q=[-10e3,20e3]", "load.sigma=[0,0]"], 2.0)):
            for factor, rate in (("cholmod", 0.4), ("superlu", 0.5)):
                for digits in (2.0, 3.0, 4.0, 5.0, 6.0):
                    settings = [*loads, f"fem.accuracy={10**-digits!r}", f"fem.factor={factor}"]
                    seconds = kind * family * 0.1 * math.exp(rate * digits + spread * random.normal())
                    slow = random.uniform(1, 3)
                    costs = {"exact": 0.1 * seconds * slow, "fem": 0.9 * seconds * slow}
                    yield prices.MeasuredRun(partialslip.load_scene(name, settings), costs, 0.7 * slow, 0.5 * slow)


def priced(known, name="hertz-shear", *settings, **more):
    return known.price(partialslip.load_scene(name, ["fem.factor=cholmod", "fem.accuracy=1e-4", *settings]), **more)


def test_the_model_is_found_again():
    """Independent of other load on the machine; for each profile, family and factorisation."""
    known = prices.fit(measured(), "a machine")
    assert max(family.spread for family in known.families.values()) == pytest.approx(1, abs=2e-2)
    work = known.closing + known.start
    slow = priced(known).cpu_s - work
    means = ["load.Q=[-10e3,20e3]", "load.sigma=[0,0]"]
    for setting, expected in (
        (("hertz-shear", "fem.factor=superlu"), 0.4),
        (("flat-rounded",), math.log(1.5)),
        (("hertz-shear", *means), math.log(2)),
    ):
        assert math.log((priced(known, *setting).cpu_s - work) / slow) == pytest.approx(expected, abs=3e-2)


def test_start_and_report_are_in_the_price():
    known = prices.fit(measured(), "a machine")
    once, twice = priced(known), priced(known, start=2 * known.start)
    assert (once.start_s, once.closing_s) == (known.start, known.closing)
    assert twice.cpu_s == pytest.approx(2**known.power * (once.cpu_s - known.start) + 2 * known.start)
    assert 0.9 < known.power <= 1


def test_prices_that_are_not_known_are_not_told():
    """A family without measured runs, an accuracy beyond them, other methods, and runs that scatter."""
    known = prices.fit(measured(), "a machine")
    assert priced(known).cpu_s is not None
    assert "1.0e-04 a: price not known" in str(priced(known, "fretting-aluminium", "load.P=[120e3, 135e3]"))
    for setting in ("fem.accuracy=1e-8", "fem.order=2", "material.upper={E=1e11,nu=0.3}", "effects.history=true"):
        assert priced(known, "hertz-shear", setting).cpu_s is None, setting
    assert priced(known, methods=["march", "fem"]).cpu_s is None
    assert priced(known, methods=["fem", "exact"]).cpu_s == priced(known).cpu_s
    scattered = prices.fit(measured(1.0), "a machine")
    assert priced(scattered, "hertz-shear", "fem.accuracy=1e-6").cpu_s is None
    few = prices.fit([run for run in measured() if prices.price_family(run.scene) == "reversed"], "a machine")
    assert [*few.families] == ["reversed"]
    with pytest.raises(partialslip.InputError, match="at least 10"):
        prices.fit([], "a machine")


def test_families_follow_bodies_and_loads():
    def family(*settings):
        return prices.price_family(partialslip.load_scene("fretting-aluminium", settings))

    assert family() == family("load.Q=[-1e4, 1e4]") == family("fem.accuracy=1e-6") == "reversed"
    assert family("load.Q=[0, 3e4]") == "mean loads, slip turns round"
    assert family("load.Q=[0, 3e4]", "load.sigma=[0, 0]") == "mean loads"
    assert family("load.P=[120e3, 135e3]") == "varying P"
    assert family("material.upper={E=2e11, nu=0.3}") == "unlike"
    pad = "bodies.upper={kind='pad', width=12e-3, height=5e-3"
    assert family(pad + "}") == "finite"
    assert family(pad + ", support='pivot', pivot_height=1e-4}") == "pivot"
    driven = (
        "load={P=135750.0, displacement=[-2e-6, 2e-6]}",
        pad + ", support='sides'}",
        "bodies.lower={width=4e-2, height=4e-3, support='roller'}",
    )
    assert family(*driven) == "finite, plates moved"


def test_a_price_follows_no_gradual_way(monkeypatch):
    """Which takes seconds where a zone inside slips: as many as the run."""
    monkeypatch.setattr("partialslip.halfplane.turning.steady", lambda *_: pytest.fail("followed"))
    turning = partialslip.load_scene("hertz-shear", ["load.Q=[-267035, 267035]", "load.sigma=[-9e8, 9e8]"])
    assert prices.price_family(turning) == "slip turns round"


def test_the_shipped_list_rises_with_accuracy():
    known = prices.load_prices()
    assert {*known.profiles} == {"hertz", "flat-rounded"}
    paid = [priced(known, "hertz-shear", f"fem.accuracy={asked}").cpu_s for asked in (1e-3, 1e-4, 1e-5)]
    assert paid == sorted(paid)
    assert paid[0] > known.start + known.closing


@pytest.mark.parametrize("extra", [("--with", "exact"), ("--set", "fem.size=0.1")])
def test_a_budget_needs_elements_that_follow_an_accuracy(refused, extra):
    assert refused("run", "hertz-shear", "--budget", "50s", *extra).startswith("partialslip: --budget: needs")


def test_a_budget_below_the_least_price_is_refused_before_work_starts(monkeypatch, refused):
    monkeypatch.setattr(partialslip, "run", lambda *_, **__: pytest.fail("work has started"))
    assert "must be at least" in refused("run", "hertz-shear", "--budget", "0.01s")


def test_what_the_choice_of_methods_takes_is_part_of_a_budget(monkeypatch, refused):
    """The exact way is followed for it, which may take more than all else."""
    clock, allowed = [0.0], []

    def default_methods(_):
        clock[0] += 100.0
        return "exact", "fem"

    def run(*_, **__):
        raise partialslip.InputError("no run")

    monkeypatch.setattr(command, "time", SimpleNamespace(process_time=lambda: clock[0]))
    monkeypatch.setattr(importlib.import_module("partialslip.run"), "default_methods", default_methods)
    monkeypatch.setattr(command, "Allowance", lambda rest, **_: allowed.append(rest))
    monkeypatch.setattr(partialslip, "run", run)
    refused("run", "hertz-shear", "--budget", "1000s")
    known = prices.load_prices()
    assert allowed == [pytest.approx(1000 - 100 - known.start - known.closing)]


def test_a_price_is_told_and_the_accuracy_reached(tmp_path, capsys):
    assert main(["run", "hertz-shear", "--accuracy", "1e-3", "--out", str(tmp_path)]) == 0
    printed = capsys.readouterr()
    assert "predicted" in printed.err
    assert "actual" in printed.out
    text = json.loads((tmp_path / "results.json").read_text("utf-8"))
    found, estimate = text["comparison"]["fem"]["errors"], text["methods"]["fem"]["estimate"]
    assert max(found[key] for key in ("a", "m", "n")) <= 1e-3
    assert f"known to {max(estimate[key] for key in ('a', 'm', 'n')):.1e} a" in printed.out


def test_a_budget_goes_beyond_the_default_accuracy_and_tells_the_estimate(tmp_path, capsys, monkeypatch):
    """Up to the finest accuracy, or to the one that is set."""
    monkeypatch.setattr(prices, "FINEST_ACCURACY", 1e-7)
    for settings, finest in ([], 1e-7), (["--set", "fem.accuracy=1e-3"], 1e-3):
        out = tmp_path / str(finest)
        assert main(["run", "hertz-shear", "--budget", "1000s", *settings, "--out", str(out)]) == 0
        fem = json.loads((out / "results.json").read_text("utf-8"))["methods"]["fem"]
        known = max(fem["estimate"][key] for key in ("a", "m", "n"))
        assert fem["settings"]["accuracy"] == finest
        printed = " ".join(capsys.readouterr().out.split())
        assert "budget of 1000 s" in printed
        assert f"known to {known:.1e} a" in printed


@pytest.mark.parametrize(
    "options",
    [("--budget", "0"), ("--budget", "-1s"), ("--budget", "soon"), ("--budget", "nan"), ("--budget", "1e-3s"),
     ("--accuracy", "x"), ("--accuracy", "1"), ("--accuracy", "1e-3", "--budget", "5s")],
)  # fmt: skip
def test_bad_prices_are_one_line(refused, options):
    refused("run", "hertz-shear", *options)
