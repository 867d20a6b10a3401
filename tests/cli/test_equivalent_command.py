"""partialslip equivalent: what it prints and writes, and how scenes refer to it."""

import json
import re

import pytest

import partialslip
from partialslip.cli import main

TEXT = """
name = "blocks"
[material]
E = 72.8e9
nu = 0.3
[profile]
kind = "hertz"
R = 50e-3
[load]
p0 = 4e8
Q = [-2.3e5, 2.3e5]
sigma = [-2.4e8, 2.4e8]
[friction]
f = 0.5
[bodies.upper]
width = 16e-3
height = 8e-3
[bodies.lower]
width = 16e-3
height = 8e-3
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A scene, and another that refers to the rig which is not there yet."""
    path = tmp_path_factory.mktemp("equivalent")
    (path / "blocks.toml").write_text(TEXT)
    (path / "referring.toml").write_text(TEXT + '[bodies]\nequivalent = "results/blocks-equivalent/rig.json"\n')
    return path


@pytest.fixture
def call(folder, monkeypatch, capsys):
    monkeypatch.chdir(folder)
    monkeypatch.setenv("COLUMNS", "100")

    def called(*arguments):
        code = main(arguments)
        return code, *capsys.readouterr()

    return called


@pytest.fixture
def done(call):
    return call("equivalent", "blocks.toml")


def test_the_half_planes_are_named(done):
    code, out, _ = done
    assert code == 0
    first = out.splitlines()[0]
    assert re.match(r"blocks: the bodies act like half-planes with R = 49\.4\d+ mm, not 50 mm; sigma = ", first)
    assert "turned" not in first  # mirror images
    assert re.search(r"1 kN/m of P +0\.000384\d* 1/m +0 rad +0 MPa +0 MPa/mm", out)
    assert "The data hold where |x| <= 4 mm." in out
    assert "written: rig.json, half-planes.toml" in out


@pytest.mark.slow
@pytest.mark.usefixtures("done")
def test_the_half_planes_of_the_file_do_what_the_bodies_do(call, folder):
    """By exact and by march, and the same in both scenes."""
    code, out, _ = call("run", "results/blocks-equivalent/half-planes.toml", "--with", "exact,march", "--json")
    assert code == 0
    found = json.loads(out)["methods"]
    own = partialslip.run(partialslip.load_scene(folder / "referring.toml"), ["equivalent"])["equivalent"]
    assert found["exact"]["m"] == pytest.approx(own.m, rel=1e-9)
    assert found["march"]["m"] == pytest.approx(own.m, rel=1e-3)


@pytest.mark.usefixtures("done")
def test_a_scene_that_refers_to_the_rig_runs_by_exact_and_equivalent(call):
    code, out, _ = call("run", "referring.toml", "--json")
    assert code == 0
    assert set(json.loads(out)["methods"]) == {"exact", "equivalent"}


def test_units_are_those_of_the_scene(call, folder):
    metres = ("72.8e9", "50e-3", "4e8", "2.3e5", "2.4e8", "16e-3", "8e-3")
    text = TEXT
    for old, new in zip(metres, ("72.8e3", "50", "400", "230", "240", "16", "8"), strict=True):
        text = text.replace(old, new)
    (folder / "mm.toml").write_text('units = "N-mm"' + text.replace('"blocks"', '"mm"'))
    code, out, _ = call("equivalent", "mm.toml")
    assert code == 0
    assert re.search(r"1 N/mm of P +3\.84\d*e-07 1/mm +0 rad +0 MPa +0 MPa/mm", out)
    code, out, err = call("equivalent", "mm.toml", "--set", "load.displacement=[0,3e-3]", "--set", "load.Q=[0,0]")
    assert (code, out) == (2, "")
    assert err.startswith("partialslip: mm.toml: load.displacement = [0, 0.003] mm: must be load.Q here")
