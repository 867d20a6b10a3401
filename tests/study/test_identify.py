"""f from measured loops and from widths of scars. Loops are those of benchmarks/identify.py: Mindlin's closed form."""

import json
import runpy
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from refusing import line_of

import partialslip
from partialslip.cli import main
from partialslip.scene.reading import scene_toml
from partialslip.study.identify import MeasuredLoop, fit, from_loop, from_width, measured_loop, read_loop
from partialslip.tools.errors import InputError

made_by = SimpleNamespace(**runpy.run_path(str(Path(__file__).parents[2] / "benchmarks" / "identify.py")))
P, A = made_by.P, made_by.A
PLAIN = {"cycles": 2.0, "count": 100, "missing": "", "tension": 0.0, "drift": 0.0}


def scene_of(made=None, **load):
    tension = 1e4 * (made.tension if made else 0.0)
    return partialslip.parse_scene(
        {**made_by.SCENE, "load": {**made_by.SCENE["load"], "sigma": [-tension, tension], **load}}
    )


def made(seed, **settings):
    return made_by.loop(np.random.default_rng(seed), **{"used": 0.8, "noise": 0.01, **PLAIN, **settings})


def rows(made, **changes):
    return MeasuredLoop(**{"displacement": made.displacement, "Q": made.Q, "time": made.time, **changes})


def found(made, **changes):
    return from_loop(scene_of(made), rows(made, **changes))


@pytest.mark.parametrize("more", [{}, {"tension": 3.0}, {"begin": 0.2, "sharp": True, "drift": 0.05}])
def test_without_noise_f_and_stiffness_are_those_of_the_closed_form(more):
    loop = made(1, noise=0.0, **more)
    of = found(loop)
    assert of.f.value == pytest.approx(loop.f, rel=2e-3)
    assert of.stiffness.value == pytest.approx(1 / loop.compliance, rel=2e-3)
    half = 0.8 * loop.f * P
    whole, y = made_by.slipped(np.array(2 * half), loop.f, loop.tension), np.linspace(0, 2 * half, 2001)
    wide = whole - made_by.slipped(y, loop.f, loop.tension) - made_by.slipped(y[::-1], loop.f, loop.tension)
    assert of.area == pytest.approx(np.trapezoid(wide, y), rel=5e-3)


@pytest.mark.parametrize("seed", range(5))
def test_f_and_stiffness_are_in_their_intervals(seed):
    """Offset, drift, missing parts, noise of 0.5 to 5 %, with and without tension."""
    loop = made_by.loop(np.random.default_rng(100 + seed), count=100)
    of = found(loop)
    assert of.f.low <= loop.f <= of.f.high
    assert of.f.low > loop.f / 3
    assert of.stiffness.low <= 1 / loop.compliance <= of.stiffness.high


@pytest.mark.slow
def test_f_is_in_its_interval_in_95_of_100_loops():
    """40 loops, every eighth of them without slip to speak of. With a chance of 0.95 each, 35 or fewer have 1.4 %. A
    refusal tells nothing wrong, but must be rare."""
    random, inside, refused = np.random.default_rng(7), 0, 0
    for number in range(40):
        loop = made_by.loop(random, used=0.03 if number % 8 == 7 else None)
        try:
            of = found(loop)
        except InputError:
            refused += 1
            continue
        inside += of.f.low <= loop.f <= of.f.high
    assert refused <= 2
    assert inside >= 36 - refused


@pytest.mark.parametrize("more", [{"count": 20, "cycles": 1.0, "begin": 0.5}, {"used": 0.995}, {"used": 0.2}])
@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_short_loops_and_loops_near_sliding(more, noise):
    loop = made(3, noise=noise, **more)
    of = found(loop).f
    assert of.low <= loop.f <= of.high


def test_a_loop_without_slip_gives_a_lower_bound():
    loop = made(4, used=0.04)
    of = found(loop)
    assert of.f.one_sided
    assert 0.04 * loop.f * 0.99 <= of.f.low <= loop.f
    assert any("does not tell f" in line for line in of.remarks)


def test_more_noise_makes_the_interval_wider_in_proportion():
    narrow, wide = (found(made(5, noise=noise)).f for noise in (0.002, 0.02))
    assert 5 < (wide.high - wide.low) / (narrow.high - narrow.low) < 20


def test_an_error_of_the_model_does_not_average_out_over_cycles():
    """A rig whose compliance grows with Q: the loop bends by 2 % of its displacement."""
    intervals = []
    for cycles in (2.0, 8.0):
        loop = made(6, noise=0.002, cycles=cycles)
        y = (loop.Q - loop.Q.mean()) / np.ptp(loop.Q)
        of = found(loop, displacement=loop.displacement + 0.02 * np.ptp(loop.displacement) * (2 * y) ** 3)
        assert any("correlated" in line for line in of.remarks)
        assert of.f.low <= loop.f <= of.f.high
        intervals.append(of.f.high - of.f.low)
    assert intervals[1] > 0.8 * intervals[0]


def test_units_offsets_and_signs_change_nothing():
    loop = made(7)
    f = found(loop).f
    for change in (
        {"displacement": 1e-3 - loop.displacement, "Q": 1e5 - loop.Q},  # both turned round
        {"Q": loop.Q + 7e5, "time": 3 * loop.time + 40},
    ):
        other = found(loop, **change).f
        assert (other.value, other.low, other.high) == pytest.approx((f.value, f.low, f.high), rel=1e-4)


@pytest.mark.fault
def test_a_fault_turning_points_at_the_extreme_rows_are_noticed(monkeypatch):
    """The largest of many noisy rows is too large."""
    loop = made(10, count=400, noise=0.02)
    of = found(loop).f
    assert of.low <= loop.f <= of.high

    def extreme(loop):
        return measured_loop.branches_of(loop)._replace(turns=np.sort(loop.Q)[[0, -1]], turns_error=np.zeros(2))

    monkeypatch.setattr(fit, "branches_of", extreme)
    of = found(loop).f
    assert not of.low <= loop.f <= of.high


@pytest.mark.fault
def test_a_fault_correlated_rows_that_count_in_full_are_noticed(monkeypatch):
    """Noise that a filter of 30 rows has smoothed: 30 rows count as about one."""

    def missed():
        outside = 0
        for seed in range(5):
            loop = made(20 + seed, noise=0.0)
            noise = np.convolve(
                np.random.default_rng(seed).standard_normal(len(loop.Q) + 29), np.ones(30) / 30, "valid"
            )
            of = found(loop, displacement=loop.displacement + 0.05 * np.ptp(loop.displacement) * noise).f
            outside += not of.low <= loop.f <= of.high
        return outside

    assert missed() <= 1
    monkeypatch.setattr(fit, "_correlation", lambda _: 1.0)
    monkeypatch.setattr(fit, "_first_autocorrelation", lambda _: 0.0)
    assert missed() >= 2


LOOP = made(9, cycles=5.0, count=50)


@pytest.mark.parametrize(
    ("change", "line"),
    [
        ({"Q": 0 * LOOP.Q + 5}, "loop: Q is 5 N/m in all rows: must change"),
        ({"displacement": -LOOP.displacement}, "the displacement falls as Q rises: change its sign"),
        ({"Q": LOOP.Q[::-1], "displacement": LOOP.displacement[::-1]}, "the loop runs backwards"),
        ({"Q": np.clip(LOOP.Q - LOOP.Q.mean(), -1e4, 1e4)}, "the contact slides there, and f is about 0.073"),
        ({"Q": LOOP.Q * np.linspace(1, 0.5, len(LOOP.Q))}, "must have one amplitude"),
        (
            {"displacement": LOOP.displacement + 2e-6 * (np.arange(len(LOOP.Q)) == 100)},
            "the row at time 2 is off the loop by",
        ),
        ({"Q": np.sort(LOOP.Q), "displacement": np.sort(LOOP.displacement)}, "Q must rise and fall"),
    ],
)
def test_loops_that_are_none_are_refused(change, line):
    assert line in line_of(found, LOOP, **change)


@pytest.mark.parametrize(
    ("load", "line"),
    [
        ({"P": [1e5, 2e5]}, "load: P or M varies: must be constant"),
        ({"sigma": [-1e8, 1e8]}, "load.sigma: slip reverses between the load points"),
        ({"Q": [0.0, 0.0], "sigma": [0, 1e8]}, "load.Q: the same at load points 1 and 2"),
    ],
)
def test_scenes_without_such_a_loop_are_refused(load, line):
    assert line in line_of(from_loop, scene_of(**load), rows(LOOP))


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("u [um],Q [N]\n", "column 'Q [N]': must be per unit depth"),
        ("u [MPa],Q\n", "column 'u [MPa]': must be a length"),
        ("a,b\n", "column displacement: must be one of a, b: name it by --columns"),
        ("u,u,Q\n", "column displacement: must be one of"),
    ],
)
def test_files_that_are_no_loops_are_refused(tmp_path, text, line):
    file = tmp_path / "loop.csv"
    file.write_text(text + "".join(f"{k},{k}{',1' * (text.count(',') - 1)}\n" for k in range(20)))
    assert line in line_of(read_loop, file)
    file.write_text("u,Q\n1,2\n3,4\n")
    assert "2 rows with values: must be 16 to" in line_of(read_loop, file)


def test_columns_and_factors(tmp_path):
    loop, file = made(10), tmp_path / "loop.txt"
    table = np.stack([loop.Q * 0.01, loop.displacement * -1e6, loop.time], axis=1)  # N of a contact of 10 mm
    np.savetxt(file, table, "%.9g", ";", header="load cell [N];LVDT [um];t [s]", comments="")
    of = read_loop(file, columns={"Q": "1", "displacement": "2"}, factors=(-1, 100))
    for name in ("Q", "displacement", "time"):
        assert getattr(of, name) == pytest.approx(getattr(loop, name), rel=1e-6, abs=1e-12)


@pytest.mark.parametrize("slip", [False, True])
def test_f_from_the_width_of_a_scar(slip):
    """c = a sqrt(1 - Q/(f P)), Q = 1e4 N/m."""
    a, f = made_by.A_HALF_WIDTH, 0.1
    c = a * np.sqrt(1 - 1e4 / (f * P))
    width = a - c if slip else 2 * c
    assert from_width(scene_of(), width, slip=slip)[0].value == pytest.approx(f, rel=1e-9)
    of, _ = from_width(scene_of(), width, 0.1 * a, slip)
    ends = [1e4 / P / (1 - ((a - w if slip else w / 2) / a) ** 2) for w in (width - 0.1 * a, width + 0.1 * a)]
    assert (of.low, of.high) == pytest.approx(sorted(ends), rel=1e-9)
    of, remarks = from_width(scene_of(), width, width if slip else 2 * a - width, slip)
    assert of.one_sided
    assert any("f is at least" in line for line in remarks)


def test_the_wider_slip_zone_counts_under_tension():
    scene = scene_of(Q=[-1e4, 1e4], sigma=[-2e7, 2e7])
    zone = partialslip.halfplane.stick_zone(partialslip.halfplane.contact(scene), 0.1, 2e4, 4e7)
    width = made_by.A_HALF_WIDTH - min(zone.m, zone.n)
    assert from_width(scene, width, slip=True)[0].value == pytest.approx(0.1, rel=1e-6)


def test_the_command_prints_writes_and_refuses(tmp_path, monkeypatch, capsys, refused):
    monkeypatch.chdir(tmp_path)
    loop = made(11)
    made_by.write(loop, Path("loop.csv"))
    made_by.write(made(12, used=0.01), Path("stuck.csv"))
    Path("rig.toml").write_text(scene_toml(scene_of()))
    scene = ["identify", "rig.toml"]
    assert main([*scene, "--from", "loop.csv", "--stiffness", "--out", "told"]) == 0
    out = capsys.readouterr().out
    assert " f  " in out
    assert "stiffness" in out
    data = json.loads(Path("told/identify.json").read_text())
    assert data["f"]["low"] <= loop.f <= data["f"]["high"]
    assert "<svg" in Path("told/identify.svg").read_text()
    assert Path("told/identify.csv").read_text().startswith("displacement,Q,time,fitted,drift\n")
    assert main([*scene, "--from", "stuck.csv", "--out", "stuck"]) == 0
    assert "f not told at least" in " ".join(capsys.readouterr().out.split())
    assert json.loads(Path("stuck/identify.json").read_text())["f"]["high"] is None
    for options, line in (
        ([], "one of the arguments --from --stick-width --slip-scar is required"),
        (["--from", "none.csv"], "none.csv: cannot be read"),
        (["--from", "loop.csv", "--factors", "1"], "--factors 1: must be two numbers"),
        (["--from", "loop.csv", "--factors", "0,1"], "--factors 0,1: must be finite and not zero"),
        (["--from", "loop.csv", "--error", "1e-5"], "--error 1e-5: must be left out with --from"),
        (["--from", "loop.csv", "--columns", "x=1"], "--columns x=1: must name displacement, Q or time"),
        (["--stick-width", "0"], "--stick-width 0: must be a length > 0"),
        (["--stick-width", "1"], "--stick-width 1 m: must be between 0 and"),
        (["--slip-scar", "nan"], "--slip-scar nan: must be a length > 0"),
        (["--stick-width", "1e-5", "--stiffness"], "--stiffness: must be given only with --from"),
        (["--stick-width", "1e-5", "--set", "load.Q=[0,0]"], "load.Q, load.sigma: the same at load points 1 and 2"),
    ):
        assert line in refused(*scene, *options)
