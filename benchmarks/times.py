"""Times that are tracked from version to version: pytest benchmarks/times.py --benchmark-autosave --benchmark-compare

Work counts are compared with what is stored by the tests; times are not, as machines are noisy: they are kept in
``.benchmarks`` here and compared where someone looks.
"""

import numpy as np
import pytest

import partialslip
from partialslip import halfplane
from partialslip.halfplane.hertz import HertzShape

SCENES = sorted(partialslip.shipped_scenes())


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("method", ["exact", "march", "fem"])
def test_shipped_scene(benchmark, method, name):
    scene = partialslip.load_scene(name)
    benchmark.group = method
    benchmark.pedantic(partialslip.run, (scene, [method]), rounds=3, warmup_rounds=1)


@pytest.mark.parametrize("accuracy", [1e-2, 1e-3, 1e-4, 1e-5, 1e-6])
def test_accuracy(benchmark, accuracy):
    scene = partialslip.load_scene("hertz-large-tension", [f"fem.accuracy={accuracy}"])
    benchmark.group = "fem, accuracy"
    benchmark.pedantic(partialslip.run, (scene, ["fem"]), rounds=3, warmup_rounds=1)


def test_many_stick_zones(benchmark):
    contact = halfplane.Contact(a=1.0, P=np.pi / 2, shape=HertzShape())
    random = np.random.default_rng(0)
    f, share = 0.5, random.random((2, 100_000))
    dsigma = share[1] * 16 * f * (1 - np.sqrt(1 - share[0]))
    benchmark.pedantic(
        halfplane.stick_zone, (contact, f, 2 * f * contact.P * share[0], dsigma), rounds=3, warmup_rounds=1
    )
