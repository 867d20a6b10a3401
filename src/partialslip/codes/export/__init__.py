"""Export a scene as a model for other codes."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from partialslip.codes.export.aster import aster_files
from partialslip.codes.export.inp import abaqus_deck, calculix_deck
from partialslip.codes.export.model import GROWTH, SIZE, modelled
from partialslip.codes.export.moose import moose_files
from partialslip.codes.export.named_boundaries import UNTESTED
from partialslip.scene.reading import AnyScene, as_scene
from partialslip.tools.errors import InputError
from partialslip.tools.output.files import zipped

# Decks of several files, which nobody of the project has run
UNTESTED_DECKS = {"moose": moose_files, "code-aster": aster_files}
# Suffix of the file by format.
FORMATS = {"calculix": ".inp", "abaqus": ".inp", "gmsh": ".msh"} | dict.fromkeys(UNTESTED_DECKS, f"-{UNTESTED}.zip")


def export(
    scene: AnyScene,
    to: str,
    *,
    size: float = SIZE,
    width: float | None = None,
    growth: float = GROWTH,
    stiffer: float = 1.0,
    ends: Sequence[float] = (),
    fine: float | None = None,
    penalty: bool = False,
) -> Callable[[Path], None]:
    """Return a function that writes ``scene`` to a path, for another code.

    The file has the meshes of both bodies; for calculix and abaqus also contact and load steps. For moose and
    code-aster it is an archive of the files of a deck. This project has run decks for CalculiX alone. The file is
    in the scene's units (:attr:`Scene.shown_in`); for calculix the unit of length may be smaller, as its comments say.

    Parameters
    ----------
    scene : Scene, str or path
        A scene, the name of a shipped one, or the path of a scene file.
        With an even gap.
    to : str
        "calculix", "abaqus", "gmsh", "moose" or "code-aster".
    size, width, growth, stiffer, ends, fine
        As for :func:`partialslip.codes.export.model.modelled`.
    penalty : bool
        Whether contact in CalculiX uses surface-to-surface penalties instead of mortar elements.

    Raises
    ------
    InputError
        If ``to`` is not a format, or the scene cannot be exported.
    MissingLibraryError
        If gmsh, or a system library that gmsh needs, is missing.
    """
    scene = as_scene(scene)
    if to not in FORMATS:
        raise InputError(f"export to {to!r}: must be one of {', '.join(FORMATS)}")
    if penalty and to != "calculix":
        raise InputError(f"penalty: must be false for {to}; only calculix has it")
    made = modelled(scene, size, width, growth, stiffer, ends, fine)
    if to == "gmsh":
        from partialslip_meshes.write import write_quads

        return partial(write_quads, bodies={part.name: part.mesh for part in made.in_units(scene.units).parts})
    if to in UNTESTED_DECKS:
        archive = zipped(UNTESTED_DECKS[to](scene, made, f"{scene.name}-{UNTESTED}"))
        return lambda path: _write(path, archive)
    lines = (
        abaqus_deck(scene, made) if to == "abaqus" else calculix_deck(scene, made, "penalty" if penalty else "mortar")
    )
    deck = ("\n".join(lines) + "\n").encode("ascii")
    return lambda path: _write(path, deck)


def _write(path: Path, content: bytes) -> None:
    path.write_bytes(content)
