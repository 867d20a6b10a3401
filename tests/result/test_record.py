"""Results are plain data: unchanged by pickle, by another process, and by writing and reading a file."""

import json
import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import msgspec
import numpy as np
import pytest
from refusing import line_of

import partialslip
from partialslip import load_result, load_scene, run
from partialslip.report import write_run
from partialslip.report.record import SCHEMA, record, schema
from partialslip.tools.origin import made_now

DOCS = Path(__file__).parents[2] / "docs"
FAST = ["fem.accuracy=1e-2"]
SCENES = [
    ("hertz-large-tension", [], ("exact", "march", "fem")),
    pytest.param(("flat-rounded", [], ("exact", "march", "fem")), marks=pytest.mark.slow),
    pytest.param(("fretting-aluminium", ["load.Q=[5e3,3e4]", "load.sigma=[0,1e8]"], ("exact", "march", "fem")),
     marks=pytest.mark.slow),
    ("flat-rounded", ["profile={kind='tabulated',x=[0,1e-3,2e-3,4e-3],gap=[0,1e-5,4e-5,2e-4]}"], ("exact", "fem")),
    pytest.param(("hertz-shear", ["material.upper={E=210e9,nu=0.3}"], ("fem",)), marks=pytest.mark.slow),
]  # fmt: skip


@pytest.fixture(scope="module", params=SCENES, ids=lambda each: f"{each[0]} {' '.join(each[1])}"[:40])
def found(request):
    name, settings, methods = request.param
    return run(load_scene(name, [*FAST, *settings]), methods, subsurface=True)


def test_a_run_is_the_same_after_a_pickle(found):
    """Also at points between the points of the columns."""
    back = pickle.loads(pickle.dumps(found))
    assert record(back) == record(found)
    for name, mine in found.results.items():
        its, x = back.results[name], np.linspace(-1.1, 1.1, 57) * mine.a
        for one, other in zip(its.traction.at(x), mine.traction.at(x), strict=True):
            assert (one is None) == (other is None)
            np.testing.assert_array_equal(one, other)
        if mine.surface:
            np.testing.assert_array_equal(its.surface.at(x), mine.surface.at(x))
        if mine.stress_at:
            np.testing.assert_array_equal(its.stress_at(x, 0.3 * x), mine.stress_at(x, 0.3 * x))


def test_results_are_read_back_as_they_were(found, tmp_path):
    made = made_now("partialslip run it", ["friction.f=0.4"])
    write_run(found, tmp_path, made)
    back = load_result(tmp_path / "results.json")
    assert back == record(found, made=made)
    assert back.made.overrides == ("friction.f=0.4",)
    assert back.scene == found.scene
    for name, mine in found.results.items():
        its = back.methods[name]
        assert (its.a, its.m, its.n, its.cost) == (mine.a, mine.m, mine.n, mine.cost)
        np.testing.assert_array_equal(its.traction.p, mine.traction.p)
    for name, mine in found.comparisons.items():
        assert back.comparison[name].verdicts == tuple(verdict.finite for verdict in mine.verdicts)


def test_a_pool_brings_a_run_back():
    scene = load_scene("hertz-shear", FAST)
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        back = pool.submit(run, scene, ["exact", "march"]).result()
    here = run(scene, ["exact", "march"])
    for name, mine in here.results.items():
        assert (back.results[name].m, back.results[name].n) == (mine.m, mine.n)
        np.testing.assert_array_equal(back.results[name].traction.dq, mine.traction.dq)


def test_numbers_that_json_does_not_have_are_null():
    """NaN is stored as null, and the verdict stays missed."""
    outcome = run(load_scene("hertz-shear", FAST), ["exact", "march"])
    traction = outcome.results["march"].traction
    traction.dq[:3] = np.nan, np.inf, -np.inf
    kept = msgspec.json.decode(record(outcome).json, type=partialslip.Record)
    assert kept.methods["march"].traction.dq[:3] == (None, None, None)
    assert kept.methods["march"].traction.dq[3] == traction.dq[3]
    assert kept.outcome == "missed"


def unversioned(found):
    """A schema without what only some versions of msgspec tell: names of keys, and defaults."""
    if isinstance(found, dict):
        return {key: unversioned(value) for key, value in found.items() if key not in ("propertyNames", "default")}
    return [unversioned(each) for each in found] if isinstance(found, list) else found


def test_the_schema_that_is_published_is_that_of_the_types():
    """Written by: import json; from partialslip.report.record import schema; print(json.dumps(schema(), indent=1))."""
    published = json.loads((DOCS / "reference" / "results.schema.json").read_text("utf-8"))
    assert unversioned(published) == unversioned(json.loads(json.dumps(schema())))


@pytest.mark.parametrize(("text", "said"), [
    (b"[]", "must be a results.json"), (b"{}", f"schema = '': must be '{SCHEMA}'"),
    (b'{"schema": "partialslip/result/2"}', "run the scene again"), (b'{"schema": 3}', "must be a results.json"),
    (f'{{"schema": "{SCHEMA}"}}'.encode(), ": missing"),
])  # fmt: skip
def test_a_file_that_is_none_is_refused_in_one_line(text, said, tmp_path):
    path = tmp_path / "results.json"
    path.write_bytes(text)
    assert said in line_of(load_result, path)
