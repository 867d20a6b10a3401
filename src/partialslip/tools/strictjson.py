"""Strict JSON: the one reader of JSON files. Whatever is ambiguous is refused, with a message of one line.

Refused are text that is not UTF-8, a key that stands twice in an object, NaN and Infinity, numbers that double
precision cannot hold (infinite, or lost to zero), whole numbers of more than 19 digits, unpaired surrogates, nesting
that is too deep, and values of another type: text is no number.
"""

import json
import math
import re
from collections.abc import Mapping
from typing import Any, NoReturn, TypeVar

import msgspec

from partialslip.tools.errors import InputError

_Kind = TypeVar("_Kind")
_DIGITS = 19  # fixed: of the largest whole numbers of 64 bits
JSON_KINDS = {
    "object": "an object",
    "array": "an array",
    "float": "a number",
    "int": "a whole number",
    "str": "a string",
    "bool": "true or false",
    "date": "a date",
    "time": "a time",
    "datetime": "a date and time",
}  #: Types of msgspec in plain words.
_SURROGATE = re.compile(r"\\u[dD][89a-fA-F]")


def decoded(text: bytes | str, kind: type[_Kind], told: str) -> _Kind:
    """Return the JSON ``text`` as an object of the type ``kind``.

    Parameters
    ----------
    text : bytes or str
    kind : type
        A type of msgspec.
    told : str
        Begin of messages: the file, and what it must be.

    Raises
    ------
    InputError
        If the text is no strict JSON, or other data than ``kind``.
    """
    return converted(parsed(text, told), kind, told)


def parsed(text: bytes | str, told: str) -> Any:
    """Return the JSON ``text`` as dicts, lists, strings, numbers and None. Parameters and errors as for
    :func:`decoded`."""
    try:
        words = text if isinstance(text, str) else text.decode("utf-8-sig")
        tree = json.loads(
            words, object_pairs_hook=_object, parse_float=_finite_float, parse_int=_whole, parse_constant=_constant
        )
        if _SURROGATE.search(words):
            json.dumps(tree, ensure_ascii=False).encode("utf-8")
    except InputError as error:
        raise InputError(f"{told}: {error}") from None
    except UnicodeDecodeError as error:
        raise InputError(f"{told}: not UTF-8 text (byte {error.start})") from None
    except UnicodeEncodeError:
        raise InputError(f"{told}: an unpaired surrogate, which is no character") from None
    except RecursionError:
        raise InputError(f"{told}: nested too deep") from None
    except ValueError as error:
        raise InputError(f"{told}: not JSON: {error}") from None
    return tree


def converted(tree: Any, kind: type[_Kind], told: str) -> _Kind:
    """Return plain data, ``tree``, as an object of the type ``kind``. Parameters and errors as for :func:`decoded`."""
    try:
        return msgspec.convert(tree, kind)
    except msgspec.ValidationError as error:
        said = error.__cause__ if isinstance(error.__cause__, InputError) else _said(str(error))
        raise InputError(f"{told}: {said}") from None


def _said(message: str) -> str:
    """What is wrong where, from the ``message`` of msgspec."""
    what, _, where = message.partition(" - at `$")
    path = where.rstrip("`").removeprefix(".")
    if field := re.fullmatch(r"(?s)Object (missing required|contains unknown) field `(.*)`", what):
        key = f"{path}.{_shortened(field[2])}" if path else _shortened(field[2])
        return f"{key}: {'missing' if field[1].startswith('missing') else 'unknown key'}"
    place = f"{_shortened(path)}: " if path else ""
    return f"{place}must be {wanted(what) or what.replace('`', '').removeprefix('Expected ')}"


def wanted(what: str, kinds: Mapping[str, str] = JSON_KINDS) -> str | None:
    """Type or bound that a value must have, in plain words, from msgspec's message ``what``; ``kinds`` are the words of
    its types. None for any other message."""
    if wrong := re.fullmatch(r"Expected `([a-z]+(?: \| [a-z]+)*)`, got `(?:datetime\.)?([a-z]+)`", what):
        types = [kinds.get(kind, kind) for kind in wrong[1].split(" | ") if kind != "null"]
        return f"{' or '.join(types)}, not {kinds.get(wrong[2], wrong[2])}"
    bound = re.fullmatch(r"Expected `(?:float|int)(?: \| (?:null|str))*` (.*)", what)
    return bound[1] if bound else None


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for place, key in enumerate(keys) if key in keys[:place])
        raise InputError(f"{_shortened(twice)}: a key that stands twice in an object: must stand once")
    return found


def _finite_float(text: str) -> float:
    value = float(text)
    if math.isinf(value) or (value == 0 and re.search("[1-9]", re.split("[eE]", text)[0])):
        raise InputError(f"{_shortened(text)}: a number out of the range of double precision")
    return value


def _whole(text: str) -> int:
    if len(text.lstrip("-")) > _DIGITS:
        raise InputError(f"{_shortened(text)}: a whole number of more than {_DIGITS} digits")
    return int(text)


def _constant(text: str) -> NoReturn:
    raise InputError(f"{text}: must be a number, or null without a value")


def _shortened(text: str) -> str:
    return text if len(text) <= 40 else text[:37] + "..."
