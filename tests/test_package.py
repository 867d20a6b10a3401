"""What the package shows: its public names, found by help and tab completion, and imported when they are used."""

import subprocess
import sys

import pytest

import partialslip
from partialslip import halfplane
from partialslip.tools.moved import NEW_NAMES, new_name


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


def done(code, *options):
    """What became of a program."""
    return subprocess.run([sys.executable, *options, "-c", code], capture_output=True, text=True, check=True)


@pytest.mark.parametrize("name", ["run", "plan", "score", "export"])
def test_a_function_is_not_hidden_by_its_module(name):
    """Also under the module name of version 1.0, which warns, and leads to the same module."""
    module = NEW_NAMES.get(name, name)
    code = f"import partialslip\nimport partialslip.{name}\nprint(callable(partialslip.{name}))"
    code += f"\nfrom partialslip.{module} import {name}\nprint(partialslip.{name} is {name})"
    assert done(code).stdout.split() == ["True", "True"]


@pytest.mark.parametrize("old", ["fatigue", "gradual", "judge.verdict", "run.judge.means", "errors"])
def test_module_names_of_version_1_0_warn_and_lead_to_the_same_module(old):
    new = f"partialslip.{new_name(old)}"
    code = f"""import sys, {new}
found = sys.modules["{new}"]
name = found.__spec__.name
import partialslip.{old}
print(sys.modules["partialslip.{old}"] is found, found.__spec__.name == name)"""
    found = done(code, "-W", "always")
    assert found.stdout.split() == ["True", "True"]
    assert f"DeprecationWarning: partialslip.{old} is now {new}" in found.stderr


@pytest.mark.parametrize("name", ["study.cost.ladder", "verify.benchmark.badge"])
def test_a_function_is_not_hidden_by_its_former_module(name):
    home, _, function = name.rpartition(".")
    code = f"""import partialslip.{home}, importlib, sys
before = partialslip.{home}.{function}
module = importlib.import_module("partialslip.{name}")
print(partialslip.{home}.{function} is before is module.{function})"""
    assert done(code).stdout == "True\n"


def test_other_names():
    assert partialslip.scene.Material(E=1e9, nu=0.3).nu == 0.3
    with pytest.raises(AttributeError, match="module 'partialslip' has no attribute 'loadscene'"):
        partialslip.loadscene  # noqa: B018


HEAVY = "gmsh skfem meshio matplotlib pandas rich cvxopt jinja2"
GRADE = """import numpy as np
from partialslip.benchmark import grade
x = np.linspace(-1.1, 1.1, 121)
grade("PS-01", 2.066976e-4 * x, 418.1044e6 * np.sqrt(np.maximum(1 - x**2, 0)))"""
RUN = "import partialslip as p; s = p.load_scene('hertz-shear', ['fem.size=0.2', 'fem.factor=superlu']); p.run(s, {})"
IMPORTED = {  # which of some packages a piece of code imports
    "import partialslip": ("numpy scipy msgspec " + HEAVY, ""),
    "from partialslip.cli import parser; parser().format_help()": ("numpy scipy msgspec shtab " + HEAVY, ""),
    "from partialslip.cli import main; main(['run', 'hertz-shear', '--with', 'exact', '--json'])": (
        "gmsh skfem meshio matplotlib", ""
    ),
    "import partialslip; partialslip.load_scene('hertz-shear')._repr_html_()": ("jinja2 matplotlib pandas", "jinja2"),
    GRADE: (f"{HEAVY} scipy.optimize scipy.interpolate partialslip_meshes partialslip_fem", ""),
    RUN.format(["exact", "march"]): (HEAVY, ""),
    RUN.format(["fem"]): (HEAVY, "skfem"),  # gmsh runs in a separate process
}  # fmt: skip


@pytest.mark.parametrize("code", IMPORTED)
def test_only_what_is_used_is_imported(code):
    packages, found = IMPORTED[code]
    code += f"\nimport sys\nprint(*({{*{packages.split()}}} & {{*sys.modules}}), file=sys.stderr)"
    assert done(code).stderr.split() == found.split()
