"""The README says what is so."""

import re
import tomllib
from pathlib import Path

import pytest

from partialslip.cli import main
from partialslip.output import page
from partialslip.scene.reading import parse_scene
from partialslip_meshes.gmsh import DEBIAN_PACKAGES

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text("utf-8")


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```", README, flags=re.MULTILINE | re.DOTALL)


def test_two_commands_set_up_one_runs_one_tests():
    set_up, run, tests, long_checks = blocks("sh")
    assert len(set_up.strip().splitlines()) == 2
    assert run.strip() == ".venv/bin/partialslip run fretting-aluminium"
    assert tests.strip() == ".venv/bin/python -m pytest -n auto --dist worksteal"
    assert long_checks.startswith(f"{tests.strip()} -m slow\n")  # .ci/run takes the commands from these blocks
    assert all(f"<!-- {name} -->\n```sh" in README for name in ("set-up", "run", "tests", "long checks"))


def test_every_library_that_is_needed_is_set_up():
    assert all(f" {package}" in blocks("sh")[0] for package in DEBIAN_PACKAGES.values())
    assert page.LIBRARIES in blocks("sh")[0]


def test_scene_in_the_readme_is_the_shipped_one(capsys):
    (text,) = blocks("toml")
    scene = parse_scene(tomllib.loads(text))
    assert main(["run", scene.name, "--with", "exact", "--json"]) == 0
    printed = capsys.readouterr().out
    shipped = tomllib.loads((ROOT / f"src/partialslip/scene/shipped/{scene.name}.toml").read_text("utf-8"))
    assert scene.load == parse_scene(shipped).load
    assert f'"name": "{scene.name}"' in printed


def test_python_in_the_readme_runs(capsys):
    code = "\n".join(blocks("python"))
    exec(compile(code.replace('"load.Q=', '"fem.accuracy=1e-2", "load.Q='), "README.md", "exec"), {})
    compared, *zones, slips = capsys.readouterr().out.splitlines()
    exact_m, fem_m, q, cpu = map(float, compared.split())
    _, exact_dissipated, fem_dissipated = map(float, slips.split())
    assert fem_dissipated == pytest.approx(exact_dissipated, rel=1e-2)
    assert "-1" in zones[-1]
    assert fem_m == pytest.approx(exact_m, abs=1e-2)
    assert 0 < q < 0.15
    assert cpu > 0


def test_it_is_short():
    assert len(README.splitlines()) <= 180


def test_links_lead_somewhere():
    targets = re.findall(r"\]\((?!https?:)([^)#]+)\)", README)
    assert targets
    assert all((ROOT / target).exists() for target in targets)
