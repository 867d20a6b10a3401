"""Tables of a scene whose P varies: the pressure at load point 1 is read and judged, too."""

import importlib
from pathlib import Path

import meshio
import numpy as np
import pytest
import varying
from tables import written

from partialslip.cli import main
from partialslip.codes.score import calculix
from partialslip.codes.score.mistakes import mistakes
from partialslip.codes.score.read import read_tractions
from partialslip.codes.score.samples import Samples
from partialslip.run.judge import compare
from partialslip.tools.errors import InputError

method = importlib.import_module("partialslip.codes.score.method")
SCENE, TRUE = varying.SCENE, varying.solved(varying.SCENE)
FRD = Path(__file__).parent / "calculix.frd"


def table(scene=SCENE, count=101):
    """Points, off the middle by an odd amount, and p, p1 and dq there."""
    true = varying.solved(scene)
    x = 1.1 * true.a * np.linspace(-1, 1.003, count)
    p, dq, *_, p1 = true.traction.at(x)
    return np.column_stack([x, p, p1, dq])


def scored(path, content, names="x,p,p1,dq", scene=SCENE):
    found = method.scored(scene, read_tractions(written(path, content, names), scene), path.name, str(path))
    return found, compare(found, varying.solved(scene), scene, None)


@pytest.mark.parametrize("scene", [SCENE, varying.TURNED])
def test_both_contacts_are_found(tmp_path, scene):
    """Ends at both load points and of the stick zone to part of a spacing, 0.022 a, and both pressures; a is that of
    the larger contact, whichever load point it belongs to."""
    found, comparison = scored(tmp_path / "t.csv", table(scene), scene=scene)
    lengths = ("a", "left_1", "right_1", "left_2", "right_2", "m", "n")
    assert max(comparison.errors[key] for key in lengths) < 1e-3
    assert all(comparison.errors[key] < 0.02 for key in ("p", "p_1", "q"))
    assert found.regime == "small tension"
    assert found.settings["f_seen"] == pytest.approx(SCENE.friction.f, rel=1e-6)


def test_nodal_forces(tmp_path):
    """Forces at both load points, of the area of a cell each."""
    x, *columns = table().T
    widths = np.gradient(x)
    found, comparison = scored(tmp_path / "t.csv", np.column_stack([x, *columns * widths]), "x,Fn,Fn1,dFt")
    assert max(comparison.errors[key] for key in ("left_1", "right_1", "m", "n")) < 2e-3
    assert found.traction.p1 == pytest.approx(table()[:, 2], abs=1e-9 * found.p0)


def test_point_data(tmp_path):
    x, p, p1, dq = table().T
    points, line = np.column_stack([x, 0 * x, 0 * x]), np.column_stack([np.arange(100), np.arange(1, 101)])
    mesh = meshio.Mesh(points, [("line", line)], point_data={"p": p, "p1": p1, "dq": dq})
    meshio.write(tmp_path / "t.vtu", mesh)
    assert read_tractions(tmp_path / "t.vtu", SCENE).p1 == pytest.approx(p1)
    del mesh.point_data["p1"]
    meshio.write(tmp_path / "t.vtu", mesh)
    with pytest.raises(InputError, match="must include p1, p at load point 1"):
        read_tractions(tmp_path / "t.vtu", SCENE)


def test_calculix_at_both_load_points():
    found = calculix.read_frd(FRD.read_text(), "a.frd", None, calculix.LoadPoints(0, 1, 2))
    turned = calculix.read_frd(FRD.read_text(), "a.frd", None, calculix.LoadPoints(1, 0, 2))
    assert np.array_equal(found["p1"], turned["p"])
    assert read_tractions(FRD, SCENE).p1 is not None
    assert read_tractions(FRD, SCENE.replace(load={"P": SCENE.P})).p1 is None


def test_what_is_missing_or_too_much_is_named(tmp_path):
    path, constant = tmp_path / "t.csv", SCENE.replace(load={"P": SCENE.P})
    written(path, table()[:, [0, 1, 3]])
    with pytest.raises(InputError, match=r"must include p1, p at load point 1.*--columns p1="):
        read_tractions(path, SCENE)
    assert read_tractions(path, SCENE, chosen={"x": "x", "p": "p", "p1": "p", "dq": "dq"}).p1 is not None
    with pytest.raises(InputError, match="--columns p1: must be left out"):
        read_tractions(path, constant, chosen={"x": "x", "p": "p", "p1": "p", "dq": "dq"})
    written(path, table() * [1, 1, 0, 1], "x,p,p1,dq")
    with pytest.raises(InputError, match="p1 > 0 at 0 points"):
        read_tractions(path, SCENE)
    assert read_tractions(path, constant).p1 is None


def test_half_of_the_change_is_not_the_shear_at_a_load_point(tmp_path):
    """Unless the loads are fully reversed, as those of the same scene with constant P are."""
    path = written(tmp_path / "t.csv", table() * [1, 1, 1, 0.5], "x,p,p1,q")
    found, reversed_ = (read_tractions(path, scene) for scene in (SCENE, SCENE.replace(load={"P": SCENE.P})))
    assert found.q2 is None
    assert np.array_equal(reversed_.q2, found.dq / 2)


def test_the_template_has_a_column_for_each_pressure(capsys, tmp_path):
    (tmp_path / "mine.toml").write_text(
        'name = "mine"\n[material]\nE = 72.8e9\nnu = 0.3\n[profile]\nkind = "hertz"\nR = 0.05\n'
        "[friction]\nf = 0.5\n[load]\nP = [4e5, 6e5]\nQ = [-1e5, 1e5]\n"
    )
    assert main(["score", str(tmp_path / "mine.toml"), "--template"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "P1 = 400000 N/m, P2 = 600000 N/m" in lines[4]
    assert lines[5] == "x,p,p1,dq"
    assert all(line.count(",") == 3 for line in lines[5:])


@pytest.mark.fault
def test_pressure_of_load_point_1_that_is_off_is_named(tmp_path):
    content = table()
    good, _ = scored(tmp_path / "t.csv", content)
    assert mistakes(SCENE, good, TRUE) == ()
    wrong, comparison = scored(tmp_path / "t.csv", content * [1, 1, 1.1, 1])
    assert comparison.errors["p_1"] == pytest.approx(0.1, rel=0.1)
    assert any("p1 adds up to 1.1 of the scene's P at load point 1" in note for note in mistakes(SCENE, wrong, TRUE))


@pytest.mark.fault
def test_friction_bound_of_one_load_point_moves_the_stick_zone(tmp_path, monkeypatch):
    """Slip is at 2 f times the mean pressure: not at that of load point 2."""
    monkeypatch.setattr(Samples, "p_mean", property(lambda samples: samples.p))
    found, _ = scored(tmp_path / "t.csv", table())
    assert found.n is None or abs(found.n - TRUE.n) > 0.03 * TRUE.a
