"""The checks that are not tests: style, types, and which module may import which."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.mark.parametrize(
    "command",
    ["ruff check .", "ruff format --check .", "mypy", "lint-imports"],
    ids=lambda command: command.split(" .")[0],
)
def test_clean(command):
    program, *arguments = command.split()
    found = shutil.which(program, path=str(Path(sys.executable).parent)) or shutil.which(program)
    assert found, f"{program} is not installed: pip install -e '.[dev]'"
    done = subprocess.run([found, *arguments], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_no_module_over_500_lines():
    modules = [path for root in ("src", "fem", "meshes", "tests") for path in (ROOT / root).rglob("*.py")]
    assert len(modules) > 30
    assert [path for path in modules if len(path.read_text("utf-8").splitlines()) > 500] == []
