"""Rigs as JSON files, sealed with a checksum (:mod:`partialslip.tools.seal`)."""

import os
from pathlib import Path
from typing import Annotated

import msgspec
import numpy as np

from partialslip.result.rig.rig import Rig, Terms, key_of
from partialslip.scene import Scene
from partialslip.tools.errors import InputError
from partialslip.tools.output.files import write_texts
from partialslip.tools.seal import read_sealed, sealed_text

RIG_SCHEMA = "partialslip/rig/2"
_LARGEST = 2**20  # limit: bytes
_MOST = 64  # limit: terms
_Row = Annotated[list[float], msgspec.Meta(min_length=2, max_length=_MOST)]
_Rows = Annotated[list[_Row], msgspec.Meta(min_length=2, max_length=_MOST)]


class _Terms(msgspec.Struct, forbid_unknown_fields=True):
    xx: _Rows
    yy: _Rows
    xy: _Rows
    pulled: _Rows
    lower_xx: _Rows
    lower_yy: _Rows
    lower_xy: _Rows


class _File(msgspec.Struct, forbid_unknown_fields=True, omit_defaults=True):
    schema: str
    key: str
    reach: Annotated[float, msgspec.Meta(gt=0)]
    terms: _Terms
    rough: _Terms
    edited: bool = False  # whether the rig was read from an edited file


def write_rig(rig: Rig, path: str | os.PathLike[str]) -> None:
    """Write ``rig`` to a file at ``path``; a file that is there is replaced.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    terms, rough = (_Terms(*(each.tolist() for each in terms)) for terms in (rig.terms, rig.rough))
    data = _File(RIG_SCHEMA, rig.key, rig.reach, terms, rough, rig.edited)
    write_texts(Path(path).parent, {Path(path).name: sealed_text(data)})


def load_rig(path: str | os.PathLike[str], scene: Scene | None = None) -> Rig:
    """Read a rig from ``path``. If the file was edited since partialslip wrote it, :attr:`Rig.edited` is True, and
    results with the rig have a note.

    Parameters
    ----------
    path : str or path
    scene : Scene, optional
        A scene whose bodies the rig must have.

    Raises
    ------
    InputError
        If the file cannot be read or is not a rig, or is that of other bodies than those of ``scene``.
    """
    found, changed = read_sealed(path, _LARGEST, _File, RIG_SCHEMA, "not a rig", "partialslip equivalent makes it")
    count = len(found.terms.xx)
    terms, rough = (_arrays(f"{path}: {name}", getattr(found, name), count) for name in ("terms", "rough"))
    if scene and found.key != key_of(scene):
        raise InputError(
            f"{path}: this rig has other bodies, supports or materials than {scene.name}; "
            "must be made from them: partialslip equivalent"
        )
    return Rig(found.key, found.reach, terms, rough, bool(changed) or found.edited)


def _arrays(name: str, found: _Terms, count: int) -> Terms:
    shapes = dict.fromkeys(("xx", "yy", "xy", "lower_xx", "lower_yy", "lower_xy"), (count, count)) | {
        "pulled": (2, count)
    }
    arrays = {}
    for key, shape in shapes.items():
        rows = getattr(found, key)
        if len(rows) != shape[0] or any(len(row) != shape[1] for row in rows):
            raise InputError(f"{name}.{key}: must have {shape[0]} rows of {shape[1]} numbers")
        arrays[key] = np.array(rows)
        if key in ("xx", "yy", "lower_xx", "lower_yy") and not np.array_equal(arrays[key], arrays[key].T):
            raise InputError(f"{name}.{key}: must be symmetric")
    return Terms(**arrays)
