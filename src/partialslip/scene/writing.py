"""Writing scenes as TOML."""

from collections.abc import Mapping
from typing import Any

import msgspec
import tomli_w

from partialslip.scene import Scene


def scene_toml(scene: Scene) -> str:
    """Text of a scene file for ``scene``, with all settings that are not None."""
    return tomli_w.dumps(_set(msgspec.to_builtins(scene)))


def _set(table: Mapping[str, Any]) -> dict[str, Any]:
    """``table`` without None, which TOML lacks, and without empty tables."""
    known = {key: _set(value) if isinstance(value, dict) else value for key, value in table.items()}
    return {key: value for key, value in known.items() if value is not None and value != {}}
