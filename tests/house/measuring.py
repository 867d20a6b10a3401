"""Measure the house: code, modules, constants, imports and words. After growth: python tests/house/measuring.py.

Code is lines without comments, docstrings and blank lines. Arrows are imports from one folder to another at run time;
floors are the longest way down along them. Words are those of all Markdown files.
"""

import ast
import io
import runpy
import tokenize
from pathlib import Path

ROOT = Path(__file__).parents[2]
TABLE = Path(__file__).with_name("house.txt")
GROWTH = 1.05  # fixed: most growth of a line of the table that a test accepts
_BLANK = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENDMARKER,
    tokenize.ENCODING,
}


def code_lines(text: str) -> int:
    """Number of lines of Python code without comments, docstrings and blank lines."""
    lines: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in _BLANK:
            lines.update(range(token.start[0], token.end[0] + 1))
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef) and node.body:
            first = node.body[0]
            if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant) and type(first.value.value) is str:
                lines.difference_update(range(first.lineno, (first.end_lineno or first.lineno) + 1))
    return len(lines)


def _code(folder: Path) -> int:
    return sum(code_lines(path.read_text("utf-8")) for path in folder.rglob("*.py"))


def measure() -> dict[str, int]:
    """All figures, by name."""
    drawing = runpy.run_path(str(ROOT / "docs" / "architecture.py"))
    constants = runpy.run_path(str(ROOT / "docs" / "constants.py"))["constants"]()
    imports = drawing["imports"](hidden=frozenset({"__main__"}))
    package = ROOT / "src" / "partialslip"
    folders = sorted(path for path in package.iterdir() if path.is_dir() and path.name != "__pycache__")
    roots = (package, ROOT / "fem" / "partialslip_fem", ROOT / "meshes" / "partialslip_meshes")
    figures = {f"code of {folder.name}": _code(folder) for folder in (*folders, *roots[1:])}
    return figures | {
        "code of all": sum(map(_code, roots)),
        "modules": sum(1 for root in roots for _ in root.rglob("*.py")),
        "entries": len(folders),
        "floors": 1 + max(drawing["levels"](imports).values()),
        "arrows": sum(map(len, imports.values())),
        "constants marked accuracy": sum(each.kind == "accuracy" for each in constants),
        "words of documents": sum(
            len(path.read_text("utf-8").split())
            for path in [*ROOT.glob("*.md"), *ROOT.glob("benchmarks/**/*.md"), *ROOT.glob("docs/**/*.md")]
            if "_build" not in path.parts
        ),
        "code of tests": _code(ROOT / "tests"),
    }


def written(figures: dict[str, int]) -> str:
    """The table as text, a line each."""
    width = max(map(len, figures))
    return "".join(f"{name:{width}}  {figure:7,d}\n" for name, figure in figures.items())


def read(text: str) -> dict[str, int]:
    """The figures of :func:`written`."""
    rows = (line.rsplit(maxsplit=1) for line in text.splitlines())
    return {name: int(figure.replace(",", "")) for name, figure in rows}


if __name__ == "__main__":
    TABLE.write_text(written(measure()), "utf-8")
