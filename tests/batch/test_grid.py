"""partialslip.sweep: one row for each point, resumable, refused before anything is solved."""

import subprocess
import sys

import known
import made
import numpy as np
import pytest
from refusing import line_of

import partialslip
from partialslip.study.batch import grid, job
from partialslip.study.batch.ledger import Ledger
from partialslip_fem import characterise

SCENE = partialslip.load_scene("fretting-aluminium")
F = np.linspace(0.3, 0.6, 4)


@pytest.fixture
def solved(monkeypatch):
    """Coefficients of friction of the scenes that are solved, in a fresh session."""
    found = []
    monkeypatch.setattr(grid, "_SESSION", Ledger())
    monkeypatch.setattr(job, "run", lambda scene, *rest, **more: (
        found.append(scene.friction.f) or partialslip.run(scene, *rest, **more)))  # fmt: skip
    return found


def test_a_row_is_a_run(solved):
    table = partialslip.sweep(SCENE, {"friction.f": F}, "exact")
    assert table["friction.f"].tolist() == F.tolist() == solved
    assert list(table) == ["friction.f", "method", "regime", "a", "p0", "m", "n", "cpu_s", "outcome", "failure"]
    for row in table.itertuples(index=False):
        exact = partialslip.run(SCENE.replace(friction={"f": row[0]}), "exact")["exact"]
        assert (row.method, row.regime, row.a, row.p0, row.m, row.n) == (
            "exact", exact.regime, exact.a, exact.p0, exact.m, exact.n
        )  # fmt: skip
        assert (row.outcome, row.failure) == ("not judged", "")


def test_the_grid_is_all_combinations_and_points_may_be_given(solved):
    Q = [[-1e4, 1e4], (-2e4, 2e4)]
    table = partialslip.sweep(SCENE, {"load.Q": np.array(Q), "friction.f": F[:3]}, ["exact"])
    assert table["friction.f"].tolist() == [*F[:3], *F[:3]]
    assert table["load.Q"].tolist() == [(-1e4, 1e4)] * 3 + [(-2e4, 2e4)] * 3
    assert len(solved) == 6
    points = [{"load.Q": Q[1], "friction.f": F[0]}, {"load.Q": Q[0], "friction.f": F[2]}]
    pairs = partialslip.sweep(SCENE, points, "exact")
    assert pairs["m"].tolist() == table["m"].tolist()[3:1:-1]
    assert len(solved) == 6  # known in this session


def test_points_of_one_geometry_share_their_meshes(solved):
    """In any order of the points, each geometry is factored once: the first mesh, and the uniform one."""
    block = {"width": 8e-3, "height": 8e-3}
    rough = SCENE.replace(fem={"size": 0.1, "order": 2}, bodies={"lower": block, "upper": block})
    heights = [6e-3, 7e-3, 8e-3]
    points = [{"friction.f": f, **{f"bodies.{body}.height": height for body in ("lower", "upper")}}
              for f in F[1:].tolist() for height in heights]  # fmt: skip
    table = partialslip.sweep(rough, points, "fem", cores=1)
    assert table["bodies.lower.height"].tolist() == heights * 3
    assert table["factorizations"].tolist() == [2, 2, 2, 0, 0, 0, 0, 0, 0]
    assert len(solved) == 9


def test_a_sweep_that_was_stopped_goes_on(solved, tmp_path):
    """Ctrl-C after two points: both are in the file, and the next call solves the other two."""

    def stop(done, total, _):
        assert total == 4
        if done == 2:
            raise KeyboardInterrupt

    path = tmp_path / "new" / "friction.jsonl"
    with pytest.raises(KeyboardInterrupt):
        partialslip.sweep(SCENE, {"friction.f": F}, "exact", ledger=path, progress=stop)
    assert len(Ledger(path)) == len(solved) == 2
    steps = []
    table = partialslip.sweep(
        SCENE, {"friction.f": F}, "exact", ledger=str(path), progress=lambda *at: steps.append(at)
    )
    assert solved == F.tolist()
    assert [done for done, *_ in steps] == [2, 3, 4]
    assert table["m"].notna().all()


def test_a_point_that_fails_says_why_and_the_others_stand(solved):
    scene = SCENE.replace(load={"Q": [-1e4, 1e4, 0.0], "sigma": [-1e8, 1e8, 0.0]})
    table = partialslip.sweep(scene, {"load.sigma": [[-1e8, 1e8, 0.0], [-1e8, 1e8, 1e7]]}, "exact")
    assert table["failure"][0] == ""
    assert "in phase" in table["failure"][1]
    assert table["m"].notna().tolist() == [True, False]
    assert len(solved) == 2
    failed = partialslip.sweep(scene, {"load.sigma": [[-1e8, 1e8, 1e7]]}, (name for name in ["exact"]))
    assert list(failed) == list(table)
    assert failed["m"].isna().all()


def test_columns_of_another_method():
    """Those of the reference have no prefix; errors and estimates belong to the other method."""
    entry = made.solved(known.SCENE, errors={"a": 1e-5, "m": 2e-5, "n": 3e-5, "p": 4e-5, "q": 5e-5},
                        exact={"estimate": {}}, fem={"a": 1.0, "estimate": {"m": 1e-4, "left": 2e-4}})  # fmt: skip
    row = grid._point_row({"friction.f": 0.5}, entry)
    assert (row["method"], row["a"], row["fem.a"]) == ("exact", known.A, 1.0)
    assert {key: row[key] for key in row if "error" in key or "estimate" in key} == {
        "fem.error.a": 1e-5, "fem.error.m": 2e-5, "fem.error.n": 3e-5, "fem.error.p": 4e-5, "fem.error.q": 5e-5,
        "fem.estimate.m": 1e-4,
    }  # fmt: skip
    assert [*row][-2:] == ["outcome", "failure"]


def blocks(width):
    """Blocks as wide as high."""
    return SCENE.replace(
        {f"bodies.{body}.{key}": width for body in ("upper", "lower") for key in ("width", "height")}
        | {"load.P": None, "load.a": 1e-3, "load.sigma": [0.0, 0.0], "fem.accuracy": 1e-2}
    )


def test_a_geometry_is_characterised_once(solved, monkeypatch):
    """In whatever order its points are asked for, and however many geometries there are."""
    found, rig = [], characterise.characterise_bodies(blocks(20e-3))  # instead of that of either geometry
    monkeypatch.setattr(sys.modules["partialslip.run"], "_rigs", {})
    monkeypatch.setattr(sys.modules["partialslip.run"], "_KEPT", 1)
    monkeypatch.setattr(characterise, "characterise_bodies", lambda scene: found.append(scene) or rig)
    over = {"friction.f": F[:2], "bodies.lower.width": [16e-3, 20e-3]}
    table = partialslip.sweep(blocks(20e-3), over, "equivalent", cores=1)
    assert table["friction.f"].tolist() == [F[0], F[0], F[1], F[1]]
    assert table["failure"].tolist() == [""] * 4
    assert (len(solved), len(found)) == (4, 2)


def test_a_share_of_the_points_is_checked_by_finite_elements(solved):
    """Points are drawn, the same in each call; errors are those of the method asked for."""
    table = partialslip.sweep(blocks(20e-3), {"friction.f": F}, "equivalent", check=0.5, cores=1)
    assert table["method"].tolist() == ["equivalent"] * 4
    checked = table["fem.m"].notna()
    assert checked.sum() == table["error.m"].notna().sum() == 2
    assert (table["error.m"][checked] < 1e-3).all()
    assert np.allclose(abs(table["m"] - table["fem.m"])[checked], (table["error.m"] * table["fem.a"])[checked])
    again = partialslip.sweep(blocks(20e-3), {"friction.f": F}, "equivalent", check=0.5, cores=1)
    assert again.equals(table)
    assert len(solved) == 4
    assert "fem.m" not in partialslip.sweep(SCENE, {"friction.f": F[:1]}, "exact")


@pytest.mark.parametrize(
    ("over", "more", "line"),
    [
        ({"friction.g": [1]}, {}, "friction.g: unknown key; known are f"),
        ({"friction.f": [0.3, -1.0]}, {}, "friction.f = -1.0: must be >= 0.0"),
        ({"load.Q": [1e4]}, {}, "load.Q = 10000.0: must be an array, not a number"),
        ({"friction.f": 0.3}, {}, "over: friction.f = 0.3: must be a list of values"),
        ({"friction.f": []}, {}, "over: friction.f: must be a list of at least one value"),
        ([], {}, "over: must be values by key, or a list of points, each with a value by key"),
        (3, {}, "over: must be values by key, or a list of points, each with a value by key"),
        ({"friction.f": F}, {"methods": "exactly"}, "methods = exactly: must be one or several of exact, march, fem"),
        ({"friction.f": F}, {"methods": []}, "methods = none: must be one or several of exact, march, fem"),
        ({"friction.f": F}, {"methods": 3}, "methods = 3: must be one or several of exact, march, fem"),
        ({"friction.f": F}, {"methods": [["fem"]]}, "methods = ['fem']: must be one or several of exact, march, fem"),
        ({"friction.f": F}, {"ledger": 3}, "ledger = 3: must be the path of a file"),
        ({3: F}, {}, "3: a key must be a string, such as 'load.P'"),
        ([{3: 0.5}], {}, "3: a key must be a string, such as 'load.P'"),
        ({"friction.f": F}, {"check": 1.5}, "check = 1.5: must be from 0 to 1"),
        ({"friction.f": F}, {"cores": 0}, "cores = 0: must be a whole number >= 1"),
        ({"friction.f": F}, {"cluster": "nowhere"}, "--cluster 'nowhere': must be a scheduler's address"),
    ],
)
def test_what_is_refused_before_anything_is_solved(solved, over, more, line):
    assert line_of(partialslip.sweep, SCENE, over, **{"methods": "exact", **more}).startswith(line)
    assert solved == []


def test_a_script_may_use_all_cores_without_a_guard(tmp_path):
    """Worker processes do not run the script again."""
    script = tmp_path / "script.py"
    script.write_text(
        "import partialslip\nprint('begun')\nscene = partialslip.load_scene('hertz-shear')\n"
        "print(len(partialslip.sweep(scene, {'friction.f': [0.5, 0.6]}, 'exact', cores=2)))\n",
        "utf-8",
    )
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr) == ("begun\n2\n", "")


@pytest.mark.slow
@pytest.mark.usefixtures("solved")
def test_a_scene_that_asks_for_stresses_has_columns_of_them():
    """Values, places, errors against the reference, and estimates; a scene that does not ask has none, and no work."""
    asking = SCENE.replace({"fatigue.distance": 5e-5, "fem.accuracy": 1e-3})
    row = partialslip.sweep(asking, {"friction.f": F[:1]}, ["exact", "fem"]).iloc[0]
    exact = partialslip.run(asking.replace({"friction.f": F[0]}), "exact", subsurface=True)["exact"]
    assert (row["sigma_xx.x"], row["sigma_xx"]) == exact.surface.largest
    for key in ("sigma_xx", "swt", "swt.line", "principal"):
        assert row[f"fem.error.{key}"] == pytest.approx(abs(row[f"fem.{key}"] / row[key] - 1))
        assert row[f"fem.error.{key}"] < row[f"fem.estimate.{key}"] < 0.1
    plain = partialslip.sweep(SCENE.replace({"fem.accuracy": 1e-3}), {"friction.f": F[:1]}, ["exact", "fem"])
    assert not [name for name in plain if "sigma_xx" in name or "swt" in name]
