"""Plain data as JSON."""

import msgspec


def json_text(data: object) -> str:
    """Return ``data``, of types known to msgspec, as indented JSON text; null in place of NaN and infinity."""
    return msgspec.json.format(msgspec.json.encode(data), indent=1).decode() + "\n"
