"""Scenes from and to TOML and plain tables."""

import difflib
import math
import os
import re
import tomllib
from collections.abc import Collection, Iterable, Iterator, Mapping
from importlib import resources
from pathlib import Path
from typing import Any, TypeVar, get_args

import msgspec
import tomli_w

from partialslip.scene import LARGEST, SMALLEST, Scene, Table
from partialslip.scene.dimensions import with_units
from partialslip.scene.measured import ProfileFile, tabulated
from partialslip.scene.tolerance import check
from partialslip.scene.units import SI, UNITS, Units
from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import read_text
from partialslip.tools.strictjson import JSON_KINDS, wanted

_LARGEST_FILE = 500_000  # limit: bytes; a profile and a cycle of 1,000 numbers each take 120,000
_LONGEST = 1000  # limit: numbers in an array
_BITS = 8192  # limit: largest whole numbers shown in digits
_DEEPEST = 10  # limit: nested tables and arrays; a scene has three levels
# A dotted key of more than 20 parts: the time of tomllib grows at least like the square of their number.
_DEEP_KEY = re.compile(r"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){20}""", re.ASCII)
_Made = TypeVar("_Made", bound=Table)
_KINDS = JSON_KINDS | {"object": "a table"}


def shipped_scenes() -> dict[str, str]:
    """Titles of the shipped scenes by name, sorted by name."""
    files = resources.files("partialslip.scene") / "shipped"
    texts = {f.name.removesuffix(".toml"): f.read_text("utf-8") for f in files.iterdir() if f.name.endswith(".toml")}
    return {name: tomllib.loads(texts[name]).get("title", "") for name in sorted(texts)}


AnyScene = Scene | str | os.PathLike[str]


def as_scene(scene: AnyScene) -> Scene:
    """Return ``scene``; read it by :func:`load_scene` if it is the name of a shipped scene or the path of a file.

    Raises
    ------
    InputError
        If it is neither, or as :func:`load_scene`.
    """
    if isinstance(scene, Scene):
        return scene
    if isinstance(scene, (str, os.PathLike)):
        return load_scene(scene)
    raise InputError(
        f"scene = {_shown(scene)}: must be a Scene, the name of a shipped scene, or the path of a scene file; "
        "partialslip.parse_scene makes a Scene from tables"
    )


def load_scene(scene: str | os.PathLike[str], overrides: str | Iterable[str] = ()) -> Scene:
    """Read a scene from a file, or a shipped scene by name.

    Parameters
    ----------
    scene : str or Path
        The name of a shipped scene or the path of a TOML file.
    overrides : str or iterable of str
        Settings to change, each as ``"table.key=value"`` with a TOML value, e.g. ``"load.P=2e5"``, in the units of the
        scene file.

    Raises
    ------
    InputError
        With one line that names the field, its value and what is allowed.
    """
    if not isinstance(scene, (str, os.PathLike)):
        raise InputError(f"scene = {_shown(scene)}: must be the name of a shipped scene or the path of a scene file")
    data = parse_toml(_text(scene), str(scene))
    for override in [overrides] if isinstance(overrides, str) else overrides:
        if not isinstance(override, str):
            raise InputError(f"override {_shown(override)}: must be table.key=value, for example load.P=2e5")
        _override(data, override)
    _find_files(data, scene)
    try:
        return parse_scene(data)
    except InputError as error:
        raise InputError(f"{scene}: {error}") from None


def parse_scene(data: Mapping[str, Any]) -> Scene:
    """Make a scene from nested tables ``data``, as in a scene file or in ``results.json``.

    Values may be NumPy numbers and arrays, paths, and tables such as :class:`partialslip.scene.Load`. Numbers are in SI
    units, or in those that the key ``units`` names.

    Raises
    ------
    InputError
        With one line that names the field, its value and what is allowed.
    """
    if not isinstance(data, Mapping):
        raise InputError(f"scene = {_shown(data)}: must be a table")
    return make_table(Scene, data)


def changed(scene: Scene, changes: Mapping[str, Any]) -> Scene:
    """Make a scene from ``scene`` with ``changes`` by key; see :meth:`partialslip.Scene.replace`."""
    if not isinstance(changes, Mapping):
        raise InputError(f"changes = {_shown(changes)}: must be values by dotted key, such as {{'load.P': 2e5}}")
    data = msgspec.to_builtins(scene)
    for key, value in changes.items():
        if not isinstance(key, str):
            raise InputError(f"{_shown(key)}: a key must be a string, such as 'load.P'")
        _put(data, key.split("."), value, key)
    return parse_scene(data)


def _put(data: dict[str, Any], path: list[str], value: Any, key: str) -> None:
    """Set the entry of nested tables at ``path``; a mapping changes the entries of a table."""
    head, *rest = path
    if head == "*" and rest:
        if not (tables := [name for name, table in data.items() if isinstance(table, dict)]):
            raise InputError(f"{key}: the scene has no table in place of *")
        for name in tables:
            _put(data[name], rest, value, key)
    elif rest:
        if not isinstance(data.setdefault(head, {}), dict):
            data[head] = {}
        _put(data[head], rest, value, key)
    elif isinstance(value, Mapping) and isinstance(data.get(head), dict) and not _other_kind(head, value, data[head]):
        for name, entry in value.items():
            _put(data[head], [name], entry, f"{key}.{name}")
    else:
        data[head] = value


def _other_kind(head: str, change: Mapping[str, Any], table: Mapping[str, Any]) -> bool:
    """Whether a ``change`` of the profile makes it one of another kind, which has other keys."""
    return head == "profile" and change.get("kind", table["kind"]) != table["kind"]


def make_table(kind: type[_Made], data: Mapping[str, Any]) -> _Made:
    """Make a table of type ``kind``, a scene or one of its tables, from ``data``; see :func:`parse_scene`."""
    place = _place(kind)
    data = _as_builtins(data, place)
    if kind is not Scene:
        return _made(kind, place, data, data, SI)
    units = _units(data)
    written = {"shown_in": units.name} | {key: value for key, value in data.items() if key != "units"}
    profile = written.get("profile")
    if isinstance(profile, dict) and "file" in profile:
        written["profile"] = _from_file(profile, units)
    made = _made(kind, place, written, written, units)
    # What a scene must be is the same in all units: checked as written, messages show the numbers that the user knows.
    made = made if units == SI else _made(kind, place, with_units(written, units.to_si), written, SI)
    check(made)  # type: ignore[arg-type]
    return made


def _from_file(profile: dict[str, Any], units: Units) -> dict[str, Any]:
    """Keys of a tabulated profile, made from the file that the keys of ``profile`` name."""
    if profile.get("kind") != "tabulated":
        raise InputError(f"profile.kind = {_shown(repr(profile.get('kind')))}: must be 'tabulated' for a profile.file")
    for key in ("x", "gap"):
        if key in profile:
            raise InputError(f"profile.{key}: must not be given together with profile.file")
    own = {key: value for key, value in profile.items() if key in ProfileFile.__struct_fields__}
    try:
        made = tabulated(_made(ProfileFile, "profile", own, own, units), units.size("m"))
    except InputError as error:
        raise InputError(units.relabelled(str(error))) from None
    return {key: value for key, value in profile.items() if key not in own} | made


def _units(data: Mapping[str, Any]) -> Units:
    """Units of the numbers of ``data``."""
    name = data.get("units", SI.name)
    if not (isinstance(name, str) and name in UNITS):
        raise InputError(f"units = {_shown(repr(name))}: must be one of {', '.join(map(repr, UNITS))}")
    return UNITS[name]


def _made(kind: type[_Made], place: str, data: Mapping[str, Any], written: Mapping[str, Any], units: Units) -> _Made:
    """Make a table from the numbers of ``data``, which are in ``units``; messages show the values ``written``."""
    known = dict(_leaves(written, place))
    for path, value in _leaves(data, place):
        if isinstance(value, float) and not math.isfinite(value):
            raise InputError(f"{path} = {value}: must be finite")
        if type(value) in (int, float) and value != 0 and not SMALLEST <= abs(value) <= LARGEST:
            shown, where = _shown(known.get(path, value)), "" if data is written else " in SI units"
            raise InputError(f"{path} = {shown}: must be zero or of a size from {SMALLEST} to {LARGEST}{where}")
    try:
        return msgspec.convert(data, kind)
    except msgspec.ValidationError as error:
        if isinstance(error.__cause__, InputError):
            raise InputError(units.relabelled(str(error.__cause__))) from None
        raise InputError(_explain(str(error), written, kind, place)) from None


def _place(kind: type[Table]) -> str:
    """Name of a table in messages, as in a scene file; empty for the scene itself."""
    if kind is Scene:
        return ""
    return "profile" if kind.__struct_config__.tag_field else kind.__name__.lower()


def _text(scene: str | os.PathLike[str]) -> str:
    path = Path(scene)
    if _is_file(path):
        return read_text(path, _LARGEST_FILE)
    shipped = shipped_scenes()
    if str(scene) in shipped:
        return (resources.files("partialslip.scene") / "shipped" / f"{scene}.toml").read_text("utf-8")
    hint = meant(path.name, [*_scene_files(path.parent), *shipped])
    if path.suffix != ".toml":
        hint = hint or f"; known are {', '.join(shipped)}"
        raise InputError(f"scene {str(scene)!r}: neither a file nor a shipped scene{hint}")
    try:
        return read_text(path, _LARGEST_FILE)
    except InputError as error:
        raise InputError(f"{error}{hint}") from None


def _scene_files(folder: Path) -> list[str]:
    """Return the names of the scene files in ``folder``; none if it cannot be read."""
    try:
        return [file.name for file in folder.glob("*.toml") if file.is_file()]
    except (OSError, ValueError):
        return []


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):  # not a valid file name
        return False


def parse_toml(text: str, origin: str) -> dict[str, Any]:
    """Return the TOML ``text`` as nested tables. Raises InputError, whose message begins with ``origin``, if it is not
    valid TOML, or nested so deep that reading takes long."""
    if _DEEP_KEY.search(text):
        raise InputError(f"{origin}: a key of more than 20 parts: at most 20 are allowed")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{origin}: not valid TOML: {error}") from None
    except (ValueError, RecursionError):
        raise InputError(f"{origin}: not valid TOML: a number too long, or nested too deep") from None


def _override(data: dict[str, Any], override: str) -> None:
    origin = f"--set {_shown(override)}"
    path, equals, value = override.partition("=")
    keys = path.strip().split(".")
    if not (equals and all(keys)):
        raise InputError(f"{origin}: must be table.key=value, for example load.P=2e5")
    if keys == ["units"]:
        raise InputError(f"{origin}: must stand in the scene file, whose numbers it is about; see shown_in")
    value = value.strip()
    if value[:1].isalpha() and value not in ("true", "false", "nan", "inf"):
        parsed: Any = value  # words are a string: fem.far_field=box
    else:
        read = parse_toml(f"value = {value}", origin)
        if list(read) != ["value"] or "\n" in value:
            raise InputError(f"{origin}: must be one value")
        parsed = read["value"]
    for key in keys[:-1]:
        data = data.setdefault(key, {})
        if not isinstance(data, dict):
            raise InputError(f"{origin}: {_shown(key)} must be a table")
    data[keys[-1]] = parsed


def _find_files(data: dict[str, Any], scene: str | os.PathLike[str]) -> None:
    """Make paths of meshes and profiles relative to the folder of the scene file."""
    profile = data.get("profile")
    if isinstance(profile, dict) and isinstance(file := profile.get("file"), str) and file:
        profile["file"] = str(Path(scene).parent / file)
    bodies = data.get("bodies")
    for body in bodies.values() if isinstance(bodies, dict) else ():
        if isinstance(body, dict) and isinstance(mesh := body.get("mesh"), str) and mesh:
            body["mesh"] = str(Path(scene).parent / mesh)
    if isinstance(bodies, dict) and isinstance(rig := bodies.get("equivalent"), str) and rig:
        bodies["equivalent"] = str(Path(scene).parent / rig)


def _as_builtins(value: Any, path: str = "", depth: int = 0) -> Any:
    """``value`` as dicts, lists, strings and Python numbers; InputError if nested too deep or too long."""
    if hasattr(value, "tolist"):  # of NumPy and pandas
        value = value.tolist()
    elif isinstance(value, Table):
        value = msgspec.to_builtins(value)
    elif isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, (set, frozenset)):
        raise InputError(f"{path}: must be a list: a set has no order")
    if isinstance(value, (Mapping, list, tuple)) and depth == _DEEPEST:
        raise InputError(f"{path}: must be nested at most {_DEEPEST} levels deep")
    if isinstance(value, Mapping):
        if wrong := [key for key in value if not isinstance(key, str)]:
            raise InputError(f"{_join(path, wrong[0])}: a key must be a string")
        return {key: _as_builtins(child, _join(path, key), depth + 1) for key, child in value.items()}
    if isinstance(value, (list, tuple)):
        if len(value) > _LONGEST:
            raise InputError(f"{path}: must be an array of at most {_LONGEST} numbers, not {len(value)}")
        return [_as_builtins(child, f"{path}[{index}]", depth + 1) for index, child in enumerate(value)]
    return value


def _leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict):
        for key, child in value.items():
            yield from _leaves(child, _join(path, key))
    elif isinstance(value, list):
        for index, child in enumerate(value):
            yield from _leaves(child, f"{path}[{index}]")
    else:
        yield path, value


def _explain(message: str, data: Any, kind: Any, place: str) -> str:
    """Turn the decoder's message about ``data`` into "field = value: must be ..."."""
    what, _, where = message.partition(" - at `$")
    path = where.rstrip("`").lstrip(".")
    value: Any = data
    for key, index in re.findall(r"([^.\[\]]+)|\[(\d+)\]", path):
        kind = kind if index else _fields(_table_type(kind, value)).get(key)
        value = value[int(index)] if index else value[key]
    kind, path = _table_type(kind, value), ".".join(filter(None, (place, path)))
    if unknown := re.fullmatch(r"(?s)Object contains unknown field `(.*)`", what):
        keys = [*_keys(kind), *(["units"] if kind is Scene else [])]
        return f"{_join(path, unknown[1])}: unknown key{_nearest(unknown[1], keys)}"
    if missing := re.fullmatch(r"Object missing required field `(.*)`", what):
        return f"{_join(path, missing[1])}: missing"
    return f"{path} = {_shown(repr(value) if isinstance(value, str) else value)}: must be {_allowed(what, kind)}"


def _table_type(kind: Any, value: Any) -> Any:
    """Type of the table, chosen by the key ``kind`` if there are several."""
    tables = [table for table in get_args(kind) if isinstance(table, type) and issubclass(table, Table)]
    tag = value.get("kind") if isinstance(value, Mapping) else None
    return next((table for table in tables if len(tables) == 1 or table.__struct_config__.tag == tag), kind)


def _allowed(what: str, kind: Any) -> str:
    if what.startswith("Invalid value"):  # of the key `kind`
        return "one of " + ", ".join(
            repr(table.__struct_config__.tag) for table in get_args(Scene.__annotations__["profile"])
        )
    words = [word for option in (kind, *get_args(kind)) for word in get_args(option) if isinstance(word, (str, int))]
    if what.startswith("Invalid enum value"):
        numbers = any(getattr(option, "__origin__", option) is float for option in get_args(kind))
        return ("a number or " if numbers else "one of ") + ", ".join(map(repr, words))
    if length := re.fullmatch(r"Expected `array` of length (>=|<=) (\d+)", what):
        return f"an array of at {'least' if length[1] == '>=' else 'most'} {length[2]} numbers"
    strings = [repr(word) for word in words if isinstance(word, str)]
    if told := wanted(what, _KINDS | ({"str": " or ".join(strings)} if strings else {})):
        return told
    if what == "Number out of range":
        return f"of a size from {SMALLEST} to {LARGEST}"
    if "`str` of length >=" in what:
        return "a name"
    if "of length <=" in what:
        return f"at most {what.split()[-1]} characters"
    if "regex" in what and "\\x00" in what:
        return "one line of text"
    if "regex" in what:
        return "letters, digits, '.', '_' or '-', and begin with a letter or digit"
    return what.replace("`", "").removeprefix("Expected ")


def _fields(kind: Any) -> dict[str, Any]:
    tables = isinstance(kind, type) and issubclass(kind, Table)
    return {field.encode_name: field.type for field in msgspec.structs.fields(kind)} if tables else {}


def _keys(kind: Any) -> list[str]:
    chooser = kind.__struct_config__.tag_field
    return [*([chooser] if chooser else []), *_fields(kind)]


def _join(path: str, key: object) -> str:
    return f"{path}.{_shown(key)}" if path else _shown(key)


def _shown(value: Any) -> str:
    """A value, or a name, in at most 60 characters."""
    if type(value) is int and value.bit_length() > _BITS:
        return f"a whole number of {value.bit_length()} bits"
    if isinstance(value, bool):
        return str(value).lower()  # as a scene file has it
    text = repr(value) if isinstance(value, (int, float, list, dict)) else str(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _nearest(key: str, known: Iterable[str]) -> str:
    names = [*known]
    return meant(key, names) or f"; known are {', '.join(names)}"


def meant(key: str, known: Iterable[str]) -> str:
    """Return, for the end of a message, which of the ``known`` keys was meant by ``key``; empty if none is near."""
    by_lower = {name.lower(): name for name in known}
    near = difflib.get_close_matches(key[:60].lower(), by_lower, n=1, cutoff=0.6)
    return f"; did you mean {by_lower[near[0]]!r}?" if near else ""


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
