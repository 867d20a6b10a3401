"""What CalculiX makes of exported decks, where it is installed."""

import shutil
import subprocess

import numpy as np
import pytest
import varying as closed_form

from partialslip import load_scene
from partialslip.codes.export import export
from partialslip.codes.export import model as models
from partialslip.codes.score import score
from partialslip.codes.score.read import read_tractions
from partialslip.run.judge import compare

STIFFER = 100.0
UNLIKE = ["material.upper={E=2e11, nu=0.3}", "load.sigma=[0, 0]", "load.Q=[-1e5, 1e5]"]
BLOCKS = [f"bodies.{name}={{width=0.016, height=0.008}}" for name in ("lower", "upper")]


def ran(scene, folder, **how):
    """File of what CalculiX makes of the exported deck."""
    export(scene, "calculix", **how)(folder / "job.inp")
    subprocess.run(["ccx", "job"], cwd=folder, check=True, capture_output=True, timeout=600)
    return folder / "job.frd"


def computed(scene, folder, **how):
    """What CalculiX makes of the exported deck, scored."""
    file = ran(scene, folder, **how)
    return score(scene, file).comparisons[file.name]


needs_ccx = pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed")
HOW = {"size": 0.05, "growth": 0.2, "stiffer": STIFFER}


@pytest.mark.slow
@needs_ccx
@pytest.mark.parametrize(
    ("name", "ends"),
    [
        ("hertz-small-tension", ()),
        ("hertz-large-tension", ()),
        ("flat-rounded", (-1.0, -0.974, 0.425, 1.0)),  # pressure falls from 2 p0 to nothing within 0.07 a
    ],
)
def test_calculix_runs_it(name, ends, tmp_path):
    """Elements of 0.05 a: errors of less than half of them in a, m and n, and of a few per cent in tractions."""
    found = computed(load_scene(name), tmp_path, **HOW, ends=ends)
    assert max(found.a, found.m, found.n) < 0.02
    assert found.p < 0.02
    assert found.q < 0.05


@pytest.mark.slow
@needs_ccx
def test_calculix_runs_varying_p(tmp_path):
    """Contacts of 0.8 and 1 mm, elements of 0.04 mm, scored against the closed form at both load points. Such elements
    show m and n to 0.08 a only, beside the left slip zone of 0.04 a, and score does not give them."""
    scene, file = closed_form.SCENE, ran(closed_form.SCENE, tmp_path, **HOW)
    found = score(scene, file).results[file.name]
    errors = compare(found, closed_form.solved(scene), scene, None).errors
    assert max(errors[key] for key in ("a", "left_1", "right_1", "left_2", "right_2", "p", "p_1")) < 0.02
    assert errors["q"] < 0.05
    assert max(found.estimate[key] for key in "mn") > 0.05
    assert "m and n are not given" in found.notes[-1]


@pytest.mark.slow
@needs_ccx
def test_calculix_runs_bodies_of_a_size_and_unlike_ones(tmp_path):
    """Against finite elements: blocks in tension, and unlike half-planes that slip while they are pressed."""
    for overrides in (BLOCKS, UNLIKE):
        scene = load_scene("hertz-small-tension", overrides)
        found = computed(scene, tmp_path, **HOW)
        # one increment a step: where p depends on q, the path is coarse
        assert found.a < 0.02
        assert found.p < 0.03
        assert found.q < 0.05


@needs_ccx
def test_the_abaqus_deck_runs_in_calculix(tmp_path):
    """All keywords, but for what each code calls by its own name: output, penalties and the friction's multipliers."""
    scene = load_scene("hertz-small-tension", [*BLOCKS, "load.Q=[0, 0]"])
    scene = scene.replace(load={"sigma": (0.0, 0.0)})
    export(scene, "abaqus", size=0.2, growth=0.5, stiffer=STIFFER)(tmp_path / "deck.inp")
    E, told = scene.material.E * STIFFER, (tmp_path / "deck.inp").read_text("ascii")
    for own, other in (
        ("*CONTACT OUTPUT\nCSTRESS, CDISP, CFORCE", "*CONTACT FILE\nCDIS, CSTR"),
        ("OVERCLOSURE=HARD, DIRECT", f"OVERCLOSURE=LINEAR\n{1e3 * E / 1e-3:e}"),
        ("*FRICTION, LAGRANGE\n5.000000000000e-01", f"*FRICTION\n0.5, {1e2 * E / 1e-3:e}"),
    ):
        assert own in told
        told = told.replace(own, other)
    (tmp_path / "job.inp").write_text(told, "ascii")
    done = subprocess.run(["ccx", "job"], cwd=tmp_path, check=True, capture_output=True, text=True, timeout=100)
    assert "Job finished" in done.stdout
    assert "*ERROR" not in done.stdout
    found = read_tractions(tmp_path / "job.frd", scene)
    # nodal values of elements of 0.2 a; with 0.1 a the difference is 3 %, with 0.05 a 1.5 %
    assert (found.p * np.gradient(found.x)).sum() == pytest.approx(scene.P, rel=0.1)


@pytest.mark.slow
@needs_ccx
def test_fault_tension_of_the_wrong_sign(tmp_path, monkeypatch):
    """The deck's tension turned round: the scored result must say so."""
    true = models.steps_of
    monkeypatch.setattr(models, "steps_of", lambda scene: tuple(s._replace(sigma=-s.sigma) for s in true(scene)))
    found = computed(load_scene("hertz-small-tension"), tmp_path, **HOW)
    assert min(found.m, found.n) > 0.1
    assert found.q > 0.1


@pytest.mark.slow
@needs_ccx
def test_slopes_are_what_stiffer_bodies_take_away(tmp_path):
    """With the scene's own stiffness a/R = 0.02, which moves the ends by a fraction of that."""
    scene = load_scene("hertz-small-tension")
    flat, sloping = (computed(scene, tmp_path, **HOW | {"stiffer": K}) for K in (100.0, 1.0))
    assert 5e-4 < abs(sloping.n - flat.n) < 0.02
