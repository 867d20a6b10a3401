"""Figures of an assessment: labels of contours, and polar plots."""

import re

import pytest
from matplotlib.figure import Figure

import partialslip
from partialslip.study.fatigue import assess
from partialslip.study.fatigue import figure as figures

MINUS = "\N{MINUS SIGN}"


@pytest.fixture(scope="module")
def scene():
    return partialslip.load_scene("fretting-aluminium")


@pytest.fixture(scope="module")
def result(scene):
    return partialslip.run(scene, "exact", subsurface=True)["exact"]


@pytest.fixture
def sheet_of(monkeypatch):
    """Draws a figure of this module on a sheet of its size."""

    def drawn(figure_of, found):
        sheets = []

        def draw_on(draw, size):
            sheets.append(Figure(figsize=size, layout="constrained"))
            finish = draw(sheets[0])
            sheets[0].draw_without_rendering()
            if finish:
                finish()
            return ""

        monkeypatch.setattr(figures, "svg", draw_on)
        figure_of(found)
        return sheets[0]

    return drawn


def test_labels_of_contours_keep_off_the_contact_and_keep_their_sign(scene, result, sheet_of):
    """A label on the contact line, or with a minus that is a dash of its line, cannot be read."""
    sheet = sheet_of(figures.stress_svg, assess(scene, result, ["swt"]))
    labels = [(axes, text) for axes in sheet.axes for text in axes.texts]
    assert len(labels) > 25  # every second contour has one
    for axes, text in labels:
        _, y = axes.transData.inverted().transform(axes.transAxes.transform(text.get_position()))
        assert abs(y) > 0.1
        assert re.fullmatch(rf"{MINUS}?[\d.]+", text.get_text())
        assert text.get_bbox_patch() is not None
    assert any(text.get_text().startswith(MINUS) for _, text in labels)
