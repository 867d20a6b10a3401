"""Writing scenes as tables and as TOML."""

from collections.abc import Collection, Mapping
from typing import Any

import msgspec
import tomli_w

from partialslip.scene import Scene
from partialslip.scene.dimensions import with_units
from partialslip.scene.units import SI


def scene_tables(scene: Scene) -> dict[str, Any]:
    """Return ``scene`` as the tables of a scene file in the units in which it is shown; None for keys not set.

    :func:`partialslip.parse_scene` makes the scene from these tables again.
    """
    tables, units = msgspec.to_builtins(scene), scene.units
    del tables["shown_in"]
    return {"units": units.name} | (tables if units == SI else with_units(tables, units.from_si))


def scene_toml(scene: Scene, without: Collection[str] = ()) -> str:
    """Text of a scene file for ``scene``, in the units in which it is shown: :func:`set_tables`."""
    return tomli_w.dumps(set_tables(scene, without))


def set_tables(scene: Scene, without: Collection[str] = ()) -> dict[str, Any]:
    """Return :func:`scene_tables` with all settings that are not None; ``without`` some tables."""
    return _set({key: table for key, table in scene_tables(scene).items() if key not in without})


def _set(table: Mapping[str, Any]) -> dict[str, Any]:
    """``table`` without None, which TOML lacks, and without empty tables."""
    known = {key: _set(value) if isinstance(value, dict) else value for key, value in table.items()}
    return {key: value for key, value in known.items() if value is not None and value != {}}
