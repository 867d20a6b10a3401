"""Statements have closed targets, found here in other ways, and are graded like problems."""

import json

import mpmath
import numpy as np
import pytest

from partialslip.cli import main
from partialslip.verify.benchmark import Answer, graded, read_problems, read_statements
from partialslip.verify.benchmark.measured import GROUPS

ALL = read_statements()
TARGETS = {number: {key: each.value for key, each in statement.measured.items()} for number, statement in ALL.items()}


@pytest.mark.parametrize("number", ALL)
def test_statements_stand_alone(number):
    statement = ALL[number]
    assert number not in read_problems()
    assert len(statement.statement) > 200
    assert all(each.scale > 0 and each.group in GROUPS for each in statement.measured.values())


@pytest.mark.parametrize("number", ALL)
def test_formulas_hold_in_thirty_digits(number):
    with mpmath.workdps(30):
        known = {"sqrt": mpmath.sqrt, "pi": mpmath.pi}
        known |= {key: mpmath.mpf(repr(value)) for key, value in ALL[number].data.items()}
        for key, asked in ALL[number].targets.items():
            known[key] = mpmath.mpf(eval(asked.formula, {}, known))
            target = ALL[number].measured[key]
            assert abs(known[key] - target.value) <= 1e-13 * target.scale


def test_the_wedge_is_in_equilibrium():
    """Unknown F and N; up: N (cos - f sin) = G, F = N (sin + f cos); down with -f."""
    angle, f = np.arctan(0.1), 0.3
    for key, sign in (("up", 1), ("down", -1)):
        normal = 1 / (np.cos(angle) - sign * f * np.sin(angle))
        assert TARGETS["ST-02"][key] == pytest.approx(normal * (np.sin(angle) + sign * f * np.cos(angle)), rel=1e-13)


def test_the_block_that_holds_is_in_equilibrium():
    assert TARGETS["ST-03"]["friction"] == pytest.approx(9.81 * np.sin(np.arctan(0.2)), rel=1e-13)


def test_the_spheres_tractions_add_up():
    """q = f p0 (sqrt(1 - r^2) - (c/a) sqrt(1 - (r/c)^2)) carries Q, p carries P, and gives the shear asked for."""
    data, found = ALL["ST-05"].data, TARGETS["ST-05"]
    a, c, p0, f = found["a"], found["c"], found["p_max"], data["f"]

    def ellipse(radius):
        return lambda r: mpmath.sqrt(1 - (r / radius) ** 2) * 2 * mpmath.pi * r

    P = p0 * mpmath.quad(ellipse(a), [0, a])
    Q = f * p0 * (mpmath.quad(ellipse(a), [0, a]) - c / a * mpmath.quad(ellipse(c), [0, c]))
    assert float(P) == pytest.approx(data["P"], rel=1e-10)
    assert float(Q) == pytest.approx(data["Q"], rel=1e-10)
    assert found["q_0"] == pytest.approx(f * p0 * (1 - c / a), rel=1e-12)
    assert 0.9 * a > c  # slips at 0.9 a
    # pressed: p0 = 2 a E*/(pi R'), E* = E/2
    assert p0 == pytest.approx(2 * a * (data["E"] / 2) / (np.pi * data["R"] / 2), rel=1e-12)


def test_the_loop_of_the_spheres_follows_from_the_first_loading():
    """Masing: a branch after the reversal is the first loading, twice as large."""
    data, first, loop = ALL["ST-06"].data, TARGETS["ST-05"], TARGETS["ST-06"]
    P, Q, f = (mpmath.mpf(data[key]) for key in "PQf")
    whole = first["shift"] / (1 - (1 - Q / (f * P)) ** (mpmath.mpf(2) / 3))

    def loading(force):
        return whole * (1 - (1 - force / (f * P)) ** (mpmath.mpf(2) / 3))

    def back(force):
        return loading(Q) - 2 * loading((Q - force) / 2)

    assert float(back(0)) == pytest.approx(loop["shift"], rel=1e-12)
    work = mpmath.quad(lambda force: back(force) + back(-force), [-Q, Q])  # forth is back, turned over
    assert float(work / (f * P * loop["a"])) == pytest.approx(loop["dissipated"], rel=1e-10)


def test_statements_are_graded_by_score(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "meta.toml").write_text('code = "mine"\nversion = "1"\n', "utf-8")
    values = TARGETS["ST-02"] | {"up": 1.002 * TARGETS["ST-02"]["up"]}
    (tmp_path / "ST-02.json").write_text(json.dumps({"values": values}), "utf-8")
    assert main(["benchmark", "score", "."]) == 0
    row = next(line for line in capsys.readouterr().out.splitlines() if "ST-02" in line)
    assert "up" in row
    assert " B " in row


@pytest.mark.fault
def test_a_hold_that_creeps_is_seen():
    """Regularised friction, q = f p v/v0: creeps by tan a/f v0 t."""
    found = graded(ALL["ST-03"], Answer(TARGETS["ST-03"] | {"creep": 0.2 / 0.3 * 1e-3 * 100}))
    assert found.overall.grade == "E"
