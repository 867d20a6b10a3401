"""Profiles and decks whose lines, words and headings were changed at random (seeded): done, or refused in one line.

PARTIALSLIP_FUZZ=N draws N times as many as are run always, and PARTIALSLIP_SEED=S others.
"""

import os
import re

import meshio
import numpy as np
import pytest

from partialslip_meshes import block

TIMES = int(os.environ.get("PARTIALSLIP_FUZZ", "1"))
SEED = int(os.environ.get("PARTIALSLIP_SEED", "0"))
COUNT = 12

SCENE = """name = "mutated"
material = {E = 72.1e9, nu = 0.33}
friction.f = 0.3
load = {P = 135750.0, Q = [-30e3, 30e3]}
"""
PROFILE = """[profile]
kind = "tabulated"
file = "trace.csv"
smooth = 250e-6
"""
MESH = """[profile]
kind = "hertz"
R = 0.010
[bodies.lower]
mesh = "body.inp"
unit = 1e-3
[fem]
size = 0.25
"""
HEADINGS = [
    *(
        "x [mm], gap [um]",
        "Length mm,Depth um",
        "mm,um",
        "x_mm;gap_um",
        "x/mm\tz/um",
        "# Units: mm",
        "x,gap",
        "",
        "[um]",
    ),
    *(
        "x (mm), z (\N{MICRO SIGN}m)",
        "in,in",
        "m",
        "x [], gap []",
        "x [mm], gap [mm], z [mm]",
        "401",
        "\ufeffx mm,z um",
    ),
    *(
        "#",
        "x [\N{ANGSTROM SIGN}], z [nm]",
        "[" * 50,
        "mm " * 400,
        "gap um, x mm",
        "12 mm, 3 um",
        "a;b;c;d",
        "x, z [um]",
    ),
]
WORDS = [
    *(
        "",
        "nan",
        "inf",
        "-1",
        "1e400",
        "x",
        "0",
        "1e-320",
        "99999999999999999999",
        "1,5",
        "1;2",
        "\x00",
        "#",
        "**",
        "=",
        "*",
    ),
    *(
        "*NODE",
        "* ",
        "*NODE=1",
        "*NODE, SYSTEM=C",
        "*NSET",
        "*NSET, NSET=",
        "*NSET, NSET=contact",
        "*ELSET, ELSET=contact",
    ),
    *("*NSET, NSET=contact, GENERATE", "*ELEMENT, TYPE=T2D2", "*ELEMENT, TYPE=CPE4", "*ELEMENT, TYPE=", "*NGEN"),
    *("*ELEMENT, ELSET=left, TYPE=T2D2", "*INSTANCE, NAME=a", "*PART, NAME=B", "*END PART", "*INCLUDE, INPUT=body.inp"),
]


def changed(text, random):
    """Some lines left out, doubled, exchanged or put elsewhere; words, or separators everywhere, replaced."""
    lines = text.split("\n")
    for _ in range(int(random.integers(1, 4))):
        at, to = (int(random.integers(len(lines))) for _ in range(2))
        if random.integers(2):  # near the head, where there are keywords and headings
            at = min(at, int(random.integers(12)))
        word = WORDS[random.integers(len(WORDS))]
        parts = re.split(r"([,; ]+)", lines[at])
        parts[random.integers(len(parts))] = word
        end = len(lines)
        ways = [
            *((at, at + 1, []), (at, at, [lines[at]]), (at, at, [word]), (at, at + 1, ["".join(parts)])),
            *(
                (at, at + 1, [lines[to]]),
                (end, end, lines[at:]),
                (at, max(at, to), []),
                (0, end, lines[at:] + lines[:at]),
            ),
        ]
        begin, end, new = ways[random.integers(len(ways))]
        lines[begin:end] = new
        lines = lines or [""]
    text = "\n".join(lines)
    if random.integers(5) == 0:
        text = text.replace(",", [";", "\t", " ", ", ,", "\r\n"][random.integers(5)])
    return text


def trace(random):
    """A trace of a cylinder with noise, from anywhere on, with some heading."""
    begin = [0.0, -1.5, -0.06, 0.06, -1.0, 1.5][random.integers(6)]
    x = np.linspace(begin, 2.0, int(random.integers(5, 300)))
    shift = [0.0, 0.0, begin, 1e-3, 1e6][random.integers(5)]
    z = x**2 / 20 * 1e3 + 0.02 * random.standard_normal(len(x))
    heading = HEADINGS[random.integers(len(HEADINGS))]
    return "\n".join([heading, *(f"{a - shift:.6g},{b:.6g}" for a, b in zip(x, z, strict=True))])


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """The text of a sound deck, a flat specimen in mm."""
    mesh = block(4.0, (-0.5, 0.5), {}, 0.5, 2.0, along=0.06)
    sets = {name: np.unique(edges) for name, edges in mesh.lines.items()}
    path = tmp_path_factory.mktemp("sound") / "body.inp"
    points = np.column_stack([mesh.points, 0 * mesh.points[:, 0]])
    meshio.write(path, meshio.Mesh(points, [("triangle", mesh.triangles)], point_sets=sets))
    return path.read_text()


def test_mutated_profiles(judged, tmp_path):
    refused = 0
    for number in range(COUNT * TIMES):
        random = np.random.default_rng([SEED, number, 1])
        (tmp_path / "trace.csv").write_text(changed(trace(random), random), "utf-8", newline="")
        (tmp_path / "job.toml").write_text(
            SCENE + PROFILE + ["", "unit = 1e-3\n", "noise = 1e-7\n"][random.integers(3)]
        )
        refused += judged(["run", "job.toml", "--with", "exact", "--json"])
    assert refused > 0


def test_mutated_decks(judged, tmp_path, sound):
    refused = 0
    for number in range(COUNT * TIMES):
        random = np.random.default_rng([SEED, number, 2])
        (tmp_path / "body.inp").write_text(changed(sound, random), "utf-8", newline="")
        (tmp_path / "job.toml").write_text(SCENE + MESH)
        refused += judged(["run", "job.toml", "--with", "fem", "--json"])
    assert refused > 0
