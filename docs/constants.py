"""Print the lists of the tuning constants: python docs/constants.py.

The lists are made from the sources: a constant is a name in capitals to which a module gives numbers. The comment on
its line, or the comment above it and its neighbours, begins with one of the words of :data:`KINDS`.
"""

import ast
import re
import textwrap
from collections import Counter
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
FOLDERS = ("src/partialslip", "fem/partialslip_fem", "meshes/partialslip_meshes")
KINDS = {
    "accuracy": "changes results, by no more than their estimates say, or the estimates themselves",
    "cost": "changes only what results cost",
    "limit": "says what is accepted, given up or refused",
    "display": "changes how things look",
    "fixed": "no choice: a format, a standard or mechanics says it",
}
_HEAD = """# Tuning constants

Numbers that were chosen, package by package: not facts of mechanics, and not the settings of a scene. The first word
says what a constant does:

{kinds}

A comment that begins with none of these words says that of the constants above it.
"""


class Constant(NamedTuple):
    """A tuning constant: its package, module, name, its value as the source has it, what kind it is, and what it is."""

    package: str
    module: str
    name: str
    value: str
    kind: str
    what: str


def _numeric(node: ast.expr) -> bool:
    """Whether the expression is made of numbers alone."""
    match node:
        case ast.Constant(value=value):
            return isinstance(value, int | float) and not isinstance(value, bool)
        case ast.UnaryOp(operand=operand):
            return _numeric(operand)
        case ast.BinOp(left=left, right=right):
            return _numeric(left) and _numeric(right)
        case ast.Tuple(elts=values) | ast.List(elts=values) | ast.Dict(values=values):
            return bool(values) and all(map(_numeric, values))
    return False


def _names(node: ast.stmt) -> list[tuple[str, ast.expr]]:
    """Names in capitals to which a statement gives numbers, each with its value."""
    match node:
        case ast.Assign(targets=[ast.Tuple(elts=names)], value=ast.Tuple(elts=values)):
            pairs = list(zip(names, values, strict=True))
        case ast.Assign(targets=[name], value=value) | ast.AnnAssign(target=name, value=ast.expr() as value):
            pairs = [(name, value)]
        case _:
            return []
    named = [(name.id, value) for name, value in pairs if isinstance(name, ast.Name) and name.id.isupper()]
    return named if all(_numeric(value) for _, value in named) else []


def _comments(lines: list[str], first: int, last: int) -> tuple[str, str]:
    """The comment on lines ``first`` to ``last`` (from 1) and the comment right above them."""
    own = " ".join(found[1] for line in lines[first - 1 : last] if (found := re.search(r"  # ?(.*)", line)))
    above: list[str] = []
    while first > 1 and lines[first - 2].startswith("#"):
        above.insert(0, lines[first - 2].lstrip("# "))
        first -= 1
    return re.sub(r"\s*fmt: (off|skip)", "", own), " ".join(above)


def _split(comment: str) -> tuple[str, str]:
    """Kind and the rest of a comment; no kind if it does not begin with one."""
    kind, colon, rest = comment.partition(":")
    return (kind, rest.strip()) if colon and kind in KINDS else ("", comment)


def constants() -> list[Constant]:
    """All tuning constants, by package and module."""
    found: list[Constant] = []
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*.py")):
            text, inside = path.read_text("utf-8"), path.relative_to(ROOT / folder)
            lines, last, shared = text.splitlines(), 0, ("", "")
            package = folder.split("/")[1] if len(inside.parts) == 1 or folder != FOLDERS[0] else inside.parts[0]
            module = ".".join(inside.with_suffix("").parts)
            for node in ast.parse(text).body:
                names = _names(node)
                if not names:
                    continue
                assert node.end_lineno
                own, above = _comments(lines, node.lineno, node.end_lineno)
                if above:
                    shared = _split(above)
                elif node.lineno != last + 1:
                    shared = "", ""
                last = node.end_lineno
                kind, what = _split(own)
                statement = "\n".join(lines[node.lineno - 1 : node.end_lineno])  # the whole text takes a second in all
                ast.increment_lineno(node, 1 - node.lineno)
                values = [" ".join((ast.get_source_segment(statement, value) or "").split()) for _, value in names]
                for (name, _), value in zip(names, values, strict=True):
                    found.append(Constant(package, module, name, value, kind or shared[0], what or shared[1]))
    return found


def page() -> str:
    """The page, in Markdown."""
    kinds = "\n".join(f"- **{kind}**: {what};" for kind, what in KINDS.items())[:-1] + "."
    every = constants()
    packages = sorted({each.package for each in every})
    count = Counter((each.package, each.kind) for each in every)
    total = Counter(each.kind for each in every)
    lines = [f"| package | {' | '.join(KINDS)} |", "|---" * (len(KINDS) + 1) + "|"]
    lines += [
        f"| `{package}` | " + " | ".join(str(count[package, kind]) for kind in KINDS) + " |" for package in packages
    ]
    lines.append("| all | " + " | ".join(str(total[kind]) for kind in KINDS) + " |")
    parts = [_HEAD.format(kinds=kinds), "\n".join(lines)]
    for package in packages:
        rows = [each for each in every if each.package == package]
        parts.append(f"## `{package}`")
        for module in dict.fromkeys(row.module for row in rows):
            lines = [f"`{module}`:", ""]
            for row in rows:
                if row.module == module:
                    text = f"- `{row.name} = {row.value}`: **{row.kind}**: {row.what}"
                    lines += textwrap.wrap(text, 118, subsequent_indent="  ", break_on_hyphens=False)
            parts.append("\n".join(lines))
    return "\n\n".join(part.strip() for part in parts) + "\n"


if __name__ == "__main__":
    print(page(), end="")
