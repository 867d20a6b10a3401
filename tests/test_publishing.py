"""What is prepared for publishing agrees with itself."""

import json
import re
import tomllib
from pathlib import Path

import yaml

from partialslip.verify.benchmark.data import links

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
CITATION = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
ZENODO = json.loads((ROOT / ".zenodo.json").read_text("utf-8"))
PAGE = (ROOT / "docs" / "publishing.md").read_text("utf-8")


def test_version_and_licence_are_the_same_everywhere():
    assert PROJECT["version"] == CITATION["version"] == ZENODO["version"]
    assert PROJECT["license"] == CITATION["license"] == ZENODO["license"]


def test_addresses_come_from_the_project_alone():
    assert links() == PROJECT.get("urls", {})


def test_the_checklist_names_files_that_are_there():
    for name in re.findall(r"`([\w./]+\.(?:toml|cff|json|md|py))`", PAGE):
        assert (ROOT / name).is_file(), name


def test_the_workflows_run_the_test_that_is_there():
    folder = ROOT / "examples" / "grade_in_ci"
    steps = yaml.safe_load((folder / "github.yml").read_text("utf-8"))["jobs"]["grade"]["steps"]
    script = yaml.safe_load((folder / "gitlab.yml").read_text("utf-8"))["grade"]["script"]
    assert script == [step["run"] for step in steps if "run" in step]
    assert (folder / script[-1].split()[-1]).is_file()


def test_the_example_passes():
    namespace = {}
    exec((ROOT / "examples" / "grade_in_ci" / "test_contact.py").read_text("utf-8"), namespace)
    namespace["test_ps_02"]()
