"""Two grips of a pulled specimen: shares of Q on its two sides."""

import numpy as np
import pytest

from partialslip import InputError, load_state, parse_scene, run
from partialslip.codes.export.model import outlined
from partialslip.march.equivalent.many import stick_zone
from partialslip.run import characterise

SCENE = {
    "name": "grips", "material": {"E": 72.1e9, "nu": 0.33}, "profile": {"kind": "hertz", "R": 0.01},
    "friction": {"f": 0.5}, "load": {"P": 135750.0, "Q": [-20e3, 20e3], "sigma": [-15e6, 15e6], "cycles": 2},
    "bodies": {
        "upper": {"width": 12e-3, "height": 5e-3},
        "lower": {"width": 20e-3, "height": 3e-3, "support": "roller", "pulled": True},
    },
    "fem": {"size": 0.1},
}  # fmt: skip


MOVED = {"load.Q": [0.0, 0.0], "load.displacement": [0.0, 1e-6]}
T, SIGMA = 3e-3, np.array(SCENE["load"]["sigma"])
_NODES, _WEIGHTS = (each * T / 2 for each in np.polynomial.legendre.leggauss(20))


def borne(found, x):
    """int sigma_xx dy over the specimen's section at ``x``, at load points 1 and 2."""
    y = _NODES - T / 2
    return found.stress_at(np.full_like(y, x), y)[:2, 0] @ _WEIGHTS


def solved(changes=None, method="fem", **asked):
    return run(parse_scene(SCENE).replace(changes or {}), method, **asked)[method]


def grip(share):
    return {"bodies.lower.right_grip": share}


@pytest.mark.slow
def test_the_right_grip_is_the_mirror_image_of_the_left_one():
    """Where the right side carries all of Q, the left one bears sigma alone."""
    right = solved(grip(1.0))
    left = solved({"load.Q": [20e3, -20e3]})
    assert (right.m, right.n) == pytest.approx((left.n, left.m), abs=1e-3 * left.a)
    other = solved()
    assert abs(right.m - other.m) > 5e-3 * left.a


@pytest.mark.slow
def test_sections_bear_their_shares():
    """int sigma_xx dy over sections of the specimen on both sides of the contact."""
    share = 0.3
    found = solved(grip(share) | {"fem.size": 0.2}, subsurface=True)
    for x, carried in ((-7e-3, -(1 - share)), (7e-3, share)):
        assert borne(found, x) == pytest.approx(SIGMA * T + carried * np.array([-20e3, 20e3]), rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.7, "stiffness"])
def test_equivalent_half_planes_know_both_grips(share):
    fem, found = solved(grip(share) | {"fem.size": 0.04}), solved(grip(share), "equivalent")
    assert (found.m, found.n) == pytest.approx((fem.m, fem.n), abs=2e-3 * fem.a)
    if share == "stiffness":
        return
    scene = parse_scene(SCENE).replace(grip(0.7))
    many = stick_zone(scene, characterise(scene), 40e3, 30e6)
    assert many.centre == pytest.approx(found.stick_centre, abs=2e-3 * fem.a)


@pytest.mark.slow
def test_a_plate_on_the_right_bears_what_the_section_beside_it_bears():
    """The force is found by reciprocity; stresses on a section between contact and plate have the same resultant."""
    found = solved(grip("stiffness") | {"fem.size": 0.2}, subsurface=True)
    assert borne(found, 7e-3) - SIGMA * T == pytest.approx(found.right_grip, abs=2e-3 * 20e3)


def test_the_share_of_a_plate_on_the_right_follows_from_the_stiffness():
    """A contact in the middle is as far from both plates: each carries half of Q. P stretches the block along x, which
    both plates hinder by the same force: Poisson's, of a bar, but for what is near the contact."""
    E, nu, width = 72.1e9, 0.33, 20e-3
    found = solved(grip("stiffness") | {"fem.size": 0.3})
    first, second = found.right_grip
    assert second - first == pytest.approx(20e3, rel=1e-3)
    strain = nu * (1 + nu) / E * SCENE["load"]["P"]  # P/l of a bar of the length l that is pressed across, times l
    assert (first + second) / 2 == pytest.approx(-strain * E / (1 - nu**2) * 3e-3 / width, rel=1e-2)


def test_a_plate_on_the_right_holds_what_it_pulls():
    """Sigma moves the plate so that the right side bears sigma on average. Half of Q on either side makes the contact
    nearly that of a share of one half, but for the steady force of P."""
    held = solved(grip("stiffness") | {"fem.size": 0.3})
    halved = solved(grip(0.5) | {"fem.size": 0.3})
    left = solved({"fem.size": 0.3})
    assert abs(held.m - halved.m) < 0.2 * abs(left.m - halved.m)


def test_a_run_goes_on_from_a_state(tmp_path):
    first = solved(halves := grip(0.5) | {"fem.size": 0.3})
    first.state.save(tmp_path / "state.npz")
    again = solved(halves, start=load_state(tmp_path / "state.npz"))
    assert (again.m, again.n) == pytest.approx((first.m, first.n), abs=1e-3 * first.a)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        (grip(1.2), r"bodies.lower.right_grip = 1.2: must be <= 1"),
        (grip(0.2) | {"bodies.lower.pulled": False}, r"right_grip = 0.2: must be given only with pulled = true"),
        (grip(0.2) | MOVED, r"right_grip = 0.2: must be 'stiffness' or left out with load.displacement"),
        (grip("glued"), r"bodies.lower.right_grip = 'glued': must be a number or 'stiffness'"),
        (grip(True), r"bodies.lower.right_grip = true: must be a number or 'stiffness', not true or false"),
        (grip("stiffness") | {"bodies.lower.pulled": False}, r"'stiffness': must be given only with pulled = true$"),
    ],
)
def test_bad_input_is_one_line(changes, told):
    with pytest.raises(InputError, match=told):
        solved(changes)


@pytest.mark.parametrize("share", [0.2, "stiffness"])
def test_decks_know_one_grip(share):
    with pytest.raises(InputError, match=rf"bodies.lower.right_grip = {share!r}: must be 0 or left out to export"):
        outlined(parse_scene(SCENE).replace(grip(share)))
