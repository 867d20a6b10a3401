"""Every field of a scene with every kind of value: done, or refused in one line."""

from pathlib import Path

import pytest

GOOD = (Path(__file__).parent / "bench.toml").read_text("utf-8")
FLAT = GOOD.replace('kind = "hertz"', 'kind = "flat-rounded"\nb = 1e-3').replace("p0 = 400e6", "P = 6e5")
TABLE = 'kind = "tabulated"\nx = [0.0, 1e-3, 2e-3, 3e-3]\ngap = [0.0, 1e-5, 4e-5, 9e-5]'
TABULATED = GOOD.replace('kind = "hertz"\nR = 0.05', TABLE).replace("p0 = 400e6", "P = 6e5")

NO_NUMBERS = ("nan", "inf", "-inf", "1e400", "-1e-320", "1e101", "-1e101", "9" * 400, "true", "''", "'1'", "x y", "[]",
              "[1]", "[nan, 1]", "[[1], [2]]", "['a', 'b']", "{}", "{a = 1}", "1979-05-27", "12:00:00", "1__0", "[1",
              "=", "", '"\\u0000"', "1\n2")  # fmt: skip
SIZES = ("-1", "0", "1", "1e-100", "1e-50", "1e-12", "1e12", "1e50", "1e100", "-1e-100", "-1e100")
NUMBERS = ("material.E", "material.nu", "material.upper.E", "material.lower.nu", "profile.R", "friction.f", "load.p0",
           "load.cycles", "load.steps", "fem.accuracy", "fem.order", "fem.width", "fem.size", "fem.lower_size",
           "bodies.upper.width", "bodies.lower.height")  # fmt: skip
LISTS = ("load.Q", "load.sigma")
WORDS = ("name", "title", "material.plane", "fem.far_field", "fem.factor", "profile.kind")
NO_LISTS = tuple(value for value in NO_NUMBERS if value not in ("[1", "=", "", "1\n2")) + SIZES
PAIRS = ("[0, 0]", "[0, 0, 0]", "[1, 1]", "[1e100, -1e100]", "[1e-100, -1e-100]", "[1e50, 1e-50]", "[0, 1e12]")
NO_WORDS = (
    "1",
    "1.5",
    "nan",
    "true",
    "[]",
    "['x']",
    "{}",
    "1979-05-27",
    "12:00:00",
    '"\\u0000"',
    '"a/b"',
    "''",
    '"\\n"',
)
TABLES = ("[0, 1]", "[0, 1, 1]", "[0, 2, 1]", "[1, 2, 3, 4]", "[0, -1, -2, -3]", "[0, 0, 0, 0]", "[0, 1e-3, nan, 1]",
          "[0, 1e50, 1e51, 1e52]", "[0, 1e-90, 1e-80, 1e-70]", "[0, 1, 2, 3, 4]", "[0, 1e-3, 2e-3, 3e-3]")  # fmt: skip


def refusals(judged, tmp_path, text, settings):
    """How many of the settings are refused by the exact method."""
    (tmp_path / "bench.toml").write_text(text, "utf-8")
    run = ("run", "bench.toml", "--with", "exact", "--json")
    return sum(judged([*run, "--set", f"{field}={value}"]) for field, value in settings)


@pytest.mark.parametrize("field", NUMBERS)
def test_numbers(judged, tmp_path, field):
    assert refusals(judged, tmp_path, GOOD, [(field, value) for value in NO_NUMBERS]) == len(NO_NUMBERS)
    refusals(judged, tmp_path, GOOD, [(field, value) for value in SIZES])


@pytest.mark.parametrize("field", LISTS)
def test_lists(judged, tmp_path, field):
    assert refusals(judged, tmp_path, GOOD, [(field, value) for value in NO_LISTS]) == len(NO_LISTS)
    refusals(judged, tmp_path, GOOD, [(field, value) for value in PAIRS])
    number = f"{field}[0]"
    assert refusals(judged, tmp_path, GOOD, [(number, value) for value in SIZES]) == len(SIZES)


@pytest.mark.parametrize("field", WORDS)
def test_words(judged, tmp_path, field):
    wrong = NO_WORDS if field != "title" else tuple(v for v in NO_WORDS if v not in ('"a/b"', "''"))
    assert refusals(judged, tmp_path, GOOD, [(field, value) for value in wrong]) == len(wrong)


@pytest.mark.parametrize("field", ["profile.b", "profile.R", "load.P", "material.E", "friction.f"])
def test_a_flat(judged, tmp_path, field):
    """Of any size, with pressure from next to none to a contact all but as wide as the flat."""
    long = ("profile.R", "1e-12"), ("profile.b", "1")  # these work, but take long
    sizes = [value for value in SIZES if (field, value) not in long]
    refusals(judged, tmp_path, FLAT, [(field, value) for value in sizes])


@pytest.mark.parametrize("field", ["profile.x", "profile.gap"])
def test_tables(judged, tmp_path, field):
    settings = [(field, value) for value in (*NO_LISTS, *TABLES)]
    assert refusals(judged, tmp_path, TABULATED, settings) >= len(settings) - 2
