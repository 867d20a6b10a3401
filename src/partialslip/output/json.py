"""Plain data as JSON."""

import msgspec


def json_text(data: object) -> str:
    """``data``, of types that msgspec knows, as the indented text of a JSON file; null for numbers that are NaN or
    infinite."""
    return msgspec.json.format(msgspec.json.encode(data), indent=1).decode() + "\n"
