"""A problem as plain files for any code: meshes of both bodies in four formats, loads and supports, and decks."""

import importlib.util
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from partialslip.codes.export import UNTESTED_DECKS
from partialslip.codes.export.inp import abaqus_deck, calculix_deck
from partialslip.codes.export.model import Model, modelled
from partialslip.codes.export.named_boundaries import UNTESTED
from partialslip.scene import Scene
from partialslip.tools.errors import InputError
from partialslip.tools.output.files import json_text
from partialslip.verify.benchmark.increments import gradual
from partialslip.verify.benchmark.problem import Problem

_FORMATS = (".msh", ".inp", ".vtu")
_WITH_H5PY = (".med",)
GROWTH = 0.2  # accuracy: growth of the elements of the meshes
STIFFER = 100.0  # accuracy: decks: half-planes neglect the slopes of the surfaces; those of such bodies are a hundredth


def files(problem: Problem) -> dict[str, bytes]:
    """Files of ``problem`` by name.

    ``model.json``: bodies, supports and load steps in SI units. ``lower`` and ``upper`` with .msh, .inp, .med (if h5py
    is installed) and .vtu: a body's mesh of quadrilaterals, in m, with the groups contact, face, back, left, right
    and, if there is a holder, flanks. ``calculix-mortar.inp`` and ``calculix-penalty.inp``: decks that this project
    has run. ``abaqus-untested.inp``, ``moose-untested`` (.i, .msh) and
    ``code_aster-untested`` (.comm, .mail, .export): decks that nobody of this project has run, where they carry the
    loads. None where the problem cannot be exported.
    """
    scene = gradual(problem.scene)
    try:
        made = modelled(scene, growth=GROWTH)
        flat = modelled(scene, growth=GROWTH, stiffer=STIFFER)
    except InputError:
        return {}
    reading = f"partialslip benchmark read {problem.number} JOB.frd -o FOLDER"
    decks = {
        "calculix-mortar.inp": calculix_deck(scene, flat, "mortar", reading),
        "calculix-penalty.inp": calculix_deck(scene, flat, "penalty", reading),
        f"abaqus-{UNTESTED}.inp": abaqus_deck(scene, flat),
    }
    texts = {"model.json": json_text(_told(made))} | {name: "\n".join(deck) + "\n" for name, deck in decks.items()}
    return {name: text.encode() for name, text in texts.items()} | _untested(scene, flat) | _meshes(made)


def _untested(scene: Scene, flat: Model) -> dict[str, bytes]:
    """Decks for codes that this project has never run; none for a code that cannot carry the loads."""
    found: dict[str, bytes] = {}
    for name, deck in UNTESTED_DECKS.items():
        with suppress(InputError):
            found |= deck(scene, flat, f"{name.replace('-', '_')}-{UNTESTED}")
    return found


def _told(made: Model) -> dict[str, Any]:
    """Content of ``model.json``."""
    bodies = {
        part.name: {
            "E": part.E,
            "nu": part.nu,
            "held_along_x": part.held[0],
            "held_along_y": part.held[1],
            "pulled": part.pulled,
        }
        for part in made.parts
    }
    lower = made.parts[0]
    turns = " and turns" if made.turns else " and does not turn"
    pulled = "sigma is a traction along x on its right side; its held lines do not move"
    uniform = (
        "sigma moves its held lines by u = sigma (strains[0] x, strains[1] y), along the held directions, and is a "
        "traction along x on sides that are free along x"
    )
    return {
        "units": "SI: m, N/m, Pa, N; E and nu are those of plane strain, also where the problem is in plane stress",
        "f": made.f,
        "expected_half_width": float(f"{made.a:.2g}"),  # the half-width is for the code to find
        "element_size": float(f"{made.size:.2g}"),
        "overlap": float(f"{made.overlap:.2g}"),
        "bodies": bodies,
        "lower_body": pulled if lower.pulled else uniform,
        "strains": lower.strained.tolist(),
        "upper_body": f"its held lines are a rigid frame, under P along -y and Q along -x, that moves freely{turns}",
        "guided": "in a guided step the upper body's frame is held along x",
        "increments": "number of equal increments; more are better where the contact grows or slip turns round",
        "steps": [step._asdict() for step in made.steps],
    }


def _meshes(made: Model) -> dict[str, bytes]:
    from partialslip_meshes.write import write_body

    formats = _FORMATS + (_WITH_H5PY if importlib.util.find_spec("h5py") else ())
    found = {}
    with TemporaryDirectory() as folder:
        for part in made.parts:
            for suffix in formats:
                path = Path(folder) / f"{part.name}{suffix}"
                write_body(path, part.mesh)
                found[path.name] = path.read_bytes()
    return found
