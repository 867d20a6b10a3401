"""Writing scene files: a scene in, TOML out."""

from collections.abc import Mapping
from typing import Any

import msgspec
import tomli_w

from partialslip.scene import Scene


def scene_toml(scene: Scene) -> str:
    """A scene as the text of a scene file, every setting that it has written out."""
    return tomli_w.dumps(_set(msgspec.to_builtins(scene)))


def _set(table: Mapping[str, Any]) -> dict[str, Any]:
    """Without what is None, which TOML does not know, and without empty tables."""
    known = {key: _set(value) if isinstance(value, dict) else value for key, value in table.items()}
    return {key: value for key, value in known.items() if value is not None and value != {}}
