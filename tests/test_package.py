"""What the package shows: its public names, found by help and tab completion, and imported when they are used."""

import importlib
import subprocess
import sys

import pytest

import partialslip
from partialslip import halfplane


def test_every_name_is_there_once_and_documented():
    assert partialslip.__all__ == sorted(partialslip.__all__)
    assert set(dir(partialslip)) == {*partialslip.__all__, "__version__", "halfplane"}
    for name in partialslip.__all__:
        found = getattr(partialslip, name)
        assert found.__name__ == name
        assert found.__doc__
        assert name in partialslip._HOMES
    assert dir(halfplane) == sorted(halfplane.__all__)
    assert all(getattr(halfplane, name).__doc__ for name in halfplane.__all__)


@pytest.mark.parametrize("name", ["run", "plan", "score", "export"])
def test_a_function_is_not_hidden_by_its_module(name):
    code = f"import partialslip\nimport partialslip.{name}\nprint(callable(partialslip.{name}))"
    code += f"\nfrom partialslip.{name} import {name}\nprint(partialslip.{name} is {name})"
    assert callable(getattr(partialslip, name))
    assert importlib.import_module(f"partialslip.{name}") is sys.modules[f"partialslip.{name}"]
    if name == "run":
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        assert done.stdout.split() == ["True", "True"]


def test_other_names():
    assert partialslip.scene.Material(E=1e9, nu=0.3).nu == 0.3
    with pytest.raises(AttributeError, match="module 'partialslip' has no attribute 'loadscene'"):
        partialslip.loadscene  # noqa: B018


def test_nothing_is_imported_before_it_is_used():
    code = (
        "import sys, partialslip\nprint({'numpy', 'scipy', 'msgspec', 'rich', 'pandas', 'matplotlib'} & {*sys.modules})"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "set()\n"
