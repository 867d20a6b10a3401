"""Are the tests of the judge worth anything? Change one operator, number or condition of a module at a time, and see
whether a test fails.

    python benchmarks/mutations.py src/partialslip/run/judge/*.py --tests tests/judge/test_verdicts.py
    python benchmarks/mutations.py src/partialslip/verify/case.py --tests tests/verify/test_requirements.py

What survives is printed, with its line; tests must then say more, or the change makes no difference. mutmut and
cosmic-ray start Python and import everything anew for each change, seconds of it; here a forked process imports the
changed module, and what others import is there already.
"""

import argparse
import ast
import copy
import importlib
import importlib.abc
import importlib.util
import os
import random
import signal
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

_SECONDS = 300  # a change that makes tests run for ever is seen, too
_WITHOUT = [
    word for name in ("cacheprovider", "hypothesispytest", "xdist", "benchmark") for word in ("-p", f"no:{name}")
]
_SWAPS: dict[type[ast.AST], type[ast.AST]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In, ast.And: ast.Or, ast.Or: ast.And,
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult, ast.BitOr: ast.BitAnd,
}  # fmt: skip
_NAMES = {"max": "min", "min": "max", "any": "all", "all": "any", "first": "last", "last": "first"}


def changes(node: ast.AST) -> Iterator[tuple[str, Callable[[ast.AST], None]]]:
    """The changes of one node: each in words, and the function that makes it in a copy."""
    for field in ("op", "ops"):
        operators = getattr(node, field, None)
        for place, operator in enumerate(operators if isinstance(operators, list) else [operators]):
            if swap := _SWAPS.get(type(operator)):
                yield f"{type(operator).__name__} -> {swap.__name__}", _swapper(field, place, swap)
    if isinstance(node, (ast.If, ast.IfExp)):
        yield "condition negated", lambda copied: _negate(copied, "test")
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        yield "not dropped", lambda copied: _negate(copied, "operand")
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        yield "minus dropped", lambda copied: setattr(copied, "op", ast.UAdd())
    if isinstance(node, ast.comprehension):
        for place in range(len(node.ifs)):
            yield "filter negated", lambda copied, place=place: copied.ifs.__setitem__(place, _not(copied.ifs[place]))
    if isinstance(node, ast.Constant) and isinstance(node.value, bool):
        yield f"{node.value} -> {not node.value}", lambda copied: setattr(copied, "value", not copied.value)
    elif isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
        yield f"{node.value} -> {node.value + 1}", lambda copied: setattr(copied, "value", copied.value + 1)
    if isinstance(node, ast.Name) and node.id in _NAMES and isinstance(node.ctx, ast.Load):
        yield f"{node.id} -> {_NAMES[node.id]}", lambda copied: setattr(copied, "id", _NAMES[copied.id])
    if isinstance(node, ast.Expr) and isinstance(node.value, (ast.Yield, ast.YieldFrom)):
        yield "yield dropped", lambda copied: setattr(copied, "value", ast.Constant(None))


def mutants(source: str) -> list[tuple[int, str, ast.Module]]:
    """Line, words and tree of every change of a module, in which annotations, imports for types
    and the ``strict`` of zip stay: that guards against mistakes in the code, which no result shows."""
    tree = ast.parse(source)
    kept = {id(below) for node in ast.walk(tree) for field in ("annotation", "returns") for below in
            ast.walk(getattr(node, field, None) or ast.Pass())}  # fmt: skip
    kept |= {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.keyword) and node.arg == "strict"}
    kept |= {
        id(node) for node in ast.walk(tree) if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
    }
    found = []
    for place, node in enumerate(ast.walk(tree)):
        for words, change in () if id(node) in kept else changes(node):
            copied = copy.deepcopy(tree)
            target = list(ast.walk(copied))[place]
            change(target)
            line = getattr(node, "lineno", 0)
            found.append((line, words, ast.fix_missing_locations(copied)))
    return found


def survives(module: str, path: Path, tree: ast.Module, tests: list[str]) -> bool:
    """Whether all ``tests`` pass with the changed module, in a process of its own."""
    child = os.fork()
    if child == 0:
        silent = os.open(os.devnull, os.O_WRONLY)
        os.dup2(silent, 1)
        os.dup2(silent, 2)
        signal.alarm(_SECONDS)
        sys.meta_path.insert(0, _Changed(module, path, tree))
        import pytest

        os._exit(int(pytest.main(["-x", "-q", *_WITHOUT, *tests])) and 1)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


class _Changed(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Imports one module from a changed tree."""

    def __init__(self, module: str, path: Path, tree: ast.Module) -> None:
        self._module, self._path, self._tree = module, path, tree

    def find_spec(self, name, path=None, target=None):  # noqa: ARG002
        return importlib.util.spec_from_file_location(name, self._path, loader=self) if name == self._module else None

    def create_module(self, spec):  # noqa: ARG002
        return None

    def exec_module(self, module):
        exec(compile(self._tree, str(self._path), "exec"), module.__dict__)


def _swapper(field: str, place: int, swap: type[ast.AST]) -> Callable[[ast.AST], None]:
    def change(copied: ast.AST) -> None:
        if field == "op":
            copied.op = swap()
        else:
            copied.ops[place] = swap()

    return change


def _negate(node: ast.AST, field: str) -> None:
    setattr(node, field, _not(getattr(node, field)))


def _not(node: ast.AST) -> ast.UnaryOp:
    return ast.UnaryOp(ast.Not(), node)


def _preload() -> None:
    """Import everything, then forget this project's own: what it needs from elsewhere stays."""
    for name in ("pytest", "partialslip", "partialslip.verify", "partialslip.report", "partialslip.verify.driver"):
        importlib.import_module(name)
    for name in [name for name in sys.modules if name.startswith("partialslip")]:
        del sys.modules[name]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=Path, help="modules in src to change")
    parser.add_argument("--tests", nargs="+", required=True, help="what pytest is to run")
    parser.add_argument("--processes", type=int, default=os.cpu_count())
    parser.add_argument("--share", type=float, default=1.0, help="of all changes, drawn at random (default: all)")
    given = parser.parse_args()
    _preload()
    tasks = []
    for path in given.files:
        module = ".".join(path.with_suffix("").parts[1:]).removesuffix(".__init__")
        tasks += [(module, path, *mutant) for mutant in mutants(path.read_text("utf-8"))]
    random.seed(0)
    tasks = [task for task in tasks if random.random() < given.share]
    began, lost = time.monotonic(), []
    with ThreadPoolExecutor(given.processes) as pool:
        outcomes = pool.map(lambda task: survives(task[0], task[1], task[4], given.tests), tasks)
        for done, (task, alive) in enumerate(zip(tasks, outcomes, strict=True), start=1):
            if alive:
                lost.append(task)
                print(f"survived: {task[1]}:{task[2]}: {task[3]}", flush=True)
            if done % 25 == 0:
                print(f"{done} of {len(tasks)}, {time.monotonic() - began:.0f} s", file=sys.stderr, flush=True)
    killed = len(tasks) - len(lost)
    print(f"{killed} of {len(tasks)} changes seen, {killed / len(tasks):.1%}")


if __name__ == "__main__":
    main()
