"""Saved states: what they hold, and what is refused. To stop and go on is not to stop: see `tests/invariances`."""

import numpy as np
import pytest

import partialslip
from partialslip import InputError, load_scene, load_state, run
from partialslip.cli import main

MEAN = ("load.Q=[31415.9, 219911.5]", "load.sigma=[2e8, 1e9]", "fem.accuracy=1e-3")


def solved(method, cycles, start=None, extra=()):
    scene = load_scene("hertz-large-tension", [*MEAN, f"load.cycles={cycles}", *extra])
    return run(scene, [method], start=start).results[method]


def test_a_state_of_one_method_starts_another():
    start = solved("march", 1).state
    assert solved("fem", 1, start).m == pytest.approx(solved("fem", 2).m, rel=1e-4)


def test_steady_cycles_are_not_repeated():
    scene = load_scene("hertz-large-tension", ["load.cycles=200", "effects.history=true", "fem.accuracy=1e-2"])
    for result in run(scene, ["march", "fem"]).results.values():
        assert result.counts["cycles"] == 1
        assert result.counts["load_steps"] == 3


def test_another_load_or_material_is_refused():
    start = solved("march", 1).state
    for other, what in (("load.p0=401e6", "P = "), ("material.E=73e9", "P = ")):
        with pytest.raises(InputError, match=rf"^state: is of {what}"):
            run(load_scene("hertz-large-tension", [other]), ["march"], start=start)
    P = start.P
    harder = load_scene("fretting-aluminium", [f"load.P={P}", "load.Q=[-1e4, 1e4]", "material.E=73e9"])
    with pytest.raises(InputError, match=r"^state: is of A = "):
        run(harder, ["march"], start=start)


def test_on_the_command_line(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    common = [
        "run",
        "hertz-large-tension",
        "--with",
        "march",
        "--set",
        "load.Q=[31415.9, 219911.5]",
        "--accuracy",
        "1e-3",
    ]
    assert main([*common, "--save", "half.npz"]) == 0
    assert "half.npz" in capsys.readouterr().out
    assert main([*common, "--start", "half.npz", "--out", "rest"]) == 0
    assert (tmp_path / "rest" / "results.json").exists()


@pytest.mark.parametrize("content", [b"", b"PK", b"not a state", None])
def test_broken_files(tmp_path, capsys, content):
    path = tmp_path / "broken.npz"
    if content is None:
        np.savez(path, loads=np.ones(4), cells=np.array([0.0, 1.0]), p=np.ones((1, 3)), q=np.ones((1, 1)))
    else:
        path.write_bytes(content)
    with pytest.raises(InputError, match="not a state that partialslip has saved"):
        load_state(path)
    assert main(["run", "hertz-shear", "--with", "march", "--start", str(path)]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_missing_file(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        partialslip.load_state(tmp_path / "none.npz")
