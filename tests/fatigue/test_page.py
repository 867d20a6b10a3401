"""The page on the convergence of the criteria shows what its script makes today."""

import re
import runpy
from pathlib import Path

import numpy as np
import pytest

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "fatigue.md").read_text("utf-8")
SCRIPT = runpy.run_path(str(DOCS / "fatigue.py"))
NUMBER = r"[-+]?\d+\.\d+e[-+]\d+"
ROW = re.compile(rf"^\| (linear|quadratic) \| (\S+) \| ({NUMBER}(?: \| {NUMBER})+) \|$", re.MULTILINE)
FOUND = {}
for elements, size, cells in ROW.findall(PAGE):  # first in the elements, then recovered
    FOUND.setdefault((elements, float(size)), []).append([float(cell) for cell in cells.split(" | ")])


def test_the_exact_values_are_todays():
    scene = SCRIPT["problem"]()
    exact = SCRIPT["exact_values"](scene)
    shown = [float(value) for value in re.findall(r"^\| (?:sigma|SWT|FS)[^|]*\| ([\d.]+)", PAGE, re.MULTILINE)]
    assert exact / [1e6, 1e6, 1, 1e6, 1] == pytest.approx(shown, rel=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize(("order", "elements"), [(1, "linear"), (2, "quadratic")])
def test_the_errors_are_todays(order, elements):
    """Meshes differ a little from version to version of gmsh: to a fifth of an error at the surface."""
    scene = SCRIPT["problem"]()
    errors = SCRIPT["measured"](scene, order, 0.05, SCRIPT["exact_values"](scene))
    for now, shown in zip(errors, FOUND[elements, 0.05], strict=True):
        assert now[:3] == pytest.approx(shown[:3], rel=0.2)


def test_peaks_in_elements_converge_like_the_square_root():
    """As the stress falls like the square root of the distance from the edge."""
    for elements in ("linear", "quadratic"):
        rows = {size: FOUND[elements, size][0] for each, size in FOUND if each == elements}
        sizes = sorted(rows)
        assert sizes == sorted(SCRIPT["SIZES"])
        for quantity in range(3):
            errors = [abs(rows[size][quantity]) for size in sizes]
            rate = np.polyfit(np.log(sizes), np.log(errors), 1)[0]
            assert rate == pytest.approx(0.5, abs=0.06)


def test_the_words_are_the_scripts():
    words = [part.strip() for part in re.split(r"\{[^}]*\}", SCRIPT["_PAGE"])]
    assert all(part in PAGE for part in words)
