"""The README says what is so."""

import re
import tomllib
from pathlib import Path

import pytest

from partialslip.cli import main
from partialslip.scene.reading import parse_scene
from partialslip.tools.output import page
from partialslip_meshes.gmsh import DEBIAN_PACKAGES

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text("utf-8")
(SHOWN,) = re.findall(r"^```\n(fretting-aluminium: .*?)^```", README, flags=re.MULTILINE | re.DOTALL)


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```", README, flags=re.MULTILINE | re.DOTALL)


def test_two_commands_set_up_one_runs_one_tests():
    run, set_up, tests, long_checks = blocks("sh")
    assert len(set_up.strip().splitlines()) == 2
    assert run.strip() == ".venv/bin/partialslip run fretting-aluminium"
    assert tests.strip() == ".venv/bin/python -m pytest -n auto --dist worksteal"
    assert long_checks.startswith(f"{tests.strip()} -m slow\n")  # .ci/run takes the commands from these blocks
    assert all(f"<!-- {name} -->\n```sh" in README for name in ("set-up", "run", "tests", "long checks"))


def test_every_library_that_is_needed_is_set_up():
    assert all(f" {package}" in blocks("sh")[1] for package in DEBIAN_PACKAGES.values())
    assert page.LIBRARIES in blocks("sh")[1]


def test_scene_in_the_readme_is_the_shipped_one(capsys):
    (text,) = blocks("toml")
    scene = parse_scene(tomllib.loads(text))
    assert main(["run", scene.name, "--with", "exact", "--json"]) == 0
    printed = capsys.readouterr().out
    shipped = tomllib.loads((ROOT / f"src/partialslip/scene/shipped/{scene.name}.toml").read_text("utf-8"))
    assert scene.load == parse_scene(shipped).load
    assert f'"name": "{scene.name}"' in printed


def told(output):
    """Lines of the output of a run without what depends on the machine, and the numbers that do: errors and estimates
    of the finite elements in the rows of the table, and their unknowns."""
    lines, numbers, cut = [], [], None
    for line in output.splitlines():
        if line.startswith(" quantity"):
            cut = slice(line.index(" exact ") + len(" exact"), line.index(" bar"))
        elif cut and line.startswith(" ") and "─" not in line and line.strip():
            numbers += [float(number) for number in re.findall(r"\d\.\de-\d\d", line[cut])]
            line = line[: cut.start] + line[cut.stop :]
            line = re.sub(r"(\.\d{6})\d+", r"\1", line)  # as many digits as the error leaves
        if " dofs" in line:
            numbers.append(float(re.search(r"([\d,]+) dofs", line)[1].replace(",", "")))
        line = re.sub(r"[\d.]+ CPU s|[\d,]+ dofs|─+", "", line)
        lines.append(" ".join(line.split()))
    return " ".join(lines).split(), numbers


def test_output_in_the_readme_is_that_of_the_command(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "120")
    assert main(["run", "fretting-aluminium"]) == 0
    (words, numbers), (expected, others) = told(capsys.readouterr().out), told(SHOWN)
    assert words == expected
    assert {"small", "0.4195305", "0.02090568", "met:"} <= {*words}  # regime, m, n, verdict
    *errors, dofs = zip(numbers, others, strict=True)
    assert all(max(each) < 1e-9 or 1 / 3 < each[0] / each[1] < 3 for each in errors)
    assert len(errors) == 12
    assert dofs[0] == pytest.approx(dofs[1], rel=0.06)  # as in tests/work/work.txt


def test_what_differs_from_the_output_in_the_readme_is_seen():
    words, numbers = told(SHOWN)
    assert told(re.sub(r"[\d.]+ CPU s", "9.9 CPU s", SHOWN)) == (words, numbers)
    for before, after in (
        ("0.4195305 a", "0.4195306 a"),
        ("small tension,", "large tension,"),
        ("2.0e-04 ok", "2.0e-04"),
    ):
        assert before in SHOWN
        assert told(SHOWN.replace(before, after))[0] != words
    assert told(SHOWN.replace(" dofs", "0 dofs"))[1][-1] == 10 * numbers[-1]


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
    assert len(README.splitlines()) <= 120


def test_links_lead_somewhere():
    targets = re.findall(r"\]\((?!https?:)([^)#]+)\)", README)
    assert targets
    assert all((ROOT / target).exists() for target in targets)
