"""Functions of points take numbers, lists and arrays of any shape."""

import numpy as np
import pytest

import partialslip
from partialslip import halfplane
from partialslip.tools.methods import METHODS

SCENE = partialslip.load_scene("fretting-aluminium")


@pytest.fixture(scope="module")
def exact():
    return partialslip.run(SCENE, "exact", subsurface=True)["exact"]


@pytest.fixture(scope="module")
def march():
    return partialslip.run(SCENE.replace(fem={"accuracy": 1e-2}), "march")["march"]


def functions(result):
    """Functions of x, by name, each as one array."""
    traction = result.traction
    found = {"at": lambda x: np.stack(traction.at(x)[:4])}
    if result.surface:
        found |= {"surface": result.surface.at, "inside": lambda x: result.stress_at(x, -0.1 * result.a)}
    return found


@pytest.mark.parametrize("method", ["exact", "march"])
def test_values_have_the_shape_of_the_points(method, request):
    result = request.getfixturevalue(method)
    x = np.linspace(-1.2, 1.2, 12) * result.a
    for function in functions(result).values():
        line = function(x)
        assert line.shape[-1] == 12
        np.testing.assert_array_equal(function(x.tolist()), line)
        box = function(x.reshape(3, 2, 2))
        np.testing.assert_array_equal(box, line.reshape(*line.shape[:-1], 3, 2, 2))
        np.testing.assert_allclose(function(x[4]), line[..., 4], rtol=0, atol=1e-12 * result.p0)
        assert function([]).shape == (*line.shape[:-1], 0)


def test_a_number_gives_numbers(exact):
    for value in (*exact.traction.at(0)[:4], exact.surface.at(0)[0, 0]):
        assert isinstance(value, float)
    pressed = halfplane.contact(SCENE)
    assert pressed.pressure(0) == pytest.approx(pressed.p0)
    assert isinstance(halfplane.adhered(0, pressed.a, 1e4, 0.0), float)
    assert SCENE.gap_at(2e-3) == pytest.approx(2e-4)
    assert SCENE.gap_at([[0, 2e-3]]).shape == pressed.pressure([[0, 1e-4]]).shape == (1, 2)


def test_coordinates_are_broadcast(exact):
    x, y = np.linspace(-1, 1, 3) * exact.a, -np.array([[0.1], [0.5]]) * exact.a
    found = exact.stress_at(x, y)
    assert found.shape == (2, 3, 2, 3)
    np.testing.assert_allclose(found[..., 1, 2], exact.stress_at(x[2], y[1, 0]), rtol=0, atol=1e-12 * exact.p0)


KINDS = {  # changes of the scene, and the methods that solve it
    "one pressure": ({}, ("exact", "march", "fem")),
    "sliding": ({"load": {"Q": [-5e4, 5e4]}}, ("exact", "march", "fem")),
    "varying pressure": ({"load": {"P": [1e5, 1.3e5], "sigma": [0.0, 0.0]}}, ("exact", "march", "fem")),
    "unlike materials": ({"material": {"upper": {"E": 2.1e11, "nu": 0.3}}}, ("march", "fem")),
    "blocks": ({"bodies": {"lower": {"width": 0.02, "height": 0.01}}}, METHODS),
}


@pytest.mark.slow
@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("kind", "method"), [(kind, method) for kind, (_, some) in KINDS.items() for method in some])
def test_tractions_are_nan_at_nan_and_zero_at_infinity(kind, method):
    scene = SCENE.replace(KINDS[kind][0], fem={"accuracy": 1e-2})
    result = partialslip.run(scene, [method])[method]
    x = result.a * np.array([[0.3, np.nan, np.inf], [np.nan, -np.inf, 10]])
    found = [each for each in result.traction.at(x) if each is not None]
    for each in found:
        np.testing.assert_array_equal(each.ravel()[1:], [np.nan, 0, np.nan, 0, 0])
        assert np.isfinite(each[0, 0])
    assert all(np.isnan(each) for each in result.traction.at(np.nan) if each is not None)
    np.testing.assert_array_equal(result.traction.at([]).p, [])


def test_tractions_of_a_table_are_nan_at_nan_and_zero_at_infinity(tmp_path):
    x = np.linspace(-2e-4, 2e-4, 9)
    table = "\n".join(["x,p,dq", *(f"{each},{4e8 - 1e16 * each**2},{1e8 - 2.5e15 * each**2}" for each in x)])
    (tmp_path / "mine.csv").write_text(table, "utf-8")
    at = partialslip.score(SCENE, tmp_path / "mine.csv")["mine.csv"].traction.at([0, np.nan, np.inf, -np.inf])
    np.testing.assert_allclose(at.p, [4e8, np.nan, 0, 0])
    np.testing.assert_allclose(at.dq, [1e8, np.nan, 0, 0])


def test_points_that_are_none_are_refused_in_one_line(exact):
    for points in (("x",), ([1.0, [2.0]],)):
        with pytest.raises(partialslip.InputError, match=r"^points: must be numbers or arrays of numbers"):
            exact.traction.at(*points)
    with pytest.raises(partialslip.InputError, match="shapes that fit"):
        exact.stress_at([0, 0], [0, 0, 0])
