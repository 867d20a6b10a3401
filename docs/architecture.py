"""Draw the packages and what they import, for architecture.md: python docs/architecture.py [DIR] (default:
docs/architecture). The picture is made from the imports themselves, so that it shows what is so."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import grimp

from partialslip.tools.output.svg import svg

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ROOTS = ("partialslip", "partialslip_fem", "partialslip_meshes")
# What nearly every package uses; its arrows would hide the others.
EVERYWHERE = frozenset({"tools", "__main__"})
_SIZE = (7.4, 6.2)


def home(module: str) -> str:
    """The package, or the module right in partialslip, that a module belongs to."""
    first, *rest = module.split(".")
    return rest[0] if first == "partialslip" and rest else first


def imports(hidden: frozenset[str] = EVERYWHERE) -> dict[str, set[str]]:
    """What each folder imports at run time, by folder, without those ``hidden``."""
    graph = grimp.build_graph(*ROOTS, exclude_type_checking_imports=True)
    found: dict[str, set[str]] = {}
    for module in graph.modules - {"partialslip"}:
        there = {home(each) for each in graph.find_modules_directly_imported_by(module)}
        found.setdefault(home(module), set()).update(there)
    hidden = hidden | {"partialslip"}
    return {name: there - hidden - {name} for name, there in found.items() if name not in hidden}


def levels(found: dict[str, set[str]]) -> dict[str, int]:
    """The longest way down from each package: 0 where it imports none. A circle of imports raises RecursionError."""

    def level(name: str) -> int:
        return 1 + max((level(below) for below in found[name]), default=-1)

    return {name: level(name) for name in found}


def direct(found: dict[str, set[str]]) -> dict[str, set[str]]:
    """Without the imports that a longer way explains."""

    def below(name: str) -> set[str]:
        return found[name].union(*(below(each) for each in found[name]))

    return {name: there - set().union(*(below(each) for each in there)) for name, there in found.items()}


def _draw(figure: "Figure") -> None:
    axes, found = figure.subplots(), imports()
    rows: dict[int, list[str]] = {}
    for name, level in sorted(levels(found).items()):
        rows.setdefault(level, []).append(name)
    place = {}
    for level in sorted(rows):  # over the middle of what they import, and apart
        middle = {
            name: sum(place[each][0] for each in found[name]) / len(found[name]) if found[name] else 0.0
            for name in rows[level]
        }
        names = sorted(rows[level], key=lambda name: (middle[name], name))
        place |= {name: (number - (len(names) - 1) / 2, level) for number, name in enumerate(names)}
    box = {"boxstyle": "round,pad=0.35", "facecolor": "white", "edgecolor": "black", "lw": 0.8}
    boxes = {
        name: axes.text(x, y, name, ha="center", va="center", size=8, bbox=box).get_bbox_patch()
        for name, (x, y) in place.items()
    }
    for name, there in direct(found).items():
        for each in sorted(there):
            ends = {"patchA": boxes[name], "patchB": boxes[each], "shrinkA": 1, "shrinkB": 1}
            axes.annotate(
                "", place[each], place[name], arrowprops={"arrowstyle": "->", "color": "0.5", "lw": 0.8, **ends}
            )
    widest = max(map(len, rows.values()))
    axes.set(xlim=(-widest / 2, widest / 2), ylim=(-0.6, max(rows) + 0.6))
    axes.axis("off")


def picture() -> str:
    """The picture as SVG."""
    return svg(_draw, _SIZE)


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).with_suffix(""))
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "imports.svg").write_text(picture(), "utf-8")
