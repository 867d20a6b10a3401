"""Regenerate docs/sizes/strips.svg and print fitted exponents: python docs/sizes.py [DIR] (default: docs/sizes).

When a strip is a half-plane: differences of two equal strips, by the exact method, over their height, with finite
elements as markers; one CPU minute.
"""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from scipy.integrate import quad

from partialslip import load_scene, run
from partialslip.tools.arrays import Array
from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LOADS = ("load.Q=[-30e3, 30e3]", "load.sigma=[-60e6, 60e6]", "effects.subsurface=true")
_HEIGHTS = 2.0 ** np.arange(8)  # in a of the half-planes
_MESHED = 2.0 ** np.arange(1, 8, 2)
_FAR = 2  # accuracy: heights, the largest, from which exponents are fitted
_LINES = {"a": "-", "m": "--", "n": "-.", "p_max": ":", "sigma_xx": (0, (6, 1, 1, 1, 1, 1))}


def main(folder: Path) -> None:
    """Write the figure into ``folder``."""
    alone = _measured("exact")
    a, p0 = alone[0], alone[3]
    scales = np.array([a, a, a, p0, p0])
    exact, fem = (
        np.array([(_measured(method, height * a, width) - alone) / scales for height in heights])
        for method, heights, width in (("exact", _HEIGHTS, None), ("fem", _MESHED, 40.0))
    )
    for name, law, near, far in zip(_LINES, _laws(alone), exact[-_FAR], exact[-1], strict=True):
        k = np.log2(near / far) / np.log2(_HEIGHTS[-1] / _HEIGHTS[-_FAR])
        print(f"{name:9} {far * _HEIGHTS[-1] ** round(k):+.5f} (a/h)^{k:.4f}, closed {law:+.5f}")
    (folder / "strips.svg").write_text(svg(lambda figure: _draw(figure, exact, fem), (7.4, 4.4)), "utf-8")


def _measured(method: str, height: float | None = None, width: float | None = None) -> Array:
    """a, m, n, p_max and the largest sigma_xx, SI; of strips with a ``height``, m, and a ``width`` in heights, infinite
    by default."""
    told = width * height if width and height else "'infinite'"
    strip = f"{{height={height}, width={told}, support='roller'}}"
    bodies = [f"bodies.upper={strip}", f"bodies.lower={strip}"] if height else []
    found = run(load_scene("fretting-aluminium", [*_LOADS, *bodies, "fem.accuracy=1e-5"]), method)[method]
    assert found.surface
    return np.array([found.a, found.m, found.n, found.traction.p_max, found.surface.largest[1]])


def _laws(alone: Array) -> list[float]:
    """Closed factors of (a/h)^2, and of a/h for sigma_xx (docs/theory.md, section 13)."""
    scene = load_scene("fretting-aluminium", _LOADS)
    a, m, n = alone[:3]
    e, c = (n - m) / (2 * a), (n + m) / (2 * a)
    integrands: tuple[Callable[[float, float], float], ...] = (
        lambda w, below: w * (1 - (np.cosh(2 * w) - 1) / below),
        lambda w, below: w * (1 - (np.cosh(2 * w) + 1) / below),
        lambda w, below: 4 * w / below,
    )
    I_M, I_N, J = (quad(lambda w, of=of: of(w, np.sinh(2 * w) + 2 * w), 1e-9, 40)[0] for of in integrands)
    Qf = scene.load.dQ / (2 * scene.friction.f * scene.P)
    dc, de = -c * (I_M - I_N * Qf) / 4, -e * (I_M - I_N) / 2
    return [-I_M / 4, dc - de, dc + de, I_M / 4, J / 2]


def _draw(figure: "Figure", exact: Array, fem: Array) -> None:
    axes = figure.subplots()
    for number, (name, style) in enumerate(_LINES.items()):
        label = {"a": "a, in a", "m": "m, in a", "n": "n, in a"}.get(name, f"{name}, in p0")
        axes.loglog(_HEIGHTS, np.abs(exact[:, number]), color="black", lw=1.3, ls=style, label=label)
        axes.loglog(_MESHED, np.abs(fem[:, number]), "o", color="black", mfc="white", ms=4)
    axes.plot([], [], "o", color="black", mfc="white", ms=4, label="fem, W = 40 h")
    axes.set(xlabel="h/a", ylabel="difference from half-planes", xticks=_HEIGHTS)
    axes.set_xticklabels([f"{each:g}" for each in _HEIGHTS])
    axes.minorticks_off()
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else Path(__file__).parent / "sizes")
