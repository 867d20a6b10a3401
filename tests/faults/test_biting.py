"""The harness of the deliberate faults turns red where a fault does not bite."""

from types import SimpleNamespace

import pytest
from biting import biting


class _Contact:
    @property
    def nodes(self):
        return 7


@pytest.fixture
def model():
    return SimpleNamespace(press=lambda force: force, shear=lambda force: force)


def test_a_fault_that_is_called_bites(model):
    with biting(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(model, "press", lambda force: 2 * force)
        patch.setattr(_Contact, "nodes", property(lambda _: 0))
        assert (model.press(1.0), _Contact().nodes) == (2.0, 0)
    assert (model.press(1.0), _Contact().nodes) == (1.0, 7)


def test_a_name_that_does_not_exist_is_told(model):
    with pytest.raises(pytest.fail.Exception, match=r"patches .*\.pressed, which does not exist"), biting():
        pytest.MonkeyPatch().setattr(model, "pressed", lambda force: 2 * force)


@pytest.mark.parametrize("fault", [("press", lambda force: 2 * force), (_Contact, "nodes", property(lambda _: 0))])
def test_a_function_that_nothing_calls_is_told(model, fault):
    with (
        pytest.raises(pytest.fail.Exception, match=r"(press|nodes), which nothing has called"),
        biting(),
        pytest.MonkeyPatch.context() as patch,
    ):
        patch.setattr(*(fault if len(fault) == 3 else (model, *fault)))
        model.shear(1.0)


def test_names_patched_by_their_path_are_counted():
    with pytest.raises(pytest.fail.Exception, match=r"math\.sqrt, which nothing has called"), biting():
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("math.sqrt", lambda x: x)
