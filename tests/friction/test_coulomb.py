"""Coulomb's law in every load step of march, and under varying pressure and between unlike bodies by both methods.

tests/fem/test_random_cycles.py has it for finite elements at constant pressure, with faults.
"""

from dataclasses import replace

import pytest
from coulomb import recorded
from random_marches import missed
from varying_scenes import varying

import partialslip
from partialslip.verify.random_scenes import KINDS, PROFILES, draw

SEED = 17
MEAN = "load.Q=[-0.2e5, 0.9e5]", "load.cycles=3", "load.steps=3"
UNLIKE = "material.upper.E=728e9", "material.upper.nu=0.3"
SCENES = {
    "P varies": varying((1.0, 1.2), 0.5, 0.3, cycles=2),
    "e varies": varying((1.0, 1.1), 0.4, 1.0, e=(0.0, 0.1), cycles=2, steps=3),
    "unlike bodies": partialslip.load_scene("hertz-large-tension", ["fem.accuracy=1e-2", *UNLIKE, *MEAN]),
}


def marches_of(scene, method):
    with recorded() as marches:
        partialslip.run(scene, [method])
    return marches


def complaints_on(scene, method):
    """What is wrong with a result and with the load steps that it took."""
    with recorded() as marches:
        result = partialslip.run(scene, [method]).results[method]
    return [*missed(result), *(complaint for march in marches for complaint in march.complaints())]


@pytest.mark.parametrize(
    "numbers",
    [(0, 30), pytest.param(range(len(KINDS) * len(PROFILES)), marks=pytest.mark.slow)],
    ids=["few", "many"],
)
def test_march_at_constant_pressure(numbers):
    found = [
        (number, kind, complaint)
        for number in numbers
        for kind, scene in [draw(SEED, number)]
        for complaint in complaints_on(scene, "march")
    ]
    assert not found, "\n".join(map(str, found))


@pytest.mark.parametrize("method", ["march", "fem"])
@pytest.mark.parametrize("name", list(SCENES))
def test_other_marches(name, method):
    marches = marches_of(SCENES[name], method)
    assert not [complaint for march in marches for complaint in march.complaints()]
    assert any(march.each("slip").any() for march in marches)


@pytest.mark.slow
@pytest.mark.fault
def test_coupling_left_short_is_seen():
    """Deliberate fault: pressure moves the surfaces by a thousandth less than it does."""
    march = marches_of(SCENES["unlike bodies"], "march")[-1]
    short = replace(march, across=0.999 * march.across)
    assert any("displacements leave over" in complaint for complaint in short.complaints())
