"""Notes on what a result is off by name what can be done."""

from types import SimpleNamespace

from partialslip.friction.regime import doubts, steps_of_coupled

MISSED = {"m": 3e-4, "q1": 4e-3}


def test_too_few_steps_of_coupled_bodies_can_be_more():
    coupled = SimpleNamespace(path=SimpleNamespace(moves=True, substeps=8), reverses=False)
    (note,) = steps_of_coupled(coupled, MISSED, 1e-4)
    assert note.endswith("in 8 steps (load.steps), too few for the accuracy; increase load.steps")
    assert steps_of_coupled(coupled, MISSED, 1e-3) == ()


def test_an_accuracy_that_is_not_reached_stands_beside_the_one_that_is():
    (note,) = doubts(None, MISSED, 1e-4)
    assert "accuracy 0.0001 not reached, but about 3.0e-04: estimated errors are m 3.0e-04, q1 4.0e-03 (" in note
    assert doubts(None, MISSED, 3e-4) == ()
    (note,) = doubts(None, MISSED | {"q1": 0.2}, 1e-4)  # no accuracy allows that
    assert "not reached: estimated" in note
