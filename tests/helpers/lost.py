"""The half-plane solver as it was before gradual loads could be followed."""

from contextlib import contextmanager

import pytest

from partialslip.halfplane import method, turning
from partialslip.halfplane.gradual_path.stage import LostError


@contextmanager
def lost_way():
    """As if the way of gradual loads were lost wherever slip turns round: what was solved before is forgotten."""

    def steady(*_):
        raise LostError("no way is known")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(turning, "steady", steady)
        method._change.cache_clear()
        yield
    method._change.cache_clear()
