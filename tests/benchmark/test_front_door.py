"""``partialslip.benchmark``: tractions are graded from Python, in the tests of any code."""

import numpy as np
import pytest

import partialslip.benchmark
from partialslip.benchmark import grade
from partialslip.codes.score.samples import samples
from partialslip.verify import benchmark
from partialslip.verify.benchmark import Answer, graded
from partialslip.verify.benchmark.problem import numbered
from partialslip.verify.benchmark.tables import table_values


def cattaneo(c_over_a=None, points=401):
    """x, p, q1, q2 of PS-02 by Cattaneo's formula: Q is fully reversed, and -q1 = q2."""
    E, nu, R, f, P, Q = 72.1e9, 0.33, 0.010, 0.3, 135750.0, 30e3
    a = np.sqrt(8 * P * R * (1 - nu**2) / (np.pi * E))  # two equal half-planes: 1/E* = 2 (1 - nu^2)/E
    c, p0 = a * (np.sqrt(1 - Q / (f * P)) if c_over_a is None else c_over_a), 2 * P / (np.pi * a)
    x = np.linspace(-1.1, 1.1, points) * a
    outer, inner = (np.sqrt(np.maximum(1 - (x / end) ** 2, 0)) for end in (a, c))
    q = f * p0 * (outer - c / a * inner)
    return x, p0 * outer, -q, q


def test_cattaneos_formula_reaches_the_targets():
    found = grade("PS-02", *cattaneo(points=1201))
    assert found.grade <= "B"
    assert found.groups["contact"] == found.groups["stick"] == "A"
    assert found.groups["slip"] == "not offered"
    assert str(found).startswith(f"PS-02: {found.grade}, {found.worst} off by ")


def test_the_grade_is_that_of_the_command():
    x, p, q1, q2 = cattaneo()
    problem = numbered("PS-02")
    made = samples({"x": x, "p": p, "q1": q1, "q2": q2}, "PS-02", (1.0, 1.0, 1.0), 1, "sampled")
    table = table_values(problem, made, "PS-02")
    known, found = graded(problem, Answer(dict(table.values))), grade("PS-02", x, p, q1, q2)
    assert (found.grade, found.worst, found.errors) == (known.overall.grade, known.overall.worst, known.errors)
    assert found.reading == table.errors


@pytest.mark.parametrize(("off", "at_most"), [(0.003, "C"), (0.03, "D")])
def test_a_stick_zone_that_is_off_is_graded_by_how_much(off, at_most):
    found = grade("PS-02", *cattaneo(0.5132105 + off))
    assert found.errors["m"] == pytest.approx(off, abs=2e-4)
    assert found.groups["stick"] == at_most


@pytest.mark.fault
def test_tractions_in_mpa_are_graded_e_and_named():
    x, *tractions = cattaneo()
    found = grade("PS-02", x, *(each / 1e6 for each in tractions))
    assert found.grade == "E"
    assert "MPa" in str(found)


@pytest.mark.parametrize(
    ("changed", "line"),
    [
        ({"problem": "PS-99"}, "PROBLEM 'PS-99': must be one of PS-01"),
        ({"q1": None}, "q1: must be given for PS-02, as the problem has friction"),
        ({"problem": "PS-19"}, "p1: must be given for PS-19, as P or M varies"),
        ({"p": np.ones(3)}, r"p: shape \(3,\): must be \(n,\), that of x, \(401,\)"),
        ({"p": np.full(401, np.nan)}, "PS-02: p = nan: must be zero or of a size"),
        ({"p": -cattaneo()[1]}, "PS-02: p > 0 at 0 points: must be at least 6; pressure must be positive"),
        ({"kind": "mids"}, "kind = 'mids': must be one of sampled, mean, nodal, or None"),
    ],
)
def test_wrong_arrays_are_refused_in_a_line(changed, line):
    given = dict(zip(("x", "p", "q1", "q2"), cattaneo(), strict=True)) | {"problem": "PS-02"} | changed
    with pytest.raises(partialslip.InputError, match=line):
        grade(**given)


def test_without_friction_pressure_is_enough():
    x, p, *_ = cattaneo()
    assert grade("PS-01", x, p).groups["contact"] == "A"


def test_other_names_are_those_of_the_benchmark():
    assert partialslip.benchmark.read_submission is benchmark.read_submission
    with pytest.raises(AttributeError, match=r"module 'partialslip\.benchmark' has no attribute 'other'"):
        partialslip.benchmark.other  # noqa: B018
    assert not hasattr(partialslip.benchmark, "__path__")
