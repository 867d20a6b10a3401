"""The harness of the deliberate faults turns red where a fault does not bite."""

import math
from types import SimpleNamespace

import pytest
from biting import biting


class _Contact:
    @property
    def nodes(self):
        return 7


def patched(*fault):
    """Patch a name, and use nothing of it."""
    with biting(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(*fault)


@pytest.fixture
def model():
    return SimpleNamespace(press=lambda force: force)


def test_a_fault_that_is_called_bites(model):
    with biting(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(model, "press", lambda force: 2 * force)
        patch.setattr(_Contact, "nodes", property(lambda _: 0))
        assert (model.press(1.0), _Contact().nodes) == (2.0, 0)
    assert (model.press(1.0), _Contact().nodes) == (1.0, 7)


def test_a_name_that_does_not_exist_is_told(model):
    with pytest.raises(pytest.fail.Exception, match=r"patches .*\.pressed, which does not exist"):
        patched(model, "pressed", lambda force: 2 * force)


@pytest.mark.parametrize(
    ("name", "fault"),
    [
        ("nodes", (_Contact, "nodes", property(lambda _: 0))),
        ("radians", (math, "radians", lambda x: x)),
        ("radians", ("math.radians", lambda x: x)),
    ],
)
def test_a_function_that_nothing_calls_is_told(name, fault):
    with pytest.raises(pytest.fail.Exception, match=rf"patches \S+\.{name}, which nothing has called"):
        patched(*fault)
