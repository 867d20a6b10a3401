"""Bad files: tables and results to score, meshes, saved states; and the arguments that go with them."""

from pathlib import Path

import meshio
import numpy as np
import pytest

from partialslip import load_scene, run

FIXTURES = Path(__file__).parents[1] / "score"
FRD, DAT = (FIXTURES / f"calculix.{ending}" for ending in ("frd", "dat"))
X = np.linspace(-1.1e-3, 1.1e-3, 23)
P = 4e8 * np.sqrt(np.maximum(1 - (X / 1e-3) ** 2, 0))
TABLE = "x,p,dq\n" + "".join(f"{x!r},{p!r},{p / 4!r}\n" for x, p in np.column_stack([X, P]).tolist())


def lines(text, **changes):
    """``text`` with the lines of the numbers given changed, L3="..." being the third."""
    every = text.splitlines()
    for number, new in changes.items():
        every[int(number[1:]) - 1] = new
    return "\n".join(every) + "\n"


TABLES = [
    ("", "empty: must have a header line"),
    ("x,p,dq\n", "line 1: no row of numbers follows"),
    (TABLE.partition("\n")[2].replace("\n", ",1\n"), "line 1: must be a header line with x, p and dq"),
    (TABLE.replace("x,p,dq", "x,p"), "line 2: must have 2 fields, like the header line"),
    (TABLE.replace("x,p,dq", "x,p,tau"), "columns 'x', 'p', 'tau': must be"),
    (TABLE.replace("x,p,dq", "X,P,DQ"), "columns 'X', 'P', 'DQ': must be"),
    (TABLE.replace("x,p,dq", "x,p,dFt"), "columns p and dFt: must be both tractions or both forces"),
    (TABLE.replace("x,p,dq", "x,Fn,q"), "columns Fn and q: must be both tractions or both forces"),
    (TABLE.replace("x,p,dq", "x,x,dq"), "column 'x': must be there once, not 2 times"),
    (TABLE.replace("x,p,dq", "x,p,q1"), "columns 'x', 'p', 'q1': must be"),
    (TABLE.replace("x,p,dq", "x 2 dq"), "line 1: must be a header line of 3 names, like line 2"),
    (TABLE.replace("\n", ",1\n").replace("x,p,dq,1", "x,p,dq,q"), "'dq', 'q': must be"),
    (lines(TABLE, L3="1,2"), "line 3: must have 3 fields"),
    (lines(TABLE, L4="a,2,3"), "line 4: x = 'a': must be a number"),
    (lines(TABLE, L4="1e-4,1 2,3"), "line 4: p = '1 2': must be a number"),
    (lines(TABLE, L4='1e-4,"1,3'), "line 4: must have 3 fields"),
    (lines(TABLE, L4="1e-4,inf,3"), "line 4: p = inf: must be zero or of a size"),
    (lines(TABLE, L4="1e-4,1e200,3"), "line 4: p = 1e200: must be zero or of a size"),
    (lines(TABLE, L4="1e-4,1e-200,3"), "line 4: p = 1e-200: must be zero or of a size"),
    (TABLE.replace("\n", "\n#"), "line 1: no row of numbers follows"),
    (lines(TABLE, L1="x,p,dq")[:150], ""),
    ("x,p,dq\n" + "0,1e8,0\n" * 50, "p > 0 at 1 points"),
    ("x,p,dq\n" + "".join(f"{x!r},0,0\n" for x in X.tolist()), "p > 0 at 0 points"),
    ("x,p,dq\n" + "".join(f"{i},{i % 2 * 1e8},0\n" for i in range(60)), "must exceed its noise"),
    ("x,Fn,dFt\n" + "".join(f"{i},{1 + i % 2 * 1e8},0\n" for i in range(60)), "another order (--order)"),
    ("x,p,dq\n" + "\x00" * 99, "must be text; character 8 is not"),
]


@pytest.mark.parametrize(("text", "expected"), TABLES)
def test_tables(rejected, tmp_path, text, expected):
    (tmp_path / "t.csv").write_text(text, "utf-8")
    message = rejected(None, ["score", "hertz-shear", "t.csv"])
    assert message.startswith("partialslip: t.csv: ")
    assert expected in message


@pytest.mark.parametrize("content", [b"\x80\x01" * 50, b"x,p,dq\n\x02,1,2\n"])
@pytest.mark.parametrize("name", ["t.csv", "t.frd", "t.dat"])
def test_no_text(rejected, tmp_path, content, name):
    (tmp_path / name).write_bytes(content)
    assert "must be text" in rejected(None, ["score", "hertz-shear", name])


@pytest.mark.parametrize("name", ["t.csv", "t.frd", "t.dat", "t.vtu", "t.xdmf", "t.msh", "t.med", "t.vtk", "nul\0.csv",
                                  "two\nlines.csv", "x" * 300 + ".csv", "none/t.csv", "nul\0.vtu"])  # fmt: skip
def test_no_file(rejected, tmp_path, name):
    assert "cannot be read" in rejected(None, ["score", "hertz-shear", name])
    if "\0" not in name and len(name) < 100 and "/" not in name:
        (tmp_path / name).mkdir()
        assert "cannot be read" in rejected(None, ["score", "hertz-shear", name])


def swapped(old, new, count=-1):
    return lambda text: text.replace(old, new, count)


FRDS = {
    "empty": (lambda _: "", "no nodes (block 2C)"),
    "another file": (lambda _: TABLE, "no nodes (block 2C)"),
    "without nodes": (swapped("    2C", "    7C"), "no nodes (block 2C)"),
    "without contact": (swapped("CONTACT", "STRESS "), "no contact stresses; add"),
    "without shear": (swapped("CSHEAR1", "CSHARE1"), "must include CPRESS and CSHEAR1"),
    "one load point": (lambda text: text[: text.rindex("    1PSTEP")] + " 9999\n", "contact results of 1 steps"),
    "breaks off": (lambda text: text[: text.rindex(" -3")], "the block that begins here has no end"),
    "stars": (lambda text: text[: text.rindex(" -1") + 13] + "*" * 72 + "\n -3\n", "must be ASCII rows of 6 numbers"),
    "nan": (lambda text: text[: text.rindex(" -1") + 37] + "         NaN" * 4 + "\n -3\n", ""),
    "step of no number": (swapped("    1PSTEP", "    1PSTEP  x"), ""),
    "no step number": (lambda text: text.replace("    1PSTEP", "    1PSTEP x\n"), "'x': must be a whole number"),
    "other nodes": (lambda text: text[: text.rindex(" -1")] + " -3\n", "must be at the same nodes"),
    "no pressure": (lambda text: "".join(x for x in text.splitlines(True) if len(x) < 80), "p > 0 at 0 points"),
}


DATS = {
    "empty": (lambda _: "", "no contact stresses; add"),
    "another file": (lambda _: TABLE, "no contact stresses; add"),
    "words": (swapped("E+08", "E+ 8", 1), "must be rows of 5 numbers"),
    "stars": (swapped("E+07", "****", 1), "must be rows of 5 numbers"),
    "another element": (swapped("      540 ", "      999 "), ""),
    "one load point": (lambda text: text[: text.rindex(" contact stress")], "contact results of 1 steps"),
    "nodes": (swapped("(slave element+face", "(slave node"), "must be rows of 4 numbers"),
    "no such face": (lambda text: text.replace("          3 ", "          9 "), "face 9 of element"),
}


@pytest.mark.parametrize(
    ("path", "fault"),
    [*((FRD, fault) for fault in FRDS), *((DAT, fault) for fault in DATS)],
    ids=lambda each: str(each)[-20:],
)
def test_results_of_calculix(rejected, tmp_path, path, fault):
    spoil, expected = (FRDS if path is FRD else DATS)[fault]
    (tmp_path / "t.frd").write_bytes(FRD.read_bytes())
    name = f"t{path.suffix}"
    (tmp_path / name).write_text(spoil(path.read_text("utf-8")), "utf-8")
    if expected:
        assert expected in rejected(None, ["score", "hertz-shear", name])


def test_dat_without_its_mesh(rejected, tmp_path):
    (tmp_path / "t.dat").write_bytes(DAT.read_bytes())
    assert "t.frd: cannot be read: No such file" in rejected(None, ["score", "hertz-shear", "t.dat"])
    (tmp_path / "t.frd").write_text(FRD.read_text("utf-8").replace("    3C", "    7C"), "utf-8")
    assert "elements (block 3C): must be in the .frd file" in rejected(None, ["score", "hertz-shear", "t.dat"])
    (tmp_path / "t.frd").write_text("    2C\n -3\n    3C\n -3\n", "utf-8")
    assert ": must be in the .frd file of the same name" in rejected(None, ["score", "hertz-shear", "t.dat"])


MESHES = {
    "no data": ({}, "must be x; p or Fn"),
    "no shear": ({"p": P}, "must be x; p or Fn; and one of dq"),
    "too much shear": ({"p": P, "q": P, "dq": P}, "must be x; p or Fn; and one of dq"),
    "vectors": ({"p": np.stack([P] * 3, axis=1), "dq": P}, "'p:2', 'dq': must be x; p or Fn"),
    "all nan": ({"p": np.full(23, np.nan), "dq": P}, "p > 0 at 0 points"),
    "infinite": ({"p": np.full(23, np.inf), "dq": P}, ""),
    "few": ({"p": np.where(np.abs(X) < 1.5e-4, P, 0), "dq": P}, "must be at least 6"),
}


def mesh(data, y=0.0):
    points = np.column_stack([X, y + 0 * X, 0 * X])
    return meshio.Mesh(points, [("line", np.column_stack([np.arange(22), np.arange(1, 23)]))], point_data=data)


@pytest.mark.parametrize("fault", MESHES)
@pytest.mark.parametrize("ending", ["vtu", "vtk"])
def test_meshes(rejected, tmp_path, fault, ending):
    data, expected = MESHES[fault]
    with np.errstate(invalid="ignore"):
        meshio.write(tmp_path / f"t.{ending}", mesh(data))
    if ending == "vtu" or fault != "vectors":
        assert expected in rejected(None, ["score", "hertz-shear", f"t.{ending}"])


def test_a_mesh_that_is_no_line(rejected, tmp_path):
    meshio.write(tmp_path / "t.vtu", mesh({"p": P, "dq": P}, y=np.arange(23) * 1e-4))
    assert "lie apart across x: must be on one line" in rejected(None, ["score", "hertz-shear", "t.vtu"])


@pytest.mark.parametrize(
    "content", [b"", b"<VTKFile", b"<?xml version='1.0'?><VTKFile/>", b"\x00" * 64, TABLE.encode()]
)
@pytest.mark.parametrize("ending", ["vtu", "vtk", "xdmf", "xmf", "msh", "med", "e", "exo", "ex2", "VTU"])
def test_no_mesh(rejected, tmp_path, content, ending):
    (tmp_path / f"t.{ending}").write_bytes(content)
    rejected(None, ["score", "hertz-shear", f"t.{ending}"])


@pytest.fixture(scope="module")
def state(tmp_path_factory):
    """Arrays of a valid state."""
    path = tmp_path_factory.mktemp("state") / "state.npz"
    run(load_scene("hertz-shear"), ["march"]).results["march"].state.save(path)
    with np.load(path) as file:
        return dict(file)


STATES = {
    "no loads": lambda s: {key: s[key] for key in s if key != "loads"},
    "three loads": lambda s: s | {"loads": s["loads"][:3]},
    "no cells": lambda s: s | {"cells": s["cells"][:0]},
    "one cell end": lambda s: s | {"cells": s["cells"][:1], "q": s["q"][:, :0], "p": s["p"][:, :0]},
    "cells turned round": lambda s: s | {"cells": s["cells"][::-1]},
    "nan cell": lambda s: s | {"cells": np.append(s["cells"][:-1], np.nan)},
    "cells are one number": lambda s: s | {"cells": np.float64(1.0)},
    "cells in two directions": lambda s: s | {"cells": np.stack([s["cells"]] * 2)},
    "p of fewer cells": lambda s: s | {"p": s["p"][:, 1:]},
    "p without powers": lambda s: s | {"p": s["p"][:0]},
    "q as a list": lambda s: s | {"q": s["q"][0]},
    "infinite q": lambda s: s | {"q": s["q"] + np.inf},
    "complex q": lambda s: s | {"q": s["q"] + 1j},
    "words": lambda s: s | {"q": np.array(["a", "b"])},
    "objects": lambda s: s | {"q": np.array([{}, []], dtype=object)},
    "dates": lambda s: s | {"loads": np.array(["2020-01-01"] * 4, dtype="datetime64[D]")},
    "of another P": lambda s: s | {"loads": s["loads"] * [2, 1, 1, 1]},
    "of another A": lambda s: s | {"loads": s["loads"] * [1, 2, 1, 1]},
    "q beyond the bound": lambda s: s | {"q": s["q"] + 10 * s["p"].max()},
    "elsewhere": lambda s: s | {"cells": s["cells"] + 1.0},
    "error below zero": lambda s: s | {"q_error": np.float64(-1e-3)},
    "of another size": lambda s: s | {"cells": s["cells"] * 1e-6},
}


@pytest.mark.parametrize("fault", STATES)
def test_states(rejected, tmp_path, state, fault):
    np.savez(tmp_path / "s.npz", **STATES[fault](state))
    rejected(None, ["run", "hertz-shear", "--with", "march", "--start", "s.npz"])
