"""Figures as SVG in one common style: black on white, and light on dark where the reader's screen is dark."""

import io
import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_STYLE: dict[Any, Any] = {
    "svg.fonttype": "none",  # text stays text
    "svg.hashsalt": "partialslip",  # equal runs give equal files
    "font.size": 10,
    "font.family": "sans-serif",
    "axes.spines.top": False,
    "axes.spines.right": False,
}
_DARK = "@media screen and (prefers-color-scheme: dark)"
_INK, _PAPER = (0xE6, 0xE6, 0xE6), (0x13, 0x14, 0x16)  # display: black and white on a dark screen, as in style.css
_SHADE = re.compile(r"#([0-9a-f]{2})\1\1\b")


#: Draws on a figure; returns what finishes it where it is laid out and axes have their size, or None.
Draw = Callable[["Figure"], Callable[[], None] | None]


def svg(draw: Draw, size: tuple[float, float] = (7.4, 4.4)) -> str:
    """Return a figure as SVG text, drawn by ``draw(figure)``, of ``size`` (width, height) in inches."""
    from matplotlib import rc_context
    from matplotlib.backends.backend_svg import FigureCanvasSVG
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    with rc_context(_STYLE):
        layout = ConstrainedLayoutEngine()
        figure = Figure(figsize=size, layout=layout)
        finish = draw(figure)
        # laid out here, as savefig would draw everything once more to do so, at the 72 dots per inch of SVG
        FigureCanvasSVG(figure)
        figure.dpi = 72
        layout.execute(figure)
        figure.set_layout_engine("none")
        if finish:
            for axes in figure.axes:
                axes.apply_aspect()
            finish()
        text = io.StringIO()
        figure.savefig(text, format="svg", metadata=dict.fromkeys(("Date", "Creator", "Format", "Type")))
    return with_dark_mode(text.getvalue())


def with_dark_mode(text: str) -> str:
    """Return the SVG ``text`` with a style for dark screens: each shade of grey becomes one between ink and paper.

    The colours themselves stay as they are, because programs other than browsers know no variables and no media.
    """
    shades = sorted({found[0] for found in _SHADE.finditer(text)})
    rules = ["svg { fill: " + _on_dark("#000000") + " }"]
    rules += [
        f'[style*="{key}: {shade}"], [{key}="{shade}"] {{ {key}: {_on_dark(shade)} !important }}'
        for shade in shades
        for key in ("fill", "stroke")
    ]
    style = "\n".join(["<style>", _DARK + " {", *rules, "}", "</style>"])
    start = text.index(">", text.index("<svg")) + 1
    return f"{text[:start]}\n{style}{text[start:]}"


def _on_dark(shade: str) -> str:
    """Return the colour of a shade of grey, #rrggbb, on a dark screen."""
    light = int(shade[1:3], 16) / 255
    return "#" + "".join(f"{round(ink + (paper - ink) * light):02x}" for ink, paper in zip(_INK, _PAPER, strict=True))
