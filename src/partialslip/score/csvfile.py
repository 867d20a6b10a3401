"""Tractions as a table: comma-separated values with a header line."""

import numpy as np

from partialslip.errors import InputError
from partialslip.scene import Array, Scene

NORMAL = ("p", "Fn")
SHEARS = (("dq",), ("q",), ("q1", "q2"), ("dFt",), ("Ft",), ("Ft1", "Ft2"))
_ROWS = 1_000_000
_TEMPLATE_ROWS = 81
_REACH = 1.1  # half-widths


def read_csv(text: str, origin: str) -> dict[str, Array]:
    """Columns x, p (or Fn) and shear by name, in that order. ``#`` begins a comment; columns of other names are left
    out; separators are commas, semicolons or tabs.

    Raises
    ------
    InputError
        With one line that names line and column.
    """
    lines = [(number, line) for number, line in enumerate(text.splitlines(), start=1) if line.partition("#")[0].strip()]
    if not lines:
        raise InputError(f"{origin}: empty: must have a header line with x, p and dq")
    if len(lines) > _ROWS:
        raise InputError(f"{origin}: {len(lines)} lines: must be at most {_ROWS}")
    header = lines[0][1].partition("#")[0]
    separator = max(",;\t", key=header.count)
    names = [name.strip().strip('"') for name in header.split(separator)]
    wanted = _wanted(names, origin)
    columns = [names.index(name) for name in wanted]
    rows = [line.partition("#")[0].split(separator) for _, line in lines[1:]]
    numbers = [number for number, _ in lines[1:]]
    if short := next((n for n, row in zip(numbers, rows, strict=True) if len(row) != len(names)), None):
        raise InputError(f"{origin}: line {short}: must have {len(names)} fields, like the header line")
    table = [[row[column].strip() for row in rows] for column in columns]
    return {name: _numbers(values, numbers, name, origin) for name, values in zip(wanted, table, strict=True)}


def template(scene: Scene, a: float) -> str:
    """A table to fill in: points over a contact of half-width ``a`` (m) and beyond, without tractions."""
    x = _REACH * a * np.linspace(-1, 1, _TEMPLATE_ROWS)
    head = (
        f"# {scene.name}: put your tractions here and run: partialslip score {scene.name} THIS-FILE\n"
        "# x: along the contact, m, its middle at 0 (any points will do); p: pressure, Pa;\n"
        "# dq: change q2 - q1 of the shear traction between load points 1 and 2, Pa, positive where Q is.\n"
        "# Instead of dq: q (half of it), or q1 and q2. From nodal forces, N per m of depth: Fn, and dFt or Ft1, Ft2.\n"
        f"# The scene: P = {scene.P:.10g} N/m, dQ = {scene.load.dQ:.10g} N/m, dsigma = {scene.load.dsigma:.10g} Pa, "
        f"f = {scene.friction.f:.10g}\n"
        "x,p,dq\n"
    )
    return head + "".join(f"{point:.9e},0,0\n" for point in x)


def _wanted(names: list[str], origin: str) -> list[str]:
    for name in ("x", *NORMAL, *(name for shear in SHEARS for name in shear)):
        if names.count(name) > 1:
            raise InputError(f"{origin}: column {name!r}: must be there once, not {names.count(name)} times")
    normal = [name for name in NORMAL if name in names]
    shears = [shear for shear in SHEARS if set(shear) <= set(names)]
    if "x" not in names or len(normal) != 1 or len(shears) != 1:
        shown = ", ".join(repr(name) for name in names)[:100]
        raise InputError(
            f"{origin}: columns {shown}: must be x; p or Fn; and one of dq, q, q1 and q2, dFt, Ft, Ft1 and Ft2"
        )
    if (normal[0] == "Fn") != shears[0][0].endswith(("Ft", "Ft1")):
        raise InputError(f"{origin}: columns {normal[0]} and {shears[0][0]}: must be both tractions or both forces")
    return ["x", *normal, *shears[0]]


def _numbers(values: list[str], lines: list[int], name: str, origin: str) -> Array:
    try:
        return np.fromiter(map(float, values), float, len(values))
    except ValueError:
        line, value = next((n, v) for n, v in zip(lines, values, strict=True) if not _is_number(v))
        raise InputError(f"{origin}: line {line}: {name} = {value[:40]!r}: must be a number") from None


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
