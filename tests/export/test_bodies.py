"""Decks of finite bodies, unlike materials and bodies that turn."""

import numpy as np
import pytest
from decks import COARSE, UNIT, Deck, deck_equations, places

from partialslip import load_scene
from partialslip.codes.export import export, parts
from partialslip.codes.export.model import modelled

SCENE = "hertz-large-tension"
UNLIKE = ["material.upper={E=2e11, nu=0.3}", "load.sigma=[0, 0]"]
PULLED = ["bodies.upper={kind='pad', width=0.02, height=0.01, holder={width=0.03, height=0.01}}",
          "bodies.lower={width=0.06, height=0.01, support='roller', pulled=true}"]  # fmt: skip
BLOCKS = [f"bodies.{name}={{width=0.016, height=0.008}}" for name in ("lower", "upper")]
BLOCK = ["bodies.lower={width=0.012, height=0.008}"]  # clamped, below a half-plane


def total(loads, component):
    """Sum of the forces of a step along a component."""
    return sum(force for (_, along), force in loads.items() if along == component)


@pytest.mark.parametrize("overrides", [PULLED, BLOCK, UNLIKE])
def test_finite_and_unlike_bodies_carry_the_loads(overrides, tmp_path):
    """P and Q on the frame; a pulled body carries sigma times its height, a clamped one is in equilibrium."""
    scene = load_scene(SCENE, overrides)
    export(scene, "abaqus", size=0.3, growth=0.2)(tmp_path / "deck")
    deck = Deck(tmp_path / "deck")
    points, pulled = places(deck), scene.bodies.lower is not None and scene.bodies.lower.pulled
    lower = set(deck.members("LOWER_OUTER").tolist()) | set(deck.table("*NODE, NSET=LOWER")[:, 0].astype(int).tolist())
    for (moved, forces), (Q, sigma) in zip(deck.steps()[-2:], scene.load.points, strict=True):
        own = {key: force for key, force in forces.items() if key[0] not in lower}
        pull = {key: force for key, force in forces.items() if key[0] in lower}
        assert total(own, 2) == pytest.approx(-scene.P, rel=1e-9)
        assert total(own, 1) == pytest.approx(-Q, rel=1e-9)
        assert total(pull, 2) == 0
        height = scene.bodies.lower.height if pulled else 0.0
        assert total(pull, 1) == pytest.approx(sigma * height, rel=1e-9, abs=1e-6 * scene.P)
        if pulled:  # held on the left along x, on the back along y, and nowhere else
            held = {component: {node for node, along in moved if along == component} & lower for component in (1, 2)}
            assert {round(points[node, 0], 9) for node in held[1]} == {-0.03}
            assert {round(points[node, 1], 9) for node in held[2]} == {-0.01}
            assert not any(moved.values())


@pytest.mark.fault
def test_a_pull_that_is_left_out_is_seen(tmp_path, monkeypatch):
    """The specimen is not pulled: no force on the lower body."""
    monkeypatch.setattr(parts.MeshedBody, "pull", property(lambda part: np.zeros(len(part.mesh.points))))
    with pytest.raises(AssertionError):
        test_finite_and_unlike_bodies_carry_the_loads(PULLED, tmp_path)


def test_a_clamped_block_in_tension_is_in_uniform_tension():
    """Displacements of its back and forces on its sides are those of one uniform stress: equilibrium with
    sigma_xx = sigma at every node, by the stiffness of plane strain."""
    made = modelled(load_scene(SCENE, BLOCK), 0.5, growth=1.0)
    lower, step = made.parts[0], made.steps[-1]
    mesh, (c11, c12) = lower.mesh, lower.E / ((1 + lower.nu) * (1 - 2 * lower.nu)) * np.array([1 - lower.nu, lower.nu])
    strain = lower.strained * step.sigma
    assert made.bulk(step) == pytest.approx(mesh.points[lower.outer] * strain)
    assert c11 * strain[1] + c12 * strain[0] == pytest.approx(0.0, abs=1e-9 * step.sigma)
    stress = c11 * strain[0] + c12 * strain[1]
    assert stress == pytest.approx(step.sigma)
    # traction of this stress on all of the boundary that is not held
    x = mesh.points[:, 0]
    right, left = (np.flatnonzero(np.isclose(x, end)) for end in (x.max(), x.min()))
    height = load_scene(SCENE, BLOCK).bodies.lower.height
    assert lower.pull[right].sum() == pytest.approx(height)
    assert lower.pull[left].sum() == pytest.approx(-height)
    assert np.count_nonzero(lower.pull) == len(right) + len(left)


def test_a_pad_is_flat_along_the_contact_and_has_its_shape_beyond():
    """With stiffer bodies the gap is flatter there, and no other part of the body changes."""
    scene = load_scene(SCENE, PULLED)
    for stiffer in (1.0, 100.0):
        upper = modelled(scene, 0.3, growth=0.2, stiffer=stiffer).parts[1].mesh
        line, face = (np.unique(upper.lines[name]) for name in ("contact", "face"))
        x, y = upper.points[line].T
        assert np.ptp(y - scene.gap_at(x) / stiffer) < 1e-12
        x, y = upper.points[face].T
        reach = np.abs(upper.points[line, 0]).max()
        beyond, end = scene.gap_at(x), scene.gap_at(np.array(reach))
        assert np.ptp(y - beyond) < 0.1 * end  # the gap at the contact's end, which fades with the depth of the face
        assert upper.points[:, 1].max() == pytest.approx(0.02, abs=1e-9)


def test_where_pressing_slips_it_is_gradual_and_soon_free():
    steps = modelled(load_scene(SCENE, UNLIKE), 0.5, growth=1.0).steps
    assert [(step.name, step.guided) for step in steps[:2]] == [("touch", True), ("press", False)]
    assert steps[0].P < 0.02 * steps[1].P
    assert steps[1].increments > 8


@pytest.mark.parametrize("to", ["calculix", "abaqus"])
def test_a_frame_turns_about_the_origin_under_the_moment(to, tmp_path):
    """A rigid rotation of the frame satisfies the equations, and the moment on it is that of P."""
    scene = load_scene(SCENE, ["load.e=[-1e-4, 1e-4]"])
    export(scene, to, **COARSE)(tmp_path / "deck")
    deck = Deck(tmp_path / "deck")
    (turn,), (frame,) = (deck.rows(f"*NODE, NSET={name}")[0][:1] for name in ("TURN", "FRAME"))
    deck.blocks = [block for block in deck.blocks if block[0] not in ("*NODE, NSET=TURN", "*NODE, NSET=FRAME")]
    points, turn, frame = np.vstack([places(deck), np.zeros((2, 3 if to == "calculix" else 2))]), int(turn), int(frame)
    unit, thickness = (UNIT, np.nanmax(points[:, 2]) * UNIT) if to == "calculix" else (1.0, 1.0)
    arm, angle = 1e-3 / unit, 1e-3
    u = np.full((len(points), 2), np.nan)
    u[:, 0], u[:, 1] = 2.0 - angle * points[:, 1], 3.0 + angle * points[:, 0]
    u[turn, 0] = angle * arm
    sums = [
        sum(float(c) * u[int(node), int(k) - 1] for node, k, c in zip(row[::3], row[1::3], row[2::3], strict=True))
        for _, (_, row) in deck_equations(deck)
    ]
    assert len(sums) == 2 * len(deck.members("UPPER_OUTER"))
    assert np.abs(sums).max() < 1e-9 * angle * np.nanmax(points)
    for (_, forces), (P, M) in zip(deck.steps()[-2:], scene.pressing, strict=True):
        assert forces[turn, 1] * arm * unit / thickness == pytest.approx(-M, rel=1e-9)
        assert forces[frame, 2] / thickness == pytest.approx(-P, rel=1e-9)
