"""Regenerate the page on the convergence of fatigue criteria: python docs/fatigue.py [DIR] (default: docs) writes
fatigue.md and fatigue/*.svg."""

import sys
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import partialslip
from partialslip.result import Result
from partialslip.scene import Scene
from partialslip.study.fatigue import edges, fatemi_socie, smith_watson_topper, with_zz
from partialslip.tools.arrays import Array
from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DOCS = Path(__file__).parent
SIZES = (0.1, 0.05, 0.025, 0.01, 0.005, 0.0025)  # of elements along the contact, in a
ORDERS = {1: "linear", 2: "quadratic"}
DISTANCE = 50e-6  # m
NEAR = 0.5  # half-widths from the end within which the largest value is sought
QUANTITIES = ("sigma_xx", "SWT", "FS", "SWT, averaged", "FS, averaged")
_SIDES = ("elements", "recovered")
_LOADS = np.array([0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99])
_STYLES = (("-", "o", "black"), ("-", "s", "black"), ("-", "^", "black"), ("--", "s", "0.5"), ("--", "^", "0.5"))

_PAGE = """\
# How fatigue criteria converge

The tension at the trailing edge falls like the square root of the distance from the edge, so finite elements approach
the peak slowly. Here the exact values are known. `python docs/fatigue.py` makes this page.

The problem is `fretting-aluminium` (a cylindrical pad, f = 0.3, fully reversed Q and bulk tension). The criteria are
Smith-Watson-Topper (SWT) and Fatemi-Socie (FS) with k = 1 and sigma_y = 330 MPa, also averaged over a half disc of 50
um, {share:.2f} a, around the edge.

| quantity | exact |
|---|---|
{exact}

## In the elements

Relative error of the largest value at the centroids of the triangles, and of the average by area over the triangles
whose centroid is in the half disc. The size is `fem.size`; linear elements are half as long, so that both have about as
many nodes.

{elements}

![Relative errors over the element size, linear elements on the left, quadratic ones on the right](fatigue/elements.svg)

{said}

## Recovered

`result.stress_at` integrates the tractions in the contact instead. Relative error at x = a on the surface, and of the
averages, on the same meshes:

{recovered}

## Slip zones from asymptotes

The slip zone predicted by [asymptotes](howto/fatigue.md), K_T/(f K_N), and the exact one: under Q alone, `hertz-shear`,
and under Q and a tension in proportion, `hertz-small-tension`, at the edge where both add up. Under Q alone the
prediction is 2.5 % too short at a tenth of the sliding load and {half:.0f} % at half of it. In the limit it is half of
the exact length.

![Predicted and exact length of the slip zone over the load](fatigue/slip-zones.svg)
"""


def main(folder: Path) -> None:
    """Write the page and its figures into ``folder``."""
    (folder / "fatigue").mkdir(parents=True, exist_ok=True)
    scene = problem()
    exact = exact_values(scene)
    errors = {order: [measured(scene, order, size, exact) for size in SIZES] for order in ORDERS}
    zones = {name: slip_zones(name) for name in ("hertz-shear", "hertz-small-tension")}
    (folder / "fatigue" / "elements.svg").write_text(convergence_svg(errors), "utf-8")
    (folder / "fatigue" / "slip-zones.svg").write_text(zones_svg(zones), "utf-8")
    (folder / "fatigue.md").write_text(page(exact, errors, zones), "utf-8")


def problem() -> Scene:
    """The scene with the constants of the criteria."""
    constants = {"k_fatemi_socie": 1.0, "sigma_y": 330e6, "distance": DISTANCE}
    return partialslip.load_scene("fretting-aluminium").replace(fatigue=constants)


def values(scene: Scene, path: Array) -> Array:
    """Largest sigma_xx (Pa), SWT (Pa) and FS, (3, ...), of stress paths (s, 3, ...)."""
    material, constants = scene.material, scene.fatigue
    assert material.E
    assert material.nu
    stress = with_zz(path, material.nu)
    swt = smith_watson_topper(stress, material.E, material.nu).value
    k, sigma_y = constants.k_fatemi_socie or 0.0, constants.sigma_y or 1.0
    fs = fatemi_socie(stress, material.E, material.nu, k, sigma_y).value
    return np.stack([path[:, 0].max(axis=0), swt, fs])


def exact_values(scene: Scene) -> Array:
    """Exact values of the QUANTITIES."""
    return recovered(scene, partialslip.run(scene, "exact", subsurface=True)["exact"])


def recovered(scene: Scene, result: Result) -> Array:
    """The QUANTITIES by ``result.stress_at``."""
    assert result.stress_at
    found = partialslip.assess(scene, result, ["swt", "fatemi-socie"])
    at_end = values(scene, result.stress_at(result.a, 0.0))
    return np.array([*at_end, *(each.averages["area"].value for each in found.ratings.values())])


def in_elements(scene: Scene, result: Result, a: float) -> Array:
    """The QUANTITIES by the stresses at the centroids of the elements, around the exact end of the contact, x = a."""
    body = next(each for each in result.bodies if each.name == "lower" or len(result.bodies) == 1)
    corners = body.points[body.triangles]
    centre = corners.mean(axis=1) - [a, 0.0]
    near = np.hypot(*centre.T) < NEAR * a
    edges_of = np.diff(corners[near], axis=1)
    area = np.abs(edges_of[:, 0, 0] * edges_of[:, 1, 1] - edges_of[:, 0, 1] * edges_of[:, 1, 0]) / 2
    path = np.stack([stress[near].T for stress in body.stresses.values()])
    inside = np.hypot(*centre[near].T) < DISTANCE
    average = (path[:, :, inside] @ area[inside]) / area[inside].sum()
    return np.array([*values(scene, path).max(axis=1), *values(scene, average)[1:]])


def measured(scene: Scene, order: int, size: float, exact: Array) -> tuple[Array, Array]:
    """Relative errors of the QUANTITIES on a mesh: in the elements, and recovered."""
    on_mesh = scene.replace(fem={"order": order, "size": size})
    result = partialslip.run(on_mesh, "fem", subsurface=True)["fem"]
    a = partialslip.run(scene, "exact")["exact"].a
    return in_elements(scene, result, a) / exact - 1, recovered(scene, result) / exact - 1


def slip_zones(name: str) -> Array:
    """Predicted and exact length of the slip zone at x = a, in a, over the load, (2, k)."""
    scene, found = partialslip.load_scene(name), []
    for share in _LOADS:
        factor = share * scene.friction.f * scene.P / scene.load.Q[1]
        loads = {key: [factor * each for each in getattr(scene.load, key)] for key in ("Q", "sigma")}
        loaded = scene.replace(load=loads)
        result = partialslip.run(loaded, "exact")["exact"]
        edge = edges(loaded, result)[1]
        found.append((edge.predicted / result.a, edge.found / result.a))
    return np.array(found).T


def convergence_svg(errors: dict[int, list[tuple[Array, Array]]]) -> str:
    """Figure of the errors in the elements over the element size."""

    def draw(figure: "Figure") -> None:
        panels = figure.subplots(1, 2, sharey=True)
        for axes, (order, rows) in zip(panels, errors.items(), strict=True):
            found = np.abs([elements for elements, _ in rows])
            for name, error, (line, mark, color) in zip(QUANTITIES, found.T, cycle(_STYLES)):
                axes.loglog(SIZES, error, line, marker=mark, ms=4, mfc="white", color=color, lw=1.1, label=name)
            h = np.array([SIZES[0], SIZES[-1]])
            axes.loglog(h, 0.9 * (h / h[0]) ** 0.5, ":", color="0.4", lw=0.9, label="square root of the size")
            axes.set(xlabel="fem.size (in a)", title=f"{ORDERS[order]} elements")
            axes.grid(color="0.92", lw=0.6)
        panels[0].set_ylabel("relative error")
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=3, frameon=False,
                      fontsize=9)  # fmt: skip

    return svg(draw, (7.6, 4.2))


def zones_svg(zones: dict[str, Array]) -> str:
    """Figure of the slip zones over the load."""

    def draw(figure: "Figure") -> None:
        axes = figure.subplots()
        for (name, (predicted, found)), color in zip(zones.items(), ("black", "0.5"), strict=True):
            known = np.isfinite(found)
            axes.plot(_LOADS[known], found[known], "-", color=color, lw=1.3, label=f"{name}, exact")
            axes.plot(_LOADS, predicted, "--", color=color, lw=1.1, label=f"{name}, asymptotes")
        axes.set(xlabel="largest Q/(f P)", ylabel="slip zone/a at x = a", xlim=(0, 1), ylim=(0, 2))
        axes.legend(frameon=False, fontsize=9)

    return svg(draw, (5.2, 3.6))


def table(errors: dict[int, list[tuple[Array, Array]]], side: int) -> str:
    """Relative errors as a Markdown table: in the elements (``side`` 0) or recovered (1)."""
    lines = ["| elements | size/a | " + " | ".join(QUANTITIES) + " |", "|---" * (len(QUANTITIES) + 2) + "|"]
    for order, rows in errors.items():
        for size, row in zip(SIZES, rows, strict=True):
            cells = (f"{error:+.1e}" for error in row[side])
            lines.append(f"| {ORDERS[order]} | {size} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def page(exact: Array, errors: dict[int, list[tuple[Array, Array]]], zones: dict[str, Array]) -> str:
    """Content of the page."""
    a = partialslip.run(problem(), "exact")["exact"].a
    units = ("MPa", "MPa", "", "MPa", "")
    lines = [
        f"| {name} | {value / (1e6 if unit else 1):.6g} {unit} |".replace(" |", " |")
        for name, value, unit in zip(QUANTITIES, exact, units, strict=True)
    ]
    finest = {order: rows[-1][0] for order, rows in errors.items()}
    said = (
        f"At the finest size, {SIZES[-1]} a, the largest sigma_xx is still {abs(finest[1][0]):.0%} off with linear "
        f"elements and {abs(finest[2][0]):.0%} with quadratic ones, SWT {abs(finest[1][1]):.0%} and "
        f"{abs(finest[2][1]):.0%}. The averages are within {max(abs(each[3:]).max() for each in finest.values()):.1%}."
    )
    predicted, found = zones["hertz-shear"]
    at_half = list(_LOADS).index(0.5)
    return _PAGE.format(
        share=DISTANCE / a,
        exact="\n".join(line.replace("  |", " |") for line in lines),
        elements=table(errors, 0),
        recovered=table(errors, 1),
        said="\n".join(_wrapped(said)),
        half=100 * (1 - predicted[at_half] / found[at_half]),
    )


def _wrapped(text: str) -> list[str]:
    import textwrap

    return textwrap.wrap(text, 120)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else DOCS)
