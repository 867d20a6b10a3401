"""Seals: a checksum of the content of a JSON file under its last key, which tells whether the file was edited.

The checksum is of the data, not of the text: keys in another order, other white space and 100000 in place of 1e5 change
nothing. It guards against accidents. Whoever wants to forge a file can make the checksum anew.
"""

import hashlib
import json
from typing import Any, TypeVar

import msgspec

from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import Name, read_bytes
from partialslip.tools.output.files import json_text
from partialslip.tools.strictjson import converted, parsed

KEY = "sum"
_Kind = TypeVar("_Kind")


class _Schema(msgspec.Struct):
    schema: str = ""


def sealed_text(data: object) -> str:
    """Return ``data``, of a type known to msgspec, as indented JSON text with its checksum as the last key."""
    text = json_text(data)
    body = text.rstrip().removesuffix("}").rstrip()
    return f'{body},\n "{KEY}": "{_checksum(text)}"\n}}\n'


def read_sealed(
    path: Name, most: int, kind: type[_Kind], schema: str, what: str, again: str
) -> tuple[_Kind, bool | None]:
    """Read a JSON file of one ``schema``, and whether it was edited since it was sealed; None if it has no seal.

    Parameters
    ----------
    path : str or path
    most : int
        Largest size, bytes.
    kind : type
        Type of msgspec of the content.
    schema : str
        The value that the key ``schema`` must have.
    what, again : str
        For messages: what the file must be, and how one of this schema is made.

    Raises
    ------
    InputError
        If the file cannot be read, is no strict JSON, or has another schema or other content.
    """
    text, told = read_bytes(path, most), f"{path}: {what}"
    tree = parsed(text, told)
    found = converted(tree, _Schema, told).schema
    if found != schema:
        raise InputError(f"{path}: schema = {found!r}: must be {schema!r}; {again}")
    changed = edited(text, tree)
    return converted(tree, kind, told), changed


def edited(text: bytes | str, tree: dict[str, Any]) -> bool | None:
    """Return whether the JSON ``text`` was changed since it was sealed; None if it has no seal.

    The seal is removed from ``tree``, the content of the text as plain data.
    """
    found = tree.pop(KEY, None)
    return None if found is None else found != _checksum(text)


def _checksum(text: bytes | str) -> str:
    """Return the checksum of a JSON object without its seal; whole numbers count as the floats that they equal."""
    data = json.loads(text, parse_int=float)
    data.pop(KEY, None)
    return hashlib.sha256(json.dumps(data, sort_keys=True).encode()).hexdigest()[:16]
