"""Slip that reverses from load step to load step."""

import numpy as np

from partialslip.friction.history import Steps

BOTH = ((0.5, 1.0), (0.5, 1.0))  # two legs of two steps


def reverses(*forces, pressures=(1.0, 1.0, 1.0, 1.0)):
    """Whether a node with these shear forces slips back; its friction bounds are the ``pressures``."""
    columns = [np.array(each, float)[:, None] for each in (forces, pressures)]
    return Steps(BOTH, *columns, np.ones(1), np.zeros(4)).reversing.tolist() == [True]


def test_a_node_that_slips_and_sticks_again_on_the_same_leg_reverses():
    assert reverses(1.0, 0.9, 0.0, -1.0)
    assert reverses(1.0, -1.0, 0.0, 1.0)


def test_a_node_that_sticks_again_as_the_loads_turn_round_does_not():
    assert not reverses(0.0, 1.0, 0.2, -1.0)
    assert not reverses(1.0, 1.0, -1.0, -1.0)


def test_a_node_follows_its_bound_and_ceases_with_the_contact():
    assert not reverses(1.0, 0.5, -0.5, -1.0, pressures=(1.0, 0.5, 0.5, 1.0))
    assert not reverses(1.0, 0.0, 0.0, 0.0, pressures=(1.0, 0.0, 0.0, 0.5))
